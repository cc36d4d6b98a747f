//! Keys and mouse in frames that are slow: all events of one frame at once.

use std::cell::RefCell;
use std::rc::Rc;

use eframe::egui::accesskit::Role;
use eframe::egui::{Event, Key, Modifiers, PointerButton, Pos2, Rect, Vec2};
use egui_kittest::kittest::Queryable;
use neurotess::synth::Kind;
use neurotess_viewer::Command;
use neurotess_viewer::command::{Edit, Tab, Toggles, listed};
use neurotess_viewer::state::Dialog;

use crate::common::{SMALL, Window, gpu, run, samples_in, settle, state, window_of, with_samples};

/// One frame that brings all of these, and those after it, each of half a second.
fn slow_frame(window: &mut Window, events: Vec<Event>) {
    window.input_mut().events.extend(events);
    for _ in 0..12 {
        let time = window.ctx.input(|input| input.time) + 0.5;
        window.input_mut().time = Some(time);
        window.step();
    }
    settle(window);
}

fn key(key: Key, modifiers: Modifiers) -> [Event; 2] {
    [true, false].map(|pressed| Event::Key {
        key,
        physical_key: None,
        pressed,
        repeat: false,
        modifiers,
    })
}

fn button(pos: Pos2, button: PointerButton, pressed: bool) -> Event {
    Event::PointerButton {
        pos,
        button,
        pressed,
        modifiers: Modifiers::NONE,
    }
}

fn typed(text: &str) -> impl Iterator<Item = Event> {
    text.chars().flat_map(|c| {
        let name = c.to_uppercase().to_string();
        let pressed = Key::from_name(&name).map(|k| key(k, Modifiers::NONE));
        let [down, up] = pressed.map_or([None, None], |both| both.map(Some));
        [down, Some(Event::Text(c.to_string())), up]
            .into_iter()
            .flatten()
    })
}

