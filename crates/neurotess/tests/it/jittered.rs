//! Tracings merge without a pair, at every level, also if their points were moved at random: what crosses may cross more on
//! the way.

use std::path::Path;

use neurotess::formats::{ReadOptions, read};
use neurotess::generate::{GenerateOptions, generate};
use neurotess::mesh::SurfaceMesh;
use neurotess::morphology::Morphology;
use neurotess::refine::{LodCriterion, RefineOptions, Refinement};
use neurotess::union::{UnionOptions, union};
use neurotess_testing::{cases, is_full, shared, shared_data};

use moved::{moved, share};

#[path = "../../examples/jittered/moved.rs"]
mod moved;

/// Points of the largest tracing that is merged at all levels: the others take minutes.
const MOST_POINTS: usize = 20_000;

/// Merges a cell at these levels; returns how many of its surfaces crossed themselves.
fn assert_merges(cell: &Morphology, levels: &[u32], what: &str) -> usize {
    let generated = generate(cell, &GenerateOptions::default()).expect("meshed");
    let before = generated.mesh.topology().components;
    let crosses = levels.iter().filter(|&&level| {
        let what = format!("{what}, level {level}");
        let lod = LodCriterion::Homogeneous(level);
        let refined = Refinement::new(&generated.mesh, lod, &RefineOptions::default());
        let merged = union(&SurfaceMesh::collect(&refined), &UnionOptions::default());
        let merged = merged.unwrap_or_else(|error| panic!("{what}: {error}"));
        assert_eq!(merged.report.pairs, 0, "{what}");
        assert!(
            merged.topology.closed && merged.topology.vertex_manifold,
            "{what}"
        );
        assert!(
            merged.topology.components <= before,
            "{what}: it fell apart"
        );
        merged.report.pairs_before > 0
    });
    crosses.count()
}

#[neurotess_testing::test(needs(shared))]
fn moved_tracings_merge_to_nothing_that_crosses() {
    let (every, usual) = (&[1, 2, 3, 4, 5, 6][..], &[2][..]);
    let full = [
        ("asc/simple.asc", 50, every),
        ("h5/sample.h5", 50, every),
        ("swc/simple-heterogeneous-neurite.swc", 50, every),
        ("h5/simple-dendritric-spine.h5", 50, every),
        ("h5/Neuron.h5", 12, usual),
        ("h5/C220197A-P2.h5", 12, usual),
    ];
    let quick = [("asc/simple.asc", 12, usual), ("h5/sample.h5", 12, usual)];
    let chosen = if is_full() { &full[..] } else { &quick[..] };
    let mut crossed = 0;
    for &(file, copies, levels) in chosen {
        let read = read(shared_data().join(file), &ReadOptions::default()).expect("a cell");
        for copy in 0..copies {
            let cell = moved(&read.morphology, share(copy, copies), copy);
            crossed += assert_merges(&cell, levels, &format!("{file}, copy {copy}"));
        }
    }
    assert!(crossed >= cases(12, 600) as usize, "{crossed} crossed");
}

#[neurotess_testing::test(needs(neurotess_testing::full, shared))]
fn reference_tracings_merge_at_every_level() {
    let mut crossed = 0;
    for folder in ["swc", "asc", "h5"] {
        let files = std::fs::read_dir(shared_data().join(folder)).expect("a folder");
        for file in files {
            let path = file.expect("a file").path();
            crossed += merged_at_every_level(&path).unwrap_or_default();
        }
    }
    assert!(crossed > 50, "{crossed} crossed");
}

/// How many of a file's surfaces crossed themselves; none if it has no cell, or is too large.
fn merged_at_every_level(path: &Path) -> Option<usize> {
    let cell = read(path, &ReadOptions::default()).ok()?.morphology;
    // Its branches lie in one another all along: more than a million pairs of faces, of which merging says that they are too many.
    let crowd = path.file_name()?.to_str()?.starts_with("deep_caterpillar");
    if crowd || cell.points.len() > MOST_POINTS {
        return None;
    }
    generate(&cell, &GenerateOptions::default()).ok()?;
    Some(assert_merges(
        &cell,
        &[1, 2, 3, 4, 5, 6],
        &path.display().to_string(),
    ))
}
