//! What a frame of the window costs in which nothing changes, one in which the camera turns, and one in which another
//! neuron is selected, with thousands of neurons.
//!
//! `cargo run -p neurotess-viewer --example idle -- 2000 10000` prints milliseconds of the processor for each
//! number of neurons, and how much memory 200 selections take (on Linux).
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

type Window = Harness<'static, Option<Viewer>>;

const FRAMES: usize = 30;

/// As many edits as the history keeps.
const CLICKS: usize = 200;

fn main() {
    let counts = std::env::args().skip(1);
    for count in counts.filter_map(|n| n.parse().ok()) {
        measure(count);
    }
}

fn measure(count: usize) {
    let mut window = window();
    window.step();
    run(&mut window, Command::OpenSample(Kind::Granule));
    // The list and the panels would be measured too; the baseline of before had them hidden.
    let state = &mut viewer(&mut window).state;
    state.layout.panels = std::env::var_os("PANELS").is_some();
    for i in 1..count {
        let mut neuron = Neuron::new(SourceId(0), format!("n{i}"));
        neuron.placement.translation.x = 300.0 * (i % 100) as f64;
        neuron.placement.translation.y = 300.0 * (i / 100) as f64;
        state.document.neurons.push(neuron);
    }
    for grid in [false, true] {
        run(&mut window, Edit::SetGrid(grid));
        run(&mut window, Command::Home);
        report(
            &format!("{count} neurons, grid {grid}, nothing changes"),
            (0..FRAMES).map(|_| frame(&mut window)).collect(),
        );
        report(
            &format!("{count} neurons, grid {grid}, the camera turns"),
            (0..FRAMES).map(|_| turned(&mut window)).collect(),
        );
    }
    run(&mut window, Edit::SetGrid(false));
    let before = resident();
    let times = (0..CLICKS).map(|i| {
        // Not neighbors, as clicks are not.
        let select = Edit::Select(vec![i * count / CLICKS], false);
        viewer(&mut window).state.run(select);
        frame(&mut window)
    });
    report(
        &format!("{count} neurons, another is selected"),
        times.collect(),
    );
    println!(
        "memory of {CLICKS} selections: {:.1} MB",
        resident() - before
    );
}

/// Resident memory of this process, in MB.
fn resident() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find(|line| line.starts_with("VmRSS:"));
    let kb = line.unwrap().split_whitespace().nth(1).unwrap();
    kb.parse::<f64>().unwrap() * 1024.0 / 1e6
}

/// Milliseconds of one frame.
fn frame(window: &mut Window) -> f64 {
    let clock = Instant::now();
    window.step();
    clock.elapsed().as_secs_f64() * 1e3
}

/// Milliseconds of the frame after a small turn.
fn turned(window: &mut Window) -> f64 {
    let state = &mut viewer(window).state;
    state.view = state.view.orbited(0.002, 0.0, glam::DVec3::Y);
    let time = frame(window);
    viewer(window).stage.gpu().wait().unwrap();
    time
}

fn window() -> Window {
    let render = create_render_state(wgpu_setup(None, Arc::default()), RendererOptions::default());
    let ours = render.clone();
    Harness::builder()
        .with_size(Vec2::new(640.0, 480.0))
        .renderer(WgpuTestRenderer::from_render_state(render))
        .build_ui_state(
            move |ui, viewer: &mut Option<Viewer>| {
                let viewer = viewer.get_or_insert_with(|| {
                    Viewer::new(ui.ctx(), ours.clone(), Settings::default())
                        .unwrap()
                        .without_motion()
                });
                viewer.ui(ui);
            },
            None,
        )
}

fn viewer(window: &mut Window) -> &mut Viewer {
    window.state_mut().as_mut().unwrap()
}

fn run(window: &mut Window, command: impl Into<Command>) {
    viewer(window).state.run(command);
    for _ in 0..3 {
        window.step();
        while !viewer(window).is_settled() {
            window.step();
            std::thread::sleep(Duration::from_millis(2));
        }
    }
}

fn report(what: &str, mut times: Vec<f64>) {
    times.sort_by(f64::total_cmp);
    let at = |share: f64| times[(share * (times.len() - 1) as f64) as usize];
    println!("{what}: median {:.2} ms, worst {:.2} ms", at(0.5), at(1.0));
}
