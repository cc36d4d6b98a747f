//! Writes one cell of each kind into a folder (default `samples`):
//! `cargo run --release -p neurotess-synth --example samples`

use std::fs::File;
use std::path::Path;

use neurotess_formats::swc;
use neurotess_synth::{Kind, Options, grow};

fn main() -> std::io::Result<()> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| "samples".into());
    for kind in Kind::ALL {
        let file = File::create(Path::new(&folder).join(format!("{kind}.swc")))?;
        swc::write(&grow(&Options::sample(kind)), file)?;
    }
    Ok(())
}
