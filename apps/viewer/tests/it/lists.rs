//! Lists, panels and the legend go with the picture.

use std::fs;

use eframe::egui::accesskit::Role;
use eframe::egui::{Event, Modifiers, Pos2, Rect, Vec2};
use egui_kittest::kittest::Queryable;
use neurotess::formats::swc;
use neurotess::synth::{Kind, Options, grow};
use neurotess_viewer::Command;
use neurotess_viewer::command::{Edit, FilePurpose, Tab};
use neurotess_viewer::document::{ColorBy, Look};
use neurotess_viewer::state::{CellPart, Picked};

use crate::common::{
    SIZE, Window, click, gpu, hit_at, picture, run, settle, snapshot, state, viewer, window,
    with_samples,
};

/// A window with so many cells of three neurites, `cell_00` and so on.
fn many(count: usize) -> Window {
    let mut window = window();
    window.step();
    let folder = tempfile::tempdir().expect("a folder");
    for i in 0..count {
        let x = 90 * i;
        let text = format!(
            "1 1 {x} 0 0 5 -1\n2 3 {x} 9 0 1 1\n3 3 {x} 30 0 1 2\n4 2 {x} -9 0 1 1\n\
             5 2 {x} -40 0 1 4\n6 4 {x} 0 9 1 1\n7 4 {x} 3 40 1 6\n"
        );
        fs::write(folder.path().join(format!("cell_{i:02}.swc")), text).expect("written");
    }
    run(
        &mut window,
        Command::Open(vec![folder.path().to_path_buf()]),
    );
    assert_eq!(state(&mut window).document.neurons.len(), count);
    window
}

