//! What the window shows, with pictures of its panels.

use eframe::egui::{Event, Key, Modifiers, Pos2};
use egui_kittest::kittest::Queryable;
use neurotess::synth::Kind;
use neurotess_viewer::Command;
use neurotess_viewer::command::{Edit, FilePurpose, Tab};
use neurotess_viewer::state::CellPart;

use crate::common::{
    Window, click, gpu, hit_at, rest, run, settle, snapshot, state, window, with_samples,
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
        .pointing
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

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
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
    assert!(!state(&mut window).document.neurons.shows(1));
    window.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    window.step();
    settle(&mut window);
    assert!(state(&mut window).document.neurons.shows(1));
}
