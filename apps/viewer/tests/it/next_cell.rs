//! What one cell was looked at with does not make another one look like something else.

use egui_kittest::kittest::Queryable;
use neurotess::synth::Kind;
use neurotess_viewer::Command;
use neurotess_viewer::command::Edit;
use neurotess_viewer::document::{Look, VisibleParts};
use neurotess_viewer::state::State;

use crate::common::{
    SMALL, gpu, run, run_undrawn, samples_in, set_look, settle, state, undrawn, wait, window_of,
};

#[neurotess_testing::test(needs(gpu))]
fn what_falsifies_is_said_and_does_not_survive_into_the_next_cell() {
    let mut window = undrawn(&[Kind::Star]);
    let look = Look {
        background: [250, 240, 230],
        radius_factor: 100.0,
        parts: VisibleParts::Neurites,
        ..Look::default()
    };
    run_undrawn(&mut window, Edit::SetLook(Box::new(look)));
    run_undrawn(&mut window, Command::SetYDown(true));
    window.get_by_label("radii × 100, neurites only");
    let taste = Look {
        background: [250, 240, 230],
        ..Look::default()
    };
    // The next start.
    let next = State::new(state(&mut window).settings.clone());
    assert!(next.document.look == taste && !next.document.y_down);
    // The next cell in this window.
    run_undrawn(&mut window, Edit::SelectAll);
    run_undrawn(&mut window, Edit::Remove);
    state(&mut window).run(Command::OpenSample(Kind::Granule));
    wait(&mut window, |w| !state(w).document.neurons.is_empty());
    assert_eq!(state(&mut window).document.look, taste);
    assert!(!state(&mut window).document.y_down);
    assert!(window.query_by_label_contains("radii ×").is_none());
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn the_look_is_reset_from_the_picture() {
    let mut window = samples_in(window_of(SMALL), &[Kind::Star]);
    set_look(&mut window, |look| look.radius_factor = 3.0);
    window.get_by_label("×").click();
    window.run_steps(3);
    settle(&mut window);
    assert_eq!(state(&mut window).document.look.radius_factor, 1.0);
    assert!(window.query_by_label_contains("radii ×").is_none());
    run(&mut window, Command::Undo);
    assert_eq!(state(&mut window).document.look.radius_factor, 3.0);
}
