//! One cell: read, generate, refine and write.

use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use glam::{DAffine3, DVec3};
use neurotess::circuit::soma_center;
use neurotess::formats::{self, ReadOptions};
use neurotess::generate::Generated;
use neurotess::mesh::{self as surfaces, InUnit, Placed, Surface, SurfaceMesh, Unit, Watched};
use neurotess::morphology::Morphology;
use serde::Serialize;

use super::files::{Files, PartReport, Target, broken};
use super::meshed::Meshed;
use super::observed::Observed;
use super::options::MeshOptions;
use super::smoothing::SmoothingReport;
use super::surface::{CellSurface, CrossingsReport, SeparationReport};
use super::warning::CellWarning;
use super::{size, table, verdict};
use crate::io::claims::Claimed;
use crate::io::morphologies::read_morphology;
use crate::io::output::{OutputError, begin};
use crate::io::targets::Job;
use crate::report::{Failure, Progress, Reporter};

/// One object of the JSON list, and one line of the log.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct CellReport {
    pub(crate) file: String,
    pub(crate) out: String,
    /// The files that were written instead of `out`, one for each type.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) parts: Vec<PartReport>,
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
    pub(crate) soma_volume: f64,
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
    meshed: Meshed,
    read: Vec<formats::Warning>,
    seconds: Seconds,
    /// The tracing, if a table is to tell where on it triangles are.
    morphology: Option<Morphology>,
    /// Center of the soma in the tracing's coordinates (µm).
    pub(crate) soma_center: DVec3,
}

impl Prepared {
    /// The surface that is written.
    pub(super) fn surface(&self, options: &MeshOptions) -> CellSurface<'_> {
        self.meshed.surface(options)
    }
}

/// A cell in temporary files.
pub(super) struct Made {
    pub(super) report: CellReport,
    pub(super) files: Files,
}

/// Generates the mesh of one cell and writes it, with its table if there is to be one.
pub(super) fn mesh(
    job: &Job,
    options: &MeshOptions,
    claimed: Claimed,
    watchers: Watchers<'_>,
) -> Result<Made, Failure> {
    let file = job.input.display();
    let failed = |e: OutputError| Failure(format!("{file}: {e}"));
    // Before the work: it may be in the way.
    let path = options.table.as_deref();
    let table = path.map(|path| begin(path, options.force)).transpose();
    let table = table.map_err(failed)?;
    let prepared = prepare(&job.input, options)?;
    let surface = prepared.surface(options);
    let to = Target::new(job, claimed);
    let mut made = finish(&prepared, &surface, options, to, None, watchers)?;
    if let (Some(path), Some(mut table)) = (path, table)
        && let Some(morphology) = &prepared.morphology
    {
        table::write(surface.surface(), morphology, table.file())
            .map_err(|e| failed(broken(path, e)))?;
        made.files.add(table);
    }
    Ok(made)
}

/// What is informed while a cell is written.
#[derive(Clone, Copy)]
pub(super) struct Watchers<'t> {
    pub(super) reporter: &'t Reporter,
    /// Counts blocks of the surface.
    pub(super) progress: Option<&'t Progress<'t>>,
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
    let meshed = Meshed::new(&read.morphology, options, tick, &AtomicBool::new(false))
        .map_err(|Failure(what)| Failure(format!("{file}: {what}")))?;
    seconds.soma = meshed.generated.soma_seconds;
    let merging = meshed.merging_seconds;
    seconds.coarse = (clock.elapsed().as_secs_f64() - seconds.soma - merging).max(0.0);
    Ok(Prepared {
        file,
        meshed,
        soma_center: soma_center(&read.morphology),
        morphology: options.table.is_some().then_some(read.morphology),
        read: read.warnings,
        seconds,
    })
}

