//! How long coarse meshes take: the best of some runs, in milliseconds, on one thread or as many as
//! `RAYON_NUM_THREADS` says, and a hash of the mesh by which two builds are compared.
//!
//! ```text
//! cargo run --release -p neurotess-generate --example coarse -- [RUNS] [separate] FILES…
//! ```
//!
//! `separate`: branches that were traced through one another are moved apart.

#![expect(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "this is its output"
)]

use std::hash::{DefaultHasher, Hash, Hasher};
use std::time::Instant;

use neurotess_generate::{Crossings, GenerateOptions, generate};
use neurotess_mesh::CoarseMesh;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut args = std::env::args().skip(1).peekable();
    let runs = args.next_if(|arg| arg.parse::<u32>().is_ok());
    let runs = runs.map_or(Ok(5), |runs| runs.parse::<u32>())?.max(1);
    let mut options = GenerateOptions::default();
    if args.next_if(|arg| arg == "separate").is_some() {
        options.crossings = Crossings::Separate;
    }
    let threads = std::env::var("RAYON_NUM_THREADS").map_or(Ok(1), |threads| threads.parse())?;
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build_global()?;
    let mut sum = 0.0;
    println!("file points rings ms hash");
    for file in args {
        let read = match neurotess_formats::read(&file, &neurotess_formats::ReadOptions::default())
        {
            Ok(read) => read,
            Err(error) => {
                eprintln!("{file}: {error}");
                continue;
            }
        };
        let mut best = f64::INFINITY;
        let mut mesh = CoarseMesh::default();
        for _ in 0..runs {
            let start = Instant::now();
            mesh = generate(&read.morphology, &options)?.mesh;
            best = best.min(1e3 * start.elapsed().as_secs_f64());
        }
        sum += best;
        let name = std::path::Path::new(&file).file_name().unwrap_or_default();
        println!(
            "{:30.30} {:6} {:6} {best:8.2} {:016x}",
            name.to_string_lossy(),
            read.morphology.points.len(),
            mesh.tracing.len(),
            hash(&mesh)
        );
    }
    println!("all {sum:.2}");
    Ok(())
}

fn hash(mesh: &CoarseMesh) -> u64 {
    let mut hasher = DefaultHasher::new();
    for vertex in &mesh.vertices {
        let numbers = [vertex.position, vertex.normal].map(|v| v.to_array().map(f32::to_bits));
        (numbers, vertex.tracing).hash(&mut hasher);
    }
    for patch in &mesh.patches {
        patch.corners.hash(&mut hasher);
    }
    for point in &mesh.tracing {
        let numbers = [point.center, point.tangent].map(|v| v.to_array().map(f32::to_bits));
        (numbers, point.radius.to_bits(), point.collar.to_bits()).hash(&mut hasher);
    }
    hasher.finish()
}
