//! Clamped neurons: fine in both modes, also while the camera moves.

use eframe::egui::Key;
use neurotess::render::color::ColorMap;
use neurotess::synth::Kind;
use neurotess_viewer::Command;
use neurotess_viewer::command::Edit;
use neurotess_viewer::document::{ColorBy, RestChoice};

use crate::common::{
    Window, differing, drawn, gpu, rest, run, set_look, settle, state, viewer, wait, with_samples,
};

/// Two cells, whose pictures at rest are drawn within a budget.
fn explored() -> Window {
    let mut window = with_samples(&[Kind::Motor, Kind::Granule]);
    run(&mut window, Edit::SetGrid(true));
    run(&mut window, Command::Home);
    set_look(&mut window, |look| {
        (look.axes, look.scale_bar, look.legend) = (false, false, false);
    });
    at_rest(&mut window, RestChoice::Budget);
    window
}

fn at_rest(window: &mut Window, choice: RestChoice) {
    let mut detail = state(window).document.detail;
    detail.at_rest = choice;
    run(window, Edit::SetDetail(detail));
}

fn clamp_all(window: &mut Window) {
    run(window, Edit::SelectAll);
    run(window, Edit::Clamp(true));
    run(window, Edit::SelectNone);
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn clamped_neurons_are_as_in_a_full_picture_whatever_is_explored() {
    let mut window = explored();
    let reduced = drawn(&mut window);
    assert!(state(&mut window).drawing.counters.lowered.is_some());
    clamp_all(&mut window);
    assert_eq!(state(&mut window).drawing.counters.clamped, [2, 2]);
    assert!(
        state(&mut window).drawing.counters.lowered.is_some(),
        "it is explored still"
    );
    let clamped = drawn(&mut window);
    at_rest(&mut window, RestChoice::Full);
    assert!(state(&mut window).drawing.counters.lowered.is_none());
    let full = drawn(&mut window);
    assert!(
        differing(&reduced, &full) > 500,
        "{}",
        differing(&reduced, &full)
    );
    assert!(
        differing(&clamped, &full) <= 3,
        "{}",
        differing(&clamped, &full)
    );
    // One of them, and the other within the budget.
    at_rest(&mut window, RestChoice::Budget);
    run(&mut window, Edit::UnclampAll);
    run(&mut window, Edit::Select(vec![0], false));
    run(&mut window, Edit::Clamp(true));
    run(&mut window, Edit::SelectNone);
    assert_eq!(state(&mut window).drawing.counters.clamped, [1, 1]);
    let one = drawn(&mut window);
    let [from_reduced, from_full] = [&reduced, &full].map(|other| differing(&one, other));
    assert!(
        from_reduced > 100 && from_full > 100,
        "{from_reduced} {from_full}"
    );
    assert!(from_full < differing(&reduced, &full));
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn clamped_neurons_are_recolored_and_picked_like_the_others() {
    let mut window = explored();
    clamp_all(&mut window);
    rest(&mut window);
    assert!(viewer(&mut window).stage.can_pick());
    set_look(&mut window, |look| look.color_by = ColorBy::PathDistance);
    rest(&mut window);
    let rebuilds = state(&mut window).drawing.counters.rebuilds;
    set_look(&mut window, |look| look.color_map = ColorMap::Plasma);
    assert!(viewer(&mut window).stage.is_static());
    assert_eq!(
        state(&mut window).drawing.counters.rebuilds.templates,
        rebuilds.templates
    );
    let recolored = drawn(&mut window);
    at_rest(&mut window, RestChoice::Full);
    let full = drawn(&mut window);
    let differ = differing(&recolored, &full);
    assert!(differ <= 50, "{differ}");
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn while_the_camera_moves_clamped_neurons_stay_fine() {
    let mut window = explored();
    set_look(&mut window, |look| look.occlusion = false);
    // Close to a soma, where tubes of a draft are polygons.
    let soma = state(&mut window).middle_of(0).expect("a soma");
    let view = state(&mut window).view.focused((soma, 40.0));
    let turned = view.orbited(0.3, 0.1, glam::DVec3::Y);
    let draft = |window: &mut Window| {
        run(window, Command::Go(view));
        state(window).run(Command::Go(turned));
        wait(window, |w| !viewer(w).stage.is_sharp());
        let shown = drawn(window);
        settle(window);
        shown
    };
    let coarse = draft(&mut window);
    clamp_all(&mut window);
    let fine = draft(&mut window);
    let rests = drawn(&mut window);
    // A draft has a quarter of the samples, so its edges differ from those of the picture at rest.
    let [coarse, fine] = [&coarse, &fine].map(|draft| far(draft, &rests));
    assert!(coarse > 2 * fine, "{coarse} {fine}");
}

/// Number of pixels of two pictures that differ by more than a quarter.
fn far(a: &[u8], b: &[u8]) -> usize {
    let far = |(a, b): &(&[u8], &[u8])| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 64);
    a.chunks(4).zip(b.chunks(4)).filter(far).count()
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn clamping_has_a_key_is_undone_and_kept_in_sessions() {
    let mut window = with_samples(&[Kind::Granule, Kind::Granule]);
    run(&mut window, Edit::Select(vec![1], false));
    window.key_press(Key::C);
    settle(&mut window);
    assert_eq!(state(&mut window).document.neurons.clamped().to_vec(), [1]);
    window.key_press(Key::C);
    settle(&mut window);
    assert!(state(&mut window).document.neurons.clamped().is_empty());
    run(&mut window, Command::Undo);
    assert_eq!(state(&mut window).document.neurons.clamped().to_vec(), [1]);
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("kept.neurotess");
    run(&mut window, Command::SaveSession(file.clone()));
    let mut other = with_samples(&[]);
    run(&mut other, Command::Open(vec![file]));
    assert_eq!(state(&mut other).document.neurons.clamped().to_vec(), [1]);
}
