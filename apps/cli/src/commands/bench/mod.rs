//! `neurotess bench`: benchmarks that anyone can repeat.
//!
//! `refinement` repeats the experiment of García-Cantero et al. (Frontiers in Neuroinformatics
//! 2017, figure 15): scenes of several sizes drawn with rising levels in three ways, and beyond it
//! by the error in pixels and with thousands of neurons. `exploration` draws such scenes within a
//! budget. `static` colors pictures of them anew instead of drawing them anew. `opening` opens a circuit with its
//! cache and without. `streaming` flies past neurons that do not fit. `adapter` says what all of that is drawn with.

mod adapter;
mod args;
mod exploration;
mod methods;
mod opening;
mod plot;
mod recoloring;
mod scenes;
mod streaming;
mod verdict;

use std::path::Path;

use anyhow::Context;
use neurotess::render::Gpu;
use serde::Serialize;

use crate::io::output::{Output, OutputError, existing};
use crate::report::Reporter;
pub(crate) use args::BenchArgs;
use args::{Bench, RefinementArgs};
use methods::{Method, MethodTimer, Row};
use scenes::{BenchScene, Neuron};
use verdict::{Ratio, ratios};

/// The JSON document.
#[derive(Serialize)]
struct Document<'a> {
    adapter: &'a str,
    backend: &'a str,
    software: bool,
    size: [u32; 2],
    distinct: usize,
    /// Tracing points per neuron, on average.
    tracing_points: f64,
    patches: f64,
    pixels: f64,
    /// Whether times are the GPU's or times waited.
    gpu_times: bool,
    rows: Vec<Row>,
    growth: Vec<Row>,
    ratios: Vec<Ratio>,
}

/// Runs the command.
pub(crate) fn run(args: &BenchArgs, reporter: &Reporter) -> anyhow::Result<()> {
    match &args.name {
        Bench::Refinement(args) => refinement(args, reporter),
        Bench::Exploration(args) => exploration::run(args, reporter),
        Bench::Static(args) => recoloring::run(args, reporter),
        Bench::Opening(args) => opening::run(args, reporter),
        Bench::Streaming(args) => streaming::run(args, reporter),
        Bench::Adapter(args) => adapter::run(args, reporter),
    }
}

fn refinement(args: &RefinementArgs, reporter: &Reporter) -> anyhow::Result<()> {
    if let Some(folder) = &args.out {
        for name in [JSON, SVG] {
            existing(args.force).check(&folder.join(name))?;
        }
    }
    let gpu = Gpu::open(args.adapter.as_deref())?;
    let neurons = scenes::neurons(args.distinct, args.points);
    let mean = |count: fn(&Neuron) -> usize| {
        neurons.iter().map(count).sum::<usize>() as f64 / neurons.len() as f64
    };
    let document = Document {
        adapter: &gpu.adapter.name,
        backend: &gpu.adapter.backend,
        software: gpu.adapter.software,
        size: args.size.0,
        distinct: neurons.len(),
        tracing_points: mean(|n| n.mesh.tracing.len()),
        patches: mean(|n| n.mesh.patches.len()),
        pixels: args.pixels,
        gpu_times: false,
        rows: Vec::new(),
        growth: Vec::new(),
        ratios: Vec::new(),
    };
    reporter.result(&format!(
        "{} ({}), {}x{} pixels\n{} distinct neurons of {:.0} tracing points and {:.0} patches",
        document.adapter,
        document.backend,
        document.size[0],
        document.size[1],
        document.distinct,
        document.tracing_points,
        document.patches
    ));
    let timer = MethodTimer {
        gpu: &gpu,
        args,
        neurons: &neurons,
        colors: scenes::colors(),
    };
    let rows = levels(&timer, reporter)?;
    let growth = growth(&timer, reporter)?;
    let ratios = ratios(&rows);
    reporter.result(&format!("\n{}", Ratio::head()));
    for ratio in &ratios {
        reporter.result(&ratio.line());
    }
    let document = Document {
        gpu_times: rows.iter().any(|row| row.choose_ms.is_some()),
        rows,
        growth,
        ratios,
        ..document
    };
    if let Some(folder) = &args.out {
        let text = serde_json::to_string_pretty(&document)?;
        write(&folder.join(JSON), &text, args)?;
        write(&folder.join(SVG), &plot::svg(&document.rows), args)?;
        reporter.result(&format!("\n{JSON} and {SVG} are in {}", folder.display()));
    }
    reporter.document(&document)
}

