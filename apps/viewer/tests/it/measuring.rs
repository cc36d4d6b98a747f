//! Measuring in the window: clicks, dimensions on the picture, undo, sessions, the clipboard.

use std::fs;

use eframe::egui::{Event, Key, Modifiers, OutputCommand, Pos2};
use egui_kittest::kittest::Queryable;
use glam::DVec3;
use neurotess::morphology::paths::{Location, Path};
use neurotess::morphology::shape;
use neurotess::synth::Kind;
use neurotess_viewer::Command;
use neurotess_viewer::command::{Edit, Tab};
use neurotess_viewer::document::{Anchor, Dimension};
use neurotess_viewer::save::PictureFile;

use crate::common::{
    Window, click, gpu, hit_at, picture, rest, run, set_look, settle, snapshot, state, viewer,
    with_samples,
};

/// An anchor at a location of the only neuron.
fn anchor(window: &mut Window, location: Location) -> Anchor {
    let source = state(window).source_of(0).expect("open").clone();
    Anchor::new(0, location, &source.morphology).expect("on the tracing")
}

/// Clicks where the picture shows a location.
fn click_at(window: &mut Window, location: Location) {
    let at = anchor(window, location).position;
    let at = hit_at(window, at);
    click(window, at, Modifiers::NONE);
}

/// The last points of two sections of different neurites, seen apart from others.
fn ends(window: &mut Window) -> [Location; 2] {
    let source = state(window).source_of(0).expect("open").clone();
    let morphology = &source.morphology;
    let children = shape::child_counts(morphology);
    let neurites = shape::neurites(morphology);
    let end_of = |neurite: u32| {
        let sections = (0..morphology.sections.len()).filter(|&s| neurites[s] == neurite);
        let section = sections
            .clone()
            .find(|&s| children[s] == 0)
            .expect("an end");
        Location::of_point(morphology.sections[section].end - 1)
    };
    [end_of(0), end_of(1)]
}

/// The thickest fork of two branches.
fn fork(window: &mut Window) -> Location {
    let source = state(window).source_of(0).expect("open").clone();
    let morphology = &source.morphology;
    let children = shape::child_counts(morphology);
    let forks = (0..children.len()).filter(|&s| children[s] == 2);
    let last = |s: usize| Location::of_point(morphology.sections[s].end - 1);
    let thick = |s: &usize| last(*s).radius(morphology);
    let thickest = forks.max_by(|a, b| thick(a).total_cmp(&thick(b)));
    last(thickest.expect("a fork"))
}

