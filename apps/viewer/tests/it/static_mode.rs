//! Static mode: at rest the picture is colored anew, and not drawn anew.

use eframe::egui::Key;
use neurotess::render::Side;
use neurotess::render::color::ColorMap;
use neurotess_viewer::Command;
use neurotess_viewer::command::Edit;
use neurotess_viewer::playback::Pace;

use crate::common::circuit::with_circuit;
use crate::common::{differing, gpu, rest, run, set_look, state, viewer, wait};

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn at_rest_a_recording_recolors_the_fine_picture() {
    let (mut window, folder) = with_circuit();
    let report = folder.path().join("voltage.h5");
    run(&mut window, Edit::SetReport(Some(report)));
    set_look(&mut window, |look| look.axes = false);
    // From elsewhere and back, as in the end: the first picture after a report was chosen differs from
    // later ones of the same view in some 90 pixels, by up to 12 of 255, however they are colored.
    let view = state(&mut window).view.orbited(0.1, 0.0, glam::DVec3::Y);
    let turned = view.orbited(0.3, 0.1, glam::DVec3::Y);
    run(&mut window, Command::Go(turned));
    run(&mut window, Command::Go(view));
    rest(&mut window);
    let rebuilds = state(&mut window).drawing.counters.rebuilds;
    let figures = state(&mut window)
        .drawing
        .counters
        .static_picture
        .expect("made");
    let compartments = figures.compartments.expect("a recording");
    assert!(
        compartments > 0 && compartments <= figures.colors,
        "{figures:?}"
    );
    assert!(figures.bytes > 0);
    // Another time, range and color map, and a selection: on the fine picture, which is not drawn.
    run(&mut window, Command::Seek(9.0));
    assert!(viewer(&mut window).stage.is_static() && viewer(&mut window).stage.is_sharp());
    set_look(&mut window, |look| look.range = Some([-80.0, -20.0]));
    set_look(&mut window, |look| look.color_map = ColorMap::Plasma);
    run(&mut window, Edit::Select(vec![2], false));
    assert!(viewer(&mut window).stage.is_static() && viewer(&mut window).stage.is_sharp());
    let after = state(&mut window).drawing.counters.rebuilds;
    assert_eq!(
        (after.templates, after.instances),
        (rebuilds.templates, rebuilds.instances)
    );
    let recolored = window.render().expect("a picture");
    // The same, drawn: from elsewhere and back.
    run(&mut window, Command::Go(turned));
    run(&mut window, Command::Go(view));
    let drawn = window.render().expect("a picture");
    let differ = differing(recolored.as_raw(), drawn.as_raw());
    assert!(differ <= 60, "{differ} pixels: more than one of 10,000");
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn what_is_played_becomes_fine_when_the_camera_rests() {
    let (mut window, folder) = with_circuit();
    let report = folder.path().join("voltage.h5");
    run(&mut window, Edit::SetReport(Some(report)));
    let pace = Pace {
        loops: true,
        ..state(&mut window).playback.pace
    };
    run(&mut window, Command::SetPace(pace));
    window.key_press(Key::Space);
    wait(&mut window, |w| state(w).playback.playing);
    let turned = state(&mut window).view.orbited(0.3, 0.1, glam::DVec3::Y);
    state(&mut window).run(Command::Go(turned));
    wait(&mut window, |w| !viewer(w).stage.is_sharp());
    wait(&mut window, |w| viewer(w).stage.is_static());
    wait(&mut window, |w| viewer(w).stage.is_sharp());
    // From then on every frame is.
    let before = state(&mut window).playback.pace.time;
    wait(&mut window, |w| {
        assert!(viewer(w).stage.is_sharp());
        state(w).playback.pace.time != before && viewer(w).stage.shows_frame()
    });
    wait(&mut window, |w| viewer(w).stage.can_pick());
    // Another view is a draft again, of all neurons' values.
    state(&mut window).run(Command::Look(Side::Front));
    wait(&mut window, |w| !viewer(w).stage.is_static());
    wait(&mut window, |w| viewer(w).stage.is_static());
    assert!(state(&mut window).messages.problems.is_empty());
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn ghosts_and_what_is_hidden_are_another_picture() {
    let (mut window, _folder) = with_circuit();
    set_look(&mut window, |look| look.ghost_others = true);
    rest(&mut window);
    state(&mut window).run(Edit::Select(vec![2], false));
    window.step();
    assert!(!viewer(&mut window).stage.is_static(), "ghosts");
    rest(&mut window);
    state(&mut window).run(Edit::Hide);
    window.step();
    assert!(!viewer(&mut window).stage.is_static(), "hidden");
}
