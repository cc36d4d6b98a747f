//! The window, driven by commands, keys and mouse, with pictures of its main states.
//!
//! Pictures lie in `tests/snapshots`; `UPDATE_SNAPSHOTS=1 cargo test -p neurotess-viewer --test window`
//! renews them. They are compared on software Vulkan: a pixel may be off by 0.8 of dify's measure, and single
//! pixels by more than that. Times that the window has measured are masked.

mod common;

use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use eframe::egui::{self, Event, Key, Modifiers, PointerButton, Pos2, Vec2};
use egui_kittest::kittest::Queryable;
use neurotess::refine::LodCriterion;
use neurotess::render::Side;
use neurotess::synth::Kind;
use neurotess_viewer::Command;
use neurotess_viewer::command::{Edit, FilePurpose, Tab};
use neurotess_viewer::document::{
    Cut, Detail, LodKind, Look, Method, RestChoice, SomaEdit, SourceId,
};
use neurotess_viewer::save::{MeshLod, MeshOptions, PictureFile};
use neurotess_viewer::sources::Stale;
use neurotess_viewer::state::{CellPart, Lowered, State};
use neurotess_viewer::view::View;

use common::{
    SIZE, Window, click, gpu, hit_at, rest, run, settle, snapshot, state, viewer, window,
    with_samples,
};

/// Middle of the picture, where the soma of a single sample is: it is the target's.
fn middle(window: &mut Window) -> Pos2 {
    hit_at(window, glam::DVec3::ZERO)
}

#[neurotess_testing::test(needs(gpu))]
fn an_empty_window_says_how_to_begin() {
    let mut window = window();
    window.run_steps(3);
    snapshot(&mut window, "empty");
    window.get_by_label("star").click();
    window.step();
    settle(&mut window);
    assert_eq!(state(&mut window).document.neurons.len(), 1);
    assert_eq!(state(&mut window).document.neurons[0].name, "star");
}

#[neurotess_testing::test(needs(gpu))]
fn a_cell_is_drawn_picked_and_inspected() {
    let mut window = with_samples(&[Kind::Pyramidal]);
    snapshot(&mut window, "cell");
    let at = middle(&mut window);
    window.event(Event::PointerMoved(at));
    window.run_steps(4);
    let hovered = state(&mut window)
        .hovered
        .expect("something under the cursor");
    assert_eq!((hovered.neuron, hovered.part), (0, CellPart::Soma));
    click(&mut window, at, Modifiers::NONE);
    assert_eq!(
        state(&mut window).document.selected().collect::<Vec<_>>(),
        [0]
    );
    window.get_by_label("Soma, as traced");
    snapshot(&mut window, "picked");
    // Beside the cell is nothing.
    click(&mut window, Pos2::new(250.0, 700.0), Modifiers::NONE);
    assert_eq!(state(&mut window).document.selected().count(), 0);
}

#[neurotess_testing::test(needs(gpu))]
fn tabs_show_their_panels() {
    let mut window = with_samples(&[Kind::Star]);
    for (tab, name) in [
        (Tab::Soma, "soma"),
        (Tab::Look, "look"),
        (Tab::Detail, "detail"),
        (Tab::Save, "save"),
    ] {
        run(&mut window, Command::Show(tab));
        // Figures of memory are those of what is there in the end.
        rest(&mut window);
        snapshot(&mut window, name);
    }
    run(&mut window, Command::ToggleKeys);
    snapshot(&mut window, "keys");
    window.key_press(Key::Escape);
    window.run_steps(2);
    run(&mut window, Command::SetDark(false));
    run(&mut window, Command::TogglePalette);
    snapshot(&mut window, "palette_light");
    window.key_press(Key::Escape);
    window.run_steps(2);
    run(&mut window, Command::AskFiles(FilePurpose::Open));
    window.get_by_label("Open this whole folder");
}

/// Middle of the rail of the n-th slider of the panel.
fn slider(window: &mut Window, n: usize) -> egui::Rect {
    let sliders = window.get_all_by_role(egui::accesskit::Role::Slider);
    let rects: Vec<egui::Rect> = sliders.map(|slider| slider.rect()).collect();
    rects[n]
}

