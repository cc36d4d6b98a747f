//! Real cells.

use neurotess_formats::{ReadOptions, read};
use neurotess_generate::{GenerateOptions, generate};
use neurotess_mesh::{SurfaceMesh, check};
use neurotess_refine::{LodCriterion, RefineOptions, Refinement};
use neurotess_testing::shared_data;
use neurotess_union::{UnionOptions, union};

fn surface(cell: &str, level: u32) -> SurfaceMesh {
    let path = shared_data().join("swc").join(cell);
    let morphology = read(path, &ReadOptions::default())
        .expect("a cell")
        .morphology;
    let coarse = generate(&morphology, &GenerateOptions::default())
        .expect("a mesh")
        .mesh;
    let lod = LodCriterion::Homogeneous(level);
    SurfaceMesh::collect(&Refinement::new(&coarse, lod, &RefineOptions::default()))
}

#[neurotess_testing::test(needs(neurotess_testing::shared))]
fn no_faces_of_merged_cells_cross() {
    let cells = [
        "IF4_140201.CNG.swc",
        "Neuron.swc",
        "WT-Contralateral-18.CNG.swc",
        "Pvalb_469628681_m.swc",
        "sample_disordered.swc",
    ];
    // Rings that are drawn in leave some cells without any crossing.
    let mut crossed = 0;
    for cell in cells {
        for level in [1, 2] {
            let mesh = surface(cell, level);
            let merged = union(&mesh, &UnionOptions::default()).expect("a union");
            let report = check(&merged.mesh);
            let what = format!("{cell} at level {level}: {report:?}");
            crossed += usize::from(merged.report.pairs_before > 0);
            assert_eq!(report.self_intersections, 0, "{what}");
            assert!(
                report.closed && report.oriented && report.vertex_manifold,
                "{what}"
            );
            // What was enclosed twice was at most some per cent.
            assert!(
                (0.95..1.02).contains(&merged.report.volume_ratio()),
                "{what}"
            );
            let kept = merged
                .mesh
                .vertices
                .iter()
                .filter(|v| mesh.vertices.contains(v))
                .take(1);
            assert_eq!(kept.count(), 1, "{what}");
        }
    }
    assert!(crossed >= 6, "{crossed} of ten meshes crossed themselves");
}
