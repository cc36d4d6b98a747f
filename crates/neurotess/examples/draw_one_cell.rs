//! From a tracing to a picture, colored by type.
//!
//! `cargo run --release -p neurotess --example draw_one_cell -- [CELL] [OUT.png]`

use std::path::PathBuf;

use neurotess::recipe::{DrawOptions, MeshOptions};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args_os().skip(1).map(PathBuf::from);
    let cell = arguments.next().unwrap_or("samples/granule.swc".into());
    let out = arguments.next().unwrap_or("granule.png".into());
    let tracing = neurotess::read(cell)?;
    let cell = neurotess::mesh(&tracing, &MeshOptions::default())?;
    let picture = neurotess::draw(&[&cell], &DrawOptions::default().with_scale_bar(0.0))?;
    Ok(picture.save(out)?)
}
