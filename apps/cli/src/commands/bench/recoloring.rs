//! Further pictures of a recording from a fixed camera: drawn anew, and by coloring a static picture anew.

use std::convert::Infallible;
use std::time::Instant;

use neurotess::render::color::{ColorMap, ColorTable, InstanceValues};
use neurotess::render::{
    Exploration, Gpu, Image, KeyColors, PictureOptions, Proxy, StaticPicture, StillRenderer,
    VertexSource, Viewpoint, VisibleKey,
};
use rayon::prelude::*;
use serde::Serialize;

use super::args::StaticArgs;
use super::methods::{instances, median};
use super::scenes::{self, BenchScene, Neuron};
use crate::report::Reporter;

/// The JSON document.
#[derive(Serialize)]
struct Document<'a> {
    adapter: &'a str,
    backend: &'a str,
    software: bool,
    size: [u32; 2],
    samples: u32,
    budget: u32,
    distinct: usize,
    rows: Vec<Row>,
}

/// A scene's figures: medians (ms), and sizes.
#[derive(Clone, Debug, Serialize)]
struct Row {
    neurons: u32,
    /// Values of all compartments, one for each tracing point.
    values: u64,
    /// A picture of other values, drawn anew.
    drawn_ms: f64,
    /// Making the static picture.
    made_ms: f64,
    /// A picture of other values, colored anew and read back.
    recolored_ms: f64,
    /// Color keys that show, and weights.
    keys: usize,
    weights: usize,
    bytes: u64,
    /// Time of drawing a picture anew, divided by that of coloring it anew.
    ratio: f64,
}

/// Runs the benchmark.
pub(super) fn run(args: &StaticArgs, reporter: &Reporter) -> anyhow::Result<()> {
    let gpu = Gpu::open(args.adapter.as_deref())?;
    let neurons = scenes::neurons(args.distinct, args.points);
    let proxies: Vec<Proxy> = neurons
        .par_iter()
        .map(|neuron| Proxy::new(&neuron.mesh, &of_points(neuron)))
        .collect();
    let options = PictureOptions {
        size: args.size.0,
        samples: args.samples,
        ..PictureOptions::default()
    };
    let mut source = Exploration::new(&gpu, gpu.sub_pixels(&options))?;
    source.set_budget(args.budget);
    let ids = source.add(&gpu, &proxies)?;
    let mut document = Document {
        adapter: &gpu.adapter.name,
        backend: &gpu.adapter.backend,
        software: gpu.adapter.software,
        size: args.size.0,
        samples: options.samples_taken(),
        budget: args.budget,
        distinct: neurons.len(),
        rows: Vec::new(),
    };
    reporter.result(&head(&document));
    // All scenes are seen by the camera of the first, so that their neurons have the same size.
    let mut view = None;
    for &count in &args.neurons {
        let scene = BenchScene::new(&neurons, count, args.size.0)?;
        source.set_instances(&gpu, instances(&scene, &ids))?;
        let camera = scene.frame.camera;
        let near = scene.frame.near;
        let view = *view.get_or_insert(Viewpoint { camera, near });
        let row = row(&gpu, &mut source, &view, &options, (&neurons, &scene), args)?;
        reporter.result(&line(&row));
        document.rows.push(row);
    }
    reporter.document(&document)
}

