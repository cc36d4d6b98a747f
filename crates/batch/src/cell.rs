//! One cell: read, generate, refine and write.

use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use glam::DAffine3;
use neurotess_formats as formats;
use neurotess_recipe::{
    CellFiles, CellMesh, CellSurface, FileSurface, Progress, SurfaceWarning, Warning, Watch,
    WrittenFiles, mesh_watched,
};

use crate::claims::Claimed;
use crate::error::CellFault;
use crate::options::CellOptions;
use crate::report::{CellReport, NodeName, Seconds, Told};
use crate::size::{self, Crowded, LargeFile};
use crate::tables::BegunTables;
use crate::targets::Job;
use crate::tracing::read;

/// A cell read and generated, to be written once or several times.
pub(crate) struct Prepared {
    pub(crate) meshed: CellMesh,
    read: Vec<formats::Warning>,
    seconds: Seconds,
}

/// A cell in temporary files.
pub(crate) struct Made {
    pub(crate) report: CellReport,
    pub(crate) files: CellFiles,
}

/// Where a cell goes.
pub(crate) struct Target<'j> {
    pub(crate) job: &'j Job,
    pub(crate) claimed: Claimed,
    /// The cell's node, if it is of a circuit.
    pub(crate) node: Option<NodeName>,
    /// Where it is in the circuit.
    pub(crate) world_from_cell: Option<DAffine3>,
}

/// Who is told while a cell is made.
#[derive(Clone, Copy)]
pub(crate) struct Listeners<'t> {
    pub(crate) progress: &'t (dyn Fn(Progress) + Sync),
    pub(crate) large: &'t dyn Fn(&LargeFile),
}

/// Reads a cell and generates its coarse mesh.
pub(crate) fn prepare(
    input: &Path,
    options: &CellOptions,
    progress: &(dyn Fn(Progress) + Sync),
) -> Result<Prepared, CellFault> {
    let mut seconds = Seconds::default();
    let clock = Instant::now();
    let read = read(input, None, &options.read)?;
    seconds.read = clock.elapsed().as_secs_f64();

    let clock = Instant::now();
    let tick = || clock.elapsed().as_secs_f64();
    let watch = Watch::stopped_by(&options.stopped);
    let watch = watch.with_clock(&tick).with_progress(progress);
    let meshed = mesh_watched(Arc::new(read.morphology), &options.mesh, &watch)?;
    seconds.soma = meshed.soma_seconds;
    let merging = meshed.merging_seconds;
    seconds.coarse = (clock.elapsed().as_secs_f64() - seconds.soma - merging).max(0.0);
    Ok(Prepared {
        meshed,
        read: read.warnings,
        seconds,
    })
}

impl Prepared {
    /// Writes the cell's surface, perhaps at a placement, and tables.
    pub(crate) fn write(
        &self,
        options: &CellOptions,
        to: Target<'_>,
        tables: BegunTables<'_>,
        listeners: Listeners<'_>,
    ) -> Result<Made, CellFault> {
        let clock = Instant::now();
        let surface = self.meshed.surface_for(options.files.format);
        let planned = clock.elapsed().as_secs_f64();
        let mut made = self.write_surface(&surface, planned, options, to, listeners)?;
        for table in tables.write(surface.surface(), &self.meshed.morphology)? {
            made.files.add(table);
        }
        Ok(made)
    }

    /// `planned`: seconds that it took to plan the surface.
    fn write_surface(
        &self,
        cell_surface: &CellSurface<'_>,
        planned: f64,
        options: &CellOptions,
        to: Target<'_>,
        listeners: Listeners<'_>,
    ) -> Result<Made, CellFault> {
        let Self { meshed, .. } = self;
        let Target {
            job,
            claimed,
            node,
            world_from_cell,
        } = to;
        let mut seconds = self.seconds;
        seconds.refine = meshed.merging_seconds + planned;
        let watch = Watch::stopped_by(&options.stopped);
        let surface = FileSurface::new(cell_surface.surface(), &options.files, &watch)?;
        let surface = surface.placed(world_from_cell);
        let format = options.files.format;
        let coarse = &meshed.generated.mesh;
        let rounded = SurfaceWarning::of_rounding(coarse, format, world_from_cell);
        if let Some(&SurfaceWarning::Rounded { at, by, radius }) =
            rounded.as_ref().filter(|r| r.is_lost())
        {
            return Err(CellFault::Rounded {
                at,
                by,
                radius,
                format,
            });
        }
        let mut written = write(&surface, options, job, claimed, listeners, &mut seconds)?;
        let clock = Instant::now();
        let mesh = meshed.report_of(cell_surface);
        let measured = options.measures.then(|| cell_surface.volume_and_area());
        seconds.measure = clock.elapsed().as_secs_f64();
        let of_file = self.read.iter().cloned().map(Warning::File);
        let of_mesh = mesh.warnings.iter().cloned();
        let of_surface = surface.warning().into_iter().chain(rounded);
        let warnings = of_file
            .chain(of_mesh)
            .chain(of_surface.map(Warning::Surface))
            .collect();
        let told = Told {
            file: &job.input,
            out: &job.out,
            materials: options.files.materials_of(&job.out),
            node,
            measured,
            growth: world_from_cell.map_or(1.0, |transform| transform.matrix3.determinant()),
            seconds,
        };
        let parts = std::mem::take(&mut written.parts);
        Ok(Made {
            report: CellReport::new(told, parts, &written, mesh, warnings),
            files: written.files,
        })
    }
}

fn write(
    surface: &FileSurface<'_>,
    options: &CellOptions,
    job: &Job,
    claimed: Claimed,
    listeners: Listeners<'_>,
    seconds: &mut Seconds,
) -> Result<WrittenFiles, CellFault> {
    let large = surface.with(|surface| size::check(surface, &options.files, &job.out));
    let large = large.map_err(|crowded| match crowded {
        Crowded::Memory(error) => CellFault::Memory(error),
        Crowded::Disk {
            bytes,
            free,
            folder,
        } => CellFault::NoRoom {
            out: job.out.clone(),
            bytes,
            free,
            folder,
        },
    })?;
    if let Some(large) = large {
        (listeners.large)(&large);
    }
    let clock = Instant::now();
    let tick = || clock.elapsed().as_secs_f64();
    let watch = Watch::stopped_by(&options.stopped);
    let watch = watch.with_clock(&tick).with_progress(listeners.progress);
    let written = surface.write(&job.out, claimed.output, claimed.existing, &watch)?;
    let pass = tick();
    let blocks = (written.block_seconds / rayon::current_num_threads() as f64).min(pass);
    seconds.refine += blocks;
    seconds.write = pass - blocks;
    Ok(written)
}
