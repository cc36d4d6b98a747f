//! Spines that grow on cells of the window.

use std::fs;
use std::sync::Arc;

use neurotess::synth::Kind;
use neurotess_viewer::Command;
use neurotess_viewer::command::Edit;
use neurotess_viewer::document::{SpineEdit, SpinePlaces};

use crate::common::circuit::write_with_synapses;
use crate::common::{Window, gpu, run, settle, state, window, with_samples};

/// Spines of a neuron, and patches of its mesh.
fn spines(window: &mut Window, neuron: usize) -> (usize, usize) {
    settle(window);
    let source = state(window).source_of(neuron).expect("a source");
    (source.spine_count(), source.generated.mesh.patches.len())
}

fn grow(places: SpinePlaces) -> Edit {
    Edit::GrowSpines(Some(SpineEdit::at(places)))
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn spines_grow_at_random_and_are_undone() {
    let mut window = with_samples(&[Kind::Granule, Kind::Star]);
    let (none, patches) = spines(&mut window, 0);
    assert_eq!(none, 0);
    run(&mut window, Edit::Select(vec![0], false));
    run(&mut window, grow(SpinePlaces::Random));
    let (grown, more) = spines(&mut window, 0);
    assert!(grown > 200 && more > patches + 4 * grown, "{grown}, {more}");
    assert_eq!(spines(&mut window, 1).0, 0, "the other is not selected");
    let status = state(&mut window).messages.status.clone();
    assert!(status.contains(&format!("{grown} spines")), "{status}");
    // Figures are those of the cell with its spines.
    let source = state(&mut window).source_of(0).expect("a source");
    assert!(source.measures.n_sections >= 2 * grown);
    assert_eq!(source.sections.len(), source.measures.n_sections);
    // Fewer of them.
    let id = state(&mut window).document.neurons[0].source;
    let fewer = SpineEdit {
        density: 0.2,
        ..SpineEdit::default()
    };
    run(&mut window, Edit::SetSpines(vec![id], Some(fewer)));
    let (few, _) = spines(&mut window, 0);
    assert!(few > 20 && few < grown / 2, "{few} of {grown}");
    run(&mut window, Command::Undo);
    assert_eq!(spines(&mut window, 0), (grown, more));
    run(&mut window, Command::Undo);
    assert_eq!(spines(&mut window, 0), (0, patches));
    let source = state(&mut window).source_of(0).expect("a source");
    assert!(Arc::ptr_eq(&source.morphology, &source.traced));
    run(&mut window, Command::Redo);
    assert_eq!(spines(&mut window, 0), (grown, more));
    run(&mut window, Edit::GrowSpines(None));
    assert_eq!(spines(&mut window, 0), (0, patches));
    assert!(state(&mut window).messages.problems.is_empty());
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn sessions_keep_spines_and_reports_are_drawn_without() {
    let folder = tempfile::tempdir().expect("a folder");
    let (cell, session) = (
        folder.path().join("a.asc"),
        folder.path().join("a.neurotess"),
    );
    let text = "((Dendrite) (0 0 0 2) (0 20 0 2) <(3 21 0 1)> (0 40 0 2) <(-3 35 0 1)> (0 60 0 2))";
    fs::write(&cell, text).expect("written");
    let mut window = window();
    window.step();
    run(&mut window, Command::Open(vec![cell]));
    run(&mut window, grow(SpinePlaces::File));
    assert_eq!(spines(&mut window, 0).0, 2);
    run(&mut window, Command::SaveSession(session.clone()));
    let text = fs::read_to_string(&session).expect("written");
    assert!(text.contains("places = \"file\""), "{text}");
    let mut other = self::window();
    other.step();
    run(&mut other, Command::Open(vec![session]));
    assert_eq!(spines(&mut other, 0).0, 2);
    // A report numbers the sections of the tracing itself.
    state(&mut other).document.report = Some("voltage.h5".into());
    assert_eq!(spines(&mut other, 0).0, 0);
    state(&mut other).document.report = None;
    assert_eq!(spines(&mut other, 0).0, 2);
}

#[neurotess_testing::test(needs(gpu))]
fn a_file_that_tells_of_no_spines_is_a_problem_that_is_told() {
    let mut window = with_samples(&[Kind::Star]);
    run(&mut window, grow(SpinePlaces::File));
    settle(&mut window);
    let problem = state(&mut window)
        .messages
        .problems
        .pop()
        .expect("a problem");
    assert!(problem.why.contains("tells of no spines"), "{problem:?}");
    assert_eq!(spines(&mut window, 0).0, 0);
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn spines_grow_where_a_cell_of_a_circuit_gets_synapses() {
    const EACH: usize = 30;
    let folder = tempfile::tempdir().expect("a folder");
    write_with_synapses(folder.path(), 4, 2, EACH);
    let mut window = window();
    window.step();
    run(
        &mut window,
        Command::Open(vec![folder.path().to_path_buf()]),
    );
    run(&mut window, Edit::Select(vec![0], false));
    // Two cells share each tracing.
    run(&mut window, grow(SpinePlaces::Synapses));
    settle(&mut window);
    let problem = state(&mut window)
        .messages
        .problems
        .pop()
        .expect("a problem");
    assert!(problem.why.contains("for itself"), "{problem:?}");
    run(&mut window, Command::Undo);
    run(&mut window, Edit::SelectOthers);
    run(&mut window, Edit::Remove);
    run(&mut window, grow(SpinePlaces::Synapses));
    let (grown, _) = spines(&mut window, 0);
    // A gap is on the soma, and some synapses have no room.
    assert!((EACH / 2..=EACH).contains(&grown), "{grown}");
    assert!(state(&mut window).messages.problems.is_empty());
}
