//! Meshes cells at some levels, merges each surface with itself and judges the result by the checks of the
//! mesh crate. With a folder, writes the merged surfaces there as PLY for others to judge.
//!
//! `cargo run --release -p neurotess-union --example cells -- LEVEL[,LEVEL] [--out FOLDER] CELL…`

use std::error::Error;
use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};
use std::time::Instant;

use neurotess_formats::{ReadOptions, read};
use neurotess_generate::{GenerateOptions, generate};
use neurotess_mesh::{Format, SurfaceMesh, check, write};
use neurotess_refine::{LodCriterion, RefineOptions, Refinement};
use neurotess_union::{Kin, UnionOptions, union};

#[expect(clippy::print_stdout, reason = "this is its output")]
fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let levels = arguments.next().ok_or("say a level")?;
    let levels: Vec<u32> = levels
        .split(',')
        .map(str::parse)
        .collect::<Result<_, _>>()?;
    let mut rest: Vec<String> = arguments.collect();
    let out = rest.iter().position(|word| word == "--out").map(|at| {
        rest.remove(at);
        PathBuf::from(rest.remove(at))
    });
    for cell in &rest {
        let morphology = match read(cell, &ReadOptions::default()) {
            Ok(read) => read.morphology,
            Err(error) => {
                println!("{error}");
                continue;
            }
        };
        let coarse = generate(&morphology, &GenerateOptions::default())?.mesh;
        for &level in &levels {
            let lod = LodCriterion::Homogeneous(level);
            let options = RefineOptions::default();
            let mesh = SurfaceMesh::collect(&Refinement::new(&coarse, lod, &options));
            println!("{}", judge(Path::new(cell), level, &mesh, out.as_deref())?);
        }
    }
    Ok(())
}

/// One line: what was, what is, and how long it took.
fn judge(
    cell: &Path,
    level: u32,
    mesh: &SurfaceMesh,
    out: Option<&Path>,
) -> Result<String, Box<dyn Error>> {
    let name = cell.file_stem().unwrap_or_default().to_string_lossy();
    let start = Instant::now();
    let merged = match union(mesh, &UnionOptions::default()) {
        Ok(merged) => merged,
        Err(error) => return Ok(format!("{name} {level}: FAILED {error}")),
    };
    let seconds = start.elapsed().as_secs_f64();
    let peak = peak_mib();
    let start = Instant::now();
    let (r, c) = (&merged.report, check(&merged.mesh));
    let checked = start.elapsed().as_secs_f64();
    if let Some(folder) = out {
        let mut file = BufWriter::new(File::create(folder.join(format!("{name}.{level}.ply")))?);
        write(&merged.mesh, Format::Ply, &mut file)?;
    }
    let good = c.closed && c.vertex_manifold && c.oriented && c.self_intersections == 0;
    let apart = r.places.iter().filter(|place| place.kin == Kin::Apart);
    let faces = mesh.faces.triangles.len() + 2 * mesh.faces.quads.len();
    Ok(format!(
        "{name} {level}: {} faces {faces} → {}, {:.2} s, {} rounds, pairs {} → {} ({}), volume × {:.4}, \
         components {} → {}, handles {} → {:?}, places {} ({} apart), changed {:.2} %, dropped {}, cut off {}, \
         collapsed {}, flipped {}, parted {}, smoothed {}, degenerate {}, checked in {checked:.2} s, \
         smallest angles {:.3}° and {:.2}°, peak {peak} MiB",
        if good { "good" } else { "BAD" },
        c.triangles,
        seconds,
        r.rounds,
        r.pairs_before,
        r.pairs,
        c.self_intersections,
        r.volume_ratio(),
        r.components_before,
        r.components,
        r.handles_before,
        r.handles,
        r.places.len(),
        apart.count(),
        100.0 * r.faces_changed as f64 / faces.max(1) as f64,
        r.dropped.len(),
        r.cut_off.len(),
        r.collapsed,
        r.flipped,
        r.parted,
        r.smoothed,
        c.degenerate_faces,
        c.quality.min_angle,
        c.quality.min_angle_p1,
    ))
}

/// Most memory that this process has had (MiB), where the system tells; 0 elsewhere.
fn peak_mib() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kib = peak.and_then(|peak| peak.trim().trim_end_matches(" kB").parse::<u64>().ok());
    kib.unwrap_or(0) / 1024
}
