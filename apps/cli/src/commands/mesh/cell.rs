//! One cell: read, generate, refine and write.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use glam::{DAffine3, DVec3};
use neurotess::circuit::soma_center;
use neurotess::formats::{self, ReadOptions};
use neurotess::mesh as surfaces;
use neurotess::recipe::{
    CellFiles, CellMesh, CellSurface, CrossingsReport, FileSurface, PartFile, Progress,
    SeparationReport, SmoothingReport, Stage, SurfaceWarning, Warning, Watch, WrittenFiles,
    mesh_watched,
};
use serde::Serialize;

use super::options::MeshOptions;
use super::warning::CellWarning;
use super::{areas, size, table};
use crate::io::claims::Claimed;
use crate::io::morphologies::read_morphology;
use crate::io::output::{Output, OutputError, begin, existing};
use crate::io::targets::Job;
use crate::report::{Failure, Progress as Bar, Reporter};

/// One object of the JSON list, and one line of the log.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct CellReport {
    pub(crate) file: String,
    pub(crate) out: String,
    /// The files that were written instead of `out`, one for each type.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) parts: Vec<PartFile>,
    /// The file of materials.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) materials: Option<String>,
    /// The cell's node, if it is of a circuit.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub(crate) node: Option<NodeName>,
    pub(crate) vertices: usize,
    pub(crate) triangles: usize,
    pub(crate) quads: usize,
    pub(crate) closed: bool,
    pub(crate) euler: i64,
    pub(crate) components: usize,
    /// Volume (µm³) of the written mesh; none if it is not measured.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) volume: Option<f64>,
    /// Area (µm²) of the written mesh; none if it is not measured.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) area: Option<f64>,
    /// Volume (µm³) and area (µm²) of the somata, as meshed and as traced; what neurites take is no part of the area.
    pub(crate) soma_volume: f64,
    pub(crate) soma_area: f64,
    pub(crate) soma_volume_traced: f64,
    pub(crate) soma_area_traced: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) smoothing: Option<SmoothingReport>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) crossings: Option<CrossingsReport>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) separation: Option<SeparationReport>,
    /// Shapes of the triangles.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) quality: Option<surfaces::Quality>,
    pub(crate) seconds: Seconds,
    pub(crate) warnings: Vec<CellWarning>,
}

/// A node of a circuit.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct NodeName {
    pub(crate) population: String,
    pub(crate) node_id: u64,
}

/// Seconds by stage.
///
/// Refining and writing are one streamed pass over all threads: `refine` is the planning and the
/// time of the blocks, divided by the number of threads; `write` is the rest of the pass.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub(crate) struct Seconds {
    pub(crate) read: f64,
    pub(crate) soma: f64,
    pub(crate) coarse: f64,
    pub(crate) refine: f64,
    pub(crate) write: f64,
    /// Topology, volume and area, for the report only.
    pub(crate) measure: f64,
}

/// A cell read and generated, to be written once or several times.
pub(crate) struct Prepared {
    file: String,
    meshed: CellMesh,
    read: Vec<formats::Warning>,
    seconds: Seconds,
    /// Center of the soma in the tracing's coordinates (µm).
    pub(crate) soma_center: DVec3,
}

impl Prepared {
    /// The surface that is written.
    pub(super) fn surface(&self, options: &MeshOptions) -> PlannedSurface<'_> {
        let clock = Instant::now();
        PlannedSurface {
            surface: self.meshed.surface_for(options.files.format),
            seconds: clock.elapsed().as_secs_f64(),
        }
    }
}

/// A surface, and how long it took to plan it.
pub(super) struct PlannedSurface<'m> {
    pub(super) surface: CellSurface<'m>,
    seconds: f64,
}

/// A cell in temporary files.
pub(super) struct Made {
    pub(super) report: CellReport,
    pub(super) files: CellFiles,
}

/// Generates the mesh of one cell and writes it, with the tables that are asked for.
pub(super) fn mesh(
    job: &Job,
    options: &MeshOptions,
    claimed: Claimed,
    watchers: Watchers<'_>,
) -> Result<Made, Failure> {
    let file = job.input.display();
    let failed = |e: OutputError| Failure(format!("{file}: {e}"));
    // Before the work: they may be in the way.
    let begun = |path: &Option<PathBuf>| -> Result<Option<(PathBuf, Output)>, Failure> {
        let path = path.as_ref();
        let begun = path.map(|path| Ok((path.clone(), begin(path, options.force)?)));
        begun.transpose().map_err(failed)
    };
    let (table, areas) = (begun(&options.table)?, begun(&options.areas)?);
    let prepared = prepare(&job.input, options)?;
    let surface = prepared.surface(options);
    let to = Target { job, claimed };
    let mut made = finish(&prepared, &surface, options, to, None, watchers)?;
    let (shown, morphology) = (surface.surface.surface(), &prepared.meshed.morphology);
    if let Some((path, mut table)) = table {
        let written = table::write(shown, morphology, table.file());
        written.map_err(|e| failed(OutputError::broken(&path, std::io::Error::other(e))))?;
        made.files.add(table);
    }
    if let Some((path, mut areas)) = areas {
        let written = areas::write(shown, morphology, areas.file());
        written.map_err(|e| failed(OutputError::broken(&path, std::io::Error::other(e))))?;
        made.files.add(areas);
    }
    Ok(made)
}

/// Where a cell goes.
pub(super) struct Target<'j> {
    pub(super) job: &'j Job,
    pub(super) claimed: Claimed,
}

/// What is informed while a cell is written.
#[derive(Clone, Copy)]
pub(super) struct Watchers<'t> {
    pub(super) reporter: &'t Reporter,
    /// Counts blocks of the surface.
    pub(super) progress: Option<&'t Bar<'t>>,
}

