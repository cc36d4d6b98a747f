//! From a tracing to a picture, colored by type.
//!
//! `cargo run --release -p neurotess --example draw_one_cell -- [CELL] [OUT.png]`

use std::path::PathBuf;

use neurotess::options::Picture;
use neurotess::options::words::Fit;
use neurotess::recipe::MeshOptions;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args_os().skip(1).map(PathBuf::from);
    let cell = arguments.next().unwrap_or("samples/granule.swc".into());
    let out = arguments.next().unwrap_or("granule.png".into());
    let tracing = neurotess::read(cell)?;
    let cell = neurotess::mesh(&tracing, &MeshOptions::default())?;
    let mut picture = Picture::default();
    picture.look.scale_bar = Some(Fit::Auto);
    Ok(neurotess::draw(&[&cell], &picture)?.save(out)?)
}
