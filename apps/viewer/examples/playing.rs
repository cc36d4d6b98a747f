//! What a frame of a recording costs: reading its values, and drawing them in the window.
//!
//! ```text
//! neurotess synth circuit -o c100 --neurons 100 --morphologies 20 --reported 100
//! cargo run --release -p neurotess-viewer --example playing -- c100 c100/reports/voltage.h5
//! ```
//!
//! The figures of benchmarks/viewer.md come from here.
#![allow(
    clippy::print_stdout,
    clippy::unwrap_used,
    reason = "printing is what this program is for"
)]

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use eframe::egui::Vec2;
use egui_kittest::Harness;
use egui_kittest::wgpu::{WgpuTestRenderer, create_render_state};
use egui_wgpu::RendererOptions;
use neurotess::circuit::{Circuit, NodeRef};
use neurotess::coloring::{Cell, DECAY, Recording};
use neurotess::generate::{GenerateOptions, generate};
use neurotess_viewer::command::Edit;
use neurotess_viewer::settings::Settings;
use neurotess_viewer::{Command, Viewer, wgpu_setup};

const FRAMES: usize = 60;

type Window = Harness<'static, Option<Viewer>>;

fn main() {
    let mut paths = std::env::args_os().skip(1).map(PathBuf::from);
    let (circuit, report) = (paths.next().unwrap(), paths.next().unwrap());
    read(&circuit, &report);
    play(&circuit, &report);
}

/// Without a window: opening, and the values of one frame after the other.
fn read(circuit: &Path, report: &Path) {
    let circuit = Circuit::open(circuit).unwrap();
    let nodes: Vec<NodeRef> = circuit.nodes().collect();
    let mut of_template: BTreeMap<usize, usize> = BTreeMap::new();
    let mut stand = Vec::new();
    for instance in circuit.instances(&nodes, None) {
        let next = of_template.len();
        let cell = *of_template.entry(instance.template.index()).or_insert(next);
        stand.push((cell, Some(instance.node)));
    }
    let mut templates: Vec<(usize, usize)> = of_template.into_iter().map(|(t, c)| (c, t)).collect();
    templates.sort_unstable();
    let read = |&(_, template): &(usize, usize)| {
        let morphology = circuit.templates[template]
            .read()
            .unwrap()
            .morphology
            .clone();
        let mesh = generate(&morphology, &GenerateOptions::default())
            .expect("meshed")
            .mesh;
        (morphology, mesh)
    };
    let read: Vec<_> = templates.iter().map(read).collect();
    let cells: Vec<Cell<'_>> = read
        .iter()
        .map(|(morphology, mesh)| Cell {
            name: "",
            morphology,
            mesh,
            radius_factor: 1.0,
        })
        .collect();
    let clock = Instant::now();
    let replay = Recording::open(report, &circuit, &cells, &stand).unwrap();
    let open = clock.elapsed();
    let clock = Instant::now();
    let range = replay.range(&|_| true).unwrap();
    let ranged = clock.elapsed();
    let (mut reads, mut shares) = (Vec::new(), Vec::new());
    let mut values = 0;
    for frame in 0..replay.time.frames.min(FRAMES as u64) {
        let clock = Instant::now();
        let moment = replay
            .at(replay.time.time_of(frame), DECAY, &|_| true)
            .unwrap();
        reads.push(ms(clock));
        let clock = Instant::now();
        values = moment.len();
        std::hint::black_box(moment.values(range));
        shares.push(ms(clock));
    }
    println!(
        "{} neurons, {values} values a frame; open {:.0} ms, range of all frames {:.0} ms",
        stand.len(),
        1e3 * open.as_secs_f64(),
        1e3 * ranged.as_secs_f64()
    );
    tell("read a frame", reads);
    tell("as shares of the range", shares);
}

/// In the window: frames of the recording, and as many small turns of the camera to compare with.
fn play(circuit: &Path, report: &Path) {
    let mut window = window();
    window.step();
    run(&mut window, Command::Open(vec![circuit.to_path_buf()]));
    let clock = Instant::now();
    run(&mut window, Edit::SetReport(Some(report.to_path_buf())));
    println!("report chosen to full picture: {:.0} ms", ms(clock));
    let adapter = window
        .state()
        .as_ref()
        .unwrap()
        .state
        .drawing
        .adapter
        .0
        .clone();
    println!("drawn on {adapter}");
    let axis = state(&mut window).playback.facts.as_ref().unwrap().time;
    turn(&mut window);
    let turns = turn(&mut window);
    tell("draft of another view", turns);
    for round in ["first", "again"] {
        let mut frames = Vec::new();
        for frame in 1..=(FRAMES as u64).min(axis.frames - 1) {
            let clock = Instant::now();
            state(&mut window).run(Command::Seek(axis.time_of(frame)));
            window.step();
            while !window.state().as_ref().unwrap().stage.shows_frame() {
                window.step();
            }
            window.state().as_ref().unwrap().stage.gpu().wait().unwrap();
            frames.push(ms(clock));
        }
        tell(&format!("draft of another frame, {round}"), frames);
    }
}

fn turn(window: &mut Window) -> Vec<f64> {
    let mut times = Vec::new();
    for _ in 0..FRAMES {
        let clock = Instant::now();
        let state = state(window);
        state.view = state.view.orbited(0.002, 0.0, glam::DVec3::Y);
        window.step();
        window.state().as_ref().unwrap().stage.gpu().wait().unwrap();
        times.push(ms(clock));
    }
    times
}

fn window() -> Window {
    let render = create_render_state(wgpu_setup(None, Arc::default()), RendererOptions::default());
    let ours = render.clone();
    Harness::builder()
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
        )
}

fn state(window: &mut Window) -> &mut neurotess_viewer::state::State {
    &mut window.state_mut().as_mut().unwrap().state
}

fn run(window: &mut Window, command: impl Into<Command>) {
    state(window).run(command);
    for _ in 0..2 {
        window.step();
        while !window.state().as_ref().unwrap().is_settled() {
            window.step();
            std::thread::sleep(Duration::from_millis(2));
        }
    }
}

fn ms(clock: Instant) -> f64 {
    clock.elapsed().as_secs_f64() * 1e3
}

fn tell(what: &str, mut times: Vec<f64>) {
    times.sort_by(f64::total_cmp);
    let at = |share: f64| times[(share * (times.len() - 1) as f64) as usize];
    println!("{what}: median {:.2} ms, 95 % {:.2} ms", at(0.5), at(0.95));
}
