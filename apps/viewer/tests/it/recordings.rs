//! Circuits in the window: colors of their cells, reports and spikes played back.

use std::fs;
use std::path::Path;

use eframe::egui::Key;
use egui_kittest::kittest::Queryable;
use neurotess::render::Side;
use neurotess::synth::Kind;
use neurotess_viewer::Command;
use neurotess_viewer::command::{Edit, Tab};
use neurotess_viewer::document::{ColorBy, Lighting, Look};
use neurotess_viewer::playback::Pace;
use neurotess_viewer::save::{FilmOptions, PictureFile};

use crate::common::circuit::{make_sticks, with_circuit, write_circuit};
use crate::common::{
    SMALL, Window, differing, gpu, rest, run, run_undrawn, set_look, settle, snapshot, state,
    viewer, wait, window, window_of,
};

/// The distinct colors of the picture alone, without its legend, roughly.
fn hues(window: &mut Window) -> usize {
    let image = window.render().expect("a picture");
    let picture = (240..880).flat_map(|x| (30..640).map(move |y| (x, y)));
    let colored = picture.filter_map(|(x, y)| {
        let [r, g, b, _] = image.get_pixel(x, y).0;
        let spread = r.max(g).max(b) - r.min(g).min(b);
        (spread > 60).then_some([r / 64, g / 64, b / 64])
    });
    colored.collect::<std::collections::BTreeSet<_>>().len()
}

/// The need of tests of videos.
fn ffmpeg() -> Result<(), String> {
    let started = std::process::Command::new("ffmpeg")
        .arg("-version")
        .output();
    started
        .map(drop)
        .map_err(|error| format!("ffmpeg does not start: {error}"))
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn neurons_of_one_tracing_have_their_own_colors() {
    let (mut window, _folder) = with_circuit();
    let plain = |look: &mut Look| {
        look.legend = false;
        look.axes = false;
        look.scale_bar = false;
        look.occlusion = false;
    };
    set_look(&mut window, |look| {
        plain(look);
        look.color_by = ColorBy::Neuron;
    });
    let each = hues(&mut window);
    run(&mut window, Edit::Select(vec![4], false));
    run(&mut window, Edit::Isolate);
    run(&mut window, Edit::SelectNone);
    let one = hues(&mut window);
    assert!(each > 2 * one, "{each}, {one}");
    run(&mut window, Edit::ShowAll);
    set_look(&mut window, |look| {
        look.color_by = ColorBy::Attribute;
        look.attribute = "synapse_class".into();
        look.legend = true;
    });
    run(&mut window, Command::Show(Tab::Look));
    snapshot(&mut window, "attribute");
    // The color goes with the neuron when others go.
    run(&mut window, Edit::Select(vec![0, 1], false));
    run(&mut window, Edit::Remove);
    assert_eq!(state(&mut window).messages.problems, []);
    set_look(&mut window, |look| look.attribute = "weather".into());
    let problems = &state(&mut window).messages.problems;
    assert!(
        problems[0]
            .why
            .contains("no cell has an attribute 'weather'"),
        "{problems:?}"
    );
}

/// Issue 9, 2.8: values had the resolution of traced points, and this dendrite has two.
#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn a_stick_of_two_points_shows_all_its_compartments() {
    let mut window = window();
    window.step();
    let folder = tempfile::tempdir().expect("a folder");
    write_circuit(folder.path(), 3, 1, 1);
    make_sticks(
        folder.path(),
        &[-80.0, 0.0, -60.0, 20.0, -40.0, 10.0, -70.0],
    );
    let open = vec![folder.path().to_path_buf()];
    run(&mut window, Command::Open(open));
    set_look(&mut window, |look| {
        (look.legend, look.axes, look.scale_bar) = (false, false, false);
        (look.occlusion, look.light) = (false, Lighting::Flat);
    });
    let report = folder.path().join("stick.h5");
    run(&mut window, Edit::SetReport(Some(report)));
    run(&mut window, Edit::Select(vec![0], false));
    run(&mut window, Edit::Isolate);
    run(&mut window, Edit::SelectNone);
    assert_eq!(state(&mut window).messages.problems, []);
    run(&mut window, Command::Look(Side::Front));
    let bands = bands(&mut window);
    // Seven values that rise and fall: six changes of direction.
    assert!(bands >= 6, "{bands}");
}

