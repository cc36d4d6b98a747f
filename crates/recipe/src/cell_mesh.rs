//! A cell meshed: its coarse mesh, and the surface where what crosses was merged.

use std::sync::Arc;

use neurotess_generate::{GenerateError, Generated, generate_watched};
use neurotess_mesh::Format;
use neurotess_morphology::Morphology;
use neurotess_union::UnionError;

use crate::merged::Merged;
use crate::refined::vertex_count;
use crate::surface::CellSurface;
use crate::thinning::Thinning;
use crate::{MeshError, MeshOptions, Watch, memory, soma_mesh, verdict};

/// How often a mesh for simulators is made again with thinner tubes.
const ROUNDS: usize = 6;

/// What merging holds for each vertex of the surface: itself, two triangles, and the boxes around these. Measured: 350 and 364 on
/// the pyramidal sample at levels 8 and 16.
const BYTES_TO_MERGE: u64 = 350;

/// A cell's coarse mesh, and the surface where what crosses was merged.
pub struct CellMesh {
    /// The tracing.
    pub morphology: Arc<Morphology>,
    /// The coarse mesh, and what was found on the way.
    pub generated: Arc<Generated>,
    /// Where what crosses was merged.
    pub(crate) merged: Option<Merged>,
    /// The file's numbers of samples where tubes were made thinner than traced, since they would have grown together.
    pub(crate) thinned: Vec<i64>,
    /// Seconds that somata took, in all rounds; 0 without a clock.
    pub soma_seconds: f64,
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
    let morphology = Arc::new(cell.as_ref().clone());
    mesh_watched(morphology, options, &Watch::default())
}

/// [`mesh`], which another thread can stop, and which a clock watches.
///
/// # Errors
/// As [`mesh`], and [`MeshError::Stopped`].
pub fn mesh_watched(
    morphology: Arc<Morphology>,
    options: &MeshOptions,
    watch: &Watch<'_>,
) -> Result<CellMesh, MeshError> {
    options.check()?;
    let generated = generated(&morphology, options, watch)?;
    let best = CellMesh::of(morphology, generated, options, watch)?;
    improved(best, watch)
}

/// [`mesh_watched`] of a cell whose coarse mesh is there, made by [`MeshOptions::generate_options`].
///
/// # Errors
/// As [`mesh_watched`].
pub fn mesh_from(
    generated: Arc<Generated>,
    morphology: Arc<Morphology>,
    options: &MeshOptions,
    watch: &Watch<'_>,
) -> Result<CellMesh, MeshError> {
    options.check()?;
    let best = CellMesh::of(morphology, generated, options, watch)?;
    improved(best, watch)
}

/// The same mesh; one for simulators is made again with thinner tubes where they grew together.
fn improved(mut best: CellMesh, watch: &Watch<'_>) -> Result<CellMesh, MeshError> {
    if !best.options.is_simulation() {
        return Ok(best);
    }
    let (traced, options) = (Arc::clone(&best.morphology), best.options.clone());
    let mut thinning = Thinning::new(&traced);
    let mut places = best.places();
    let (mut soma_seconds, mut merging_seconds) = (best.soma_seconds, best.merging_seconds);
    for _ in 0..ROUNDS {
        if best.faults() == Faults::default() || !thinning.thin(&places) {
            break;
        }
        let next = generated(&thinning.morphology(), &options, watch);
        let next = next.and_then(|next| CellMesh::of(Arc::clone(&traced), next, &options, watch));
        let mut next = match next {
            Ok(next) => next,
            Err(_) if watch.is_stopped() => return Err(MeshError::Stopped),
            // What there is already may do.
            Err(_) => break,
        };
        next.thinned = thinning.samples();
        soma_seconds += next.soma_seconds;
        merging_seconds += next.merging_seconds;
        places = next.places();
        if next.faults() < best.faults() {
            best = next;
        }
    }
    best.soma_seconds = soma_seconds;
    best.merging_seconds = merging_seconds;
    verdict::check(&best.surface(), &best.generated)?;
    Ok(best)
}

/// The coarse mesh of a tracing.
fn generated(
    morphology: &Morphology,
    options: &MeshOptions,
    watch: &Watch<'_>,
) -> Result<Arc<Generated>, MeshError> {
    let options = soma_mesh::generate_options(options, morphology)?;
    let generated = generate_watched(morphology, &options, watch);
    generated.map(Arc::new).map_err(|e| match e {
        GenerateError::Stopped(_) => MeshError::Stopped,
        e => e.into(),
    })
}

impl CellMesh {
    fn of(
        morphology: Arc<Morphology>,
        generated: Arc<Generated>,
        options: &MeshOptions,
        watch: &Watch<'_>,
    ) -> Result<Self, MeshError> {
        if generated.mesh.patches.is_empty() {
            return Err(MeshError::Empty);
        }
        let vertices = vertex_count(&generated.mesh, options);
        if vertices > u32::MAX as usize {
            return Err(MeshError::TooManyVertices(vertices));
        }
        if options.merges() {
            memory::check((vertices as u64).saturating_mul(BYTES_TO_MERGE))?;
        }
        let start = watch.seconds();
        let merged = options
            .merges()
            .then(|| Merged::new(&generated.mesh, options, watch));
        let merged = merged.transpose().map_err(|e| match e {
            MeshError::Merge(UnionError::Stopped(_)) => MeshError::Stopped,
            e => e,
        })?;
        Ok(Self {
            merging_seconds: watch.seconds() - start,
            morphology,
            merged,
            soma_seconds: generated.soma_seconds,
            generated,
            thinned: Vec::new(),
            options: options.clone(),
        })
    }

    /// What it was made by.
    pub fn options(&self) -> &MeshOptions {
        &self.options
    }

    /// The surface. Quads of the coarse mesh stay quads.
    pub fn surface(&self) -> CellSurface<'_> {
        self.surface_with(true)
    }

    /// The surface as a format takes it: of triangles, if it holds no quads.
    pub fn surface_for(&self, format: Format) -> CellSurface<'_> {
        self.surface_with(format.has_quads())
    }

    fn surface_with(&self, coarse_quads: bool) -> CellSurface<'_> {
        let (mesh, merged) = (&self.generated.mesh, self.merged.as_ref());
        CellSurface::new(mesh, merged, &self.options, coarse_quads)
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