#[neurotess_testing::test(needs(gpu))]
fn the_list_counts_what_it_shows() {
    let mut window = many(12);
    window.get_by_label("12 neurons");
    state(&mut window).layout.search = "_1".into();
    window.run_steps(2);
    window.get_by_label("2 of 12 neurons");
    assert!(window.query_by_label("cell_03").is_none());
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn a_pick_scrolls_both_lists_to_its_line() {
    let mut window = many(40);
    let inside = |window: &Window, label: &str| {
        let panel = Rect::from_min_max(Pos2::ZERO, Pos2::new(picture(window).left(), SIZE.y));
        let mut lines = window.query_all_by_label(label).map(|node| node.rect());
        lines.any(|line| line.is_positive() && panel.contains_rect(line))
    };
    assert!(!inside(&window, "cell_37"));
    let soma = hit_at(&mut window, glam::DVec3::new(37.0 * 90.0, 0.0, 0.0));
    click(&mut window, soma, Modifiers::NONE);
    let picked = state(&mut window).pointing.picked.expect("picked");
    assert_eq!(picked.neuron, 37);
    assert!(inside(&window, "cell_37"));
    // A section of a cell with many.
    let mut window = with_samples(&[Kind::Purkinje]);
    let source = state(&mut window).source_of(0).expect("there").clone();
    let last = source.sections.len() - 1;
    let label = {
        let length = source.sections[last].length;
        let digits = match length {
            100.0.. => 0,
            10.0.. => 1,
            _ => 2,
        };
        format!("{last}  {length:.digits$} µm")
    };
    assert!(!inside(&window, &label));
    let picked = Picked {
        neuron: 0,
        part: CellPart::Section(last as u32),
    };
    let state_of = state(&mut window);
    (state_of.pointing.picked, state_of.pointing.reveal) = (Some(picked), Some(picked));
    window.run_steps(40);
    assert!(inside(&window, &label), "{label}");
    assert_eq!(
        state(&mut window).pointing.reveal,
        None,
        "and then the list is free"
    );
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn what_is_hidden_is_not_marked() {
    let mut window = many(2);
    let row = window.get_by_label("cell_01").rect().center();
    window.event(Event::PointerMoved(row));
    window.run_steps(3);
    let hovered = |window: &mut Window| state(window).pointing.hovered.map(|h| h.neuron);
    assert_eq!(hovered(&mut window), Some(1));
    run(&mut window, Edit::SetHidden(1, true));
    window.event(Event::PointerMoved(row + Vec2::new(1.0, 0.0)));
    window.run_steps(3);
    assert_eq!(hovered(&mut window), None);
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn a_resized_window_keeps_the_cells_in_view() {
    let mut window = many(3);
    let ends = |window: &mut Window| {
        let ends = [
            glam::DVec3::new(-5.0, 0.0, 0.0),
            glam::DVec3::new(185.0, 0.0, 0.0),
        ];
        let rect = picture(window);
        ends.map(|end| (hit_at(window, end).x - rect.left()) / rect.width())
    };
    let within = |[left, right]: [f32; 2]| left > 0.0 && right < 1.0 && right - left > 0.6;
    assert!(within(ends(&mut window)), "{:?}", ends(&mut window));
    for size in [Vec2::new(700.0, 700.0), Vec2::new(1500.0, 420.0), SIZE] {
        window.set_size(size);
        window.run_steps(3);
        settle(&mut window);
        assert!(within(ends(&mut window)), "{size}: {:?}", ends(&mut window));
    }
    // Moved by hand, the shorter side keeps what it showed.
    let moved = state(&mut window).view.orbited(0.2, 0.1, glam::DVec3::Y);
    run(&mut window, Command::Go(moved));
    let before = ends(&mut window);
    window.set_size(Vec2::new(760.0, 740.0));
    window.run_steps(3);
    settle(&mut window);
    let after = ends(&mut window);
    assert!(
        within(before) && after[0] > 0.0 && after[1] < 1.0,
        "{before:?} {after:?}"
    );
    assert_ne!(state(&mut window).view, moved);
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn panels_leave_the_picture_free_in_a_small_window() {
    let mut window = many(12);
    for size in [Vec2::new(480.0, 320.0), Vec2::new(600.0, 400.0), SIZE] {
        window.set_size(size);
        for (tab, name) in Tab::ALL {
            run(&mut window, Command::Show(tab));
            window.run_steps(3);
            let rect = picture(&window);
            let panel = window.get_by_label("Inspect").rect();
            let list = window.get_by_label("12 neurons").rect();
            assert!(rect.width() > 0.28 * size.x, "{size} {name}: {rect}");
            assert!(
                panel.left() >= rect.right(),
                "{size} {name}: {panel} {rect}"
            );
            assert!(list.right() <= rect.left(), "{size} {name}: {list} {rect}");
        }
    }
}

#[neurotess_testing::test(needs(gpu))]
fn the_legend_is_that_of_the_picture() {
    let mut window = many(3);
    let before = viewer(&mut window).stage.legend().clone();
    let look = Look {
        color_by: ColorBy::PathDistance,
        ..state(&mut window).document.look.clone()
    };
    state(&mut window).run(Edit::SetLook(Box::new(look)));
    // Drafts that are too expensive wait until exploration mode has made its own; the old picture stays meanwhile.
    viewer(&mut window).stage.limit_patches(Some(0));
    for _ in 0..2000 {
        window.step();
        let stage = &viewer(&mut window).stage;
        let (other, drawn) = (*stage.legend() != before, stage.is_drawn());
        assert!(!other || drawn, "no picture has these colors yet");
        if other {
            return;
        }
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    panic!("it never changed");
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn memory_is_shown_whatever_was_opened() {
    let mut window = with_samples(&[Kind::Star]);
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("mine.neurotess");
    run(&mut window, Command::SaveSession(file.clone()));
    run(&mut window, Command::Show(Tab::Detail));
    for _ in 0..2 {
        let counters = &state(&mut window).drawing.counters;
        assert!(
            counters.bytes.iter().all(|bytes| *bytes > 0),
            "{:?}",
            counters.bytes
        );
        assert!(counters.triangles > 0);
        run(&mut window, Command::Open(vec![file.clone()]));
        run(&mut window, Command::Show(Tab::Detail));
        window.run_steps(3);
        settle(&mut window);
    }
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn the_path_line_completes_and_a_save_dialog_says_what_it_is_for() {
    let mut window = many(1);
    let folder = tempfile::tempdir().expect("a folder");
    fs::create_dir(folder.path().join("reconstructions")).expect("made");
    for name in ["purkinje_1.swc", "purkinje_2.swc"] {
        fs::write(folder.path().join("reconstructions").join(name), "").expect("written");
    }
    run(&mut window, Command::AskFiles(FilePurpose::Open));
    window.run_steps(3);
    let type_in = |window: &mut Window, text: String| {
        window.event(Event::Text(text));
        window.step();
        window.key_press(egui::Key::Tab);
        window.run_steps(3);
    };
    let typed = |window: &Window| {
        let line = window.get_by_role(Role::TextInput);
        line.value().unwrap_or_default()
    };
    let path = folder.path().display();
    type_in(&mut window, format!("{path}/rec"));
    assert_eq!(typed(&window), format!("{path}/reconstructions/"));
    type_in(&mut window, "p".into());
    assert_eq!(typed(&window), format!("{path}/reconstructions/purkinje_"));
    window.get_by_label("purkinje_1.swc");
    type_in(&mut window, "2".into());
    assert_eq!(
        typed(&window),
        format!("{path}/reconstructions/purkinje_2.swc")
    );
    assert!(
        window.query_by_label("purkinje_1.swc").is_none(),
        "only what fits"
    );
    window.key_press(egui::Key::Escape);
    window.step();
    state(&mut window).settings.folder = folder.path().join("reconstructions");
    run(&mut window, Command::AskFiles(FilePurpose::SaveSession));
    window.run_steps(3);
    window.get_by_label("No folder and no session here yet");
}

/// Two dendrites through one another beside a third neuron without any crossing.
#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn crossings_are_listed_and_flown_to() {
    let mut window = window();
    window.step();
    let folder = tempfile::tempdir().expect("a folder");
    let crossing = "1 1 0 0 0 6 -1\n2 3 10 0 0 1 1\n3 3 40 0 0 1 2\n4 3 60 30 0 1 3\n5 3 20 60 0 1 4\n\
                    6 3 0 10 0 1 1\n7 3 0 30 0 1 6\n8 3 40 50 0 1 7\n9 3 60 65 0 1 8\n";
    let plain = "1 1 90 0 0 6 -1\n2 3 90 9 0 1 1\n3 3 90 40 0 1 2\n";
    fs::write(folder.path().join("a.swc"), crossing).expect("written");
    fs::write(folder.path().join("b.swc"), plain).expect("written");
    let folder = folder.path().to_path_buf();
    run(&mut window, Command::Open(vec![folder]));
    run(&mut window, Command::ListCrossings(true));
    assert!(
        state(&mut window).crossing_list().is_none(),
        "of the selection only"
    );
    run(&mut window, Edit::Select(vec![0], false));
    let list = |window: &mut Window| {
        let (list, current) = state(window).crossing_list().expect("searched");
        assert!(current);
        list.expect("searched").to_vec()
    };
    let found = list(&mut window);
    let [only] = &found[..] else {
        panic!("{found:?}");
    };
    assert_eq!(only.place.kin, neurotess::union::Kin::Apart);
    assert_eq!(only.place.points, [5, 8]);
    let where_it_is = glam::DVec3::new(36.0, 48.0, 0.0);
    assert!(only.place.position.distance(where_it_is) < 3.0, "{only:?}");
    let line = "2.00 µm, branches (5, 8)";
    let line = window.get_by_label(line).rect().center();
    click(&mut window, line, Modifiers::NONE);
    settle(&mut window);
    let target = glam::DVec3::from(state(&mut window).view.target);
    assert!(target.distance(only.place.position) < 1e-6, "{target}");
    // A neuron without any; then none.
    run(&mut window, Edit::Select(vec![1], false));
    assert!(list(&mut window).is_empty());
    window.get_by_label("None: the surface crosses itself nowhere.");
    run(&mut window, Command::ListCrossings(false));
    assert!(state(&mut window).crossing_list().is_none());
}

#[neurotess_testing::test(needs(gpu))]
fn crossings_are_marked_in_the_picture() {
    let mut window = window();
    window.step();
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("purkinje.swc");
    let crossing = grow(&Options {
        may_cross: true,
        ..Options::sample(Kind::Purkinje)
    });
    swc::write(&crossing, fs::File::create(&file).expect("a file")).expect("written");
    run(&mut window, Command::Open(vec![file]));
    run(&mut window, Command::ListCrossings(true));
    snapshot(&mut window, "crossings");
}
