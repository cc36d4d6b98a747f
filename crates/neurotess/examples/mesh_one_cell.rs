//! From a tracing to a mesh file, and the file checked.
//!
//! `cargo run --release -p neurotess --example mesh_one_cell -- [CELL] [OUT.ply]`

use std::path::PathBuf;

use neurotess::formats::{ReadOptions, read};
use neurotess::generate::{GenerateOptions, generate};
use neurotess::mesh::{self, Format};
use neurotess::output::{Existing, Output};
use neurotess::refine::{LodCriterion, RefineOptions, Refinement};

#[expect(clippy::print_stdout, reason = "this is its output")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args_os().skip(1).map(PathBuf::from);
    let cell = arguments.next().unwrap_or("samples/granule.swc".into());
    let out = arguments.next().unwrap_or("granule.ply".into());

    // The tracing; what is odd in the file comes back as warnings.
    let read = read(&cell, &ReadOptions::default())?;
    for warning in &read.warnings {
        println!("{}: {warning}", cell.display());
    }
    // Quads around it, closed by their indices, and smooth triangles of them, made as they are written.
    let generated = generate(&read.morphology, &GenerateOptions::default())?;
    let lod = LodCriterion::Homogeneous(4);
    let surface = Refinement::new(&generated.mesh, lod, &RefineOptions::default());
    let mut file = Output::create(&out, Existing::Replace)?;
    mesh::write(&surface, Format::Ply, file.file())?;
    file.finish()?;

    let report = mesh::check(&mesh::read(&out)?);
    println!("{}: {} triangles", out.display(), report.triangles);
    println!(
        "closed: {}, volume: {:.1} µm³",
        report.closed, report.volume
    );
    Ok(())
}
