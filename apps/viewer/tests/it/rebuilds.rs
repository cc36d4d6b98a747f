//! What is derived for thousands of neurons is derived again only where it must be.

use neurotess::render::color::{ColorMap, Palette};
use neurotess::synth::Kind;
use neurotess_viewer::Command;
use neurotess_viewer::command::Edit;
use neurotess_viewer::document::{ColorBy, Neuron, SourceId};
use neurotess_viewer::state::Rebuilds;

use crate::common::{Window, gpu, run, set_look, settle, state, with_samples};

const NEURONS: usize = 2000;

/// A window with thousands of instances of one tracing.
fn many() -> Window {
    let mut window = with_samples(&[Kind::Granule]);
    let neurons = &mut state(&mut window).document.neurons;
    for i in 1..NEURONS {
        let mut neuron = Neuron::new(SourceId(0), format!("n{i}"));
        neuron.placement.translation =
            300.0 * glam::DVec3::new((i % 50) as f64, (i / 50) as f64, 0.0);
        neurons.push(neuron);
    }
    run(&mut window, Command::Home);
    settle(&mut window);
    window
}

fn rebuilds(window: &mut Window) -> Rebuilds {
    state(window).drawing.counters.rebuilds
}

#[neurotess_testing::test(needs(neurotess_testing::full, gpu))]
fn only_what_a_change_concerns_is_made_again() {
    let mut window = many();
    let before = rebuilds(&mut window);
    assert!(
        before.instances > 0 && before.templates > 0 && before.proxies > 0,
        "{before:?}"
    );
    window.run_steps(20);
    assert_eq!(rebuilds(&mut window), before, "nothing changes");
    // Another view.
    let turned = state(&mut window).view.orbited(0.3, 0.1, glam::DVec3::Y);
    run(&mut window, Command::Go(turned));
    assert_eq!(rebuilds(&mut window), before, "the camera turns");
    // Other colors of the same types.
    set_look(&mut window, |look| look.palette = Palette::ALL[1]);
    let recolored = rebuilds(&mut window);
    let colors = recolored.colors;
    assert!(colors > before.colors);
    assert_eq!(recolored, Rebuilds { colors, ..before }, "a palette");
    set_look(&mut window, |look| look.color_map = ColorMap::ALL[2]);
    let colors = rebuilds(&mut window).colors;
    assert_eq!(
        rebuilds(&mut window),
        Rebuilds { colors, ..before },
        "a color map"
    );
    // A selection.
    run(&mut window, Edit::Select(vec![7], false));
    let states = rebuilds(&mut window).states;
    assert!(states > before.states);
    let selected = Rebuilds {
        colors,
        states,
        ..before
    };
    assert_eq!(rebuilds(&mut window), selected, "a selection");
    // What is hidden: instances and spheres, but no meshes.
    run(&mut window, Edit::Hide);
    let hidden = rebuilds(&mut window);
    assert!(hidden.instances > before.instances && hidden.spheres > before.spheres);
    let meshes = |r: &Rebuilds| (r.placements, r.templates, r.proxies);
    assert_eq!(meshes(&hidden), meshes(&before), "hidden");
    run(&mut window, Edit::ShowAll);
    // Other color keys need other meshes, and say so.
    set_look(&mut window, |look| look.color_by = ColorBy::PathDistance);
    assert!(rebuilds(&mut window).templates > before.templates);
    window.run_steps(3);
    let last = rebuilds(&mut window);
    window.run_steps(20);
    assert_eq!(rebuilds(&mut window), last, "nothing changes any more");
    // Larger radii need other meshes, once: not again for other colors.
    let saved = |window: &mut Window| state(window).source_of(0).expect("open").generated.clone();
    let traced = saved(&mut window);
    set_look(&mut window, |look| look.radius_factor = 3.0);
    assert!(
        std::sync::Arc::ptr_eq(&traced, &saved(&mut window)),
        "meshes are saved as traced"
    );
    let thicker = rebuilds(&mut window);
    assert!(thicker.templates > last.templates && thicker.spheres > last.spheres);
    set_look(&mut window, |look| look.color_map = ColorMap::ALL[1]);
    let recolored = rebuilds(&mut window);
    assert!(recolored.colors > thicker.colors);
    assert_eq!(
        Rebuilds {
            colors: thicker.colors,
            ..recolored
        },
        thicker,
        "a color map"
    );
    set_look(&mut window, |look| look.radius_factor = 1.0);
    assert!(rebuilds(&mut window).templates > thicker.templates);
}