/// Writes a cell's surface, perhaps at a placement.
pub(super) fn finish(
    prepared: &Prepared,
    cell_surface: &CellSurface<'_>,
    options: &MeshOptions,
    to: Target<'_>,
    world_from_cell: Option<DAffine3>,
    watchers: Watchers<'_>,
) -> Result<Made, Failure> {
    let Prepared { file, meshed, .. } = prepared;
    let generated = &meshed.generated;
    let mut seconds = prepared.seconds;
    seconds.refine = meshed.merging_seconds + cell_surface.seconds;
    let failed = |Failure(what)| Failure(format!("{file}: {what}"));
    let out = to.out();
    let watched = Watched::new(cell_surface.surface());
    let walled = options.walls.then(|| {
        let whole = SurfaceMesh::collect(&watched);
        surfaces::with_walls(whole)
    });
    if walled.is_some() {
        // With walls it knows no tracing any more.
        watched
            .check()
            .map_err(|e| failed(Failure(e.to_string())))?;
    }
    let surface: &dyn Surface = match &walled {
        Some(walled) => walled,
        None => cell_surface.surface(),
    };
    let written = write(
        surface,
        options,
        to,
        world_from_cell,
        watchers,
        &mut seconds,
    );
    let written = written.map_err(failed)?;
    let clock = Instant::now();
    let topology = &cell_surface.topology;
    let growth = world_from_cell.map_or(1.0, |transform| transform.matrix3.determinant());
    let measured = options.measure.then(|| cell_surface.volume_and_area());
    let measured = measured.map(|(volume, area)| (growth * volume, growth.cbrt().powi(2) * area));
    seconds.measure = clock.elapsed().as_secs_f64();
    let cell = CellReport {
        file: file.clone(),
        out: out.display().to_string(),
        parts: written.parts,
        materials: options
            .materials_of(out)
            .map(|file| file.display().to_string()),
        node: None,
        vertices: written.vertices,
        triangles: written.triangles,
        quads: written.quads,
        closed: topology.closed,
        euler: topology.euler,
        components: topology.components,
        volume: measured.map(|(volume, _)| volume),
        area: measured.map(|(_, area)| area),
        soma_volume: growth * soma_volume(generated),
        smoothing: generated.smoothing.as_ref().map(SmoothingReport::from),
        crossings: cell_surface.merged().map(CrossingsReport::new),
        separation: generated.separation.as_ref().map(SeparationReport::from),
        quality: cell_surface.merged().and_then(|merged| merged.quality),
        seconds,
        warnings: warnings(&prepared.read, meshed, cell_surface)
            .into_iter()
            .chain(walled.iter().filter_map(verdict::of_walls))
            .collect(),
    };
    Ok(Made {
        report: cell,
        files: written.files,
    })
}

/// Volume (µm³) of all somata.
pub(super) fn soma_volume(generated: &Generated) -> f64 {
    // Adding 0 turns −0, the sum of no somata, into 0.
    generated.somata.iter().map(|soma| soma.volume).sum::<f64>() + 0.0
}

/// What was written into files.
struct Written {
    files: Files,
    parts: Vec<PartReport>,
    vertices: usize,
    triangles: usize,
    quads: usize,
}

fn write(
    surface: &dyn Surface,
    options: &MeshOptions,
    to: Target<'_>,
    world_from_cell: Option<DAffine3>,
    watchers: Watchers<'_>,
    seconds: &mut Seconds,
) -> Result<Written, Failure> {
    let placed = world_from_cell.map(|placed| Placed::new(surface, placed));
    let surface: &dyn Surface = placed.as_ref().map_or(surface, |placed| placed);
    let scaled = InUnit::new(surface, options.unit);
    let surface: &dyn Surface = match options.unit {
        Unit::Micrometer => surface,
        Unit::Meter => &scaled,
    };

    let clock = Instant::now();
    size::tell(surface, options.format, to.out(), watchers.reporter)?;
    let observed = Observed::new(surface, options, watchers.progress);
    let (files, parts) = to
        .write(&observed, options)
        .map_err(|e| Failure(e.to_string()))?;
    let pass = clock.elapsed().as_secs_f64();
    let blocks = (observed.seconds() / rayon::current_num_threads() as f64).min(pass);
    seconds.refine += blocks;
    seconds.write = pass - blocks;
    Ok(Written {
        files,
        parts,
        vertices: surface.vertex_count(),
        triangles: surface.triangle_count(),
        quads: surface.quad_count(),
    })
}

/// All warnings of a cell: of its file, of its mesh and of its surface.
pub(super) fn warnings(
    read: &[formats::Warning],
    meshed: &Meshed,
    surface: &CellSurface<'_>,
) -> Vec<CellWarning> {
    let of_file = read.iter().map(|w| CellWarning {
        line: w.line,
        sample: None,
        code: w.code,
        message: w.message.clone(),
        count: w.count,
    });
    let of_mesh = meshed.generated.warnings.iter().map(|w| CellWarning {
        line: None,
        sample: w.sample,
        code: w.code,
        message: w.to_string(),
        count: w.count as u64,
    });
    let of_surface = surface.merged().into_iter().flat_map(verdict::warnings);
    let of_surface = of_surface.chain(verdict::of_thinning(&meshed.thinned));
    of_file.chain(of_mesh).chain(of_surface).collect()
}
