//! What merging costs where tracings are worse than real ones: copies of cells whose points are moved at random.
//!
//! ```text
//! cargo run --release -p neurotess --example jittered -- COPIES FILES…
//! ```
//!
//! Each copy moves every point by up to a share of its radius that grows from copy to copy, from 0.1 to 3. A JSON object
//! for each copy: what was moved, seconds, the peak of memory while merging in sizes of the refined mesh (Linux), rounds,
//! what was cut off and joined again, and the volume of what was left out as a share of the whole.

use std::fs;
use std::path::Path;
use std::time::Instant;

use neurotess::formats::{ReadOptions, read};
use neurotess::generate::{GenerateOptions, generate};
use neurotess::mesh::SurfaceMesh;
use neurotess::morphology::Morphology;
use neurotess::refine::{LodCriterion, RefineOptions, Refinement};
use neurotess::union::{UnionOptions, union};

use moved::{moved, share};

mod moved;

/// The level that cells are merged at.
const LEVEL: u32 = 2;

#[expect(clippy::print_stdout, reason = "this is its output")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let copies: u32 = arguments.next().ok_or("COPIES FILES…")?.parse()?;
    for file in arguments {
        let morphology = read(Path::new(&file), &ReadOptions::default())?.morphology;
        for copy in 0..copies {
            let share = share(copy, copies);
            let jittered = moved(&morphology, share, copy);
            println!(
                r#"{{"file": {file:?}, "copy": {copy}, "moved": {share}, {}}}"#,
                merged(&jittered)?
            );
        }
    }
    Ok(())
}

/// The figures of merging a cell.
fn merged(morphology: &Morphology) -> Result<String, Box<dyn std::error::Error>> {
    let generated = generate(morphology, &GenerateOptions::default())?;
    let lod = LodCriterion::Homogeneous(LEVEL);
    let surface = SurfaceMesh::collect(&Refinement::new(
        &generated.mesh,
        lod,
        &RefineOptions::default(),
    ));
    drop(generated);
    let size =
        size_of_val(surface.vertices.as_slice()) + size_of_val(surface.faces.triangles.as_slice());
    let before = peak_from_here();
    let clock = Instant::now();
    let result = union(&surface, &UnionOptions::default());
    let seconds = clock.elapsed().as_secs_f64();
    let peak = peak().saturating_sub(before) as f64 / size as f64;
    let dropped = result.as_ref().map_or(0.0, |union| {
        let parts = union.report.dropped.iter().map(|part| part.volume.abs());
        parts.sum::<f64>() / union.report.volume_before.abs()
    });
    let told = match &result {
        Ok(union) => format!(
            r#""rounds": {}, "pairs": [{}, {}], "cut_off": {}, "joined": {}, "dropped": {dropped:.4}"#,
            union.report.rounds,
            union.report.pairs_before,
            union.report.pairs,
            union.report.cut_off.len(),
            union.report.joined.len()
        ),
        Err(error) => format!(r#""error": {:?}"#, error.to_string()),
    };
    Ok(format!(
        r#""faces": {}, "seconds": {seconds:.2}, "peak": {peak:.1}, {told}"#,
        surface.faces.triangles.len()
    ))
}

/// The memory (bytes) that this program has now, from which on its peak counts.
fn peak_from_here() -> usize {
    // Linux alone knows this; elsewhere the peak is 0.
    let _ = fs::write("/proc/self/clear_refs", "5");
    peak()
}

/// The most memory (bytes) that this program had.
fn peak() -> usize {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kilobytes = line.and_then(|line| line.trim().trim_end_matches(" kB").parse().ok());
    1024 * kilobytes.unwrap_or(0)
}
