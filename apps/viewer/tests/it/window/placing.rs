//! Cells that are selected by a lasso, moved, turned and copied; presentations.

use eframe::egui::accesskit::Role;
use eframe::egui::{Event, Key, Modifiers, PointerButton, Pos2, Vec2};
use egui_kittest::kittest::Queryable;
use glam::DVec3;
use neurotess::render::Placement;
use neurotess::synth::Kind;
use neurotess_viewer::Command;
use neurotess_viewer::command::{Edit, Tab};

use crate::common::{
    Window, differing, drawn, gpu, hit_at, run, settle, snapshot, state, with_samples,
};

/// Presses the left button at the first place, moves over the others, and releases it.
fn drag(window: &mut Window, way: &[Pos2], modifiers: Modifiers) {
    drag_in(window, way, modifiers, true);
}

/// The same; `each`: whether each event comes in a frame of its own instead of all in a slow one.
fn drag_in(window: &mut Window, way: &[Pos2], modifiers: Modifiers, each: bool) {
    let event = |window: &mut Window, event: Event| {
        if each {
            window.event_modifiers(event, modifiers);
            window.step();
        } else {
            // The harness gives each of its own events a frame.
            window.input_mut().events.push(event);
        }
    };
    let button = |pos: Pos2, pressed: bool| Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers,
    };
    let [first, .., last] = way else {
        panic!("a drag has two ends");
    };
    if !each {
        window
            .input_mut()
            .events
            .push(Event::ModifiersChanged(modifiers));
    }
    event(window, Event::PointerMoved(*first));
    event(window, button(*first, true));
    for &at in &way[1..] {
        event(window, Event::PointerMoved(at));
    }
    event(window, button(*last, false));
    window.run_steps(4);
    window.event(Event::ModifiersChanged(Modifiers::NONE));
    settle(window);
}