/// How often a color turns from darker to lighter or back, along the middle of the picture.
fn bands(window: &mut Window) -> usize {
    let image = window.render().expect("a picture");
    let light = |x: u32, y: u32| {
        let [r, g, b, _] = image.get_pixel(x, y).0.map(i32::from);
        let colored = r.max(g).max(b) - r.min(g).min(b) > 40;
        colored.then_some(2 * r + 3 * g + b)
    };
    let column = |x: u32| {
        let lights: Vec<i32> = (40..700).filter_map(|y| light(x, y)).collect();
        let mut turns: Vec<i32> = Vec::new();
        let mut last = lights.first().copied().unwrap_or(0);
        for &light in &lights {
            if (light - last).abs() > 60 {
                turns.push((light - last).signum());
                last = light;
            }
        }
        turns.dedup();
        turns.len()
    };
    (250..870).map(column).max().unwrap_or(0)
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn a_report_is_played_stepped_and_saved() {
    let (mut window, folder) = with_circuit();
    let report = folder.path().join("voltage.h5");
    run(&mut window, Edit::SetReport(Some(report.clone())));
    let facts = state(&mut window).playback.facts.clone().expect("open");
    assert_eq!((facts.unit.as_str(), facts.time.frames), ("mV", 20));
    assert_eq!(facts.without, [2, 9]);
    assert!(
        facts.range[0] >= -80.0 && facts.range[1] <= 16.0,
        "{:?}",
        facts.range
    );
    snapshot(&mut window, "report");
    // Space plays, the time goes on, space stops.
    window.key_press(Key::Space);
    let before = state(&mut window).playback.pace.time;
    wait(&mut window, |w| {
        let playback = &state(w).playback;
        playback.playing && playback.pace.time > before
    });
    window.key_press(Key::Space);
    wait(&mut window, |w| !state(w).playback.playing);
    run(&mut window, Command::Seek(6.0));
    for (key, time) in [(Key::Period, 6.5), (Key::Period, 7.0), (Key::Comma, 6.5)] {
        window.key_press(key);
        window.step();
        settle(&mut window);
        assert_eq!(state(&mut window).playback.pace.time, time);
    }
    window.get_by_label("Play");
    // The session keeps file, time and which node each neuron is.
    let pace = Pace {
        time: 6.5,
        speed: 2.0,
        loops: false,
    };
    run(&mut window, Command::SetPace(pace));
    let session = folder.path().join("a.neurotess");
    run(&mut window, Command::SaveSession(session.clone()));
    let document = state(&mut window).document.clone();
    let text = fs::read_to_string(&session).expect("written");
    assert!(text.contains("report = \"voltage.h5\""), "{text}");
    rest(&mut window);
    let before = window.render().expect("a picture");
    let mut other = self::window();
    other.step();
    run(&mut other, Command::Open(vec![session]));
    assert_eq!(state(&mut other).playback.pace, pace);
    let again = state(&mut other).document.clone();
    assert_eq!(again.look, document.look);
    assert_eq!(again.neurons.len(), document.neurons.len());
    let nodes = |d: &neurotess_viewer::document::Document| -> Vec<_> {
        d.neurons.iter().map(|n| n.node.map(|n| n.node)).collect()
    };
    assert_eq!(nodes(&again), nodes(&document));
    assert_eq!(state(&mut other).messages.problems, []);
    assert!(viewer(&mut other).fatal.is_none());
    rest(&mut other);
    let after = other.render().expect("a picture");
    // The status bar says something else. One picture was recolored from another time's.
    assert!(differing(before.as_raw(), after.as_raw()) < 3000);
}

/// Two pictures of the window, of so many pixels a row, are the same; else where they differ.
fn assert_same(width: u32, a: &[u8], b: &[u8]) {
    let pairs = a.chunks(4).zip(b.chunks(4)).enumerate();
    let differ = pairs.filter(|(_, (a, b))| a != b);
    let pixels: Vec<(usize, usize)> = differ
        .map(|(i, _)| (i % width as usize, i / width as usize))
        .collect();
    let columns = || pixels.iter().map(|p| p.0);
    let rows = || pixels.iter().map(|p| p.1);
    assert!(
        pixels.is_empty(),
        "{} pixels differ, columns {:?} to {:?}, rows {:?} to {:?}",
        pixels.len(),
        columns().min(),
        columns().max(),
        rows().min(),
        rows().max()
    );
}

#[neurotess_testing::test(needs(gpu))]
fn a_frame_changes_values_and_nothing_else() {
    let (mut window, folder) = with_circuit();
    let report = folder.path().join("voltage.h5");
    run(&mut window, Edit::SetReport(Some(report)));
    rest(&mut window);
    run(&mut window, Command::Seek(4.0));
    run(&mut window, Command::Seek(0.0));
    let first = window.render().expect("a picture");
    run(&mut window, Command::Seek(9.0));
    let last = window.render().expect("a picture");
    assert_ne!(first.as_raw(), last.as_raw());
    run(&mut window, Command::Seek(0.0));
    let again = window.render().expect("a picture");
    assert_same(first.width(), first.as_raw(), again.as_raw());
    // A fixed range has other colors of the same values, and an undo has the old ones.
    set_look(&mut window, |look| look.range = Some([-80.0, -70.0]));
    assert_eq!(
        state(&mut window).playback.facts.as_ref().map(|f| f.range),
        Some([-80.0, -70.0])
    );
    run(&mut window, Command::Undo);
    run(&mut window, Command::Undo);
    assert!(
        state(&mut window).playback.facts.is_none(),
        "the report is closed"
    );
    run(&mut window, Command::Redo);
    assert!(state(&mut window).playback.facts.is_some());
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn spikes_flash() {
    let (mut window, folder) = with_circuit();
    let spikes = folder.path().join("spikes.h5");
    run(&mut window, Edit::SetReport(Some(spikes)));
    let facts = state(&mut window).playback.facts.clone().expect("open");
    assert!(facts.spikes && facts.range == [0.0, 1.0] && facts.without == [0, 9]);
    run(&mut window, Command::Show(Tab::Look));
    window.get_by_label("spikes fade in");
    let last = facts.time.time_of(facts.time.frames - 1);
    run(&mut window, Command::Seek(last));
    set_look(&mut window, |look| look.decay = 100.0);
    let slow = window.render().expect("a picture");
    set_look(&mut window, |look| look.decay = 0.2);
    let fast = window.render().expect("a picture");
    assert_ne!(slow.as_raw(), fast.as_raw());
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn reports_that_do_not_fit_are_reported_while_the_rest_shows() {
    let (mut window, folder) = with_circuit();
    let other = folder.path().join("other");
    write_circuit(&other, 20, 2, 20);
    let nodes = folder.path().join("nodes.h5");
    for (file, said) in [
        (other.join("voltage.h5"), "11 nodes of population"),
        (nodes, "neither a report nor spikes"),
        (folder.path().join("none.h5"), "no such report"),
    ] {
        state(&mut window).messages.problems.clear();
        run(&mut window, Edit::SetReport(Some(file)));
        let state = state(&mut window);
        assert!(
            state.messages.problems[0].why.contains(said),
            "{:?}",
            state.messages.problems
        );
        assert!(state.playback.facts.is_none());
    }
    run(&mut window, Edit::SetReport(None));
    assert_eq!(state(&mut window).document.look.color_by, ColorBy::Type);
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn a_report_without_a_circuit_waits_for_it() {
    let mut window = window();
    window.step();
    let folder = tempfile::tempdir().expect("a folder");
    write_circuit(folder.path(), 4, 2, 4);
    let at = |name: &str| folder.path().join(name);
    run(&mut window, Command::OpenSample(Kind::Star));
    run(&mut window, Edit::SetReport(Some(at("voltage.h5"))));
    let problems = &state(&mut window).messages.problems;
    assert!(problems[0].why.contains("open its circuit"), "{problems:?}");
    run(
        &mut window,
        Command::Open(vec![folder.path().to_path_buf()]),
    );
    let facts = state(&mut window).playback.facts.clone().expect("open");
    assert_eq!(facts.without, [1, 5], "the sample has no values");
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder").flatten();
    let mut names: Vec<String> = entries
        .map(|e| e.file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn a_film_runs_through_the_time_of_a_report() {
    let (mut window, folder) = with_circuit();
    let report = folder.path().join("voltage.h5");
    run(&mut window, Edit::SetReport(Some(report)));
    let out = folder.path().join("film");
    let film = FilmOptions {
        picture: PictureFile {
            out: out.join("f.png"),
            size: [200, 160],
            samples: 4,
            transparent: false,
            replace: false,
            recipe: true,
        },
        frames: 5,
        time: Some([0.0, 8.0]),
        video: false,
    };
    run(&mut window, Command::SaveFilm(film.clone()));
    let five: Vec<String> = (0..5).map(|i| format!("f_{i:04}.png")).collect();
    assert_eq!(
        names(&out),
        five,
        "{:?}",
        state(&mut window).messages.problems
    );
    let bytes = |i: usize| fs::read(out.join(&five[i])).expect("there");
    assert_ne!(bytes(0), bytes(4));
    // Two views and the time: as many as from view to view, and one more.
    for side in [Side::Front, Side::Iso] {
        run(&mut window, Command::Look(side));
        run(&mut window, Command::AddKeyView);
    }
    let mut along = film.clone();
    along.picture.out = out.join("g.png");
    along.frames = 2;
    along.video = true;
    run(&mut window, Command::SaveFilm(along));
    // Where ffmpeg is not installed the pictures are there, and a problem names it.
    let problems = std::mem::take(&mut state(&mut window).messages.problems);
    assert_eq!(out.join("g.mp4").exists(), problems.is_empty());
    if let Some(problem) = problems.first() {
        assert!(problem.why.contains("ffmpeg"), "{problems:?}");
    }
    let pictures = names(&out).into_iter().filter(|n| n.ends_with(".png"));
    assert_eq!(pictures.count(), 5 + 3);
    assert!(
        names(&out).iter().all(|n| !n.starts_with('.')),
        "nothing is left"
    );
    // Without either there is none.
    run(&mut window, Command::DropKeyView(1));
    run(&mut window, Edit::SetReport(None));
    run(&mut window, Command::SaveFilm(film));
    assert!(
        state(&mut window).messages.problems[0]
            .why
            .contains("keep two views")
    );
}

#[neurotess_testing::test(needs(gpu, ffmpeg))]
fn ffmpeg_makes_a_video_of_a_film() {
    let (mut window, folder) = with_circuit();
    for side in [Side::Front, Side::Iso] {
        run(&mut window, Command::Look(side));
        run(&mut window, Command::AddKeyView);
    }
    let film = FilmOptions {
        picture: PictureFile {
            out: folder.path().join("f.png"),
            size: [200, 160],
            samples: 4,
            transparent: false,
            replace: false,
            recipe: true,
        },
        frames: 2,
        time: None,
        video: true,
    };
    run(&mut window, Command::SaveFilm(film));
    assert_eq!(state(&mut window).messages.problems, []);
    let video = fs::read(folder.path().join("f.mp4")).expect("a video");
    assert_eq!(&video[4..8], b"ftyp");
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn a_film_that_is_stopped_leaves_whole_pictures() {
    let (mut window, folder) = with_circuit();
    for side in [Side::Front, Side::Iso] {
        run(&mut window, Command::Look(side));
        run(&mut window, Command::AddKeyView);
    }
    let out = folder.path().join("film");
    let film = FilmOptions {
        picture: PictureFile {
            out: out.join("f.png"),
            size: [640, 480],
            samples: 16,
            transparent: false,
            replace: false,
            recipe: true,
        },
        frames: 500,
        time: None,
        video: true,
    };
    state(&mut window).run(Command::SaveFilm(film));
    wait(&mut window, |_| out.join("f_0001.png").exists());
    run(&mut window, Command::Cancel);
    let names = names(&out);
    assert!(names.len() < 400, "{}", names.len());
    for name in &names {
        let bytes = fs::read(out.join(name)).expect("there");
        // Every file is whole: it ends as PNG does.
        let whole = bytes.starts_with(b"\x89PNG") && bytes.ends_with(b"IEND\xaeB`\x82");
        assert!(whole, "{name}");
    }
    let why = &state(&mut window).messages.problems[0].why;
    assert!(
        why.contains(&format!("stopped after {} of 501", names.len())),
        "{why}"
    );
}

#[neurotess_testing::test(needs(gpu))]
fn look_lists_the_reports_of_a_circuit_before_one_shows() {
    let mut window = window_of(SMALL);
    window.step();
    let folder = tempfile::tempdir().expect("a folder");
    write_circuit(folder.path(), 2, 1, 2);
    let simulation = r#"{"network": "circuit_config.json", "output": {"output_dir": "."},
        "run": {"tstop": 10.0}, "reports": {"voltage": {"variable_name": "v"}}}"#;
    let file = folder.path().join("simulation_config.json");
    fs::write(file, simulation).expect("written");
    state(&mut window).run(Command::Open(vec![folder.path().to_path_buf()]));
    wait(&mut window, |w| state(w).document.neurons.len() == 2);
    run_undrawn(&mut window, Command::Show(Tab::Look));
    assert!(state(&mut window).document.report.is_none());
    window.get_by_label("report");
}
