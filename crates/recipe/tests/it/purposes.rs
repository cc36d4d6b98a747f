//! Meshes for surfaces and for solvers.

use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex};

use neurotess_mesh::{SurfaceMesh, measure_surface};
use neurotess_recipe::{
    Crossings, MeshError, MeshOptions, Progress, Spelling, Stage, Watch, mesh, mesh_from,
    mesh_watched,
};

use crate::{SMALL, cell};

fn triangles(options: &MeshOptions) -> usize {
    let made = mesh(&cell(SMALL), options).expect("meshed");
    let report = made.report();
    assert!(report.closed && report.components == 1);
    SurfaceMesh::collect(made.surface().surface())
        .faces
        .triangles
        .len()
}

#[neurotess_testing::test]
fn finer_levels_have_more_triangles_and_quads_fewer() {
    let usual = MeshOptions::default;
    assert_eq!(triangles(&usual()), triangles(&usual().with_level(4)));
    assert!(triangles(&usual().with_level(8)) > triangles(&usual()));
    let coarse = usual().with_level(2);
    assert!(triangles(&coarse.clone().with_quads(true)) < triangles(&coarse) / 2);
}

/// Thick, thin and back to where it began; to and fro on a line: what their tubes hold, however it is meshed.
#[neurotess_testing::test]
fn paths_that_turn_back_have_their_volume_however_they_are_meshed() {
    let back = "1 2 0 5 0 8.45 -1\n2 2 0 0 0 2.29 1\n3 2 0 5 0 0.75 2\n4 2 0 -25 0 0.75 3\n5 2 0 -60 0 0.75 4\n";
    let to_and_fro = "1 3 0 0 0 2 -1\n2 3 10 0 0 2 1\n3 3 5 0.05 0 2 2\n4 3 40 0 0 2 3\n";
    let merged = MeshOptions::default()
        .with_level(8)
        .with_crossings(Crossings::Merge);
    for (text, volume) in [(back, 1900.0), (to_and_fro, 503.0)] {
        // What is moved apart goes around itself, which is longer.
        for (options, most) in [
            (MeshOptions::default(), 1.1),
            (merged.clone(), 1.1),
            (MeshOptions::simulation(), 1.25),
        ] {
            let made = mesh(&cell(text), &options).expect("meshed");
            let surface = made.surface();
            let report = made.report_of(&surface);
            assert!(report.closed && report.components == 1);
            let share = measure_surface(surface.surface()).volume / volume;
            assert!((0.9..most).contains(&share), "{options:?}: {share}");
        }
    }
}

/// Fault C5: a few points that are a hundredth to a hundred-thousandth as thick as all others make no more than three times
/// as many triangles, however thin they are. The time goes with them.
#[neurotess_testing::test]
fn points_that_are_far_thinner_than_others_make_few_triangles() {
    let triangles = |is_thin: fn(usize) -> bool, thin: f64| {
        let row = |i: usize| {
            let radius = if is_thin(i) { thin } else { 0.5 };
            let (x, y) = (2.0 * i as f64, 3.0 * (0.1 * i as f64).sin());
            let parent = if i == 0 { -1 } else { i as i64 };
            format!("{} 3 {x} {y} 0 {radius} {parent}\n", i + 1)
        };
        let text: String = (0..200).map(row).collect();
        let made = mesh(&cell(&text), &MeshOptions::simulation()).expect("meshed");
        let surface = made.surface();
        assert!(made.report_of(&surface).closed);
        SurfaceMesh::collect(surface.surface())
            .faces
            .triangles
            .len()
    };
    let sound = triangles(|_| false, 0.5);
    for thin in [5e-3, 5e-4, 5e-6] {
        for is_thin in [|i| i % 20 == 7, |i| (80..92).contains(&i)] {
            let all = triangles(is_thin, thin);
            assert!(all < 3 * sound, "{thin}: {all} of {sound}");
        }
    }
}

#[neurotess_testing::test]
fn a_coarse_mesh_that_is_there_gives_the_same() {
    let cell = Arc::new(cell(SMALL));
    for options in [MeshOptions::default(), MeshOptions::simulation()] {
        let made = mesh(&*cell, &options).expect("meshed");
        let there = Arc::clone(&made.generated);
        let again = mesh_from(there, cell.clone(), &options, &Watch::default()).expect("meshed");
        let [made, again] = [made, again].map(|m| SurfaceMesh::collect(m.surface().surface()));
        assert_eq!(made, again);
    }
}

#[neurotess_testing::test]
fn it_is_told_how_far_meshing_and_merging_are() {
    let told: Mutex<Vec<Progress>> = Mutex::default();
    let note = |progress| told.lock().expect("sound").push(progress);
    let watch = Watch::default().with_progress(&note);
    let options = MeshOptions::default().with_crossings(Crossings::Merge);
    mesh_watched(Arc::new(cell(SMALL)), &options, &watch).expect("meshed");
    let told = told.into_inner().expect("sound");
    for stage in [Stage::Mesh, Stage::Merge] {
        let of_stage = told.iter().filter(|told| told.stage == stage);
        let of_stage: Vec<&Progress> = of_stage.collect();
        let (first, last) = (of_stage[0], of_stage[of_stage.len() - 1]);
        assert!(of_stage.len() > 3 && of_stage.is_sorted_by_key(|told| told.done));
        assert!(first.done == 0 && first.all > 0 && last.done == last.all);
    }
}

#[neurotess_testing::test]
fn what_is_stopped_or_empty_says_so() {
    let stopped = AtomicBool::new(true);
    let watch = Watch::stopped_by(&stopped);
    for options in [MeshOptions::default(), MeshOptions::simulation()] {
        let made = mesh_watched(Arc::new(cell(SMALL)), &options, &watch);
        assert_eq!(made.err(), Some(MeshError::Stopped));
    }
    let nothing = MeshOptions::default()
        .with_soma(neurotess_generate::SomaMethod::None)
        .with_types([neurotess_morphology::NeuriteKind(9)]);
    let error = mesh(&cell(SMALL), &nothing).err().expect("nothing is left");
    assert_eq!(
        error.told(Spelling::Flag),
        "nothing is left to mesh: check --types and --soma"
    );
    assert!(error.told(Spelling::Keyword).ends_with("types and soma"));
}