#[neurotess_testing::test(needs(gpu))]
fn a_ring_follows_its_slider_and_is_shown_while_it_is_touched() {
    let mut window = with_samples(&[Kind::Pyramidal]);
    run(&mut window, Edit::Select(vec![0], false));
    run(&mut window, Command::Show(Tab::Soma));
    let close = state(&mut window).view.focused((glam::DVec3::ZERO, 16.0));
    run(&mut window, Command::Go(close));
    let source = |window: &mut Window| {
        let source = state(window).source_of(0).expect("there");
        (source.generated.rings[0], source.generated.somata[0].volume)
    };
    let (before, volume) = source(&mut window);
    // Poisson's ratio and the radius come first.
    let rail = slider(&mut window, 2);
    window.event(Event::PointerMoved(rail.center()));
    window.step();
    window.step();
    settle(&mut window);
    let part = state(&mut window).hovered.expect("touched").part;
    assert_eq!(part, CellPart::Neurite(0));
    assert!(state(&mut window).touched.is_some());
    assert!(
        state(&mut window).document.somata.is_empty(),
        "only touched"
    );
    window.event(Event::PointerButton {
        pos: rail.center(),
        button: PointerButton::Primary,
        pressed: true,
        modifiers: Modifiers::NONE,
    });
    window.step();
    for share in [0.6, 0.7, 0.85] {
        let at = rail.min + Vec2::new(share * rail.width(), rail.height() / 2.0);
        window.event(Event::PointerMoved(at));
        window.step();
        settle(&mut window);
    }
    assert!(state(&mut window).touched.is_some(), "while it is dragged");
    snapshot(&mut window, "ring");
    window.event(Event::PointerButton {
        pos: rail.min + Vec2::new(0.85 * rail.width(), rail.height() / 2.0),
        button: PointerButton::Primary,
        pressed: false,
        modifiers: Modifiers::NONE,
    });
    window.step();
    settle(&mut window);
    let (after, larger) = source(&mut window);
    assert!(after.position > 1.5, "{after:?} after {before:?}");
    assert!(larger > volume, "the surface follows");
    // The whole drag is one edit.
    run(&mut window, Command::Undo);
    assert_eq!(source(&mut window), (before, volume));
    run(&mut window, Command::Redo);
    assert_eq!(source(&mut window), (after, larger));
    window.event(Event::PointerMoved(Pos2::new(600.0, 730.0)));
    window.step();
    assert!(state(&mut window).touched.is_none());
}

#[neurotess_testing::test(needs(gpu))]
fn several_neurons_are_laid_out_selected_and_hidden() {
    let kinds = [Kind::Star, Kind::Granule, Kind::Motor];
    let mut window = with_samples(&kinds);
    run(&mut window, Edit::SetGrid(true));
    run(&mut window, Command::Home);
    run(&mut window, Edit::Select(vec![1], false));
    let mut look = state(&mut window).document.look.clone();
    look.ghost_others = true;
    run(&mut window, Edit::SetLook(Box::new(look)));
    snapshot(&mut window, "grid");
    window.key_press(Key::H);
    window.step();
    settle(&mut window);
    assert!(state(&mut window).document.neurons[1].hidden);
    window.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    window.step();
    settle(&mut window);
    assert!(!state(&mut window).document.neurons[1].hidden);
}

#[neurotess_testing::test(needs(gpu))]
fn every_edit_can_be_undone_and_done_again() {
    let mut window = with_samples(&[Kind::Star, Kind::Granule]);
    run(&mut window, Edit::Select(vec![0], false));
    let look = Look {
        cut: Some(Cut {
            axis: 2,
            place: 0.5,
            flipped: false,
        }),
        wireframe: true,
        ..Look::default()
    };
    let detail = Detail {
        criterion: LodKind::Homogeneous,
        level: 2,
        ..Detail::default()
    };
    let soma = SomaEdit {
        poisson: 0.1,
        scale: 1.3,
        ..SomaEdit::default()
    };
    run(&mut window, Edit::SetRing(SourceId(0), 2, Some(1.5)));
    let edits = [
        Edit::Select(vec![1], false),
        Edit::SelectAll,
        Edit::SelectNone,
        Edit::SelectOthers,
        Edit::Isolate,
        Edit::SetHidden(1, true),
        Edit::Hide,
        Edit::SetSoma(vec![SourceId(0)], soma),
        Edit::SetRing(SourceId(0), 1, Some(0.25)),
        Edit::SetRing(SourceId(0), 2, None),
        Edit::ResetRings(SourceId(0)),
        Edit::SetLook(Box::new(look)),
        Edit::SetDetail(detail),
        Edit::SetGrid(true),
        Edit::Remove,
    ];
    for edit in edits {
        let before = state(&mut window).document.clone();
        run(&mut window, edit.clone());
        let after = state(&mut window).document.clone();
        assert_ne!(before, after, "{edit:?} does something");
        run(&mut window, Command::Undo);
        assert_eq!(state(&mut window).document, before, "{edit:?} undone");
        run(&mut window, Command::Redo);
        assert_eq!(state(&mut window).document, after, "{edit:?} done again");
        run(&mut window, Command::Undo);
    }
    run(&mut window, Edit::Remove);
    run(&mut window, Edit::ShowAll);
    assert_eq!(state(&mut window).document.neurons.len(), 1);
    assert!(viewer(&mut window).fatal.is_none() && state(&mut window).problems.is_empty());
}

