//! Zooming to parts of a cell.

use eframe::egui::{Event, Modifiers, PointerButton};
use egui_kittest::kittest::Queryable;
use neurotess::synth::Kind;
use neurotess_viewer::Command;
use neurotess_viewer::command::Edit;
use neurotess_viewer::document::{Neuron, SourceId};
use neurotess_viewer::state::{CellPart, Picked};

use crate::common::{Window, gpu, run_undrawn, state, undrawn};

fn distance(window: &mut Window) -> f64 {
    let camera = state(window).view.camera();
    camera.eye().distance(camera.target())
}

#[neurotess_testing::test(needs(gpu))]
fn focus_and_a_double_click_in_the_tree_go_to_the_part() {
    let mut window = undrawn(&[Kind::Star]);
    run_undrawn(&mut window, Edit::Select(vec![0], false));
    run_undrawn(&mut window, Command::Focus);
    let whole = distance(&mut window);
    let part = |part| Some(Picked { neuron: 0, part });
    state(&mut window).pointing.picked = part(CellPart::Soma);
    run_undrawn(&mut window, Command::Focus);
    let soma = distance(&mut window);
    assert!(soma < 0.3 * whole, "{soma} of {whole}");
    // A click on a neurite selects its cell.
    state(&mut window).pointing.picked = part(CellPart::Section(0));
    run_undrawn(&mut window, Command::Focus);
    let again = distance(&mut window);
    assert!((again / whole - 1.0).abs() < 1e-9, "{again} {whole}");
    // The line of the tree; the panel on the right has the name, too.
    let lines = window.get_all_by_label("Soma").map(|line| line.rect());
    let line = lines.min_by(|a, b| a.left().total_cmp(&b.left()));
    let at = line.expect("a line").center();
    window.event(Event::PointerMoved(at));
    window.step();
    let button = |pressed| Event::PointerButton {
        pos: at,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    let clicks = [true, false, true, false].map(button);
    window.input_mut().events.extend(clicks);
    for _ in 0..6 {
        // The harness's own frames are too long for a double click.
        let time = window.ctx.input(|input| input.time) + 0.02;
        window.input_mut().time = Some(time);
        window.step();
    }
    window.run_steps(3);
    assert_eq!(distance(&mut window), soma);
}

#[neurotess_testing::test(needs(gpu))]
fn lines_of_the_list_are_selected_in_ranges_and_mean_whole_cells() {
    let mut window = undrawn(&[Kind::Star]);
    let name = |n: usize| format!("cell {n}");
    for n in 1..12 {
        let neuron = Neuron::new(SourceId(0), name(n));
        state(&mut window).document.neurons.push(neuron);
    }
    run_undrawn(&mut window, Edit::Select(vec![0], false));
    run_undrawn(&mut window, Command::Focus);
    let whole = distance(&mut window);
    let click = |window: &mut Window, n: usize, modifiers: Modifiers| {
        let pos = window.get_by_label(&name(n)).rect().center();
        window.event(Event::ModifiersChanged(modifiers));
        window.event(Event::PointerMoved(pos));
        window.step();
        for pressed in [true, false] {
            window.event(Event::PointerButton {
                pos,
                button: PointerButton::Primary,
                pressed,
                modifiers,
            });
            window.step();
        }
        window.event(Event::ModifiersChanged(Modifiers::NONE));
        // Not a double click.
        let time = window.ctx.input(|input| input.time) + 1.0;
        window.input_mut().time = Some(time);
        window.run_steps(2);
        state(window).document.selected().collect::<Vec<_>>()
    };
    assert_eq!(click(&mut window, 2, Modifiers::NONE), [2]);
    run_undrawn(&mut window, Command::Focus);
    let again = distance(&mut window);
    assert!(
        (again / whole - 1.0).abs() < 1e-9,
        "the cell, not its soma: {again} {whole}"
    );
    assert_eq!(click(&mut window, 4, Modifiers::SHIFT), [2, 3, 4]);
    assert_eq!(click(&mut window, 1, Modifiers::SHIFT), [1, 2]);
    assert_eq!(click(&mut window, 4, Modifiers::COMMAND), [1, 2, 4]);
    // All are those that the list shows.
    state(&mut window).layout.search = "cell 1".into();
    run_undrawn(&mut window, Edit::SelectAll);
    assert_eq!(
        state(&mut window).document.selected().collect::<Vec<_>>(),
        [1, 10, 11]
    );
}