/// Where the somata are in the window.
fn somata(window: &mut Window) -> Vec<Pos2> {
    let count = state(window).document.neurons.len();
    let places = (0..count).map(|i| state(window).middle_of(i).expect("a soma"));
    let places: Vec<DVec3> = places.collect();
    places.into_iter().map(|at| hit_at(window, at)).collect()
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn a_lasso_goes_around_what_lies_between() {
    let mut window = with_samples(&[Kind::Star, Kind::Granule, Kind::Basket]);
    run(&mut window, Edit::SetGrid(true));
    run(&mut window, Command::Home);
    run(&mut window, Command::SetLasso(true));
    let view = state(&mut window).view;
    let at = somata(&mut window);
    // Two in the upper row, one below the first: around both of the first column, whose box would hold no other,
    // and then around the second and third, past the first.
    let [a, b, c] = at[..] else {
        panic!("three cells")
    };
    let corner = |x: f32, y: f32| Vec2::new(x, y);
    let column = [
        a + corner(-15.0, -15.0),
        a + corner(15.0, -15.0),
        c + corner(15.0, 15.0),
        c + corner(-15.0, 15.0),
    ];
    drag(&mut window, &column, Modifiers::COMMAND);
    assert_eq!(
        state(&mut window).document.neurons.selected().to_vec(),
        [0, 2]
    );
    let diagonal = [
        b + corner(-15.0, -15.0),
        b + corner(15.0, -15.0),
        b + corner(15.0, 15.0),
        c + corner(15.0, 15.0),
        c + corner(-15.0, 15.0),
        c + corner(-15.0, -15.0),
    ];
    // Both paces select the same.
    for each in [true, false] {
        state(&mut window).run(Edit::SelectNone);
        drag_in(&mut window, &column, Modifiers::COMMAND, each);
        let selected = state(&mut window).document.neurons.selected().to_vec();
        assert_eq!(selected, [0, 2], "a frame for each event: {each}");
    }
    drag(&mut window, &diagonal, Modifiers::COMMAND);
    let selected = state(&mut window).document.neurons.selected().to_vec();
    assert_eq!(selected, [1, 2], "a rectangle would have the first, too");
    assert_eq!(state(&mut window).view, view, "the camera stays");
    assert!(
        state(&mut window)
            .messages
            .status
            .contains("2 neurons in the lasso")
    );
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn handles_move_and_turn_copies_and_undo_puts_them_back() {
    let mut window = with_samples(&[Kind::Star]);
    run(&mut window, Edit::Select(vec![0], false));
    run(&mut window, Command::Duplicate);
    run(&mut window, Command::Home);
    run(&mut window, Command::SetPlacing(true));
    let before = state(&mut window).document.neurons[1].placement;
    let pivot = state(&mut window).pivot().expect("handles");
    let view = state(&mut window).view;
    let middle = hit_at(&mut window, pivot);
    // Along x: 60 points of the window.
    let arrow = middle + Vec2::new(80.0, 0.0);
    let half = arrow + Vec2::new(30.0, 4.0);
    drag(
        &mut window,
        &[arrow, half, arrow + Vec2::new(60.0, 0.0)],
        Modifiers::NONE,
    );
    let moved = state(&mut window).document.neurons[1].placement;
    let way = moved.translation - before.translation;
    assert!(
        way.x > 5.0 && way.y.abs() < 1e-9 && way.z.abs() < 1e-9,
        "{way}"
    );
    let now = state(&mut window).pivot().expect("handles");
    let to = hit_at(&mut window, now);
    assert!((to.x - middle.x - 60.0).abs() < 1.5, "{to} {middle}");
    assert_eq!(state(&mut window).view, view, "the camera stays");
    assert_eq!(
        state(&mut window).document.neurons[0].placement,
        Placement::default()
    );
    // About z, which faces the camera: a quarter turn.
    let ring = |angle: f32| to + Vec2::angled(-angle) * 66.0;
    let diagonal = std::f32::consts::FRAC_PI_4;
    drag(
        &mut window,
        &[ring(diagonal), ring(2.0 * diagonal), ring(3.0 * diagonal)],
        Modifiers::NONE,
    );
    let turned = state(&mut window).document.neurons[1].placement;
    let x = turned.rotation * DVec3::X;
    assert!(x.distance(DVec3::Y) < 0.05, "{x}");
    let still = state(&mut window).pivot().expect("handles");
    assert!(still.distance(now) < 1e-6, "its soma stays");
    snapshot(&mut window, "placing");
    // Each drag is one edit.
    run(&mut window, Command::Undo);
    assert_eq!(state(&mut window).document.neurons[1].placement, moved);
    run(&mut window, Command::Undo);
    assert_eq!(state(&mut window).document.neurons[1].placement, before);
    run(&mut window, Command::Undo);
    assert_eq!(state(&mut window).document.neurons.len(), 1);
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn numbers_place_a_cell_and_each_is_one_step_of_undo() {
    let mut window = with_samples(&[Kind::Star]);
    run(&mut window, Edit::Select(vec![0], false));
    run(&mut window, Command::Show(Tab::Inspect));
    // Those of the position come first.
    let type_in = |window: &mut Window, (row, before): (usize, &str), text: &str| {
        let fields: Vec<_> = window.get_all_by_value(before).collect();
        fields[row].click();
        window.run_steps(2);
        window.event(Event::Text(text.into()));
        window.run_steps(2);
        window.key_press(Key::Enter);
        window.run_steps(3);
        settle(window);
    };
    let soma = state(&mut window).middle_of(0).expect("a soma");
    type_in(&mut window, (0, "x 0.0"), "120");
    let moved = state(&mut window).middle_of(0).expect("a soma");
    assert!(moved.distance(soma + DVec3::X * 120.0) < 1e-9, "{moved}");
    type_in(&mut window, (1, "y 0.0"), "120");
    let turned = state(&mut window).document.neurons[0].placement;
    let z = turned.rotation * DVec3::Z;
    let expected = DVec3::new(60.0_f64.to_radians().sin(), 0.0, -0.5);
    assert!(z.distance(expected) < 1e-9, "{z}");
    let still = state(&mut window).middle_of(0).expect("a soma");
    assert!(still.distance(moved) < 1e-9, "{still}");
    let numbers = state(&mut window).place_numbers().expect("numbers");
    assert_eq!(numbers.rotation, DVec3::new(0.0, 120.0, 0.0));
    run(&mut window, Command::Home);
    snapshot(&mut window, "placing_by_numbers");
    // Sessions keep it.
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("mine.neurotess");
    run(&mut window, Command::SaveSession(file.clone()));
    let mut other = crate::common::window();
    other.step();
    run(&mut other, Command::Open(vec![file]));
    let kept = state(&mut other).document.neurons[0].placement;
    assert!(kept.rotation.angle_between(turned.rotation) < 1e-6);
    assert!(kept.translation.distance(turned.translation) < 1e-3);
    run(&mut window, Command::Undo);
    let back = state(&mut window).document.neurons[0].placement;
    assert_eq!(back.rotation, Placement::default().rotation);
    assert!(back.translation.distance(DVec3::X * 120.0) < 1e-9);
    run(&mut window, Command::Undo);
    assert_eq!(
        state(&mut window).document.neurons[0].placement,
        Placement::default()
    );
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn moved_cells_are_kept_in_sessions_and_drawn_there() {
    let mut window = with_samples(&[Kind::Star]);
    let away = Placement {
        rotation: glam::DQuat::from_rotation_z(0.5),
        translation: DVec3::new(30.0, -20.0, 5.0),
        ..Placement::default()
    };
    let before = drawn(&mut window);
    run(&mut window, Edit::Place(vec![(0, away)]));
    assert!(differing(&before, &drawn(&mut window)) > 200);
    run(&mut window, Edit::Select(vec![0], false));
    run(&mut window, Command::Duplicate);
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("mine.neurotess");
    run(&mut window, Command::SaveSession(file.clone()));
    let document = state(&mut window).document.clone();
    let mut other = crate::common::window();
    other.step();
    run(&mut other, Command::Open(vec![file]));
    assert_eq!(state(&mut other).document, document);
    run(&mut other, Edit::SelectAll);
    run(&mut other, Command::PutBack);
    let neurons = &state(&mut other).document.neurons;
    assert!(neurons.iter().all(|n| n.placement == Placement::default()));
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn a_presentation_turns_the_scene_without_panels_until_escape() {
    let mut window = with_samples(&[Kind::Star]);
    run(&mut window, Edit::Select(vec![0], false));
    let view = state(&mut window).view;
    let small = crate::common::picture(&window);
    state(&mut window).run(Command::SetPresenting(true));
    window.step();
    window.step();
    let large = window.get_by_role(Role::Canvas).rect();
    assert!(large.width() > small.width() + 300.0 && large.height() > small.height() + 30.0);
    let first = state(&mut window).view;
    window.step();
    let second = state(&mut window).view;
    assert!(first != view && second != first, "it turns");
    let away = |view: neurotess_viewer::view::View| {
        let camera = view.camera();
        camera.eye().distance(camera.target())
    };
    assert!((away(first) - away(second)).abs() < 1e-6);
    // R stops the turntable, and the presentation stays.
    state(&mut window).run(Command::SetTurning(false));
    settle(&mut window);
    snapshot(&mut window, "presentation");
    window.key_press(Key::Escape);
    window.step();
    settle(&mut window);
    assert!(!state(&mut window).layout.presenting);
    assert_eq!(crate::common::picture(&window), small);
    // Escape has ended the presentation, and not the selection.
    assert_eq!(state(&mut window).document.neurons.selected().to_vec(), [0]);
}