#[neurotess_testing::test(needs(gpu))]
fn the_surface_follows_the_soma_editor() {
    let mut window = with_samples(&[Kind::Motor]);
    let volume = |window: &mut Window| {
        let source = state(window).source_of(0).expect("a source").clone();
        source.generated.somata[0].volume
    };
    let usual = volume(&mut window);
    for (edit, grows) in [
        (
            SomaEdit {
                scale: 1.5,
                ..SomaEdit::default()
            },
            true,
        ),
        (
            SomaEdit {
                scale: 0.7,
                ..SomaEdit::default()
            },
            false,
        ),
        (
            SomaEdit {
                method: Method::Profile,
                scale: 1.4,
                ..SomaEdit::default()
            },
            true,
        ),
    ] {
        run(&mut window, Edit::SetSoma(vec![SourceId(0)], edit.clone()));
        assert_eq!(volume(&mut window) > usual, grows, "{edit:?}");
    }
    run(&mut window, Command::Undo);
    run(
        &mut window,
        Edit::SetSoma(vec![SourceId(0)], SomaEdit::default()),
    );
    assert_eq!(volume(&mut window), usual);
}

#[neurotess_testing::test(needs(gpu))]
fn nothing_is_drawn_when_nothing_changes() {
    let mut window = with_samples(&[Kind::Star]);
    rest(&mut window);
    window.run_steps(40);
    let output = window
        .output()
        .viewport_output
        .values()
        .next()
        .expect("a window");
    assert!(
        output.repaint_delay > Duration::from_secs(1),
        "{:?}",
        output.repaint_delay
    );
    run(&mut window, Command::Look(Side::Top));
    rest(&mut window);
    window.run_steps(40);
    let output = window
        .output()
        .viewport_output
        .values()
        .next()
        .expect("a window");
    assert!(
        output.repaint_delay > Duration::from_secs(1),
        "{:?}",
        output.repaint_delay
    );
}

#[neurotess_testing::test(needs(gpu))]
fn a_lost_device_costs_no_work() {
    let mut window = with_samples(&[Kind::Star]);
    let folder = tempfile::tempdir().expect("a folder");
    let slot = window.state_mut();
    *slot = slot
        .take()
        .map(|viewer| viewer.with_rescue(folder.path().to_path_buf()));
    run(&mut window, Edit::Select(vec![0], false));
    run(&mut window, Edit::SetRing(SourceId(0), 1, Some(1.5)));
    let before = neurotess_viewer::session::Session::of(state(&mut window), folder.path());
    viewer(&mut window).stage.gpu().device.destroy();
    // Something must be drawn to notice it.
    let turned = state(&mut window).view.orbited(0.1, 0.0, glam::DVec3::Y);
    state(&mut window).view = turned;
    let clock = Instant::now();
    while viewer(&mut window).fatal.is_none() {
        assert!(clock.elapsed() < Duration::from_secs(20), "not noticed");
        window.step();
        std::thread::sleep(Duration::from_millis(3));
    }
    let said = viewer(&mut window).fatal.clone().expect("an error");
    let file = folder.path().join("rescued.neurotess");
    assert!(said.contains("lost") && said.contains(&file.display().to_string()));
    let rescued = neurotess_viewer::session::Session::read(&file).expect("rescued");
    assert_eq!(
        (&rescued.file, &rescued.neuron),
        (&before.file, &before.neuron)
    );
    assert_eq!(rescued.view, turned);
}

