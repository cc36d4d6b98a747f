//! Where the meshes of synthetic cells cross themselves, of 20 seeds of each kind.
//!
//! `cargo run --release -p neurotess --example grown -- [POINTS] [may-cross]` prints a row of a Markdown table per
//! kind, at levels 2 and 4: pairs of faces in all, cells without any, and the seed and sample of the first.

use neurotess::generate::{GenerateOptions, generate};
use neurotess::mesh::{SurfaceMesh, search_self_intersections};
use neurotess::morphology::Morphology;
use neurotess::refine::{LodCriterion, RefineOptions, Refinement};
use neurotess::synth::{Kind, Options, grow};

/// Cells of each kind.
const SEEDS: std::ops::RangeInclusive<u64> = 1..=20;

#[expect(clippy::print_stdout, reason = "this is its output")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let points = arguments.first().and_then(|argument| argument.parse().ok());
    let may_cross = arguments.iter().any(|argument| argument == "may-cross");
    for kind in Kind::ALL {
        let mut row = format!("| {kind} |");
        for level in [2, 4] {
            let (mut sum, mut without, mut places) = (0, 0, String::new());
            for seed in SEEDS {
                let options = Options {
                    points,
                    may_cross,
                    ..Options::new(kind, seed)
                };
                let found = pairs(&grow(&options), level)?;
                sum += found.len();
                without += usize::from(found.is_empty());
                if let Some(samples) = found.first() {
                    places += &format!(" {seed}: {samples:?} of {}", found.len());
                }
            }
            row += &format!(" {sum} | {without} of 20 | {places} |");
        }
        println!("{row}");
    }
    Ok(())
}

/// The samples of pairs of faces that cross.
fn pairs(cell: &Morphology, level: u32) -> Result<Vec<[i32; 2]>, Box<dyn std::error::Error>> {
    let generated = generate(cell, &GenerateOptions::default())?;
    let lod = LodCriterion::Homogeneous(level);
    let refinement = Refinement::new(&generated.mesh, lod, &RefineOptions::default());
    let surface = SurfaceMesh::collect(&refinement);
    let found = search_self_intersections(&surface.positions(), &surface.faces).pairs;
    let sample = |face: u32| {
        let corners = surface.faces.triangles[face as usize];
        let points = corners.map(|corner| surface.vertices[corner as usize].point);
        points.into_iter().max().unwrap_or(0)
    };
    Ok(found.into_iter().map(|pair| pair.map(sample)).collect())
}