/// The commands that run from now on.
fn heard(window: &mut Window) -> Rc<RefCell<Vec<Command>>> {
    let list: Rc<RefCell<Vec<Command>>> = Rc::default();
    let ours = Rc::clone(&list);
    let slot = window.state_mut();
    *slot = slot.take().map(|viewer| {
        viewer.with_listener(Box::new(move |command| {
            ours.borrow_mut().push(command.clone());
        }))
    });
    list
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn every_shortcut_runs_its_command_and_nothing_else() {
    let mut window = with_samples(&[Kind::Star]);
    let list = heard(&mut window);
    for (_, items) in listed(&Toggles::default()) {
        for item in items {
            // On the turntable nothing comes to rest, which the next line waits for.
            let turns = Command::SetPresenting(true) == item.command
                || Command::SetTurning(true) == item.command;
            let skipped = turns || item.command == Command::Quit;
            let (Some(keys), false) = (item.keys, skipped) else {
                continue;
            };
            let toggles = state(&mut window).toggles();
            let now = listed(&toggles).into_iter().flat_map(|(_, items)| items);
            let now = now
                .into_iter()
                .find(|i| i.keys == Some(keys))
                .expect("listed");
            slow_frame(&mut window, key(keys.logical_key, keys.modifiers).to_vec());
            let ran = std::mem::take(&mut *list.borrow_mut());
            assert_eq!(ran, [now.command], "{keys:?}");
            if !matches!(state(&mut window).layout.dialog, Dialog::Nothing) {
                slow_frame(&mut window, key(Key::Escape, Modifiers::NONE).to_vec());
                assert!(
                    matches!(state(&mut window).layout.dialog, Dialog::Nothing),
                    "{keys:?}"
                );
                assert!(list.borrow().is_empty(), "escape closes, and nothing else");
            }
        }
    }
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn tab_hides_the_panels_and_the_keys_after_it_are_heard() {
    let mut window = with_samples(&[Kind::Star]);
    let list = heard(&mut window);
    let keys = [Key::Tab, Key::Num2, Key::Tab, Key::G];
    let events = keys.into_iter().flat_map(|k| key(k, Modifiers::NONE));
    slow_frame(&mut window, events.collect());
    assert_eq!(list.borrow().len(), keys.len(), "{:?}", list.borrow());
    assert!(state(&mut window).layout.panels && state(&mut window).document.grid);
    assert_eq!(window.ctx.memory(egui::Memory::focused), None);
}

#[neurotess_testing::test(needs(gpu))]
fn what_is_typed_after_a_dialogs_keys_goes_to_the_dialog() {
    let mut window = with_samples(&[Kind::Star]);
    let list = heard(&mut window);
    let before = state(&mut window).document.clone();
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("hidden_by_keys.swc");
    let mut events = key(Key::O, Modifiers::COMMAND).to_vec();
    events.extend(typed(&path.display().to_string()));
    slow_frame(&mut window, events);
    assert_eq!(list.borrow().len(), 1, "{:?}", list.borrow());
    assert_eq!(state(&mut window).document, before);
    let line = window.get_by_role(Role::TextInput);
    assert_eq!(line.value().as_deref(), path.to_str());
    slow_frame(&mut window, key(Key::Escape, Modifiers::NONE).to_vec());
    // The list of commands: words and Enter at once.
    list.borrow_mut().clear();
    let mut events = key(Key::P, Modifiers::COMMAND).to_vec();
    events.extend(typed("soma editor"));
    events.extend(key(Key::Enter, Modifiers::NONE));
    events.extend(key(Key::Num3, Modifiers::NONE));
    slow_frame(&mut window, events);
    let ran = list.borrow().clone();
    assert_eq!(ran[1], Command::Show(Tab::Soma), "{ran:?}");
    assert!(
        matches!(ran[..], [Command::TogglePalette, _, Command::Look(_)]),
        "{ran:?}"
    );
}

#[neurotess_testing::test(needs(gpu))]
fn drags_and_clicks_count_however_slow_the_frame() {
    let mut window = with_samples(&[Kind::Star]);
    let at = Pos2::new(500.0, 350.0);
    let to = at + Vec2::new(80.0, 30.0);
    // Slowly: a frame for each event.
    let begun = state(&mut window).view;
    let drag = |which: PointerButton| {
        vec![
            Event::PointerMoved(at),
            button(at, which, true),
            Event::PointerMoved(at.lerp(to, 0.5)),
            Event::PointerMoved(to),
            button(to, which, false),
        ]
    };
    for which in [PointerButton::Primary, PointerButton::Middle] {
        state(&mut window).view = begun;
        slow_frame(&mut window, drag(which));
        let one = state(&mut window).view;
        assert_ne!(one, begun, "{which:?}");
    }
    // A slider.
    run(&mut window, Command::Show(Tab::Soma));
    let rail: Rect = {
        let mut sliders = window.get_all_by_role(Role::Slider);
        sliders.next().expect("a slider").rect()
    };
    let ends =
        [0.2, 0.8].map(|share| rail.min + Vec2::new(share * rail.width(), rail.height() / 2.0));
    slow_frame(
        &mut window,
        vec![
            Event::PointerMoved(ends[0]),
            button(ends[0], PointerButton::Primary, true),
            Event::PointerMoved(ends[1]),
            button(ends[1], PointerButton::Primary, false),
        ],
    );
    let source = state(&mut window).document.neurons[0].source;
    let poisson = state(&mut window).document.soma(source).poisson;
    assert!(poisson > 0.35, "{poisson}");
    assert_eq!(state(&mut window).history.names()[0], Some("Soma"));
    // A double click focuses.
    let before = state(&mut window).view;
    let list = heard(&mut window);
    let soma = soma_at(&mut window);
    let mut twice = vec![Event::PointerMoved(soma)];
    for _ in 0..2 {
        twice.push(button(soma, PointerButton::Primary, true));
        twice.push(button(soma, PointerButton::Primary, false));
    }
    slow_frame(&mut window, twice);
    let goes = |c: &Command| matches!(c, Command::Go(_));
    assert!(list.borrow().iter().any(goes), "{:?}", list.borrow());
    assert_ne!(state(&mut window).view, before);
}

/// Where the middle of the picture shows the soma.
fn soma_at(window: &mut Window) -> Pos2 {
    let rect = window.get_by_role(Role::Canvas).rect();
    let size = [rect.width(), rect.height()].map(|n| n as u32);
    let pixel = state(window)
        .view
        .camera()
        .pixel_of(glam::DVec3::ZERO, size);
    let [x, y] = pixel.expect("in front");
    rect.min + Vec2::new(x as f32, y as f32)
}

#[neurotess_testing::test(needs(gpu))]
fn all_clicks_that_wait_are_answered_in_one_frame() {
    let mut window = samples_in(window_of(SMALL), &[Kind::Star]);
    let soma = soma_at(&mut window);
    let beside = window.get_by_role(Role::Canvas).rect().right_bottom() - Vec2::splat(60.0);
    let clicks = [soma, beside, soma, beside, soma];
    let events = clicks.into_iter().flat_map(|at| {
        let pressed = |pressed| button(at, PointerButton::Primary, pressed);
        [Event::PointerMoved(at), pressed(true), pressed(false)]
    });
    let events: Vec<Event> = events.collect();
    window.input_mut().events.extend(events);
    let time = window.ctx.input(|input| input.time) + 4.0;
    window.input_mut().time = Some(time);
    let list = heard(&mut window);
    window.step();
    let selects = |c: &&Command| matches!(c, Command::Edit(Edit::Select(..) | Edit::SelectNone));
    let selections = list.borrow().iter().filter(selects).count();
    assert_eq!(selections, clicks.len(), "{:?}", list.borrow());
    assert_eq!(state(&mut window).document.neurons.selected().to_vec(), [0]);
}
