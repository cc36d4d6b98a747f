//! `neurotess render`: pictures of cells and circuits, without a window.
//!
//! ```text
//! arguments ─read, mesh─▶ cells, places ─▶ cameras, coloring, maker ─paint─▶ bands ─▶ PNG, stats
//! ```

mod args;
mod cameras;
mod cells;
mod circuit_instances;
mod coloring;
mod scene;
mod stats;
mod times;
mod values;
mod vertex_source;

use std::io::BufWriter;
use std::path::{Path, PathBuf};

use anyhow::Context;
use neurotess::render::{
    BoundingSphere, Camera, Cost, Gpu, Image, Look, Occlusion, Overlay, OverlayOptions,
    PictureOptions, Placement, PngWriter, StillRenderer,
};

use crate::io::output::{self, OutputError};
use crate::report::{Entry, Failure, Progress, Reporter, count, usage};
use args::ColorBy;
pub(crate) use args::RenderArgs;
use cells::Cell;
use coloring::Colored;
use scene::Cast;
use stats::{Stage, Stages, Stats};
use values::Fit;
use vertex_source::Maker;

/// Width (pixels) of the lines of a wireframe.
const WIRE: f32 = 1.0;

/// Runs the command.
pub(crate) fn run(args: &RenderArgs, reporter: &Reporter) -> anyhow::Result<()> {
    output::reserve_standard(&args.out, reporter)?;
    let files = files(args)?;
    vertex_source::mode(args)?;
    for file in files.iter().chain(&args.stats) {
        output::check(file, args.force)?;
    }
    if let [session] = &args.inputs[..]
        && neurotess_viewer::session::is_session(session)
    {
        return draw_session(session, &files, args, reporter);
    }
    check_value(args)?;
    let mut stages = Stages::begin();
    let Cast {
        entries,
        places,
        shown,
    } = scene::cast(args, reporter)?;
    stages.end(Stage::Read);
    let cells: Vec<&Cell> = entries
        .iter()
        .filter_map(|entry| match entry {
            Entry::Done(cell) => Some(cell),
            Entry::Failed(_) => None,
        })
        .collect();
    if places.is_empty() {
        return reporter.document(&stats::Document::new(&entries, &[], None));
    }
    let balls = scene::balls(&cells, &places);
    let cameras = cameras::cameras(args, &balls)?;
    stages.end(Stage::Frame);
    let gpu = Gpu::open(args.adapter.as_deref())?;
    stages.end(Stage::Adapter);
    if gpu.adapter.software {
        reporter.note(&format!("drawn by the processor: {}", gpu.adapter));
    }
    let stand: Vec<usize> = places.iter().map(|&(cell, _)| cell).collect();
    let colored = coloring::colored(&cells, shown.as_ref(), &stand, args, reporter)?;
    let (overlay, cameras) = overlay(args, &colored, cameras, &balls);
    let sitting = Sitting {
        args,
        cells: &cells,
        places: &places,
        colored: &colored,
        cameras: &cameras,
        balls: &balls,
        overlay: &overlay,
        files: &files,
    };
    stages.end(Stage::Frame);
    let mut stats = draw(&gpu, &sitting, &mut stages, reporter)?;
    stages.end(Stage::Draw);
    stats.took(stages);
    if let Some(path) = &args.stats {
        let mut output = output::begin(path, args.force)?;
        serde_json::to_writer_pretty(output.file(), &stats).context("stats")?;
        output.finish()?;
    }
    for file in &files {
        reporter.result(&format!("{}: {}", file.display(), stats.line()));
    }
    reporter.document(&stats::Document::new(&entries, &files, Some(&stats)))
}

/// A session of the window: its own view and look, at the size and smoothness that are asked for.
fn draw_session(
    session: &Path,
    files: &[PathBuf],
    args: &RenderArgs,
    reporter: &Reporter,
) -> anyhow::Result<()> {
    let [out] = files else {
        return usage("a session is one picture: leave out --turntable and times");
    };
    let picture = neurotess_viewer::save::PictureFile {
        out: out.clone(),
        size: args.size.0,
        samples: args.samples,
        transparent: args.transparent,
        replace: args.force,
    };
    let drawn = neurotess_viewer::draw_session(session, &picture, args.adapter.as_deref());
    let drawn = drawn.map_err(anyhow::Error::msg)?;
    for (file, why) in &drawn.failures {
        reporter.failure(&Failure(format!("{file}: {why}")));
    }
    reporter.result(&format!(
        "{}: {} of {}",
        out.display(),
        count(drawn.neurons, "neuron"),
        session.display()
    ));
    reporter.document(&stats::Document::new(&[], files, None))
}

/// Values come from a report, and a report gives nothing but values.
fn check_value(args: &RenderArgs) -> anyhow::Result<()> {
    match (args.color_by, &args.report) {
        (Some(ColorBy::Value), None) => usage("--color-by value needs a --report"),
        (Some(other), Some(_)) if other != ColorBy::Value => {
            usage("a --report gives values: leave out --color-by")
        }
        _ if args.range.is_some() && !args.is_number() => {
            usage("--range is for numbers: use --color-by order, radius or depth, or a --report")
        }
        _ => Ok(()),
    }
}

