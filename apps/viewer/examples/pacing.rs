//! How the window keeps up: many neurons, a camera that turns, the time until the full picture, and a
//! slider of the soma editor.
//!
//! `cargo run --release -p neurotess-viewer --example pacing -- 100` prints milliseconds from an input to the
//! end of the draft that shows it, and from the last input to the full picture. The figures of
//! benchmarks/viewer.md come from here.
#![allow(
    clippy::print_stdout,
    clippy::unwrap_used,
    reason = "printing is what this program is for"
)]

use std::sync::Arc;
use std::time::{Duration, Instant};

use eframe::egui::Vec2;
use egui_kittest::Harness;
use egui_kittest::wgpu::{WgpuTestRenderer, create_render_state};
use egui_wgpu::RendererOptions;
use neurotess::synth::Kind;
use neurotess_viewer::command::Edit;
use neurotess_viewer::document::{Neuron, SourceId};
use neurotess_viewer::settings::Settings;
use neurotess_viewer::{Command, Viewer, wgpu_setup};

const TURNS: usize = 60;

fn main() {
    let neurons: usize = std::env::args()
        .nth(1)
        .and_then(|n| n.parse().ok())
        .unwrap_or(100);
    let render = create_render_state(wgpu_setup(None, Arc::default()), RendererOptions::default());
    let ours = render.clone();
    let mut window = Harness::builder()
        .with_size(Vec2::new(1280.0, 820.0))
        .renderer(WgpuTestRenderer::from_render_state(render))
        .build_ui_state(
            move |ui, viewer: &mut Option<Viewer>| {
                let settings = Settings::default;
                let viewer = viewer.get_or_insert_with(|| {
                    Viewer::new(ui.ctx(), ours.clone(), settings())
                        .unwrap()
                        .without_motion()
                });
                viewer.ui(ui);
            },
            None,
        );
    window.step();
    for kind in Kind::ALL {
        window
            .state_mut()
            .as_mut()
            .unwrap()
            .state
            .run(Command::OpenSample(kind));
        settle(&mut window);
    }
    let state = &mut window.state_mut().as_mut().unwrap().state;
    for i in Kind::ALL.len()..neurons {
        let source = SourceId((i % Kind::ALL.len()) as u32);
        state
            .document
            .neurons
            .push(Neuron::new(source, format!("n{i}")));
    }
    let more = (neurons..state.document.neurons.len()).collect();
    state.document.neurons.remove(&more);
    state.document.grid = true;
    state.run(Command::Home);
    settle(&mut window);
    let adapter = window
        .state()
        .as_ref()
        .unwrap()
        .state
        .drawing
        .adapter
        .0
        .clone();
    println!("{neurons} neurons on {adapter}");
    turn(&mut window);
    let times = turn(&mut window);
    let rest = Instant::now();
    while !window.state().as_ref().unwrap().stage.is_sharp() {
        window.step();
        std::thread::sleep(Duration::from_millis(2));
    }
    let sharp = rest.elapsed();
    settle(&mut window);
    report("input to its draft", times);
    let counters = &window.state().as_ref().unwrap().state.drawing.counters;
    println!("at rest lowered: {:?}", counters.lowered);
    println!(
        "last input to the first step of the full picture: {:.0} ms, to the last one: {:.0} ms",
        sharp.as_secs_f64() * 1e3,
        rest.elapsed().as_secs_f64() * 1e3
    );
    report(
        "input while the full picture is made, to its draft",
        interruptions(&mut window),
    );
    report("step of a first ring to its draft", rings(&mut window));
}

/// Milliseconds from each of many steps of a ring's slider to the surface that follows.
fn rings(window: &mut Harness<'_, Option<Viewer>>) -> Vec<f64> {
    let id = SourceId(0);
    let mut times = Vec::new();
    for step in 0..TURNS {
        let position = 2.0 * step as f64 / TURNS as f64;
        let clock = Instant::now();
        let viewer = window.state_mut().as_mut().unwrap();
        viewer.state.run(Edit::SetRing(id, 0, Some(position)));
        loop {
            window.step();
            let state = &window.state().as_ref().unwrap().state;
            if state.sources.get(id).unwrap().soma == state.document.soma(id) {
                break;
            }
        }
        window.state().as_ref().unwrap().stage.gpu().wait().unwrap();
        times.push(clock.elapsed().as_secs_f64() * 1e3);
    }
    times
}

/// Milliseconds of turns at several moments of the making of the full picture.
fn interruptions(window: &mut Harness<'_, Option<Viewer>>) -> Vec<f64> {
    let mut times = Vec::new();
    for moment in 0..20 {
        let rest = Instant::now();
        while rest.elapsed() < Duration::from_millis(150 + 50 * moment) {
            window.step();
            std::thread::sleep(Duration::from_millis(2));
        }
        let clock = Instant::now();
        let viewer = window.state_mut().as_mut().unwrap();
        viewer.state.view = viewer.state.view.orbited(0.02, 0.003, glam::DVec3::Y);
        let camera = viewer.state.view.camera();
        while !window.state().as_ref().unwrap().stage.is_from(&camera) {
            window.step();
        }
        window.state().as_ref().unwrap().stage.gpu().wait().unwrap();
        times.push(clock.elapsed().as_secs_f64() * 1e3);
    }
    times
}

/// Milliseconds of each of many small turns, each waited for.
fn turn(window: &mut Harness<'_, Option<Viewer>>) -> Vec<f64> {
    let mut times = Vec::new();
    for _ in 0..TURNS {
        let clock = Instant::now();
        let viewer = window.state_mut().as_mut().unwrap();
        viewer.state.view = viewer.state.view.orbited(0.02, 0.003, glam::DVec3::Y);
        window.step();
        window.state().as_ref().unwrap().stage.gpu().wait().unwrap();
        times.push(clock.elapsed().as_secs_f64() * 1e3);
    }
    times
}

fn settle(window: &mut Harness<'_, Option<Viewer>>) {
    while !window.state().as_ref().unwrap().is_settled() {
        window.step();
        std::thread::sleep(Duration::from_millis(2));
    }
    window.step();
    while !window.state().as_ref().unwrap().is_settled() {
        window.step();
        std::thread::sleep(Duration::from_millis(2));
    }
}

fn report(what: &str, mut times: Vec<f64>) {
    times.sort_by(f64::total_cmp);
    let at = |share: f64| times[(share * (times.len() - 1) as f64) as usize];
    println!(
        "{what}: median {:.0} ms, 95 % {:.0} ms, worst {:.0} ms",
        at(0.5),
        at(0.95),
        at(1.0)
    );
}
