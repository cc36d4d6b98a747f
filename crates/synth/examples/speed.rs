//! How many cells a minute one thread grows:
//! `cargo run --release -p neurotess-synth --example speed -- [may-cross]`
#![expect(clippy::print_stdout, reason = "it is what the example is for")]

use std::time::Instant;

use neurotess_synth::{Kind, Options, grow};

fn main() {
    const CELLS: u64 = 300;
    let may_cross = std::env::args().any(|argument| argument == "may-cross");
    for kind in Kind::ALL {
        let start = Instant::now();
        let cells = (0..CELLS).map(|seed| Options {
            points: Some(5000),
            may_cross,
            ..Options::new(kind, seed)
        });
        let points: usize = cells.map(|options| grow(&options).points.len()).sum();
        let minutes = start.elapsed().as_secs_f64() / 60.0;
        println!(
            "{kind}: {:.0} cells a minute ({points} points)",
            CELLS as f64 / minutes
        );
    }
}
