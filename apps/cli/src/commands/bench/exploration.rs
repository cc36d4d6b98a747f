//! Frames of exploration and of adaptive refinement, while the camera turns.

use neurotess::refine::LodCriterion;
use neurotess::render::color::ColorTable;
use neurotess::render::{
    AdaptiveSettings, Exploration, Frame, FrameTime, Gpu, Meter, Proxy, VertexSource,
};
use rayon::prelude::*;
use serde::Serialize;

use super::args::ExplorationArgs;
use super::methods::{adaptive, instances, median, warm_up};
use super::scenes::{self, BenchScene, Neuron};
use crate::report::Reporter;

/// Angle (radians) from frame to frame, so that every frame is selected anew.
const TURN: f64 = 0.01;
/// Error (pixels) of the adaptive frame.
const ERROR: f32 = 0.5;

/// The JSON document.
#[derive(Serialize)]
struct Document<'a> {
    adapter: &'a str,
    backend: &'a str,
    software: bool,
    size: [u32; 2],
    budget: u32,
    distinct: usize,
    /// Tracing points per neuron, on average.
    points: f64,
    /// Milliseconds that it took to compute and to upload the proxies of all distinct neurons.
    sketch_ms: f64,
    upload_ms: f64,
    bytes_per_point: f64,
    rows: Vec<Row>,
}

/// A scene's figures.
#[derive(Clone, Debug, Serialize)]
struct Row {
    neurons: u32,
    /// Tracing points of all instances.
    points: u64,
    exploration: Times,
    triangles: u64,
    /// Triangles that it would take to draw everything within half a pixel.
    wanted: u64,
    /// Whether it may be more: in the largest scenes, not everything is asked.
    at_least: bool,
    /// Chunks of 64 segments that a frame measures.
    measured: u64,
    bytes: u64,
    adaptive: Option<Times>,
    adaptive_triangles: Option<u64>,
    adaptive_bytes: Option<u64>,
    /// Time waited for the adaptive frame, divided by that for the frame of exploration mode.
    ratio: Option<f64>,
}

/// Medians (ms).
#[derive(Clone, Copy, Debug, Serialize)]
struct Times {
    waited: f64,
    choose: Option<f64>,
    draw: Option<f64>,
}

/// Runs the benchmark.
pub(super) fn run(args: &ExplorationArgs, reporter: &Reporter) -> anyhow::Result<()> {
    let gpu = Gpu::open(args.adapter.as_deref())?;
    let neurons = scenes::neurons(args.distinct, args.points);
    let clock = std::time::Instant::now();
    let proxies: Vec<Proxy> = neurons
        .par_iter()
        .map(|neuron| Proxy::new(&neuron.mesh, &neuron.color_keys))
        .collect();
    let sketch_ms = clock.elapsed().as_secs_f64() * 1e3;
    let mut source = Exploration::new(&gpu, 1)?;
    source.set_budget(args.budget);
    let clock = std::time::Instant::now();
    let ids = source.add(&gpu, &proxies)?;
    gpu.wait()?;
    let mut document = Document {
        adapter: &gpu.adapter.name,
        backend: &gpu.adapter.backend,
        software: gpu.adapter.software,
        size: args.size.0,
        budget: args.budget,
        distinct: neurons.len(),
        points: proxies.iter().map(Proxy::point_count).sum::<usize>() as f64 / neurons.len() as f64,
        sketch_ms,
        upload_ms: clock.elapsed().as_secs_f64() * 1e3,
        bytes_per_point: source.bytes_per_point(),
        rows: Vec::new(),
    };
    reporter.result(&head(&document));
    let colors = scenes::colors();
    for &count in &args.neurons {
        let scene = BenchScene::new(&neurons, count, args.size.0)?;
        source.set_instances(&gpu, instances(&scene, &ids))?;
        let times = times(&gpu, &mut source, &scene.frame, &colors, args.frames)?;
        let stats = source.stats(&gpu)?;
        let points = scene
            .placements
            .iter()
            .map(|&(n, _)| proxies[n].point_count());
        let mut row = Row {
            neurons: count,
            points: points.map(|n| n as u64).sum(),
            exploration: times,
            triangles: stats.triangles,
            wanted: stats.requested,
            at_least: stats.at_least,
            measured: source.measured(&gpu)?,
            bytes: source.bytes().iter().map(|(_, bytes)| bytes).sum(),
            adaptive: None,
            adaptive_triangles: None,
            adaptive_bytes: None,
            ratio: None,
        };
        if count <= args.compare {
            compare(&mut row, &gpu, &neurons, &scene, &colors, args.frames)?;
        }
        reporter.result(&line(&row));
        document.rows.push(row);
    }
    if let Some(bar) = bar(&document.rows) {
        reporter.result(&bar);
    }
    reporter.document(&document)
}

