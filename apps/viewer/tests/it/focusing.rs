//! Zooming to parts of a cell.

use eframe::egui::{Event, Modifiers, PointerButton};
use egui_kittest::kittest::Queryable;
use neurotess::synth::Kind;
use neurotess_viewer::Command;
use neurotess_viewer::command::Edit;
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