#[neurotess_testing::test(needs(gpu))]
fn a_session_comes_back_as_it_was() {
    let mut window = with_samples(&[Kind::Star, Kind::Granule]);
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("mine.neurotess");
    let soma = SomaEdit {
        poisson: 0.05,
        ..SomaEdit::default()
    };
    run(&mut window, Edit::SetSoma(vec![SourceId(1)], soma));
    run(&mut window, Edit::Select(vec![1], false));
    run(&mut window, Edit::SetHidden(0, true));
    run(&mut window, Command::Look(Side::Iso));
    run(&mut window, Command::AddKeyView);
    run(&mut window, Command::SaveSession(file.clone()));
    let (document, view) = (state(&mut window).document.clone(), state(&mut window).view);
    let mut other = self::window();
    other.step();
    run(&mut other, Command::Open(vec![file.clone()]));
    assert_eq!(state(&mut other).document, document);
    assert_eq!(
        (state(&mut other).view, state(&mut other).key_views.len()),
        (view, 1)
    );
    // A broken one loses nothing.
    fs::write(&file, "version = 1\nview = 3\n").expect("written");
    run(&mut other, Command::Open(vec![file]));
    assert_eq!(state(&mut other).document, document);
    assert!(state(&mut other).problems[0].why.contains("line 2"));
}

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
    assert_eq!(state(&mut window).document.neurons.len(), 1);
    assert_eq!(
        state(&mut window).problems.len(),
        2,
        "{:?}",
        state(&mut window).problems
    );
    run(&mut window, Command::ToggleProblems);
    window.get_by_label("What went wrong");
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
        assert!(begun.elapsed() < Duration::from_secs(30), "never");
        window.step();
        std::thread::sleep(Duration::from_millis(20));
    }
}

#[neurotess_testing::test(needs(gpu))]
fn meshes_and_pictures_are_saved() {
    let mut window = with_samples(&[Kind::Star, Kind::Granule]);
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let meshes = MeshOptions {
        out: at("all"),
        format: neurotess::mesh::Format::Glb,
        lod: MeshLod::Fixed(Some(LodCriterion::Homogeneous(1))),
        quads: false,
        linear: false,
        flat: false,
        placed: false,
        all: true,
        replace: false,
    };
    run(&mut window, Command::SaveMeshes(meshes.clone()));
    assert!(at("all/star.glb").exists() && at("all/granule.glb").exists());
    let picture = PictureFile {
        out: at("p.png"),
        size: [160, 120],
        samples: 4,
        transparent: true,
        replace: false,
    };
    run(&mut window, Command::SavePicture(picture.clone()));
    assert!(is_png(&at("p.png")) && state(&mut window).problems.is_empty());
    run(&mut window, Command::SavePicture(picture));
    assert!(
        state(&mut window).problems[0].why.contains("exists"),
        "nothing is replaced unasked"
    );
}

fn is_png(path: &Path) -> bool {
    fs::read(path).is_ok_and(|bytes| bytes.starts_with(b"\x89PNG") && bytes.len() > 200)
}

#[neurotess_testing::test(needs(gpu))]
fn a_window_of_no_size_loses_nothing() {
    let mut window = with_samples(&[Kind::Star]);
    for size in [
        Vec2::new(1.0, 1.0),
        Vec2::new(300.0, 20.0),
        Vec2::new(640.0, 480.0),
    ] {
        window.set_size(size);
        window.run_steps(6);
    }
    window.set_size(SIZE);
    settle(&mut window);
    assert_eq!(state(&mut window).document.neurons.len(), 1);
    assert!(viewer(&mut window).fatal.is_none());
}

#[neurotess_testing::test(needs(gpu))]
fn mouse_and_keys_move_the_camera() {
    let mut window = with_samples(&[Kind::Star]);
    let view = |window: &mut Window| -> View { state(window).view };
    let at = Pos2::new(500.0, 350.0);
    let first = view(&mut window);
    for (button, pressed, to) in [
        (PointerButton::Primary, true, at),
        (PointerButton::Primary, false, at + Vec2::new(60.0, 20.0)),
        (PointerButton::Middle, true, at),
        (PointerButton::Middle, false, at + Vec2::new(-40.0, 20.0)),
    ] {
        window.event(Event::PointerMoved(to));
        window.step();
        window.event(Event::PointerButton {
            pos: to,
            button,
            pressed,
            modifiers: Modifiers::NONE,
        });
        window.step();
    }
    let dragged = view(&mut window);
    assert_ne!(dragged.eye, first.eye);
    assert_ne!(dragged.target, first.target, "the middle button moves");
    window.event(Event::PointerMoved(at));
    window.event(Event::MouseWheel {
        unit: egui::MouseWheelUnit::Point,
        delta: Vec2::new(0.0, 60.0),
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Unknown,
        modifiers: Modifiers::NONE,
    });
    window.run_steps(20);
    let distance = |view: View| view.camera().eye().distance(view.camera().target());
    assert!(
        distance(view(&mut window)) < 0.95 * distance(dragged),
        "the wheel comes nearer"
    );
    let before = view(&mut window);
    window.key_down(Key::W);
    window.run_steps(6);
    window.key_up(Key::W);
    window.step();
    assert_ne!(view(&mut window).eye, before.eye, "W flies");
    for (key, axis) in [(Key::Num1, 2), (Key::Num2, 0), (Key::Num3, 1)] {
        window.key_press(key);
        window.step();
        settle(&mut window);
        let backward = view(&mut window).camera().axes()[2];
        assert!(backward[axis] > 0.99, "{key:?}: {backward}");
    }
}

