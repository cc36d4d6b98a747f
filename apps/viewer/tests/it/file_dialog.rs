//! The file dialog, typed into as people do: a letter a frame.

use std::fs;

use eframe::egui::accesskit::Role;
use eframe::egui::{Event, Key, Modifiers};
use egui_kittest::kittest::Queryable;
use neurotess::synth::Kind;
use neurotess_viewer::Command;
use neurotess_viewer::command::FilePurpose;
use neurotess_viewer::state::Dialog;

use crate::common::{Window, gpu, settle, state, window, with_samples};

/// Sends an event in a frame of its own.
fn frame(window: &mut Window, event: Event) {
    window.event(event);
    window.step();
}

fn key(window: &mut Window, key: Key, modifiers: Modifiers) {
    for pressed in [true, false] {
        let event = Event::Key {
            key,
            physical_key: None,
            pressed,
            repeat: false,
            modifiers,
        };
        frame(window, event);
    }
}

/// Types a text as a keyboard does: each letter is a key, too, if there is one.
fn letters(window: &mut Window, text: &str) {
    for c in text.chars() {
        frame(window, Event::Text(c.to_string()));
        if let Some(letter) = Key::from_name(&c.to_uppercase().to_string()) {
            key(window, letter, Modifiers::NONE);
        }
    }
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn a_path_is_typed_to_its_end_whatever_the_list_shows() {
    let mut window = with_samples(&[Kind::Star]);
    let folder = tempfile::tempdir().expect("a folder");
    let deep = folder.path().join("deep");
    fs::create_dir(&deep).expect("made");
    state(&mut window).settings.folder = folder.path().to_path_buf();
    let before = state(&mut window).view;
    key(&mut window, Key::S, Modifiers::COMMAND);
    window.run_steps(6);
    key(&mut window, Key::A, Modifiers::COMMAND);
    // The list is there, is gone at the name that nothing begins like, and so on.
    letters(&mut window, "deep/wasd.v2");
    let line = window.get_by_role(Role::TextInput).value();
    let path = fs::canonicalize(&deep).expect("there").join("wasd.v2");
    assert_eq!(line.as_deref(), path.to_str());
    key(&mut window, Key::Enter, Modifiers::NONE);
    settle(&mut window);
    assert!(deep.join("wasd.v2.neurotess").exists());
    assert_eq!(state(&mut window).view, before, "no letter flew the camera");
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn no_key_reaches_the_scene_while_a_dialog_is_open() {
    let mut window = with_samples(&[Kind::Star]);
    let before = (state(&mut window).view, state(&mut window).document.clone());
    state(&mut window).run(Command::AskFiles(FilePurpose::Open));
    window.run_steps(8);
    // Nothing has the keyboard, as after a click beside the line.
    let focused = window.ctx.memory(egui::Memory::focused);
    let line = focused.expect("the line has the keyboard");
    window.ctx.memory_mut(|memory| memory.surrender_focus(line));
    window.step();
    letters(&mut window, "wasdqhg");
    settle(&mut window);
    let after = (state(&mut window).view, state(&mut window).document.clone());
    assert_eq!(after, before);
    assert!(matches!(state(&mut window).layout.dialog, Dialog::Files(_)));
}

#[neurotess_testing::test(needs(gpu))]
fn a_session_is_not_replaced_unasked() {
    let mut window = window();
    window.step();
    let folder = tempfile::tempdir().expect("a folder");
    state(&mut window).settings.folder = folder.path().to_path_buf();
    let other = folder.path().join("other.neurotess");
    fs::write(&other, "of someone else").expect("written");
    key(&mut window, Key::S, Modifiers::COMMAND);
    window.run_steps(6);
    key(&mut window, Key::A, Modifiers::COMMAND);
    letters(&mut window, "other.neurotess");
    key(&mut window, Key::Enter, Modifiers::NONE);
    window.run_steps(3);
    let kept = || fs::read_to_string(&other).expect("there");
    assert_eq!(kept(), "of someone else");
    assert!(matches!(
        state(&mut window).layout.dialog,
        Dialog::Replace(..)
    ));
    // Another name is to be typed.
    window.get_by_label("Cancel").click();
    window.run_steps(6);
    assert!(matches!(state(&mut window).layout.dialog, Dialog::Files(_)));
    let line = window.get_by_role(Role::TextInput);
    assert!(
        line.value()
            .is_some_and(|typed| typed.ends_with("other.neurotess"))
    );
    key(&mut window, Key::Enter, Modifiers::NONE);
    window.run_steps(3);
    window.get_by_label("Replace").click();
    settle(&mut window);
    assert!(kept().contains("version = 1"), "{}", kept());
    // Its own file now: saved again without a question.
    key(&mut window, Key::S, Modifiers::COMMAND);
    window.run_steps(6);
    key(&mut window, Key::Enter, Modifiers::NONE);
    window.run_steps(3);
    assert!(matches!(state(&mut window).layout.dialog, Dialog::Nothing));
}
