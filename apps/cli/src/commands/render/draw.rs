//! Draws all pictures of a job, and writes them band by band.

use std::io::BufWriter;
use std::path::Path;

use itertools::Itertools;
use neurotess::picture::overlay::{Overlay, OverlayOptions};
use neurotess::picture::{
    BoundingSphere, Camera, Image, Look, Occlusion, PictureOptions, PngWriter, Viewpoint,
};

use super::args::RenderArgs;
use super::cameras;
use super::coloring::PictureColors;
use super::film::FixedFilm;
use super::job::RenderJob;
use super::meshes::SceneMeshes;
use super::painter::{self, Cost, Painter, SourceStats};
use super::stats::{Stage, Stages, Stats};
use super::values::Fit;
use crate::io::output::{self, OutputError};
use crate::report::{Progress, Reporter, count};

/// Width (pixels) of the lines of a wireframe.
const WIRE: f32 = 1.0;

/// Legend and scale bar, and the cameras. If the legend would cover something, the camera is
/// changed to make room for it, if possible.
pub(super) fn overlay(
    args: &RenderArgs,
    colored: &PictureColors,
    cameras: Vec<Camera>,
    spheres: &[BoundingSphere],
) -> (Overlay, Vec<Camera>) {
    let options = OverlayOptions {
        legend: (!args.no_legend).then(|| colored.legend(0)),
        scale_bar: args.scale_bar.map(|bar| match bar {
            Fit::Auto => 0.0,
            Fit::Length(length) => length,
        }),
        axes: args.axes,
        background: args.background(),
    };
    let refitted = |margins| cameras::refitted(args, spheres, margins);
    Overlay::with_room(&options, args.size.0, cameras, spheres, refitted)
}

pub(super) fn draw(
    job: &RenderJob<'_>,
    meshes: SceneMeshes,
    stages: &mut Stages,
    reporter: &Reporter,
) -> anyhow::Result<Stats> {
    let RenderJob {
        args,
        placements,
        colored,
        cameras,
        around,
        overlay,
        files,
        ..
    } = *job;
    let shown = job.shown();
    let options = picture_options(args, colored.least_width());
    if options.samples_taken() != args.samples {
        let taken = options.samples_taken();
        reporter.warning(&format!("{} samples: {taken} are taken", args.samples));
    }
    if overlay.legend_left_out {
        reporter.warning("the legend is left out: it needs a larger --size, or use --no-legend");
    }
    let device = Painter::device(&painter::open, job)?;
    stages.end(Stage::Adapter);
    let mut painter = Painter::new(device, &options, job, meshes)?;
    if painter.software && painter.is_adapter() {
        let [name, _] = &painter.name;
        reporter.note(&format!("drawn by the processor: {name}"));
    }
    stages.end(Stage::Upload);
    let mut film = FixedFilm::new(&mut painter, &shown, (cameras, around), &options)?;
    let mut stats = Stats::new(&painter, placements.len());
    let mut counted = SourceStats::default();
    let progress = Progress::new(reporter, files.len(), "pictures");
    for (number, (camera, file)) in cameras.iter().zip_eq(files).enumerate() {
        let view = Viewpoint {
            camera: *camera,
            near: camera.near(around),
        };
        let legend = colored.legend(number);
        let overlay = overlay.again((!args.no_legend).then_some(&legend), camera);
        let cost = write(file, args, |take| {
            let mut lay = |top: u32, mut band: Image| {
                overlay.lay_on(top, &mut band);
                take(&band).map_err(anyhow::Error::from)
            };
            if let Some(film) = &mut film {
                let (picture, cost) = film.picture(colored, number)?;
                lay(0, picture)?;
                return Ok(cost);
            }
            let (table, _) = colored.picture(number)?;
            painter.draw(&shown, &view, &table, &options, &mut lay)
        })?;
        // Every picture of a film shows the same surface.
        if film.is_none() || number == 0 {
            counted = painter.stats(&view, &options)?;
        }
        stats.add(&cost, counted.clone());
        stats.film = film.as_ref().map(FixedFilm::stats);
        let left_out = [stats.lowered(), stats.coarsened(), stats.thinned()];
        for left_out in left_out.iter().flatten() {
            reporter.warning(left_out);
        }
        progress.done();
    }
    drop(progress);
    reporter.note(&count(files.len(), "picture"));
    Ok(stats)
}

/// `least_width`: of neurites (pixels).
pub(super) fn picture_options(args: &RenderArgs, least_width: f32) -> PictureOptions {
    PictureOptions {
        size: args.size.0,
        samples: args.samples,
        background: args.background(),
        look: Look {
            light: args.light.0,
            wire: if args.wireframe { WIRE } else { 0.0 },
            contrast: args.background(),
            least_width,
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

/// Writes a picture band by band. The file appears whole or not at all.
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
