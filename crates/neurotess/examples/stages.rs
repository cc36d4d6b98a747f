//! Times every stage from file to refined surface, in one process, one thread.
//!
//! `cargo run --release -p neurotess --example stages -- FILES…` prints one JSON object per file:
//! the best of several runs each, in milliseconds. The soma's factorisation is made once per
//! process; the first soma's time with it is given apart.

use std::path::Path;
use std::time::Instant;

use neurotess::formats::{ReadOptions, read};
use neurotess::generate::{GenerateOptions, generate, generate_watched};
use neurotess::mesh::{Faces, Surface, Watch};
use neurotess::refine::{LodCriterion, RefineOptions, Refinement};

#[expect(clippy::print_stdout, reason = "this is its output")]
fn main() {
    for file in std::env::args().skip(1) {
        match stages(Path::new(&file)) {
            Ok(line) => println!("{line}"),
            Err(error) => println!("{{\"file\": {file:?}, \"error\": {:?}}}", error.to_string()),
        }
    }
}

/// Milliseconds of the fastest of `runs` runs.
fn best<T>(runs: usize, mut work: impl FnMut() -> T) -> f64 {
    (0..runs)
        .map(|_| {
            let clock = Instant::now();
            std::hint::black_box(work());
            clock.elapsed().as_secs_f64() * 1e3
        })
        .fold(f64::INFINITY, f64::min)
}

fn stages(file: &Path) -> Result<String, Box<dyn std::error::Error>> {
    let options = ReadOptions::default();
    let bytes = std::fs::metadata(file)?.len();
    let morphology = read(file, &options)?.morphology;
    let read_ms = best(7, || read(file, &options));
    let generate_options = GenerateOptions::default();
    let clock = Instant::now();
    let generated = generate(&morphology, &generate_options).expect("meshed");
    let first_ms = clock.elapsed().as_secs_f64() * 1e3;
    let mut soma_ms = f64::INFINITY;
    let coarse_ms = best(7, || {
        let clock = Instant::now();
        let seconds = || clock.elapsed().as_secs_f64();
        let watch = Watch::default().with_clock(&seconds);
        let again = generate_watched(&morphology, &generate_options, &watch).expect("meshed");
        soma_ms = soma_ms.min(again.soma_seconds * 1e3);
    });
    let levels = LodCriterion::Homogeneous(4);
    let mut triangles = 0;
    let refine_ms = best(3, || {
        let refinement = Refinement::new(&generated.mesh, levels, &RefineOptions::default());
        triangles = refinement.triangle_count();
        let (mut vertices, mut faces) = (Vec::new(), Faces::default());
        for block in 0..refinement.vertex_blocks() {
            vertices.clear();
            refinement.vertices(block, &mut vertices);
            std::hint::black_box(&vertices);
        }
        for block in 0..refinement.face_blocks() {
            faces.triangles.clear();
            refinement.faces(block, &mut faces);
            std::hint::black_box(&faces);
        }
    });
    Ok(format!(
        "{{\"file\": {:?}, \"bytes\": {bytes}, \"points\": {}, \"read_ms\": {read_ms:.3}, \
         \"soma_ms\": {soma_ms:.3}, \"coarse_ms\": {coarse_ms:.3}, \"first_ms\": {first_ms:.3}, \
         \"patches\": {}, \"refine_ms\": {refine_ms:.3}, \"triangles\": {triangles}}}",
        file.display().to_string(),
        morphology.points.len(),
        generated.mesh.patches.len(),
    ))
}