const JSON: &str = "refinement.json";
const SVG: &str = "refinement.svg";

/// Times all scenes at all levels by all methods.
fn levels(timer: &MethodTimer<'_>, reporter: &Reporter) -> anyhow::Result<Vec<Row>> {
    let mut rows = Vec::new();
    let args = timer.args;
    for &count in &args.neurons {
        let scene = BenchScene::new(timer.neurons, count, args.size.0)?;
        let mut source = timer.on_the_fly(&scene)?;
        reporter.result(&format!("\n{}", head(count)));
        for &level in &args.levels {
            let of_level = (count, level);
            match timer.prerefined(&scene, level)? {
                Some(row) => tell(&mut rows, row, reporter),
                None => reporter.warning(&left_out(timer, of_level)),
            }
            for method in [Method::Homogeneous, Method::Adaptive] {
                let way = (method, Some(level));
                tell(
                    &mut rows,
                    timer.refined(&mut source, &scene, way, true)?,
                    reporter,
                );
            }
        }
        let way = (Method::PixelError, None);
        tell(
            &mut rows,
            timer.refined(&mut source, &scene, way, true)?,
            reporter,
        );
        tell(&mut rows, timer.prerefined_by_error(&scene)?, reporter);
    }
    Ok(rows)
}

/// Times adaptive refinement in ever larger scenes.
fn growth(timer: &MethodTimer<'_>, reporter: &Reporter) -> anyhow::Result<Vec<Row>> {
    let mut rows = Vec::new();
    for &count in &timer.args.grow {
        let scene = BenchScene::new(timer.neurons, count, timer.args.size.0)?;
        let mut source = timer.on_the_fly(&scene)?;
        if rows.is_empty() {
            reporter.result("\nby the error in pixels, ever more neurons");
        }
        // Lists of millions of patches are not read back.
        let counted = count <= 1000;
        let way = (Method::PixelError, None);
        tell(
            &mut rows,
            timer.refined(&mut source, &scene, way, counted)?,
            reporter,
        );
    }
    Ok(rows)
}

fn left_out(timer: &MethodTimer<'_>, (count, level): (u32, u32)) -> String {
    let used = timer.neurons.len().min(count as usize);
    let triangles: usize = timer.neurons[..used]
        .iter()
        .map(|n| n.triangles(level))
        .sum();
    format!(
        "{count} neurons stored at level {level} ({triangles} triangles) need more than {} MiB: \
         left out (--memory allows more)",
        timer.args.memory
    )
}

fn head(count: u32) -> String {
    format!(
        "{:<24} {:>5} {:>10} {:>10} {:>12} {:>10}",
        format!("neurons: {count}"),
        "level",
        "frame ms",
        "waited ms",
        "triangles",
        "MiB"
    )
}

fn tell(rows: &mut Vec<Row>, row: Row, reporter: &Reporter) {
    let method = match row.method {
        Method::Prerefined => "pre-refined",
        Method::Homogeneous => "homogeneous",
        Method::Adaptive => "adaptive",
        Method::PixelError => "error in pixels",
        Method::PrerefinedPixelError => "the same, pre-refined",
    };
    let level = row.level.map_or("-".into(), |level| level.to_string());
    let triangles = match row.triangles {
        0 => "-".into(),
        n => n.to_string(),
    };
    reporter.result(&format!(
        "{:<24} {level:>5} {:>10.2} {:>10.2} {triangles:>12} {:>10.2}",
        format!("{method} x {}", row.neurons),
        row.ms,
        row.waited_ms,
        row.bytes as f64 / f64::from(1 << 20)
    ));
    rows.push(row);
}

fn write(path: &Path, text: &str, args: &RefinementArgs) -> anyhow::Result<()> {
    use std::io::Write;
    let mut output = Output::create(path, existing(args.force))?;
    let written = output.file().write_all(text.as_bytes());
    written.map_err(|e| OutputError::broken(path, e))?;
    output.finish().context("a benchmark's figures")
}
