//! The figures of `benchmarks/circuits.md`: how long it takes to open a circuit, and to read a frame of some
//! elements of a large report.
//!
//! `cargo run --release -p neurotess-circuit --example figures -- CIRCUIT`

use std::fs::File;
use std::io::BufWriter;
use std::time::Instant;

use neurotess_circuit::write::{ReportLayout, report};
use neurotess_circuit::{Circuit, Report, Selection, TimeAxis};

const ELEMENTS: u64 = 10_000_000;
const FRAMES: u64 = 16;
const PER_NODE: u64 = 100;

#[expect(clippy::print_stdout, reason = "that is what it is for")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let seconds = |clock: Instant| clock.elapsed().as_secs_f64();
    if let Some(path) = std::env::args().nth(1) {
        for _ in 0..3 {
            let clock = Instant::now();
            let circuit = Circuit::open(&path)?;
            let opened = seconds(clock);
            let clock = Instant::now();
            let selection = Selection {
                sample: Some((10_000, 1)),
                ..Selection::default()
            };
            let nodes = circuit.select(&selection)?;
            let instances = circuit.instances(&nodes, None);
            println!(
                "{} nodes opened in {opened:.3} s, {} sampled in {:.3} s",
                circuit.n_neurons(),
                instances.len(),
                seconds(clock)
            );
        }
    }
    let folder = tempfile::tempdir()?;
    for (name, chunk, compressed) in [
        ("chunks of 1 × 4096", [1, 4096], false),
        ("chunks of 16 × 1024, compressed", [16, 1024], true),
        ("one chunk per frame", [1, ELEMENTS], false),
    ] {
        let path = folder.path().join("report.h5");
        let clock = Instant::now();
        make(&path, chunk, compressed)?;
        println!("{name}: written in {:.1} s", seconds(clock));
        let clock = Instant::now();
        let opened = Report::open(&path)?;
        let values = &opened.populations[0];
        println!("  opened in {:.3} s", seconds(clock));
        // As a view does it: the elements of some whole neurons, near one another or not.
        for (what, step) in [("of neighbors", 1), ("of neurons all over", 100)] {
            let nodes = (0..1000).map(|n| n * step);
            let wanted: Vec<u64> = nodes.flat_map(|n| values.compartment_range(n)).collect();
            for frame in [3, 4] {
                let clock = Instant::now();
                let read = values.values(frame, &wanted)?;
                let expected = |e: &u64| value(frame, *e);
                assert!(read.iter().zip(&wanted).all(|(v, e)| *v == expected(e)));
                println!("  {} elements {what}: {:.4} s", read.len(), seconds(clock));
            }
        }
    }
    Ok(())
}

fn value(frame: u64, element: u64) -> f32 {
    (frame * 7 + element % 1013) as f32
}

fn make(
    path: &std::path::Path,
    chunk: [u64; 2],
    compressed: bool,
) -> Result<(), Box<dyn std::error::Error>> {
    let nodes = ELEMENTS / PER_NODE;
    let layout = ReportLayout {
        population: "cortex".into(),
        time: TimeAxis::of_frames(0.0, 0.5, FRAMES)?,
        units: "mV".into(),
        nodes: (0..nodes).collect(),
        sections: vec![(0..PER_NODE as u32).collect(); nodes as usize],
        chunk,
        compressed,
    };
    let elements = |frame| (0..ELEMENTS).map(move |element| value(frame, element));
    let data: Vec<f32> = (0..FRAMES).flat_map(elements).collect();
    report(&layout, &data, BufWriter::new(File::create(path)?))?;
    Ok(())
}
