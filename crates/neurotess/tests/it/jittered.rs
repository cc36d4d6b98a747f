//! Tracings whose points were moved at random merge without a pair: what crosses may cross more on the way.

use neurotess::formats::{ReadOptions, read};
use neurotess::generate::{GenerateOptions, generate};
use neurotess::mesh::SurfaceMesh;
use neurotess::refine::{LodCriterion, RefineOptions, Refinement};
use neurotess::union::{UnionOptions, union};
use neurotess_testing::{cases, shared, shared_data};

use moved::{moved, share};

#[path = "../../examples/jittered/moved.rs"]
mod moved;

#[neurotess_testing::test(needs(shared))]
fn moved_tracings_merge_to_nothing_that_crosses() {
    let copies = 12;
    let files = [
        "asc/simple.asc",
        "h5/sample.h5",
        "h5/Neuron.h5",
        "h5/C220197A-P2.h5",
    ];
    for file in &files[..cases(2, files.len() as u32) as usize] {
        let read = read(shared_data().join(file), &ReadOptions::default()).expect("a cell");
        for copy in 0..copies {
            let cell = moved(&read.morphology, share(copy, copies), copy);
            let generated = generate(&cell, &GenerateOptions::default()).expect("meshed");
            let refine = RefineOptions::default();
            let refined = Refinement::new(&generated.mesh, LodCriterion::Homogeneous(2), &refine);
            let merged = union(&SurfaceMesh::collect(&refined), &UnionOptions::default());
            let merged = merged.expect("merged");
            assert_eq!(merged.report.pairs, 0, "{file}, copy {copy}");
            assert!(merged.topology.closed && merged.topology.vertex_manifold);
        }
    }
}