/// Times the same frames, refined adaptively.
fn compare(
    row: &mut Row,
    gpu: &Gpu,
    neurons: &[Neuron],
    scene: &BenchScene,
    colors: &ColorTable,
    frames: u32,
) -> anyhow::Result<()> {
    let settings = AdaptiveSettings {
        lod: LodCriterion::PixelError(ERROR),
        ..AdaptiveSettings::default()
    };
    let mut source = adaptive(gpu, neurons, scene, settings)?;
    let times = times(gpu, &mut source, &scene.frame, colors, frames)?;
    row.ratio = Some(times.waited / row.exploration.waited);
    row.adaptive = Some(times);
    row.adaptive_triangles = Some(source.stats(gpu)?.triangles);
    row.adaptive_bytes = Some(source.bytes().iter().map(|(_, bytes)| bytes).sum());
    Ok(())
}

/// Times frames of a turning camera, after one that is not counted.
fn times(
    gpu: &Gpu,
    source: &mut dyn VertexSource,
    frame: &Frame,
    colors: &ColorTable,
    frames: u32,
) -> anyhow::Result<Times> {
    let mut meter = Meter::new(gpu, source, colors)?;
    let mut times: Vec<FrameTime> = Vec::new();
    warm_up(gpu, &mut meter, source, frame)?;
    for i in 0..=frames {
        let turned = Frame {
            camera: frame.camera.turned(TURN * f64::from(i)),
            ..*frame
        };
        times.push(meter.time(source, &turned)?);
    }
    let times = &times[1..];
    let part = |k: usize| median(times.iter().filter_map(|t| Some(t.gpu_ms?[k])).collect());
    Ok(Times {
        waited: median(times.iter().map(|t| t.waited_ms).collect()).unwrap_or(0.0),
        choose: part(0),
        draw: part(1),
    })
}

fn head(document: &Document<'_>) -> String {
    let Document {
        adapter,
        backend,
        size: [width, height],
        budget,
        distinct,
        points,
        sketch_ms,
        upload_ms,
        bytes_per_point,
        ..
    } = document;
    format!(
        "{adapter} ({backend}), {width}x{height} pixels, budget {budget} triangles\n\
         {distinct} distinct neurons of {points:.0} points: {bytes_per_point:.1} bytes a point, \
         sketched in {sketch_ms:.0} ms, uploaded in {upload_ms:.0} ms\n\n\
         {:>8} {:>10} {:>10} {:>9} {:>9} {:>10} {:>12} {:>9} {:>8} {:>12} {:>12} {:>10} {:>7}",
        "neurons",
        "points",
        "waited ms",
        "choose",
        "draw",
        "triangles",
        "wanted",
        "measured",
        "MiB",
        "adaptive ms",
        "triangles",
        "MiB",
        "ratio"
    )
}

/// How the frame's time grows from 10,000 neurons to the largest scene.
fn bar(rows: &[Row]) -> Option<String> {
    let usual = rows.iter().find(|row| row.neurons == 10_000)?;
    let largest = rows.iter().max_by_key(|row| row.neurons)?;
    if largest.neurons <= usual.neurons {
        return None;
    }
    let ms = largest.exploration.waited;
    let ratio = ms / usual.exploration.waited;
    let verdict = if ratio <= 2.0 && ms <= 1000.0 {
        "met"
    } else {
        "missed"
    };
    Some(format!(
        "\n{} neurons take {ratio:.2} times as long as {} (bar: 2 times, and a second): {verdict}",
        largest.neurons, usual.neurons
    ))
}

fn line(row: &Row) -> String {
    let ms = |ms: Option<f64>| ms.map_or("-".into(), |ms| format!("{ms:.2}"));
    let whole = |n: Option<u64>| n.map_or("-".into(), |n| n.to_string());
    let mib = |n: u64| n as f64 / f64::from(1 << 20);
    format!(
        "{:>8} {:>10} {:>10.2} {:>9} {:>9} {:>10} {:>12} {:>9} {:>8.2} {:>12} {:>12} {:>10} {:>7}",
        row.neurons,
        row.points,
        row.exploration.waited,
        ms(row.exploration.choose),
        ms(row.exploration.draw),
        row.triangles,
        format!("{}{}", if row.at_least { ">" } else { "" }, row.wanted),
        row.measured,
        mib(row.bytes),
        ms(row.adaptive.map(|times| times.waited)),
        whole(row.adaptive_triangles),
        ms(row.adaptive_bytes.map(mib)),
        ms(row.ratio),
    )
}
