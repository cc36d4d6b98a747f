//! Meshes beside the cells in the window.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use egui_kittest::kittest::Queryable;
use neurotess::synth::Kind;
use neurotess_viewer::command::{Edit, Tab};
use neurotess_viewer::document::MeshEntry;
use neurotess_viewer::save::PictureFile;
use neurotess_viewer::{Command, draw_session};

use crate::common::{
    Window, differing, drawn, gpu, picture, pixels, rest, run, settle, snapshot, state, viewer,
    wait, window, with_samples,
};

/// A box around the cell, half of it: the picture shows where it is and where it is not.
fn write_box(path: &Path, side: f64) {
    let mut text = String::new();
    for corner in 0..8 {
        let place = |bit: u32| f64::from(corner >> bit & 1);
        let [x, y, z] = [
            place(0) * side,
            (place(1) - 0.5) * side,
            (place(2) - 0.5) * side,
        ];
        writeln!(text, "v {x} {y} {z}").expect("written");
    }
    for face in [
        "1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6",
    ] {
        writeln!(text, "f {face}").expect("written");
    }
    fs::write(path, text).expect("a file");
}

/// A window with a cell, and a file of a mesh.
fn with_file() -> (Window, tempfile::TempDir, PathBuf) {
    let mut window = with_samples(&[Kind::Star]);
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("region.obj");
    write_box(&file, 120.0);
    rest(&mut window);
    (window, folder, file)
}

fn look(window: &mut Window, change: impl FnOnce(&mut MeshEntry)) {
    let mut entry = state(window).document.meshes[0].clone();
    change(&mut entry);
    run(window, Edit::SetMesh(0, entry));
    rest(window);
}

