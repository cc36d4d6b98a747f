//! A cell meshed: its coarse mesh, and the surface where what crosses was merged.

use neurotess_generate::{GenerateError, Generated, generate_stoppable};
use neurotess_morphology::Morphology;
use neurotess_union::UnionError;

use crate::merged::Merged;
use crate::surface::CellSurface;
use crate::thinning::Thinning;
use crate::{MeshError, MeshOptions, Watch, verdict};

/// How often a mesh for simulators is made again with thinner tubes.
const ROUNDS: usize = 6;

/// A cell's coarse mesh, and the surface where what crosses was merged.
pub struct CellMesh {
    /// The coarse mesh, and what was found on the way.
    pub generated: Generated,
    /// Where what crosses was merged.
    pub(crate) merged: Option<Merged>,
    /// The file's numbers of samples where tubes were made thinner than traced, since they would have grown together.
    pub(crate) thinned: Vec<i64>,
    /// Seconds that refining and merging took, in all rounds; 0 where nothing is merged, or without a clock.
    pub merging_seconds: f64,
    options: MeshOptions,
}

/// Meshes a cell: a [`Tracing`](crate::Tracing) or a [`Morphology`].
///
/// # Errors
/// It cannot be meshed, the options leave nothing of it, what crosses cannot be merged, or solvers could not take what was
/// asked for as a mesh for simulations.
pub fn mesh(cell: &impl AsRef<Morphology>, options: &MeshOptions) -> Result<CellMesh, MeshError> {
    mesh_watched(cell.as_ref(), options, &Watch::default())
}

/// [`mesh`], which another thread can stop, and which a clock watches.
///
/// # Errors
/// As [`mesh`], and [`MeshError::Stopped`].
pub fn mesh_watched(
    morphology: &Morphology,
    options: &MeshOptions,
    watch: &Watch<'_>,
) -> Result<CellMesh, MeshError> {
    options.check()?;
    let mut best = CellMesh::once(morphology, options, watch)?;
    if !options.is_simulation() {
        return Ok(best);
    }
    let mut thinning = Thinning::new(morphology);
    let mut places = best.places();
    let (mut soma_seconds, mut merging_seconds) =
        (best.generated.soma_seconds, best.merging_seconds);
    for _ in 0..ROUNDS {
        if best.faults() == Faults::default() || !thinning.thin(&places) {
            break;
        }
        let mut next = match CellMesh::once(&thinning.morphology(), options, watch) {
            Ok(next) => next,
            Err(_) if watch.is_stopped() => return Err(MeshError::Stopped),
            // What there is already may do.
            Err(_) => break,
        };
        next.thinned = thinning.samples();
        soma_seconds += next.generated.soma_seconds;
        merging_seconds += next.merging_seconds;
        places = next.places();
        if next.faults() < best.faults() {
            best = next;
        }
    }
    best.generated.soma_seconds = soma_seconds;
    best.merging_seconds = merging_seconds;
    verdict::check(&best.surface(), &best.generated)?;
    Ok(best)
}

impl CellMesh {
    fn once(
        morphology: &Morphology,
        options: &MeshOptions,
        watch: &Watch<'_>,
    ) -> Result<Self, MeshError> {
        let made = generate_stoppable(
            morphology,
            &options.generate_options(),
            || watch.seconds(),
            watch.flag(),
        );
        let generated = made.map_err(|e| match e {
            GenerateError::Stopped => MeshError::Stopped,
            e => e.into(),
        })?;
        if generated.mesh.patches.is_empty() {
            return Err(MeshError::Empty);
        }
        let start = watch.seconds();
        let merged = options
            .merges()
            .then(|| Merged::new(&generated.mesh, options, watch));
        let merged = merged.transpose().map_err(|e| match e {
            MeshError::Merge(UnionError::Stopped) => MeshError::Stopped,
            e => e,
        })?;
        Ok(Self {
            merging_seconds: watch.seconds() - start,
            merged,
            generated,
            thinned: Vec::new(),
            options: options.clone(),
        })
    }

    /// What it was made by.
    pub fn options(&self) -> &MeshOptions {
        &self.options
    }

    /// The surface.
    pub fn surface(&self) -> CellSurface<'_> {
        CellSurface::new(&self.generated.mesh, self.merged.as_ref(), &self.options)
    }

    /// What merging did that a mesh for simulators should not have.
    fn faults(&self) -> Faults {
        let Some(Merged { report, .. }) = &self.merged else {
            return Faults::default();
        };
        Faults {
            pieces: report.cut_off.len(),
            handles: report.handles_made().unwrap_or(i64::MAX).max(0),
        }
    }

    /// Samples where tubes grew together.
    fn places(&self) -> Vec<[i32; 2]> {
        let places = self.merged.iter().flat_map(|merged| &merged.report.places);
        places.map(|place| place.points).collect()
    }
}

/// The worst first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
struct Faults {
    /// Pieces that were cut off.
    pieces: usize,
    /// Loops that were closed.
    handles: i64,
}
