//! Two views side by side.

use eframe::egui::accesskit::Role;
use eframe::egui::{Event, Modifiers, PointerButton, Pos2, Rect, Vec2};
use egui_kittest::kittest::Queryable;
use neurotess::synth::Kind;
use neurotess_viewer::Command;
use neurotess_viewer::command::Edit;
use neurotess_viewer::view::View;

use crate::common::{Window, gpu, run, settle, snapshot, state, viewer, with_samples};

/// The pictures, from left to right.
fn pictures(window: &Window) -> Vec<Rect> {
    let mut all: Vec<Rect> = window
        .query_all_by_role(Role::Canvas)
        .map(|picture| picture.rect())
        .collect();
    all.sort_by(|a, b| a.left().total_cmp(&b.left()));
    all
}

/// The left view and the right one.
fn views(window: &mut Window) -> [View; 2] {
    let state = state(window);
    let split = state.views.split.expect("two views");
    match split.right {
        true => [split.view, state.view],
        false => [state.view, split.view],
    }
}

fn drag(window: &mut Window, from: Pos2, way: Vec2) {
    let button = |pos: Pos2, pressed: bool| Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    for event in [
        Event::PointerMoved(from),
        button(from, true),
        Event::PointerMoved(from + way * 0.5),
        Event::PointerMoved(from + way),
        button(from + way, false),
    ] {
        window.event(event);
        window.step();
    }
    settle(window);
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn each_view_moves_by_itself_and_linked_ones_together() {
    let mut window = with_samples(&[Kind::Pyramidal]);
    let [whole] = pictures(&window)[..] else {
        panic!("one picture");
    };
    run(&mut window, Command::SetSplit(true));
    let [left, right] = pictures(&window)[..] else {
        panic!("two pictures");
    };
    assert!(left.right() < right.left() && left.width() < 0.51 * whole.width());
    assert!((left.width() - right.width()).abs() < 1.5);
    let before = views(&mut window);
    let angle = |[a, b]: [View; 2]| a.camera().axes()[2].dot(b.camera().axes()[2]);
    assert!(
        angle(before).abs() < 1e-6,
        "one is from the side of the other"
    );
    snapshot(&mut window, "two_views");
    drag(&mut window, right.center(), Vec2::new(60.0, 10.0));
    let after = views(&mut window);
    assert!(before[0] == after[0] && before[1] != after[1]);
    assert!(
        state(&mut window).views.split.expect("two").right,
        "clicked last"
    );
    // A click selects in either.
    let soma = state(&mut window).middle_of(0).expect("a soma");
    let size = [right.width(), right.height()].map(|n| n.round() as u32);
    let [x, y] = after[1].camera().pixel_of(soma, size).expect("in front");
    let at = right.min + Vec2::new(x as f32, y as f32);
    crate::common::click(&mut window, at, Modifiers::NONE);
    assert_eq!(state(&mut window).document.neurons.selected().to_vec(), [0]);
    run(&mut window, Edit::SelectNone);
    // Linked, the angle between them stays.
    run(&mut window, Command::SetLinked(true));
    let before = views(&mut window);
    drag(
        &mut window,
        left.center() + Vec2::new(0.0, 200.0),
        Vec2::new(-50.0, 0.0),
    );
    let after = views(&mut window);
    assert!(before[0] != after[0] && before[1] != after[1]);
    assert!((angle(before) - angle(after)).abs() < 1e-6);
    // Keys are for the one that was clicked last.
    assert!(!state(&mut window).views.split.expect("two").right);
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("mine.neurotess");
    run(&mut window, Command::SaveSession(file.clone()));
    let kept = views(&mut window);
    run(&mut window, Command::SetSplit(false));
    assert_eq!(pictures(&window), [whole]);
    assert_eq!(state(&mut window).view, kept[0]);
    let mut other = crate::common::window();
    other.step();
    run(&mut other, Command::Open(vec![file]));
    assert_eq!(views(&mut other), kept);
    assert!(state(&mut other).views.split.expect("two").linked);
    assert!(viewer(&mut other).fatal.is_none() && state(&mut other).messages.problems.is_empty());
}