/// Times one scene.
fn row(
    gpu: &Gpu,
    source: &mut Exploration,
    view: &Viewpoint,
    options: &PictureOptions,
    (neurons, scene): (&[Neuron], &BenchScene),
    args: &StaticArgs,
) -> anyhow::Result<Row> {
    let mut renderer = StillRenderer::new();
    let table = |frame: u32| ColorTable {
        scale: ColorMap::Viridis.scale(),
        categories: vec![[128; 3]],
        values: all_values(neurons, scene, frame),
    };
    // The first picture also makes pipelines.
    draw(gpu, &mut renderer, source, view, &table(0), options)?;
    let mut drawn = Vec::new();
    for frame in 1..=args.drawn {
        let table = table(frame);
        let clock = Instant::now();
        draw(gpu, &mut renderer, source, view, &table, options)?;
        drawn.push(ms(clock));
    }
    let table = table(0);
    let clock = Instant::now();
    let picture = renderer.render_static(gpu, source, view, &table, options)?;
    let made_ms = ms(clock);
    let mut recolored = Vec::new();
    for frame in 0..=args.frames {
        let values = visible_values(&picture, frame);
        let clock = Instant::now();
        recolor(gpu, &picture, &table, &values)?;
        // The first makes pipelines.
        if frame > 0 {
            recolored.push(ms(clock));
        }
    }
    let drawn_ms = median(drawn).unwrap_or(0.0);
    let recolored_ms = median(recolored).unwrap_or(0.0);
    let points = scene
        .placements
        .iter()
        .map(|&(neuron, _)| neurons[neuron].mesh.tracing.len() as u64);
    Ok(Row {
        neurons: scene.placements.len() as u32,
        values: points.sum(),
        drawn_ms,
        made_ms,
        recolored_ms,
        keys: picture.keys().len(),
        weights: picture.weights(),
        bytes: picture.bytes(),
        ratio: drawn_ms / recolored_ms,
    })
}

/// Color keys of a neuron: the index of each tracing point, whose value is in the table.
fn of_points(neuron: &Neuron) -> Vec<u32> {
    (0..neuron.mesh.tracing.len() as u32).collect()
}

/// A value that differs from point to point, and from frame to frame.
fn value(instance: u32, point: u32, frame: u32) -> f32 {
    let mixed = instance
        .wrapping_mul(0x9e37_79b9)
        .wrapping_add(point.wrapping_mul(0x85eb_ca6b))
        .wrapping_add(frame.wrapping_mul(0xc2b2_ae35));
    (mixed >> 8) as f32 / (1 << 24) as f32
}

fn all_values(neurons: &[Neuron], scene: &BenchScene, frame: u32) -> InstanceValues {
    let mut values = InstanceValues::default();
    let mut own = Vec::new();
    for (&(neuron, _), instance) in scene.placements.iter().zip(0..) {
        let points = 0..neurons[neuron].mesh.tracing.len() as u32;
        own.clear();
        own.extend(points.map(|point| value(instance, point, frame)));
        values.push(&own);
    }
    values
}

fn visible_values(picture: &StaticPicture, frame: u32) -> Vec<f32> {
    let of_key = |key: &VisibleKey| value(key.instance, key.color_key, frame);
    picture.keys().iter().map(of_key).collect()
}

fn draw(
    gpu: &Gpu,
    renderer: &mut StillRenderer,
    source: &mut dyn VertexSource,
    view: &Viewpoint,
    table: &ColorTable,
    options: &PictureOptions,
) -> anyhow::Result<()> {
    let take = |_, _: Image| Ok::<(), Infallible>(());
    renderer.render(gpu, source, view, table, options, take)?;
    Ok(())
}

fn recolor(
    gpu: &Gpu,
    picture: &StaticPicture,
    table: &ColorTable,
    values: &[f32],
) -> anyhow::Result<Image> {
    let colors = KeyColors {
        table,
        states: &[],
        values: Some(values),
    };
    picture.recolor(gpu, &colors)?;
    Ok(picture.image(gpu)?)
}

fn ms(clock: Instant) -> f64 {
    clock.elapsed().as_secs_f64() * 1e3
}

fn head(document: &Document<'_>) -> String {
    let Document {
        adapter,
        backend,
        size: [width, height],
        samples,
        budget,
        distinct,
        ..
    } = document;
    format!(
        "{adapter} ({backend}), {width}x{height} pixels of {samples} samples, budget {budget} \
         triangles, {distinct} distinct neurons\n\n\
         {:>8} {:>11} {:>10} {:>10} {:>13} {:>10} {:>10} {:>8} {:>7}",
        "neurons",
        "values",
        "drawn ms",
        "made ms",
        "recolored ms",
        "keys",
        "weights",
        "MiB",
        "ratio"
    )
}

fn line(row: &Row) -> String {
    format!(
        "{:>8} {:>11} {:>10.1} {:>10.1} {:>13.2} {:>10} {:>10} {:>8.1} {:>7.1}",
        row.neurons,
        row.values,
        row.drawn_ms,
        row.made_ms,
        row.recolored_ms,
        row.keys,
        row.weights,
        row.bytes as f64 / f64::from(1 << 20),
        row.ratio
    )
}
