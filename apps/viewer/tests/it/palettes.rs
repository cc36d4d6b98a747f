//! Colors of one's own in the window: pickers, files, undo, sessions.

use std::fs;

use egui_kittest::kittest::Queryable;
use neurotess::coloring::ColorTarget;
use neurotess::render::color::{Palette, Rgb};
use neurotess::synth::Kind;
use neurotess_viewer::Command;
use neurotess_viewer::command::{FilePurpose, Tab};
use neurotess_viewer::document::{ColorBy, Look};
use neurotess_viewer::state::Rebuilds;

use crate::common::circuit::with_circuit;
use crate::common::{
    Window, gpu, rest, run, set_look, settle, snapshot, state, viewer, window, with_samples,
};

const ORANGE: Rgb = [255, 136, 0];

fn color_axon(look: &mut Look) {
    look.own_colors.set(ColorTarget::Type(2), ORANGE);
}

/// Colors of the things that show, by name.
fn shown(window: &mut Window) -> Vec<(String, Rgb)> {
    let legend = viewer(window).stage.legend().clone();
    let entries = legend.entries().iter();
    entries.map(|(rgb, name)| (name.clone(), *rgb)).collect()
}

fn has_orange(window: &mut Window) -> bool {
    let picture = window.render().expect("a picture");
    let near = |pixel: &&[u8]| pixel[0] > 200 && (90..180).contains(&pixel[1]) && pixel[2] < 60;
    picture.as_raw().chunks(4).filter(near).count() > 30
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn an_own_color_recolors_the_picture_at_rest() {
    let mut window = with_samples(&[Kind::Pyramidal]);
    rest(&mut window);
    assert!(!has_orange(&mut window));
    let before = state(&mut window).drawing.counters.rebuilds;
    set_look(&mut window, color_axon);
    assert!(viewer(&mut window).stage.is_static() && viewer(&mut window).stage.is_sharp());
    let after = state(&mut window).drawing.counters.rebuilds;
    let colors = after.colors;
    assert!(colors > before.colors);
    assert_eq!(after, Rebuilds { colors, ..before }, "colors only");
    assert!(has_orange(&mut window));
    assert!(shown(&mut window).contains(&("axon".into(), ORANGE)));
    run(&mut window, Command::Undo);
    assert!(!has_orange(&mut window));
    assert!(state(&mut window).document.look.own_colors.is_empty());
    run(&mut window, Command::Redo);
    assert!(has_orange(&mut window));
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn every_thing_has_a_picker_and_can_be_reset() {
    let mut window = with_samples(&[Kind::Pyramidal]);
    run(&mut window, Command::Show(Tab::Look));
    window.run_steps(3);
    for name in ["soma", "axon", "basal dendrite", "apical dendrite"] {
        assert!(window.query_all_by_label(name).count() > 0, "{name}");
    }
    window.get_by_label("These colors differ for the color-blind, too");
    assert!(window.query_by_label("Reset all colors").is_none());
    set_look(&mut window, |look| {
        look.own_colors.set(ColorTarget::Type(2), [208, 66, 72]);
        look.own_colors.set(ColorTarget::Type(3), [72, 146, 62]);
    });
    window.run_steps(3);
    let told = "'axon' and 'basal dendrite' look alike with deuteranopia";
    window.get_by_label(told);
    snapshot(&mut window, "colors");
    let resets = window.query_all_by_label("Reset");
    let [axon, _] = &resets.collect::<Vec<_>>()[..] else {
        panic!("two were chosen");
    };
    axon.click();
    window.run_steps(2);
    settle(&mut window);
    let own = &state(&mut window).document.look.own_colors.types;
    assert_eq!(own.keys().collect::<Vec<_>>(), [&3]);
    window.get_by_label("Reset all colors").click();
    window.run_steps(2);
    settle(&mut window);
    assert!(state(&mut window).document.look.own_colors.is_empty());
    let palette = Palette::default();
    assert!(shown(&mut window).contains(&("axon".into(), palette.of_type(2))));
    // What is dragged in a picker is one edit.
    state(&mut window).history.end_joining();
    let edits = state(&mut window).history.names();
    set_look(&mut window, |look| {
        look.own_colors.set_named("axon", [1, 2, 3]);
    });
    set_look(&mut window, |look| {
        look.own_colors.set_named("axon", [4, 5, 6]);
    });
    run(&mut window, Command::Undo);
    assert!(state(&mut window).document.look.own_colors.is_empty());
    assert_eq!(state(&mut window).history.names()[0], edits[0]);
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn cells_and_kinds_of_a_circuit_have_own_colors() {
    let (mut window, _folder) = with_circuit();
    set_look(&mut window, |look| look.color_by = ColorBy::Neuron);
    let things = viewer(&mut window).stage.legend().entries().to_vec();
    let (_, name) = things.first().expect("a neuron").clone();
    set_look(&mut window, |look| {
        look.own_colors.set_named(&name, ORANGE);
    });
    assert!(shown(&mut window).contains(&(name, ORANGE)));
    assert!(has_orange(&mut window));
    set_look(&mut window, |look| {
        look.color_by = ColorBy::Attribute;
        look.attribute = "population".into();
    });
    let (population, _) = shown(&mut window).first().expect("a population").clone();
    set_look(&mut window, |look| {
        look.own_colors.set_named(&population, [9, 8, 7]);
    });
    assert_eq!(shown(&mut window), [(population, [9, 8, 7])]);
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn palettes_and_sessions_carry_own_colors() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("mine.toml");
    let session = folder.path().join("mine.neurotess");
    let mut window = with_samples(&[Kind::Pyramidal]);
    set_look(&mut window, |look| {
        color_axon(look);
        look.palette = Palette::OkabeIto;
    });
    run(&mut window, Command::SavePalette(file.clone()));
    run(&mut window, Command::SaveSession(session.clone()));
    let text = fs::read_to_string(&file).expect("written");
    assert!(
        text.contains("base = \"okabe-ito\"\n\n[types]\naxon = \"#ff8800\""),
        "{text}"
    );
    let look = state(&mut window).document.look.clone();

    let mut other = with_samples(&[Kind::Pyramidal]);
    run(&mut other, Command::OpenPalette(file.clone()));
    assert_eq!(state(&mut other).document.look, look);
    assert!(has_orange(&mut other));
    run(&mut other, Command::Undo);
    assert!(state(&mut other).document.look.own_colors.is_empty());
    // A broken one loses nothing, and says where.
    fs::write(&file, "[types]\naxon = 3\n").expect("written");
    run(&mut other, Command::OpenPalette(file.clone()));
    assert!(state(&mut other).document.look.own_colors.is_empty());
    let problem = state(&mut other)
        .messages
        .problems
        .pop()
        .expect("a problem");
    assert!(problem.why.starts_with("line 2: "), "{problem:?}");

    let mut other = self::window();
    other.step();
    run(&mut other, Command::Open(vec![session]));
    assert_eq!(state(&mut other).document.look, look);

    // Whether an existing file may be replaced is asked.
    state(&mut window).settings.folder = folder.path().to_path_buf();
    fs::rename(&file, folder.path().join("palette.toml")).expect("renamed");
    run(&mut window, Command::AskFiles(FilePurpose::SavePalette));
    window.run_steps(3);
    window.get_by_label("palette.toml");
    let save = window.query_all_by_label("Save").last();
    save.expect("the dialog's, above the tab").click();
    window.run_steps(3);
    window.get_by_label("This file exists");
}
