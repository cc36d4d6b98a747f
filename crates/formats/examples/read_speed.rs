//! How fast SWC files are read and written:
//! `cargo run --release -p neurotess-formats --example read_speed -- FILE...`
#![expect(clippy::print_stdout, reason = "it is what the example is for")]

use std::time::Instant;

use neurotess_formats::{ReadOptions, swc};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for file in std::env::args().skip(1) {
        let bytes = std::fs::read(&file)?;
        let megabytes = bytes.len() as f64 / 1e6;
        let runs = (2000.0 / megabytes).clamp(3.0, 200.0) as usize;
        let (mut read, mut written) = (Vec::new(), Vec::new());
        for _ in 0..runs {
            let start = Instant::now();
            let cell = swc::read_bytes(&bytes, &file, &ReadOptions::default())?.morphology;
            read.push(megabytes / start.elapsed().as_secs_f64());
            let start = Instant::now();
            swc::write(&cell, std::io::sink())?;
            written.push(megabytes / start.elapsed().as_secs_f64());
        }
        read.sort_by(f64::total_cmp);
        written.sort_by(f64::total_cmp);
        println!(
            "{file}: {megabytes:.1} MB, read {:.0} MB/s (median; best {:.0}), written {:.0} MB/s",
            read[runs / 2],
            read[runs - 1],
            written[runs / 2]
        );
    }
    Ok(())
}
