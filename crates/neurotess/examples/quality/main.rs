//! What meshes are worth, a JSON object for each file: what `cargo xtask quality` makes a table of.
//!
//! ```text
//! cargo run --release -p neurotess --example quality -- [--once|--digest|--separated|--simulated] FILES…
//! ```
//!
//! At levels 2 and 4: crossing pairs of facets within four radii of a fork, all of them, and facets folded by more than
//! 120°. At level 4 also the volume, the share of the area near forks that is off the branches' round cones, and by how much
//! the area of sections differs from what shows of their cones: the median, and the 95th percentile, and that of sums over
//! subtrees; how many sections show and have no triangle; and how deep (radii, the median)
//! the inner walls of bends away from forks are within the traced cones, of 40 to 100° and of 100 to 140°. At level 8
//! somata: see [`soma`].
//!
//! `--once` meshes each cell once instead of taking the fastest of three; for the other flags see [`others`].

use std::path::Path;
use std::time::Instant;

use neurotess::formats::{ReadOptions, read};
use neurotess::generate::{GenerateOptions, Generated, generate_watched};
use neurotess::mesh::{CoarseMesh, Role, SurfaceMesh, Watch, topology};
use neurotess::refine::{LodCriterion, RefineOptions, Refinement, pack};

use facets::{crossings, folded};
use sections::Sections;
use tree::Tree;

mod bends;
mod facets;
mod off;
mod others;
mod sections;
mod soma;
mod tree;

/// Most patches of a part that is packed for the device.
const MAX_PATCHES: usize = 1 << 20;
/// Runs of which the fastest counts.
const RUNS: usize = 3;

#[expect(clippy::print_stdout, reason = "this is its output")]
fn main() {
    let mut arguments = std::env::args().skip(1).peekable();
    let flag = arguments.next_if(|argument| argument.starts_with('-'));
    for file in arguments {
        match figures(Path::new(&file), flag.as_deref()) {
            Ok(line) => println!("{line}"),
            Err(error) => println!(r#"{{"file": {file:?}, "error": {:?}}}"#, error.to_string()),
        }
    }
}

/// The figures of a file.
fn figures(file: &Path, flag: Option<&str>) -> Result<String, Box<dyn std::error::Error>> {
    let morphology = read(file, &ReadOptions::default())?.morphology;
    let runs = match flag {
        None => RUNS,
        Some("--once") => 1,
        Some(flag) => {
            let others = match flag {
                "--digest" => others::digest(&morphology)?,
                "--separated" => others::separated(&morphology)?,
                _ => others::simulated(&morphology)?,
            };
            return Ok(format!(
                r#"{{"file": {:?}{others}}}"#,
                file.display().to_string()
            ));
        }
    };
    let (mut generated, mut fastest) = (Generated::default(), f64::INFINITY);
    let mut soma_seconds = f64::INFINITY;
    for _ in 0..runs {
        let clock = Instant::now();
        let seconds = || clock.elapsed().as_secs_f64();
        generated = generate_watched(
            &morphology,
            &GenerateOptions::default(),
            &Watch::default().with_clock(&seconds),
        )?;
        fastest = fastest.min(seconds());
        soma_seconds = soma_seconds.min(generated.soma_seconds);
    }
    let mesh = &generated.mesh;
    let tree = Tree::new(&morphology);
    let mut line = format!(
        r#"{{"file": {:?}, "points": {}, "seconds": {fastest}, "soma_seconds": {soma_seconds}, "bytes": {}"#,
        file.display().to_string(),
        morphology.points.len(),
        bytes_per_point(mesh),
    );
    for level in [2, 4] {
        let levels = LodCriterion::Homogeneous(level);
        let refinement = Refinement::new(mesh, levels, &RefineOptions::default());
        let surface = SurfaceMesh::collect(&refinement);
        let positions: Vec<_> = surface.vertices.iter().map(|v| v.position).collect();
        let topology = topology(&positions, &surface.faces);
        let closed = topology.closed && topology.oriented && topology.vertex_manifold;
        let [near, all] = crossings(&positions, &surface.faces, &tree);
        line += &format!(
            r#", "closed_{level}": {closed}, "near_{level}": {near}, "pairs_{level}": {all}, "folded_{level}": {}"#,
            folded(&positions, &surface.faces.triangles),
        );
        if level == 4 {
            let (volume, area) = refinement.volume_and_area();
            let off = off::share(&positions, &surface.faces.triangles, &tree);
            let Sections {
                off: [median, worst],
                subtrees,
                vanished,
            } = Sections::new(&surface, &morphology)?;
            line += &format!(
                r#", "volume": {volume}, "area": {area}, "off": {off}, "sections": {median}, "sections_95": {worst}, "subtrees": {subtrees}, "vanished": {vanished}"#
            );
            let [wide, narrow] = bends::inside(&positions, &surface.faces.triangles, &tree);
            line += &format!(
                r#", "bends": {}, "inside": {}, "narrow_bends": {}, "inside_narrow": {}"#,
                wide.0, wide.1, narrow.0, narrow.1
            );
        }
    }
    line += &soma::figures(&morphology, &generated)?;
    Ok(line + "}")
}

/// Bytes on the device for each tracing point outside somata.
fn bytes_per_point(mesh: &CoarseMesh) -> f64 {
    let keys = vec![0; mesh.tracing.len()];
    let parts = pack(mesh, &keys, &[], MAX_PATCHES);
    let words: usize = parts.iter().map(|part| part.packed.len()).sum();
    let tracing = mesh.tracing.iter();
    let points = tracing
        .filter(|point| point.role != Role::Soma)
        .count()
        .max(1);
    (4 * words) as f64 / points as f64
}
