//! Files of meshes.

use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

use glam::{DAffine3, DVec3};
use neurotess_mesh::{Format, Unit, check, read};
use neurotess_output::Existing;
use neurotess_recipe::{
    CellMesh, Crossings, MeshOptions, OptionsError, Progress, SaveError, SaveOptions, Stage, Watch,
    mesh,
};

use crate::{SMALL, cell};

fn made(options: &MeshOptions) -> CellMesh {
    mesh(&cell(SMALL), options).expect("meshed")
}

fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).expect("a folder").flatten();
    let names = entries.map(|entry| entry.file_name().to_string_lossy().into_owned());
    let mut names: Vec<String> = names.collect();
    names.sort();
    names
}

#[neurotess_testing::test]
fn a_name_tells_the_format() {
    let folder = tempfile::tempdir().expect("a folder");
    let cell = made(&MeshOptions::default().with_level(0));
    for format in Format::ALL {
        let file = folder.path().join(format!("cell.{}", format.extension()));
        cell.save(&file).expect("saved");
        let mut mesh = read(&file).expect("read");
        neurotess_mesh::merge_identical(&mut mesh);
        assert!(check(&mesh).closed, "{format}");
    }
    let unknown = cell.save(folder.path().join("cell.xyz"));
    assert!(matches!(unknown, Err(SaveError::Format(_))));
}

#[neurotess_testing::test]
fn a_cell_is_placed_in_a_unit_and_replaces_nothing_unasked() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("cell.ply");
    let mut to = SaveOptions::new(Format::Ply);
    to.files.unit = Unit::Meter;
    to.world_from_cell = Some(DAffine3::from_translation(DVec3::X * 1e6));
    to.existing = Existing::Refuse("say so");
    let cell = made(&MeshOptions::default().with_level(1));
    let saved = cell.save_with(&out, &to, &Watch::default()).expect("saved");
    assert_eq!(saved.files, std::slice::from_ref(&out));
    let mesh = read(&out).expect("read");
    let x = mesh.origin.x + f64::from(mesh.vertices[0].position.x);
    assert!((0.9..1.1).contains(&x), "{x}");
    let again = cell.save_with(&out, &to, &Watch::default());
    assert!(matches!(again, Err(SaveError::Output(_))));
}

#[neurotess_testing::test]
fn parts_with_walls_are_closed_and_materials_lie_beside() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut to = SaveOptions::new(Format::Obj);
    (to.files.parts, to.files.walls, to.files.materials) = (true, true, true);
    let cell = made(&MeshOptions::default().with_crossings(Crossings::Merge));
    let out = folder.path().join("cell.obj");
    let saved = cell.save_with(&out, &to, &Watch::default()).expect("saved");
    assert_eq!(saved.warning, None);
    let parts = [
        "cell.mtl",
        "cell_axon.obj",
        "cell_basal_dendrite.obj",
        "cell_soma.obj",
    ];
    assert_eq!(names(folder.path()), parts);
    for part in &saved.files {
        assert!(check(&read(part).expect("read")).closed, "{part:?}");
    }
    to.files.format = Format::Ply;
    let refused = cell.save_with(&out, &to, &Watch::default());
    let materials = OptionsError::NoMaterials(Format::Ply);
    assert!(matches!(refused, Err(SaveError::Options(e)) if e == materials));
}

#[neurotess_testing::test]
fn it_is_told_how_far_writing_is_and_what_is_stopped_leaves_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let cell = made(&MeshOptions::default());
    for parts in [false, true] {
        let told: Mutex<Vec<Progress>> = Mutex::default();
        let note = |progress| told.lock().expect("sound").push(progress);
        let watch = Watch::default().with_progress(&note);
        let mut to = SaveOptions::new(Format::Ply);
        to.files.parts = parts;
        let out = folder.path().join("cell.ply");
        cell.save_with(&out, &to, &watch).expect("saved");
        let told = told.into_inner().expect("sound");
        assert!(
            told.iter()
                .all(|t| t.stage == Stage::Write && t.done <= t.all)
        );
        assert!(told.len() > 2 && told[0].done == 0 && told[0].all > 1);
    }
    let before = names(folder.path());
    let stopped = AtomicBool::new(false);
    let stop = |_: Progress| stopped.store(true, Ordering::Relaxed);
    let watch = Watch::stopped_by(&stopped).with_progress(&stop);
    let out = folder.path().join("other.ply");
    let saved = cell.save_with(&out, &SaveOptions::new(Format::Ply), &watch);
    assert!(matches!(saved, Err(SaveError::Stopped)));
    assert_eq!(names(folder.path()), before);
}
