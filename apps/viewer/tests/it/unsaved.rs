//! What is not saved is neither lost by a key nor by a crash.

use std::path::Path;
use std::time::Duration;

use eframe::egui::{Event, Key, Modifiers, ViewportCommand, ViewportEvent, ViewportId};
use egui_kittest::kittest::Queryable;
use neurotess::synth::Kind;
use neurotess_viewer::Command;
use neurotess_viewer::command::Edit;
use neurotess_viewer::state::Dialog;

use crate::common::{
    SMALL, Window, gpu, run, run_undrawn, state, undrawn, viewer, wait, window, window_of,
};

/// What the last frame asked the desktop for.
fn asked(window: &Window) -> Vec<ViewportCommand> {
    let viewports = window.output().viewport_output.values();
    viewports.flat_map(|v| v.commands.clone()).collect()
}

fn root_events(window: &mut Window) -> &mut Vec<ViewportEvent> {
    let root = window.input_mut().viewports.entry(ViewportId::ROOT);
    &mut root.or_default().events
}

fn presses_ctrl_q(window: &mut Window) {
    for pressed in [true, false] {
        window.event(Event::Key {
            key: Key::Q,
            physical_key: None,
            pressed,
            repeat: false,
            modifiers: Modifiers::COMMAND,
        });
    }
    window.step();
}

/// A window that keeps what is not saved in a folder.
fn keeping(window: &mut Window, folder: &Path, every: Duration) {
    let slot = window.state_mut();
    *slot = slot
        .take()
        .map(|viewer| viewer.with_autosave(folder, every));
}

#[neurotess_testing::test(needs(gpu))]
fn closing_asks_while_there_are_unsaved_edits() {
    let mut window = window();
    window.step();
    run(&mut window, Edit::SetGrid(true));
    presses_ctrl_q(&mut window);
    assert!(!asked(&window).contains(&ViewportCommand::Close));
    assert!(matches!(
        state(&mut window).layout.dialog,
        Dialog::Unsaved(_)
    ));
    window.run_steps(8);
    window.get_by_label("Cancel").click();
    window.run_steps(3);
    assert!(matches!(state(&mut window).layout.dialog, Dialog::Nothing));
    // The window's button.
    root_events(&mut window).push(ViewportEvent::Close);
    window.step();
    assert!(asked(&window).contains(&ViewportCommand::CancelClose));
    root_events(&mut window).clear();
    window.run_steps(8);
    window.get_by_label("Quit without saving").click();
    let closes = (0..4).any(|_| {
        window.step();
        asked(&window).contains(&ViewportCommand::Close)
    });
    assert!(closes);
}

#[neurotess_testing::test(needs(gpu))]
fn a_question_has_the_keyboard_and_nothing_behind_it_can_be_reached() {
    let mut window = window();
    window.step();
    run(&mut window, Edit::SetGrid(true));
    let asks = |window: &mut Window| matches!(state(window).layout.dialog, Dialog::Unsaved(_));
    for tabs in 0..3 {
        presses_ctrl_q(&mut window);
        window.run_steps(8);
        assert!(asks(&mut window));
        // Round the answers: three of them.
        for _ in 0..3 * tabs {
            window.key_press(Key::Tab);
            window.run_steps(4);
        }
        window.key_press(Key::Enter);
        window.run_steps(4);
        assert!(!asks(&mut window), "{tabs}");
        assert!(!asked(&window).contains(&ViewportCommand::Close));
        assert_eq!(
            state(&mut window).document.neurons.len(),
            0,
            "no menu was opened"
        );
    }
    presses_ctrl_q(&mut window);
    window.run_steps(8);
    window.key_press(Key::Escape);
    window.run_steps(4);
    assert!(!asks(&mut window));
}

#[neurotess_testing::test(needs(gpu))]
fn a_saved_session_closes_at_once() {
    let mut window = window();
    window.step();
    run(&mut window, Edit::SetGrid(true));
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("s.neurotess");
    run(&mut window, Command::SaveSession(file));
    presses_ctrl_q(&mut window);
    assert!(asked(&window).contains(&ViewportCommand::Close));
}

#[neurotess_testing::test(needs(gpu))]
fn edits_are_kept_and_offered_by_the_next_window() {
    let folder = tempfile::tempdir().expect("a folder");
    let kept = folder.path().join("unsaved-0.neurotess");
    let mut first = undrawn(&[Kind::Star]);
    keeping(&mut first, folder.path(), Duration::ZERO);
    first.step();
    assert!(!kept.exists(), "nothing was edited yet");
    run_undrawn(&mut first, Edit::SetGrid(true));
    assert!(kept.exists());
    // It ends without asking.
    drop(first);
    let mut next = window_of(SMALL);
    next.step();
    keeping(&mut next, folder.path(), Duration::ZERO);
    next.run_steps(8);
    assert!(matches!(state(&mut next).layout.dialog, Dialog::Recover(_)));
    next.get_by_label("Open it").click();
    wait(&mut next, |w| state(w).document.neurons.len() == 1);
    next.step();
    assert!(state(&mut next).document.grid && state(&mut next).document.neurons.len() == 1);
    assert!(state(&mut next).session.is_none() && state(&mut next).changes.unsaved());
    // Left by its user, it leaves nothing.
    viewer(&mut next).leave();
    assert!(!kept.exists());
}