#[neurotess_testing::test(needs(gpu))]
fn two_clicks_are_a_distance_with_its_path() {
    let mut window = with_samples(&[Kind::Star]);
    let [from, to] = ends(&mut window);
    window.key_press(Key::M);
    window.step();
    settle(&mut window);
    assert!(state(&mut window).tools.measuring.is_some());
    click_at(&mut window, from);
    let selected = state(&mut window).document.selected().count();
    assert_eq!(selected, 0, "clicks measure only");
    assert!(
        state(&mut window)
            .tools
            .measuring
            .expect("on")
            .first
            .is_some()
    );
    click_at(&mut window, to);
    let dimensions = state(&mut window).document.dimensions.to_vec();
    let [Dimension::Distance { from: a, to: b }] = dimensions[..] else {
        panic!("{dimensions:?}");
    };
    let source = state(&mut window).source_of(0).expect("open").clone();
    let path = Path::between(&source.morphology, from, to).expect("one soma");
    // The cursor is within a pixel of the ends.
    let pixel = 2.0;
    assert!(a.position.distance(anchor(&mut window, from).position) < pixel);
    assert!(b.position.distance(anchor(&mut window, to).position) < pixel);
    let shown = Path::between(&source.morphology, a.location, b.location).expect("one soma");
    assert!((shown.length - path.length).abs() < 2.0 * pixel);
    window.get_by_label("Dimensions");
    // Undone, done again, removed.
    run(&mut window, Command::Undo);
    assert!(state(&mut window).document.dimensions.is_empty());
    run(&mut window, Command::Redo);
    assert_eq!(state(&mut window).document.dimensions.to_vec(), dimensions);
    window.get_by_label("Delete").click();
    window.step();
    settle(&mut window);
    assert!(state(&mut window).document.dimensions.is_empty());
    // Escape forgets the first place, then leaves the tool; the next one clears the selection.
    run(&mut window, Edit::SelectAll);
    click_at(&mut window, from);
    let tools = [(); 3].map(|()| {
        let tool = state(&mut window).tools.measuring;
        window.key_press(Key::Escape);
        window.step();
        settle(&mut window);
        tool.map(|tool| tool.first.is_some())
    });
    assert_eq!(tools, [Some(true), Some(false), None]);
    assert_eq!(state(&mut window).document.selected().count(), 0);
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn one_place_twice_is_a_diameter_or_an_angle() {
    let mut window = with_samples(&[Kind::Pyramidal]);
    let fork = fork(&mut window);
    let at = anchor(&mut window, fork).position;
    let close = state(&mut window).view.focused((at, 12.0));
    run(&mut window, Command::Go(close));
    run(&mut window, Command::SetMeasuring(true));
    click_at(&mut window, fork);
    click_at(&mut window, fork);
    // Halfway along the longest section, far from forks.
    let source = state(&mut window).source_of(0).expect("open").clone();
    let lengths = shape::section_lengths(&source.morphology).into_iter();
    let longest = lengths.enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
    let section = source.morphology.sections[longest.expect("sections").0];
    let link = Location::Neurite {
        point: section.first.midpoint(section.end),
        fraction: 0.4,
    };
    let at = anchor(&mut window, link).position;
    let close = state(&mut window).view.focused((at, 6.0));
    run(&mut window, Command::Go(close));
    click_at(&mut window, link);
    click_at(&mut window, link);
    let dimensions = state(&mut window).document.dimensions.to_vec();
    assert!(
        matches!(
            dimensions[..],
            [Dimension::Angle { .. }, Dimension::Diameter { .. }]
        ),
        "{dimensions:?}"
    );
    let figures = state(&mut window).figures();
    let labels = figures
        .iter()
        .map(|f| f.as_ref().expect("there").label.join(" "));
    let labels: Vec<String> = labels.collect();
    assert!(
        labels[0].contains('°') && labels[1].starts_with("Ø "),
        "{labels:?}"
    );
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn dimensions_look_as_they_should() {
    let mut window = with_samples(&[Kind::Pyramidal]);
    let [from, to] = ends(&mut window);
    let fork = fork(&mut window);
    let [from, to, fork] = [from, to, fork].map(|l| anchor(&mut window, l));
    let soma = anchor(&mut window, Location::Soma(0));
    run(
        &mut window,
        Edit::AddDimension(Dimension::Distance { from, to }),
    );
    run(
        &mut window,
        Edit::AddDimension(Dimension::Angle { at: fork }),
    );
    run(
        &mut window,
        Edit::AddDimension(Dimension::Diameter { at: soma }),
    );
    run(&mut window, Command::SetMeasuring(true));
    snapshot(&mut window, "measuring");
    // Near the fork, with the cursor on it and a distance under way.
    let close = state(&mut window).view.focused((fork.position, 30.0));
    run(&mut window, Command::Go(close));
    set_look(&mut window, |look| look.background = [18, 20, 26]);
    rest(&mut window);
    let beside = hit_at_offset(&mut window, soma.position);
    click(&mut window, beside, Modifiers::NONE);
    let at = hit_at(&mut window, fork.position);
    window.event(Event::PointerMoved(at));
    window.run_steps(4);
    settle(&mut window);
    snapshot(&mut window, "measuring_near");
}

/// Where the picture shows a position, or what lies in that direction at its border.
fn hit_at_offset(window: &mut Window, position: DVec3) -> Pos2 {
    let rect = picture(window).shrink(40.0);
    rect.clamp(hit_at(window, position))
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn the_clipboard_gets_numbers() {
    let mut window = with_samples(&[Kind::Star]);
    let ends = ends(&mut window);
    let [from, to] = ends.map(|end| anchor(&mut window, end));
    run(
        &mut window,
        Edit::AddDimension(Dimension::Distance { from, to }),
    );
    run(
        &mut window,
        Edit::AddDimension(Dimension::Diameter { at: from }),
    );
    run(&mut window, Command::Show(Tab::Inspect));
    let copied = |window: &mut Window| {
        window.step();
        let commands = window.output().platform_output.commands.clone();
        let text = commands.into_iter().find_map(|command| match command {
            OutputCommand::CopyText(text) => Some(text),
            _ => None,
        });
        text.expect("copied")
    };
    state(&mut window).run(Command::CopyDimensions(Some(1)));
    let diameter: f64 = copied(&mut window).parse().expect("one number");
    let source = state(&mut window).source_of(0).expect("open").clone();
    assert!((diameter - 2.0 * ends[0].radius(&source.morphology)).abs() < 1e-3);
    state(&mut window).run(Command::CopyDimensions(None));
    let table = copied(&mut window);
    let rows: Vec<Vec<&str>> = table.lines().map(|l| l.split('\t').collect()).collect();
    assert_eq!(rows.len(), 3);
    assert!(rows.iter().all(|row| row.len() == rows[0].len()), "{table}");
    let path = Path::between(&source.morphology, ends[0], ends[1]).expect("one soma");
    let column = rows[0].iter().position(|name| *name == "path_um");
    let length: f64 = rows[1][column.expect("a column")]
        .parse()
        .expect("a number");
    assert!((length - path.length).abs() < 1e-3);
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn dimensions_go_with_neurons_sessions_and_saved_pictures() {
    let mut window = with_samples(&[Kind::Star, Kind::Granule]);
    let granule = state(&mut window).source_of(1).expect("open").clone();
    let location = Location::Soma(0);
    let at = Anchor::new(1, location, &granule.morphology).expect("a soma");
    let star = anchor(&mut window, location);
    let between = Dimension::Distance { from: star, to: at };
    run(&mut window, Edit::AddDimension(between));
    run(&mut window, Edit::AddDimension(Dimension::Diameter { at }));
    let folder = tempfile::tempdir().expect("a folder");
    let picture = |window: &mut Window, name: &str| {
        let out = folder.path().join(name);
        let options = PictureFile {
            out: out.clone(),
            size: [300, 240],
            samples: 1,
            transparent: false,
            replace: true,
            recipe: true,
        };
        run(window, Command::SavePicture(options));
        fs::read(out).expect("saved")
    };
    let with = picture(&mut window, "with.png");
    // Hidden, removed, brought back.
    run(&mut window, Edit::SetHidden(1, true));
    assert!(state(&mut window).figures().iter().all(Option::is_some));
    run(&mut window, Edit::SetHidden(1, false));
    run(&mut window, Edit::Select(vec![0], false));
    run(&mut window, Edit::Remove);
    let left = state(&mut window).document.dimensions.to_vec();
    let moved = Dimension::Diameter {
        at: Anchor { neuron: 0, ..at },
    };
    assert_eq!(left, [moved]);
    assert!(state(&mut window).figures()[0].is_some());
    run(&mut window, Command::Undo);
    assert_eq!(state(&mut window).document.dimensions.len(), 2);
    let file = folder.path().join("kept.neurotess");
    run(&mut window, Command::SaveSession(file.clone()));
    run(&mut window, Edit::ClearDimensions);
    assert_ne!(picture(&mut window, "without.png"), with);

    let mut other = crate::common::window();
    other.step();
    run(&mut other, Command::Open(vec![file.clone()]));
    let back = state(&mut other).document.dimensions.to_vec();
    assert_eq!(back, [between, Dimension::Diameter { at }]);
    assert!(state(&mut other).figures().iter().all(Option::is_some));
    assert!(state(&mut other).messages.problems.is_empty());
    // A tracing that is another one at that place: the dimension is not there, and says so.
    let text = fs::read_to_string(&file).expect("saved");
    let granule = text.replace("sample:star", "sample:motor");
    fs::write(&file, granule).expect("written");
    let mut changed = crate::common::window();
    changed.step();
    run(&mut changed, Command::Open(vec![file]));
    assert_eq!(state(&mut changed).document.dimensions.len(), 2);
    assert!(viewer(&mut changed).fatal.is_none());
}
