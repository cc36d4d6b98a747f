//! Synthetic cells beside real ones, as a Markdown table:
//! `cargo run --release -p neurotess-synth --example compare -- REAL.swc...`
#![expect(clippy::print_stdout, reason = "it is what the example is for")]

use neurotess_formats::{ReadOptions, read};
use neurotess_morphology::{Morphology, NeuriteKind, SectionId, shape};
use neurotess_synth::{Kind, Options, grow};

/// How far along daughters a fork's angle is measured (µm).
const REACH: f64 = 10.0;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!(
        "| cell | part | points | length mm | spacing µm | forks/mm | order | section µm \
         | radius µm 10/50/90 % | contraction | fork angle ° |"
    );
    println!("|---|---|--:|--:|--:|--:|--:|--:|---|--:|--:|");
    for file in std::env::args().skip(1) {
        let cell = read(&file, &ReadOptions::default())?.morphology;
        rows(&cell.name, &cell);
    }
    for kind in Kind::ALL {
        rows(&format!("**{kind}**"), &grow(&Options::new(kind, 1)));
    }
    for points in [50, 500_000] {
        let cell = grow(&Options {
            points: Some(points),
            ..Options::new(Kind::Pyramidal, 1)
        });
        rows(&format!("**pyramidal, {points}**"), &cell);
    }
    Ok(())
}

fn rows(name: &str, cell: &Morphology) {
    let axon = |kind| kind == NeuriteKind::AXON;
    row(name, "dendrites", cell, |kind| !axon(kind));
    row(name, "axon", cell, axon);
}

/// One row of the table, of the sections of some kinds.
fn row(name: &str, part: &str, cell: &Morphology, taken: impl Fn(NeuriteKind) -> bool) {
    let of: Vec<usize> = (0..cell.sections.len())
        .filter(|&i| taken(cell.sections[i].kind))
        .collect();
    let points = || {
        of.iter()
            .flat_map(|&i| cell.section_points(SectionId(i as u32)))
    };
    if points().count() < 15 {
        return;
    }
    let lengths = shape::section_lengths(cell);
    let length: f64 = of.iter().map(|&i| lengths[i]).sum();
    let children = shape::child_counts(cell);
    let forks = of.iter().filter(|&&i| children[i] > 1).count();
    let orders = shape::branch_orders(cell);
    let order = of.iter().map(|&i| orders[i]).max().unwrap_or(0);
    let contraction = shape::contractions(cell);
    let contraction = mean(
        of.iter()
            .filter(|&&i| lengths[i] > 10.0)
            .filter_map(|&i| contraction[i]),
    );
    let angles = shape::fork_angles(cell, REACH);
    let angle = mean(of.iter().filter_map(|&i| angles[i])).to_degrees();
    let mut radii: Vec<f64> = points().map(|p| f64::from(p.radius)).collect();
    radii.sort_by(f64::total_cmp);
    let radius = |part: f64| radii[(part * (radii.len() - 1) as f64) as usize];
    println!(
        "| {name} | {part} | {} | {:.2} | {:.1} | {:.1} | {order} | {:.0} \
         | {:.2} / {:.2} / {:.2} | {contraction:.2} | {angle:.0} |",
        radii.len(),
        length / 1000.0,
        length / radii.len() as f64,
        forks as f64 / length * 1000.0,
        length / of.len() as f64,
        radius(0.1),
        radius(0.5),
        radius(0.9),
    );
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0), |(sum, count), v| (sum + v, count + 1));
    sum / f64::from(count)
}