/// Names of the pictures.
fn files(args: &RenderArgs) -> anyhow::Result<Vec<PathBuf>> {
    let out = &args.out;
    let png = out
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("png"));
    if output::is_standard(out) {
        return match args.series()? {
            None => Ok(vec![out.clone()]),
            Some(_) => usage("standard output takes one picture: name a series OUT.png"),
        };
    }
    let Some(stem) = out.file_stem().filter(|_| png) else {
        return usage(format!(
            "{}: pictures are PNG files: name it OUT.png",
            out.display()
        ));
    };
    let Some(frames) = args.series()? else {
        return Ok(vec![out.clone()]);
    };
    let stem = stem.to_string_lossy();
    let name = |frame| out.with_file_name(format!("{stem}_{frame:04}.png"));
    Ok((0..frames).map(name).collect())
}

/// Legend and scale bar, and the cameras: where the legend would cover something, the scene makes
/// room for it if it can.
fn overlay(
    args: &RenderArgs,
    colored: &Colored,
    mut cameras: Vec<Camera>,
    balls: &[BoundingSphere],
) -> (Overlay, Vec<Camera>) {
    let options = OverlayOptions {
        legend: (!args.no_legend).then(|| colored.coloring.legend.clone()),
        scale_bar: args.scale_bar.map(|bar| match bar {
            Fit::Auto => 0.0,
            Fit::Length(length) => length,
        }),
        background: (!args.transparent).then_some(args.background.0),
    };
    let mut overlay = Overlay::new(&options, args.size.0, &cameras, balls);
    let beside = overlay
        .covering
        .and_then(|share| cameras::beside(args, balls, share));
    if let Some(camera) = beside {
        cameras = vec![camera];
        overlay = Overlay::new(&options, args.size.0, &cameras, balls);
    }
    (overlay, cameras)
}

/// What is drawn, from where, and into which files.
struct Sitting<'a> {
    args: &'a RenderArgs,
    cells: &'a [&'a Cell],
    places: &'a [(usize, Placement)],
    colored: &'a Colored,
    cameras: &'a [Camera],
    balls: &'a [BoundingSphere],
    overlay: &'a Overlay,
    files: &'a [PathBuf],
}

fn draw(
    gpu: &Gpu,
    sitting: &Sitting<'_>,
    stages: &mut Stages,
    reporter: &Reporter,
) -> anyhow::Result<Stats> {
    let Sitting {
        args,
        places,
        colored,
        cameras,
        balls,
        overlay,
        files,
        ..
    } = *sitting;
    let options = picture_options(args);
    if options.samples_taken() != args.samples {
        let taken = options.samples_taken();
        reporter.warning(&format!("{} samples: {taken} are taken", args.samples));
    }
    if overlay.legend_left_out {
        reporter.warning("the legend is left out: it needs a larger --size, or use --no-legend");
    }
    let mut maker = Maker::new(gpu, &options, sitting)?;
    let mut studio = StillRenderer::new();
    stages.end(Stage::Upload);
    let mut stats = Stats::new(gpu, places.len());
    let progress = Progress::new(reporter, files.len(), "pictures");
    for (number, (camera, file)) in cameras.iter().zip(files).enumerate() {
        let near = camera.near(balls);
        let (table, legend) = colored.picture(number)?;
        let overlay = overlay.again((!args.no_legend).then_some(&legend), camera);
        let cost = write(file, args, |take| {
            let lay = |top: u32, mut band: Image| {
                overlay.lay_on(top, &mut band);
                take(&band)
            };
            studio
                .paint(gpu, maker.as_maker(), camera, near, &table, &options, lay)
                .map_err(|e| anyhow::anyhow!("{e}"))
        })?;
        stats.add(&cost, maker.made(gpu, camera, near, &options)?);
        if let Some(lowered) = stats.lowered() {
            reporter.warning(&lowered);
        }
        progress.done();
    }
    drop(progress);
    reporter.note(&count(files.len(), "picture"));
    Ok(stats)
}

fn picture_options(args: &RenderArgs) -> PictureOptions {
    PictureOptions {
        size: args.size.0,
        samples: args.samples,
        background: (!args.transparent).then_some(args.background.0),
        look: Look {
            light: args.light.0,
            wire: if args.wireframe { WIRE } else { 0.0 },
            contrast: (!args.transparent).then_some(args.background.0),
            ..Look::default()
        },
        occlusion: match args.ao {
            None | Some(Fit::Auto) => Occlusion::Fit,
            Some(Fit::Length(0.0)) => Occlusion::Off,
            Some(Fit::Length(radius)) => Occlusion::Within(radius as f32),
        },
        ..PictureOptions::default()
    }
}

/// Writes a picture as its bands come; it appears whole or not at all.
fn write(
    path: &Path,
    args: &RenderArgs,
    paint: impl FnOnce(&mut dyn FnMut(&Image) -> Result<(), OutputError>) -> anyhow::Result<Cost>,
) -> anyhow::Result<Cost> {
    let mut output = output::begin(path, args.force)?;
    let file = output
        .file()
        .try_clone()
        .map_err(|e| OutputError::broken(path, e))?;
    let fault = |e: std::io::Error| OutputError::broken(path, e);
    let mut png =
        PngWriter::new(BufWriter::new(file), args.size.0, args.transparent).map_err(fault)?;
    let cost = paint(&mut |band| png.write(band).map_err(fault))?;
    png.finish().map_err(fault)?;
    output.finish()?;
    Ok(cost)
}
