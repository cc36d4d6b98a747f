//! How forks look: crossing pairs of facets within four radii of a fork, and facets folded by more than
//! 120°, at levels 2 and 4; and the volume.
//!
//! ```text
//! cargo run --release -p neurotess-generate --example forks -- [--smooth LENGTH|auto] FILES…
//! ```
//!
//! With `--smooth` also the change of length and the median and largest move, in radii.

#![expect(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "this is its output"
)]

use std::iter::Peekable;
use std::time::Instant;

use glam::Vec3;
use neurotess_generate::{GenerateOptions, Smooth, generate};
use neurotess_mesh::{SurfaceMesh, self_intersections, topology};
use neurotess_morphology::{Attachment, Morphology};
use neurotess_refine::{LodCriterion, RefineOptions, Refinement};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut sums = [[0; 3]; 2];
    println!(
        "file samples ms | level 2: pairs near forks, all pairs, folded | level 4 | volume (µm³)"
    );
    let mut args = std::env::args().skip(1).peekable();
    let options = GenerateOptions {
        smooth: smooth(&mut args)?,
        ..GenerateOptions::default()
    };
    for file in args {
        let read = match neurotess_formats::read(&file, &neurotess_formats::ReadOptions::default())
        {
            Ok(read) => read,
            Err(error) => {
                eprintln!("{file}: {error}");
                continue;
            }
        };
        for morphology in [&read.morphology] {
            let start = Instant::now();
            let generated = generate(morphology, &options)?;
            let mesh = generated.mesh;
            let seconds = start.elapsed().as_secs_f64();
            let name = std::path::Path::new(&file).file_name().unwrap_or_default();
            let name = name.to_string_lossy();
            print!(
                "{name:30.30} {:6} {:7.1}",
                morphology.points.len(),
                1e3 * seconds
            );
            let forks = forks(morphology);
            for (level, sums) in [2, 4].into_iter().zip(&mut sums) {
                let options = RefineOptions::default();
                let level = LodCriterion::Homogeneous(level);
                let surface = SurfaceMesh::collect(&Refinement::new(&mesh, level, &options));
                let figures = figures(&surface, &forks);
                for (sum, figure) in sums.iter_mut().zip(figures) {
                    *sum += figure;
                }
                let positions: Vec<Vec3> = surface.vertices.iter().map(|v| v.position).collect();
                let topology = topology(&positions, &surface.faces);
                let sound = topology.closed && topology.oriented && topology.vertex_manifold;
                let [near, all, folded] = figures;
                print!(
                    " | {near:6} {all:6} {folded:6} {}",
                    if sound { "closed" } else { "OPEN" }
                );
            }
            let options = RefineOptions::default();
            let refined = Refinement::new(&mesh, LodCriterion::Homogeneous(4), &options);
            print!(" | {:.1}", refined.volume_and_area().0);
            if let Some(smoothing) = generated.smoothing {
                print!(
                    " | length {:+.2} % moved {:.2} {:.2} radii",
                    100.0 * smoothing.length_change,
                    smoothing.median_move_radii,
                    smoothing.largest_move_radii
                );
            }
            println!();
        }
    }
    println!("sums: {sums:?}");
    Ok(())
}

/// Takes `--smooth` and its value, if they come first.
fn smooth(
    args: &mut Peekable<impl Iterator<Item = String>>,
) -> Result<Smooth, Box<dyn std::error::Error>> {
    if args.next_if(|arg| arg == "--smooth").is_none() {
        return Ok(Smooth::None);
    }
    let value = args.next().ok_or("--smooth needs a length or auto")?;
    Ok(match value.as_str() {
        "auto" => Smooth::Auto,
        length => Smooth::Length(length.parse()?),
    })
}

/// Forks with their radii.
fn forks(morphology: &Morphology) -> Vec<(Vec3, f32)> {
    let mut children = vec![0; morphology.sections.len()];
    for section in &morphology.sections {
        if let Attachment::Section(parent) = section.attachment {
            children[parent.index()] += 1;
        }
    }
    let sections = morphology.sections.iter().zip(children);
    sections
        .filter(|(_, children)| *children > 1)
        .map(|(section, _)| {
            let point = &morphology.points[section.end as usize - 1];
            (point.position, point.radius)
        })
        .collect()
}

/// Crossing pairs near a fork, all of them, and folded facets.
fn figures(surface: &SurfaceMesh, forks: &[(Vec3, f32)]) -> [usize; 3] {
    let positions: Vec<Vec3> = surface.vertices.iter().map(|v| v.position).collect();
    let triangles = &surface.faces.triangles;
    let pairs = self_intersections(&positions, &surface.faces);
    let middle = |face: u32| {
        let [a, b, c] = triangles[face as usize].map(|v| positions[v as usize]);
        (a + b + c) / 3.0
    };
    let near = pairs.iter().filter(|pair| {
        let [a, b] = pair.map(middle);
        let close = |&(center, radius): &(Vec3, f32)| {
            a.distance(center).min(b.distance(center)) < 4.0 * radius
        };
        forks.iter().any(close)
    });
    [near.count(), pairs.len(), folded(&positions, triangles)]
}

fn folded(positions: &[Vec3], triangles: &[[u32; 3]]) -> usize {
    let normals: Vec<Vec3> = triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|v| positions[v as usize]);
            (b - a).cross(c - a).normalize_or_zero()
        })
        .collect();
    let mut edges = Vec::new();
    for (t, &[a, b, c]) in triangles.iter().enumerate() {
        for (p, q) in [(a, b), (b, c), (c, a)] {
            edges.push((p.min(q), p.max(q), t));
        }
    }
    edges.sort_unstable();
    let mut folded = vec![false; triangles.len()];
    for pair in edges.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        if (a.0, a.1) == (b.0, b.1) && normals[a.2].dot(normals[b.2]) < -0.5 {
            folded[a.2] = true;
            folded[b.2] = true;
        }
    }
    folded.into_iter().filter(|&f| f).count()
}
