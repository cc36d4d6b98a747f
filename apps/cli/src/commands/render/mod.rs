//! `neurotess render`: pictures of cells and circuits, without a window.
//!
//! ```text
//! arguments ─read, mesh─▶ cells, placements ─▶ cameras, colors, source ─draw─▶ bands ─▶ PNG, stats
//! ```

mod args;
mod bounds;
mod cameras;
mod cells;
mod checks;
mod circuit_instances;
mod color_check;
mod coloring;
mod draw;
mod film;
mod in_memory;
mod job;
pub(crate) mod markers;
mod meshes;
mod painter;
mod palette;
mod scene;
mod session;
mod shown;
mod stats;
mod times;
mod values;

use std::io;

use neurotess::coloring::MarkerSet;
use neurotess::output::write_into;

use crate::io::output;
use crate::report::{Entry, Reporter, usage};
pub(crate) use args::RenderArgs;
pub(crate) use cells::MeshedCell;
pub use in_memory::{DrawError, Drawing, DrawingColors, DrawingInput, Picked};
use job::RenderJob;
use meshes::SceneMeshes;
pub use painter::{Device, Open};
pub use palette::palette;
pub(crate) use scene::RenderScene;
use stats::{Stage, Stages};
// What pages share.
#[cfg(feature = "gpu")]
pub(crate) use {
    args::{ColorBy, color_maps, range},
    circuit_instances::CircuitInstances,
    coloring::{by, stem, tell_unused_types},
    palette::{PaletteArg, PaletteParser, SetColor},
    scene::read as read_scene,
    times::times,
    values::RgbArg,
};

/// Runs the command.
pub(crate) fn run(args: &RenderArgs, reporter: &Reporter) -> anyhow::Result<()> {
    output::reserve_standard(&args.out, reporter)?;
    let files = checks::files(args)?;
    shown::mode(args)?;
    for file in files.iter().chain(&args.stats) {
        output::check(file, args.force)?;
    }
    if let [path] = &args.inputs[..]
        && session::is_session(path)
    {
        return session::draw(path, &files, args, reporter);
    }
    if args.saved_view.is_some() {
        return usage("--saved-view is of a session: give the session's file");
    }
    checks::check_value(args)?;
    let mut stages = Stages::begin();
    let RenderScene {
        entries,
        placements,
        instances,
        cache,
    } = scene::read(args, reporter)?;
    let meshes = SceneMeshes::read(&args.meshes, reporter)?;
    stages.end(Stage::Read);
    let cells: Vec<&MeshedCell> = entries
        .iter()
        .filter_map(|entry| match entry {
            Entry::Done(cell) => Some(cell),
            Entry::Failed(_) => None,
        })
        .collect();
    if placements.is_empty() {
        return reporter.document(&stats::Document::new(&entries, &[], None));
    }
    let of_cells: Vec<usize> = placements.iter().map(|&(cell, _)| cell).collect();
    let shown_by = (instances.as_ref(), &of_cells[..]);
    let mut colored = coloring::of_pictures(&cells, shown_by, args, None, reporter)?;
    colored.add_meshes(&meshes, None, args)?;
    let mut spheres = bounds::spheres(&cells, &placements);
    spheres.extend(colored.markers.as_ref().and_then(MarkerSet::bounds));
    let around: Vec<_> = spheres.iter().copied().chain(meshes.points()).collect();
    spheres.extend(meshes.fitted());
    let cameras = cameras::cameras(args, &spheres)?;
    stages.end(Stage::Frame);
    let (overlay, cameras) = draw::overlay(args, &colored, cameras, &spheres);
    let job = RenderJob {
        args,
        cells: &cells,
        placements: &placements,
        colored: &colored,
        cameras: &cameras,
        #[cfg(feature = "gpu")]
        spheres: &spheres,
        around: &around,
        overlay: &overlay,
        files: &files,
    };
    stages.end(Stage::Frame);
    let mut stats = draw::draw(&job, meshes, &mut stages, reporter)?;
    stages.end(Stage::Draw);
    stats.took(stages);
    stats.cache = cache.map(Into::into);
    stats.colors = colored.closest.as_ref().map(Into::into);
    if let Some(path) = &args.stats {
        let output = output::begin(path, args.force)?;
        write_into(output, path, |to| {
            serde_json::to_writer_pretty(to, &stats).map_err(io::Error::from)
        })?;
    }
    for file in &files {
        reporter.result(&format!("{}: {}", file.display(), stats.line()));
    }
    reporter.document(&stats::Document::new(&entries, &files, Some(&stats)))
}
