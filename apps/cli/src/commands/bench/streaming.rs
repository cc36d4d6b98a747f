//! A flight past distinct neurons that do not fit the adapter's memory: what is near comes, what is behind goes. Beside
//! it the same flight with all of them there.

use std::sync::Arc;

use glam::DVec3;
use neurotess::render::{Camera, Exploration, Frame, Gpu, Meter, Proxy, StreamedTemplates};
use rayon::prelude::*;
use serde::Serialize;

use super::args::StreamingArgs;
use super::methods::{instances, median};
use super::scenes::{self, APART, BenchScene, FOV};
use crate::report::Reporter;

/// Height (µm) of the flight above the somata.
const HEIGHT: f64 = 60.0;
/// Nearest (µm) that is drawn.
const NEAR: f64 = 1.0;

/// The JSON document.
#[derive(Serialize)]
struct Document<'a> {
    adapter: &'a str,
    backend: &'a str,
    software: bool,
    size: [u32; 2],
    budget: u32,
    neurons: u32,
    /// Tracing points of all neurons.
    points: u64,
    /// Bytes of all neurons, and how many of them the device may hold.
    bytes: u64,
    memory: u64,
    frames: u32,
    whole: Flight,
    streamed: Flight,
    /// Median frame of the flight that streams, divided by that of the flight that does not.
    ratio: f64,
}

/// A flight's figures (ms).
#[derive(Clone, Copy, Debug, Serialize)]
struct Flight {
    median: f64,
    slowest: f64,
    /// Of all neurons, at the end of the flight.
    finer: Option<usize>,
    coarser: Option<usize>,
    /// Bytes that were uploaded during the flight.
    uploaded: u64,
}

/// Runs the benchmark.
pub(super) fn run(args: &StreamingArgs, reporter: &Reporter) -> anyhow::Result<()> {
    let gpu = Gpu::open(args.adapter.as_deref())?;
    let neurons = scenes::neurons(args.neurons, args.points);
    let proxies: Vec<Arc<Proxy>> = neurons
        .par_iter()
        .map(|neuron| Arc::new(Proxy::new(&neuron.mesh, &neuron.color_keys)))
        .collect();
    let scene = BenchScene::new(&neurons, args.neurons, args.size.0)?;
    drop(neurons);
    let bytes = proxies.iter().map(|proxy| proxy.bytes()).sum();
    let memory = (bytes as f64 * args.share) as u64;
    let fly = |memory: Option<u64>| fly(&gpu, &proxies, &scene, memory, args);
    let (whole, streamed) = (fly(None)?, fly(Some(memory))?);
    let document = Document {
        adapter: &gpu.adapter.name,
        backend: &gpu.adapter.backend,
        software: gpu.adapter.software,
        size: args.size.0,
        budget: args.budget,
        neurons: args.neurons,
        points: proxies.iter().map(|proxy| proxy.point_count() as u64).sum(),
        bytes,
        memory,
        frames: args.frames,
        whole,
        streamed,
        ratio: streamed.median / whole.median,
    };
    reporter.result(&table(&document));
    reporter.document(&document)
}

/// Flies over the scene, from one corner to the opposite one.
fn fly(
    gpu: &Gpu,
    proxies: &[Arc<Proxy>],
    scene: &BenchScene,
    memory: Option<u64>,
    args: &StreamingArgs,
) -> anyhow::Result<Flight> {
    let mut source = Exploration::new(gpu, 1)?;
    source.set_budget(args.budget);
    let ids = source.add_streamed(gpu, proxies, memory)?;
    source.set_instances(gpu, instances(scene, &ids))?;
    let mut meter = Meter::new(gpu, &source, &scenes::colors())?;
    // The first picture uploads what its place needs, and makes pipelines.
    meter.time(&mut source, &frame(0.0, args)?)?;
    let uploaded = |streamed: Option<StreamedTemplates>| streamed.map_or(0, |s| s.uploaded);
    let before = uploaded(source.stats(gpu)?.streamed);
    let mut times = Vec::new();
    for step in 1..=args.frames {
        let frame = frame(f64::from(step) / f64::from(args.frames), args)?;
        times.push(meter.time(&mut source, &frame)?.waited_ms);
    }
    let after = source.stats(gpu)?.streamed;
    Ok(Flight {
        slowest: times.iter().copied().fold(0.0, f64::max),
        median: median(times).unwrap_or(0.0),
        finer: after.map(|streamed| streamed.finer),
        coarser: after.map(|streamed| streamed.coarser),
        uploaded: uploaded(after) - before,
    })
}

/// The picture at a share of the way.
fn frame(share: f64, args: &StreamingArgs) -> anyhow::Result<Frame> {
    let half = f64::from(args.neurons).sqrt().ceil() * APART / 2.0;
    let along = DVec3::new(1.0, 0.0, 1.0) * std::f64::consts::FRAC_1_SQRT_2;
    let eye = along * (2.0 * share - 1.0) * half * 2_f64.sqrt() + DVec3::Y * HEIGHT;
    let target = eye + along * 4.0 * HEIGHT - DVec3::Y * HEIGHT;
    let camera = Camera::new(eye, target, DVec3::Y, FOV)?;
    Ok(Frame::whole(camera, NEAR, args.size.0))
}

fn table(document: &Document<'_>) -> String {
    let Document {
        adapter,
        backend,
        size: [width, height],
        budget,
        neurons,
        points,
        bytes,
        memory,
        frames,
        ratio,
        ..
    } = document;
    let mut text = format!(
        "{adapter} ({backend}), {width}x{height} pixels, budget {budget} triangles\n\
         {neurons} distinct neurons of {points} points: {:.1} MiB, of which {:.1} are allowed; {frames} frames\n\n\
         {:<10} {:>10} {:>11} {:>13} {:>8} {:>8}\n",
        mib(*bytes),
        mib(*memory),
        "",
        "median ms",
        "slowest ms",
        "uploaded MiB",
        "finer",
        "coarser"
    );
    for (name, flight) in [
        ("all there", document.whole),
        ("streamed", document.streamed),
    ] {
        let count = |n: Option<usize>| n.map_or("-".into(), |n| n.to_string());
        text += &format!(
            "{name:<10} {:>10.2} {:>11.2} {:>13.1} {:>8} {:>8}\n",
            flight.median,
            flight.slowest,
            mib(flight.uploaded),
            count(flight.finer),
            count(flight.coarser)
        );
    }
    text + &format!("\nstreamed / all there: {ratio:.2}")
}

fn mib(bytes: u64) -> f64 {
    bytes as f64 / f64::from(1 << 20)
}
