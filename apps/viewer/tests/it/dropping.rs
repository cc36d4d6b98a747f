//! Files that are dropped on the window: tracings, folders, circuits, reports, sessions, broken ones.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use eframe::egui::{DroppedFile, HoveredFile};
use neurotess::synth::Kind;
use neurotess_viewer::Command;
use neurotess_viewer::command::Edit;
use neurotess_viewer::document::ColorBy;

use crate::common::circuit::write_circuit;
use crate::common::{Window, gpu, run, settle, snapshot, state, window, with_samples};

const CELL: &str = "1 1 0 0 0 5 -1\n2 3 0 9 0 1 1\n3 3 0 30 0 1 2\n";

/// A file as the desktop gives it.
#[derive(Debug)]
struct Dropped(PathBuf);

impl DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        fs::read(&self.0).map_err(|e| e.to_string())
    }
}

/// Lets go of files over the window, without waiting for what comes of it.
fn let_go(window: &mut Window, paths: &[&Path]) {
    let input = window.input_mut();
    input.hovered_files.clear();
    for path in paths {
        input
            .dropped_files
            .push(Arc::new(Dropped(path.to_path_buf())));
    }
    window.step();
    window.input_mut().dropped_files.clear();
}

fn drop_on(window: &mut Window, paths: &[&Path]) {
    let_go(window, paths);
    window.step();
    settle(window);
}

fn names(window: &mut Window) -> Vec<String> {
    let neurons = &state(window).document.neurons;
    neurons.iter().map(|n| n.name.clone()).collect()
}

#[neurotess_testing::test(needs(gpu))]
fn tracings_and_folders_are_opened_and_broken_ones_reported() {
    let mut window = window();
    window.step();
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    fs::create_dir(at("cells")).expect("a folder");
    for name in ["one.swc", "cells/two.swc", "cells/three.swc"] {
        fs::write(at(name), CELL).expect("written");
    }
    fs::write(at("bad.swc"), "no tracing\n").expect("written");
    fs::write(at("note.txt"), "no tracing\n").expect("written");
    fs::write(at("bad.h5"), "no HDF5\n").expect("written");
    drop_on(&mut window, &[&at("one.swc"), &at("cells")]);
    assert_eq!(names(&mut window), ["one", "three", "two"]);
    for bad in ["bad.swc", "bad.h5", "note.txt", "missing.swc"] {
        state(&mut window).messages.problems.clear();
        drop_on(&mut window, &[&at(bad)]);
        let problems = &state(&mut window).messages.problems;
        assert_eq!(problems.len(), 1, "{bad}: {problems:?}");
        assert!(problems[0].what.ends_with(bad), "{problems:?}");
    }
    assert_eq!(names(&mut window).len(), 3, "what was open stays");
}

#[neurotess_testing::test(needs(gpu))]
fn what_is_dropped_while_others_are_read_comes_after_them() {
    let mut window = window();
    window.step();
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    for name in ["a.swc", "b.swc", "c.swc"] {
        fs::write(at(name), CELL).expect("written");
    }
    for name in ["a.swc", "b.swc", "c.swc"] {
        let_go(&mut window, &[&at(name)]);
    }
    settle(&mut window);
    assert_eq!(names(&mut window), ["a", "b", "c"]);
    assert_eq!(state(&mut window).messages.problems, []);
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn a_circuit_and_its_report_are_dropped_together() {
    let mut window = window();
    window.step();
    let folder = tempfile::tempdir().expect("a folder");
    write_circuit(folder.path(), 4, 2, 4);
    let report = folder.path().join("voltage.h5");
    drop_on(&mut window, &[folder.path(), &report]);
    assert_eq!(names(&mut window).len(), 4);
    assert_eq!(state(&mut window).document.look.color_by, ColorBy::Value);
    let facts = state(&mut window).playback.facts.clone().expect("open");
    assert_eq!((facts.title.as_str(), facts.without), ("voltage", [0, 4]));
    // Another one replaces it; several are too many.
    let spikes = folder.path().join("spikes.h5");
    drop_on(&mut window, &[&spikes]);
    assert!(
        state(&mut window)
            .playback
            .facts
            .as_ref()
            .is_some_and(|f| f.spikes)
    );
    drop_on(&mut window, &[&spikes, &report]);
    assert!(
        state(&mut window).messages.problems[0]
            .why
            .contains("one report")
    );
    assert_eq!(state(&mut window).document.report, Some(report));
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn a_session_is_dropped() {
    let mut window = with_samples(&[Kind::Star, Kind::Granule]);
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("mine.neurotess");
    run(&mut window, Edit::SetHidden(0, true));
    run(&mut window, Command::SaveSession(file.clone()));
    let mut other = self::window();
    other.step();
    // A cell beside it comes after its cells.
    let beside = folder.path().join("beside.swc");
    fs::write(&beside, CELL).expect("written");
    drop_on(&mut other, &[&beside, &file]);
    assert_eq!(names(&mut other), ["star", "granule", "beside"]);
    assert!(!state(&mut other).document.neurons.shows(0));
    fs::write(&file, "version = 1\ngrid = 3\n").expect("written");
    drop_on(&mut other, &[&file]);
    assert!(
        state(&mut other).messages.problems[0]
            .why
            .contains("line 2")
    );
    assert_eq!(names(&mut other).len(), 3, "nothing is lost");
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn files_held_over_the_window_are_announced() {
    let mut window = with_samples(&[Kind::Star]);
    window.input_mut().hovered_files = vec![HoveredFile::default(); 3];
    window.run_steps(2);
    snapshot(&mut window, "held");
}