#[neurotess_testing::test(needs(gpu))]
fn what_is_too_expensive_is_explored_says_so_and_comes_back() {
    let mut window = with_samples(&[Kind::Pyramidal]);
    run(&mut window, Command::Show(Tab::Detail));
    let one = state(&mut window).counters.patches[1];
    assert!(one > 0, "counted");
    // Three are too many, one is not.
    viewer(&mut window).stage.limit_patches(Some(2 * one));
    let state_of = state(&mut window);
    for name in ["b", "c"] {
        let neuron = neurotess_viewer::document::Neuron::new(SourceId(0), name.into());
        state_of.document.neurons.push(neuron);
    }
    state_of.document.grid = true;
    run(&mut window, Command::Home);
    assert!(viewer(&mut window).stage.is_sharp(), "no draft");
    let Some(Lowered::Triangles(Some([drawn, needed]))) = state(&mut window).counters.lowered
    else {
        panic!("explored: {:?}", state(&mut window).counters.lowered);
    };
    assert!(drawn > 0 && drawn <= needed);
    window.get_by_label_contains("reduced: ");
    // One may ask for all detail all the same, and for a budget where there is no need.
    let mut detail = state(&mut window).document.detail;
    for (at_rest, budget) in [
        (RestChoice::Full, false),
        (RestChoice::Budget, true),
        (RestChoice::Automatic, true),
    ] {
        detail.at_rest = at_rest;
        run(&mut window, Edit::SetDetail(detail));
        let lowered = state(&mut window).counters.lowered;
        assert_eq!(
            matches!(lowered, Some(Lowered::Triangles(_))),
            budget,
            "{at_rest:?}"
        );
    }
    // What is seen is known there too: somata, and a section by its number.
    let parts = seen_parts(&mut window);
    assert!(parts.contains(&(0, CellPart::Soma)) && parts.contains(&(2, CellPart::Soma)));
    let neurites = parts
        .iter()
        .filter(|(_, p)| matches!(p, CellPart::Section(_)));
    assert!(neurites.count() > 10, "{parts:?}");
    // Exploration mode draws no wireframe: the picture is coarser, and the window says so.
    let mut look = state(&mut window).document.look.clone();
    look.wireframe = true;
    run(&mut window, Edit::SetLook(Box::new(look.clone())));
    assert!(matches!(
        state(&mut window).counters.lowered,
        Some(Lowered::Error(_))
    ));
    look.wireframe = false;
    run(&mut window, Edit::SetLook(Box::new(look)));
    // Alone, it is whole again, and the window no longer says so.
    run(&mut window, Edit::Select(vec![1], false));
    run(&mut window, Edit::Isolate);
    assert_eq!(state(&mut window).counters.lowered, None);
    assert!(window.query_by_label_contains("reduced: ").is_none());
    assert!(
        seen_parts(&mut window)
            .iter()
            .all(|(neuron, _)| *neuron == 1)
    );
}

/// What is seen at pixels all over the picture.
fn seen_parts(window: &mut Window) -> std::collections::HashSet<(usize, CellPart)> {
    let stage = &viewer(window).stage;
    let pixels = (0..700).flat_map(|y| (0..900).map(move |x| (x as f32, y as f32)));
    let seen = pixels.filter_map(|(x, y)| stage.hit_at(x, y));
    seen.map(|seen| (seen.picked.neuron, seen.picked.part))
        .collect()
}

neurotess_testing::main!();
