//! Every tracing at hand gives a closed surface: the repository's samples, and the test data beside
//! the checkout where it is there.

use std::path::{Path, PathBuf};

use neurotess::formats::{ReadOptions, read};
use neurotess::generate::{GenerateOptions, SphereKind, generate};
use neurotess::mesh::{CoarseMesh, SurfaceMesh};
use neurotess::refine::{Lod, LodCriterion, RefineOptions, Refinement};

fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

#[expect(clippy::print_stderr, reason = "nothing is skipped in silence")]
fn tracings(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = std::fs::read_dir(folder) else {
        eprintln!("skipped: no folder {}", folder.display());
        return Vec::new();
    };
    let files = entries.filter_map(|e| Some(e.ok()?.path()));
    let mut files: Vec<_> = files
        .filter(|f| f.extension().is_some_and(|e| e == "swc"))
        .collect();
    files.sort();
    files
}

fn all() -> Vec<PathBuf> {
    let mut files = tracings(&workspace().join("samples"));
    files.extend(tracings(&workspace().join("../shared/data/swc")));
    files
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

#[test]
fn every_tracing_gives_a_closed_surface_without_folds_in_the_soma() {
    for file in all() {
        let name = file
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        let morphology = read(&file, &ReadOptions::default()).unwrap().morphology;
        let generated = generate(&morphology, &GenerateOptions::default()).expect("meshed");
        for warning in &generated.warnings {
            assert!(
                !["soma_folded", "soma_inverted"].contains(&warning.code),
                "{name}: {warning}"
            );
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

#[test]
fn the_papers_sphere_serves_every_tracing_too() {
    for file in all() {
        let name = file
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        let morphology = read(&file, &ReadOptions::default()).unwrap().morphology;
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

#[test]
fn first_rings_anywhere_fold_nothing() {
    for file in all() {
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        let morphology = read(&file, &ReadOptions::default()).unwrap().morphology;
        if morphology.points.len() > 50_000 {
            continue;
        }
        let usual = generate(&morphology, &GenerateOptions::default()).expect("meshed");
        let mut neurites: Vec<u32> = usual.rings.iter().map(|r| r.neurite).collect();
        neurites.dedup();
        let sample = file.parent().is_some_and(|f| f.ends_with("samples"));
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
                        !["soma_folded", "soma_inverted", "ring_unused"].contains(&warning.code),
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
