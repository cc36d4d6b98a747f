//! Files that are read, changed, broken and saved.

use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use egui_kittest::kittest::Queryable;
use neurotess::synth::Kind;
use neurotess_viewer::Command;
use neurotess_viewer::save::{MeshOptions, PictureFile};
use neurotess_viewer::sources::Stale;
use neurotess_viewer::state::{Dialog, State};

use crate::common::{SMALL, Window, gpu, run, settle, state, window, window_of, with_samples};

const CELL: &str = "1 1 0 0 0 5 -1\n2 3 0 9 0 1 1\n3 3 0 30 0 1 2\n";

#[neurotess_testing::test(needs(gpu))]
fn failures_are_listed_while_the_rest_shows() {
    let mut window = window();
    window.step();
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("good.swc"), CELL).expect("written");
    fs::write(folder.path().join("bad.swc"), "no tracing\n").expect("written");
    let missing = folder.path().join("missing.swc");
    run(
        &mut window,
        Command::Open(vec![folder.path().to_path_buf(), missing]),
    );
    let folder = fs::canonicalize(folder.path()).expect("there");
    assert_eq!(state(&mut window).settings.recent, [folder]);
    assert!(matches!(state(&mut window).layout.dialog, Dialog::Nothing));
    assert_eq!(state(&mut window).document.neurons.len(), 1);
    assert_eq!(
        state(&mut window).messages.problems.len(),
        2,
        "{:?}",
        state(&mut window).messages.problems
    );
    run(&mut window, Command::ToggleProblems);
    window.get_by_label("What went wrong");
}

#[neurotess_testing::test(needs(gpu))]
fn it_is_said_at_once_why_nothing_was_read() {
    let mut window = window_of(SMALL);
    window.step();
    let folder = tempfile::tempdir().expect("a folder");
    let bad = folder.path().join("bad.swc");
    fs::write(&bad, "no tracing\n").expect("written");
    run(&mut window, Command::Open(vec![bad]));
    assert!(matches!(state(&mut window).layout.dialog, Dialog::Problems));
    assert!(state(&mut window).settings.recent.is_empty());
}

#[neurotess_testing::test(needs(gpu))]
fn a_changed_file_is_offered_and_read_again() {
    let mut window = window();
    window.step();
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("a.swc");
    fs::write(&file, CELL).expect("written");
    run(&mut window, Command::Open(vec![file.clone()]));
    fs::write(&file, CELL.replace("30", "60")).expect("written");
    let later = std::time::SystemTime::now() + Duration::from_secs(9);
    let handle = fs::File::options().write(true).open(&file).expect("there");
    handle.set_modified(later).expect("touched");
    wait(&mut window, |state| {
        state
            .source_of(0)
            .is_some_and(|s| s.stale == Some(Stale::Changed))
    });
    state(&mut window).run(Command::Reload);
    wait(&mut window, |state| {
        state.source_of(0).is_some_and(|s| s.measures.length > 50.0)
    });
    settle(&mut window);
    fs::remove_file(&file).expect("removed");
    wait(&mut window, |state| {
        state
            .source_of(0)
            .is_some_and(|s| s.stale == Some(Stale::Gone))
    });
    assert_eq!(
        state(&mut window).document.neurons.len(),
        1,
        "what was read still shows"
    );
}

fn wait(window: &mut Window, until: impl Fn(&State) -> bool) {
    let begun = Instant::now();
    while !until(state(window)) {
        assert!(begun.elapsed() < Duration::from_secs(180), "never");
        window.step();
        std::thread::sleep(Duration::from_millis(20));
    }
}

#[neurotess_testing::test(needs(gpu))]
fn meshes_and_pictures_are_saved() {
    let mut window = with_samples(&[Kind::Star, Kind::Granule]);
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let mut meshes = MeshOptions::new(at("all"), neurotess::mesh::Format::Glb);
    meshes.recipe = meshes.recipe.with_level(1);
    run(&mut window, Command::SaveMeshes(meshes.clone()));
    assert!(at("all/star.glb").exists() && at("all/granule.glb").exists());
    let picture = PictureFile {
        out: at("p.png"),
        size: [160, 120],
        samples: 4,
        transparent: true,
        replace: false,
        recipe: true,
    };
    run(&mut window, Command::SavePicture(picture.clone()));
    assert!(is_png(&at("p.png")) && state(&mut window).messages.problems.is_empty());
    run(&mut window, Command::SavePicture(picture));
    assert!(
        state(&mut window).messages.problems[0]
            .why
            .contains("exists"),
        "nothing is replaced unasked"
    );
}

fn is_png(path: &Path) -> bool {
    fs::read(path).is_ok_and(|bytes| bytes.starts_with(b"\x89PNG") && bytes.len() > 200)
}