/// Reads a cell and generates its coarse mesh.
pub(crate) fn prepare(input: &Path, options: &MeshOptions) -> Result<Prepared, Failure> {
    let file = input.display().to_string();
    let mut seconds = Seconds::default();
    let clock = Instant::now();
    let read_options = ReadOptions {
        strict: options.strict,
        ..ReadOptions::default()
    };
    let read = read_morphology(input, None, &read_options)?;
    seconds.read = clock.elapsed().as_secs_f64();

    let clock = Instant::now();
    let tick = || clock.elapsed().as_secs_f64();
    let watch = Watch::default().with_clock(&tick);
    let morphology = Arc::new(read.morphology);
    let soma_center = soma_center(&morphology);
    let meshed = mesh_watched(morphology, &options.recipe, &watch)
        .map_err(|e| Failure(format!("{file}: {}", Failure::from(e).0)))?;
    seconds.soma = meshed.soma_seconds;
    let merging = meshed.merging_seconds;
    seconds.coarse = (clock.elapsed().as_secs_f64() - seconds.soma - merging).max(0.0);
    Ok(Prepared {
        file,
        meshed,
        soma_center,
        read: read.warnings,
        seconds,
    })
}

/// Writes a cell's surface, perhaps at a placement.
pub(super) fn finish(
    prepared: &Prepared,
    planned: &PlannedSurface<'_>,
    options: &MeshOptions,
    to: Target<'_>,
    world_from_cell: Option<DAffine3>,
    watchers: Watchers<'_>,
) -> Result<Made, Failure> {
    let Prepared { file, meshed, .. } = prepared;
    let mut seconds = prepared.seconds;
    seconds.refine = meshed.merging_seconds + planned.seconds;
    let cell_surface = &planned.surface;
    let out = &*to.job.out;
    let surface = FileSurface::new(cell_surface.surface(), &options.files, &Watch::default());
    let surface = surface.map_err(|e| Failure(format!("{file}: {e}")))?;
    let surface = surface.placed(world_from_cell);
    let coarse = &meshed.generated.mesh;
    let rounded = SurfaceWarning::of_rounding(coarse, options.files.format, world_from_cell);
    if let Some(SurfaceWarning::Rounded { at, by, radius }) =
        rounded.as_ref().filter(|r| r.is_lost())
    {
        return Err(Failure(format!(
            "{file}: at {at:.3e} µm, {} rounds by {by:.3e} µm, more than the radius of {radius:.3e} µm: correct its place, or \
             move it towards the origin",
            options.files.format
        )));
    }
    let written = write(&surface, options, to, watchers, &mut seconds);
    let written = written.map_err(|Failure(what)| Failure(format!("{file}: {what}")))?;
    let clock = Instant::now();
    let mesh = meshed.report_of(cell_surface);
    let growth = world_from_cell.map_or(1.0, |transform| transform.matrix3.determinant());
    let measured = options.measure.then(|| cell_surface.volume_and_area());
    let measured = measured.map(|(volume, area)| (growth * volume, growth.cbrt().powi(2) * area));
    seconds.measure = clock.elapsed().as_secs_f64();
    let of_file = prepared.read.iter().cloned().map(Warning::File);
    let of_walls = surface.warning().map(Warning::Surface);
    let cell = CellReport {
        file: file.clone(),
        out: out.display().to_string(),
        parts: written.parts,
        materials: options
            .files
            .materials_of(out)
            .map(|file| file.display().to_string()),
        node: None,
        vertices: written.vertices,
        triangles: written.triangles,
        quads: written.quads,
        closed: mesh.closed,
        euler: mesh.euler,
        components: mesh.components,
        volume: measured.map(|(volume, _)| volume),
        area: measured.map(|(_, area)| area),
        soma_volume: growth * mesh.soma_volume,
        soma_area: growth.cbrt().powi(2) * mesh.soma_area,
        soma_volume_traced: growth * mesh.soma_volume_traced,
        soma_area_traced: growth.cbrt().powi(2) * mesh.soma_area_traced,
        smoothing: mesh.smoothing,
        crossings: mesh.crossings,
        separation: mesh.separation,
        quality: mesh.quality,
        seconds,
        warnings: of_file
            .chain(mesh.warnings)
            .chain(of_walls)
            .chain(rounded.map(Warning::Surface))
            .map(|w| CellWarning::from(&w))
            .collect(),
    };
    Ok(Made {
        report: cell,
        files: written.files,
    })
}

fn write(
    surface: &FileSurface<'_>,
    options: &MeshOptions,
    to: Target<'_>,
    watchers: Watchers<'_>,
    seconds: &mut Seconds,
) -> Result<WrittenFiles, Failure> {
    let Target { job, claimed } = to;
    let clock = Instant::now();
    let tick = || clock.elapsed().as_secs_f64();
    let count = |told: Progress| {
        if let (Some(bar), Stage::Write) = (watchers.progress, told.stage) {
            match told.done {
                0 => bar.expect(told.all),
                _ => bar.done(),
            }
        }
    };
    let watch = Watch::default().with_clock(&tick).with_progress(&count);
    surface
        .with(|surface| size::tell(surface, options.files.format, &job.out, watchers.reporter))?;
    let written = surface
        .write(&job.out, claimed.output, existing(claimed.replace), &watch)
        .map_err(|e| Failure(e.to_string()))?;
    let pass = tick();
    let blocks = (written.block_seconds / rayon::current_num_threads() as f64).min(pass);
    seconds.refine += blocks;
    seconds.write = pass - blocks;
    Ok(written)
}