fn entries(window: &mut Window) -> Vec<MeshEntry> {
    state(window).document.meshes.to_vec()
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn a_mesh_is_shown_changed_undone_and_removed() {
    let (mut window, _folder, file) = with_file();
    let plain = drawn(&mut window);
    // As a file that is dropped is opened.
    run(&mut window, Command::Open(vec![file.clone()]));
    rest(&mut window);
    assert_eq!(entries(&mut window), [MeshEntry::new(file, 0)]);
    assert_eq!(state(&mut window).messages.problems, []);
    let solid = drawn(&mut window);
    let covered = differing(&plain, &solid);
    assert!(covered > 10_000, "{covered} pixels");
    look(&mut window, |mesh| mesh.opacity = 0.25);
    let glass = drawn(&mut window);
    assert!(differing(&solid, &glass) > 10_000 && differing(&plain, &glass) > 10_000);
    look(&mut window, |mesh| mesh.edges = true);
    let wires = drawn(&mut window);
    let inked = differing(&plain, &wires);
    assert!((500..covered / 4).contains(&inked), "{inked} pixels");
    look(&mut window, |mesh| mesh.hidden = true);
    assert_eq!(differing(&plain, &drawn(&mut window)), 0);
    // Changes of a mesh in a row are one edit, as when a slider is dragged.
    run(&mut window, Command::Undo);
    rest(&mut window);
    assert_eq!(differing(&solid, &drawn(&mut window)), 0);
    run(&mut window, Edit::RemoveMesh(0));
    rest(&mut window);
    assert_eq!(differing(&plain, &drawn(&mut window)), 0);
    run(&mut window, Command::Undo);
    rest(&mut window);
    assert_eq!(differing(&solid, &drawn(&mut window)), 0);
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn another_color_is_shown_without_drawing_anew() {
    let (mut window, _folder, file) = with_file();
    run(&mut window, Command::OpenMeshes(vec![file]));
    look(&mut window, |mesh| mesh.opacity = 0.5);
    let before = drawn(&mut window);
    let mut entry = entries(&mut window).remove(0);
    entry.color = [200, 0, 0];
    state(&mut window).run(Edit::SetMesh(0, entry));
    window.step();
    wait(&mut window, |w| viewer(w).is_settled());
    assert!(viewer(&mut window).stage.is_static(), "it is colored anew");
    let recolored = drawn(&mut window);
    assert!(differing(&before, &recolored) > 10_000);
    // What is drawn anew is the same.
    run(&mut window, Command::SetOrthographic(true));
    run(&mut window, Command::SetOrthographic(false));
    rest(&mut window);
    let redrawn = drawn(&mut window);
    let apart = differing(&redrawn, &recolored);
    assert!(apart < 200, "{apart} pixels");
    let legend = format!("{:?}", viewer(&mut window).stage.legend());
    assert!(legend.contains("region"), "{legend}");
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn cells_behind_glass_are_picked() {
    let (mut window, _folder, file) = with_file();
    let hits = |window: &mut Window| {
        wait(window, |w| viewer(w).stage.can_pick());
        let rect = picture(window);
        let stage = &viewer(window).stage;
        let rows = 0..rect.height() as usize;
        let at = rows.flat_map(|y| (0..rect.width() as usize).map(move |x| (x, y)));
        let hit = |(x, y): (usize, usize)| stage.hit_at(x as f32 + 0.5, y as f32 + 0.5);
        at.filter(|&place| hit(place).is_some()).count()
    };
    let all = hits(&mut window);
    run(&mut window, Command::OpenMeshes(vec![file]));
    rest(&mut window);
    let hidden = hits(&mut window);
    let [mesh, nothing] = [[760.0, 120.0], [600.0, 700.0]];
    let name = |window: &mut Window, [x, y]: [f32; 2]| {
        let rect = picture(window);
        let (x, y) = (x - rect.left(), y - rect.top());
        viewer(window).stage.mesh_at(x, y).map(str::to_owned)
    };
    assert_eq!(name(&mut window, mesh).as_deref(), Some("region"));
    assert_eq!(name(&mut window, nothing), None);
    assert!(hidden < all / 10 * 9, "{hidden} of {all}");
    look(&mut window, |mesh| mesh.opacity = 0.9);
    assert_eq!(hits(&mut window), all);
    assert_eq!(name(&mut window, mesh), None);
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn sessions_and_saved_pictures_have_them() {
    let (mut window, folder, file) = with_file();
    run(&mut window, Command::OpenMeshes(vec![file.clone()]));
    look(&mut window, |mesh| {
        (mesh.opacity, mesh.color) = (0.3, [0, 90, 200]);
    });
    let session = folder.path().join("mine.neurotess");
    run(&mut window, Command::SaveSession(session.clone()));
    let text = fs::read_to_string(&session).expect("a session");
    assert!(text.contains("path = \"region.obj\""), "{text}");
    let options = |name: &str| PictureFile {
        out: folder.path().join(name),
        size: [160, 120],
        samples: 4,
        transparent: false,
        replace: true,
        recipe: true,
    };
    run(&mut window, Command::SavePicture(options("window.png")));
    let [with, without] = ["with.png", "without.png"].map(|name| {
        let drawn =
            draw_session(&session, &options(name), None, &|_| Ok(None), true).expect("drawn");
        assert_eq!(drawn.failures, []);
        let picture = pixels(&folder.path().join(name));
        // The second time without the mesh.
        let lines = text.split("[[mesh]]").next().expect("cells come later");
        let rest = text.split("[playback]").nth(1).expect("playback");
        fs::write(&session, format!("{lines}[playback]{rest}")).expect("written");
        picture
    });
    assert!(pixels(&folder.path().join("window.png")) == with);
    assert!(with != without);
    fs::write(&session, &text).expect("written");
    let mut other = self::window();
    other.step();
    run(&mut other, Command::Open(vec![session]));
    rest(&mut other);
    let [opened, ours] = [&mut other, &mut window].map(entries);
    assert_eq!(opened[0].opacity, ours[0].opacity);
    assert!(opened[0].file.ends_with("region.obj"));
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn what_cannot_be_read_is_told_and_tried_again() {
    let (mut window, folder, file) = with_file();
    let bad = folder.path().join("bad.ply");
    fs::write(&bad, "ply\nformat ascii 1.0\nelement vertex no\n").expect("written");
    run(&mut window, Command::Open(vec![file, bad.clone()]));
    let problems = state(&mut window).messages.problems.clone();
    assert_eq!(problems.len(), 1, "{problems:?}");
    assert!(problems[0].what.ends_with("bad.ply") && problems[0].why.contains("line 3"));
    assert_eq!(entries(&mut window).len(), 2, "the list tells why");
    state(&mut window).messages.problems.clear();
    fs::write(
        &bad,
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
         element face 1\nproperty list uchar int vertex_indices\nend_header\n\
         0 0 0\n50 0 0\n0 50 0\n3 0 1 2\n",
    )
    .expect("written");
    run(&mut window, Edit::RemoveMesh(1));
    run(&mut window, Command::OpenMeshes(vec![bad]));
    assert_eq!(state(&mut window).messages.problems, []);
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn meshes_are_listed_with_their_looks() {
    let (mut window, folder, file) = with_file();
    let pipette = folder.path().join("pipette.obj");
    write_box(&pipette, 30.0);
    run(&mut window, Command::OpenMeshes(vec![file, pipette]));
    look(&mut window, |mesh| mesh.opacity = 0.3);
    run(&mut window, Command::Show(Tab::Look));
    window.get_by_label("Remove region").click();
    settle(&mut window);
    let names: Vec<String> = entries(&mut window).iter().map(MeshEntry::name).collect();
    assert_eq!(names, ["pipette"]);
    run(&mut window, Command::Undo);
    rest(&mut window);
    snapshot(&mut window, "meshes");
}
