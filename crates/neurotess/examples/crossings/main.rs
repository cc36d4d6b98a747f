//! Counts pairs of triangles that cross, with branches as traced and moved apart.
//!
//! `cargo run --release -p neurotess --example crossings -- FILES…`: a pair is *near* if the way between its
//! two along the tree is short, at forks and bends. All others are *apart*: branches that were traced through one
//! another, or through a soma that they do not belong to.

mod judge;

use std::path::Path;
use std::time::Instant;

use neurotess::formats::{ReadOptions, read};
use neurotess::generate::{Crossings, GenerateOptions, Separation, generate};

use judge::judge;

#[expect(clippy::print_stdout, reason = "this is its output")]
fn main() {
    for file in std::env::args().skip(1) {
        match lines(Path::new(&file)) {
            Ok(lines) => println!("{lines}"),
            Err(error) => println!("{file}: {error}"),
        }
    }
}

fn lines(file: &Path) -> Result<String, Box<dyn std::error::Error>> {
    let morphology = read(file, &ReadOptions::default())?.morphology;
    let mut lines = format!("{} ({} points)", morphology.name, morphology.points.len());
    for crossings in [Crossings::Keep, Crossings::Separate] {
        let options = GenerateOptions {
            crossings,
            ..GenerateOptions::default()
        };
        let clock = Instant::now();
        let generated = generate(&morphology, &options)?;
        let seconds = clock.elapsed().as_secs_f64();
        let crossing = judge(&morphology, &generated.mesh);
        lines += &format!(
            "\n  {crossings:?}: near {}, apart {}, {seconds:.3} s",
            crossing.near, crossing.apart
        );
        for (samples, count) in crossing.samples.iter().take(3) {
            lines += &format!("\n    {count} pairs at samples {samples:?}");
        }
        lines += &generated.separation.as_ref().map(said).unwrap_or_default();
    }
    Ok(lines)
}

fn said(separation: &Separation) -> String {
    let left: Vec<_> = separation.places.iter().filter(|p| p.after > 0.0).collect();
    let mut text = format!(
        "\n    {} places, {} left; {} points moved, by {:.3} µm or {:.2} radii (median), {:.2} µm or {:.1} radii \
         (largest); length {:+.3} %, complete: {}",
        separation.places.len(),
        left.len(),
        separation.moved,
        separation.median_move,
        separation.median_move_radii,
        separation.largest_move,
        separation.largest_move_radii,
        100.0 * separation.length_change,
        separation.complete,
    );
    for place in left.iter().take(3) {
        text += &format!("\n    left: {place:?}");
    }
    text
}
