//! Every tracing gives a closed surface: the samples, and the reference data beside the workspace.

use std::path::{Path, PathBuf};

use neurotess::formats::{ReadOptions, read};
use neurotess::generate::{GenerateOptions, SphereKind, generate};
use neurotess::mesh::{CoarseMesh, SurfaceMesh};
use neurotess::morphology::Morphology;
use neurotess::refine::{Lod, LodCriterion, RefineOptions, Refinement};
use neurotess_testing::{is_full, shared, shared_data};

fn samples() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples")
}

fn reference() -> PathBuf {
    shared_data().join("swc")
}

/// The reference data of the quick lane: a soma of three points with thick neurites, 150 points,
/// and 7,000.
const QUICK: [&str; 3] = [
    "three_point_soma.swc",
    "Cha-F-700113.CNG.swc",
    "C210401C.swc",
];

/// The tracings of a folder, each with its name; in the quick lane few of the reference data.
fn tracings(folder: &Path) -> Vec<(String, Morphology)> {
    let entries = std::fs::read_dir(folder).expect("a folder of tracings");
    let files = entries.map(|entry| entry.expect("an entry").path());
    let mut files: Vec<_> = files
        .filter(|file| file.extension().is_some_and(|e| e == "swc"))
        .collect();
    files.sort();
    if folder != samples() && !is_full() {
        files.retain(|file| QUICK.iter().any(|name| file.ends_with(name)));
    }
    assert!(!files.is_empty(), "no tracing in {}", folder.display());
    let tracing = |file: &PathBuf| {
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        let read = read(file, &ReadOptions::default()).expect("a tracing");
        (name.into_owned(), read.morphology)
    };
    files.iter().map(tracing).collect()
}

fn assert_closed<'l>(mesh: &CoarseMesh, lod: impl Into<Lod<'l>>, what: &str) {
    let coarse = mesh.topology();
    assert!(
        coarse.closed && coarse.oriented && coarse.vertex_manifold,
        "{what}: {coarse:?}"
    );
    assert_eq!(coarse.euler, 2 * coarse.components as i64, "{what}");
    let refinement = Refinement::new(mesh, lod, &RefineOptions::default());
    let surface = SurfaceMesh::collect(&refinement);
    let refined = surface.topology();
    assert!(
        refined.closed && refined.oriented && refined.vertex_manifold,
        "{what}: {refined:?}"
    );
    assert_eq!(refined.euler, coarse.euler, "{what}");
    assert_eq!(refined.components, coarse.components, "{what}");
    assert_eq!(refined.used_vertices, surface.vertices.len(), "{what}");
}

fn assert_closed_without_folds(folder: &Path) {
    for (name, morphology) in tracings(folder) {
        let generated = generate(&morphology, &GenerateOptions::default()).expect("meshed");
        for warning in &generated.warnings {
            assert_ne!(warning.code, "soma_folded", "{name}: {warning}");
        }
        let huge = morphology.points.len() > 50_000;
        assert_closed(
            &generated.mesh,
            LodCriterion::Homogeneous(if huge { 1 } else { 4 }),
            &name,
        );
        if !huge {
            let mixed: Vec<u8> = (0..generated.mesh.tracing.len())
                .map(|i| [1, 3, 2, 6][i * 7 % 4])
                .collect();
            assert_closed(&generated.mesh, Lod::per_point(&mixed), &name);
            assert_closed(&generated.mesh, LodCriterion::MaxError(0.1), &name);
        }
    }
}

fn assert_closed_on_the_papers_sphere(folder: &Path) {
    for (name, morphology) in tracings(folder) {
        if morphology.points.len() > 10_000 {
            continue;
        }
        let options = GenerateOptions {
            sphere: SphereKind::Octahedron,
            sphere_level: Some(3),
            ..GenerateOptions::default()
        };
        let generated = generate(&morphology, &options).expect("meshed");
        assert_closed(&generated.mesh, LodCriterion::Homogeneous(2), &name);
    }
}

/// Each neurite alone, then all together.
fn sets(neurites: &[u32], each: bool) -> Vec<Vec<u32>> {
    let alone = neurites.iter().filter(|_| each).map(|&n| vec![n]);
    alone.chain([neurites.to_vec()]).collect()
}

/// `sample`: each neurite is moved alone too, and none may be limited.
fn assert_first_rings_fold_nothing(folder: &Path, sample: bool) {
    for (name, morphology) in tracings(folder) {
        if morphology.points.len() > 50_000 {
            continue;
        }
        let usual = generate(&morphology, &GenerateOptions::default()).expect("meshed");
        let mut neurites: Vec<u32> = usual.rings.iter().map(|r| r.neurite).collect();
        neurites.dedup();
        for set in sets(&neurites, sample) {
            for position in [0.0, 0.5, 1.0, 1.5, 2.0] {
                let what = format!("{name}: {set:?} at {position}");
                let options = GenerateOptions {
                    rings: set.iter().map(|&n| (n, position)).collect(),
                    ..GenerateOptions::default()
                };
                let made = generate(&morphology, &options).expect("meshed");
                for warning in &made.warnings {
                    assert!(
                        !["soma_folded", "ring_unused"].contains(&warning.code),
                        "{what}: {warning}"
                    );
                    assert!(
                        !sample || warning.code != "ring_limited",
                        "{what}: {warning}"
                    );
                }
                assert_closed(&made.mesh, LodCriterion::Homogeneous(1), &what);
            }
        }
    }
}

#[neurotess_testing::test]
fn samples_give_closed_surfaces_without_folds_in_the_soma() {
    assert_closed_without_folds(&samples());
}

#[neurotess_testing::test(needs(shared))]
fn reference_data_give_closed_surfaces_without_folds_in_the_soma() {
    assert_closed_without_folds(&reference());
}

#[neurotess_testing::test]
fn the_papers_sphere_serves_samples_too() {
    assert_closed_on_the_papers_sphere(&samples());
}

#[neurotess_testing::test(needs(shared))]
fn the_papers_sphere_serves_reference_data_too() {
    assert_closed_on_the_papers_sphere(&reference());
}

#[neurotess_testing::test]
fn first_rings_anywhere_fold_nothing_of_samples() {
    assert_first_rings_fold_nothing(&samples(), true);
}

#[neurotess_testing::test(needs(neurotess_testing::full, shared))]
fn first_rings_anywhere_fold_nothing_of_reference_data() {
    assert_first_rings_fold_nothing(&reference(), false);
}
