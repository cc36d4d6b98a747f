//! A cell meshed: its coarse mesh, and the surface where what crosses was merged.

use std::sync::atomic::{AtomicBool, Ordering};

use neurotess::generate::{GenerateError, Generated, generate_stoppable};
use neurotess::morphology::Morphology;

use super::options::MeshOptions;
use super::surface::{CellSurface, Merged};
use super::thinning::Thinning;
use super::verdict;
use crate::report::Failure;

/// How often a mesh for simulators is made again with thinner tubes.
const ROUNDS: usize = 6;

/// A cell's coarse mesh, and the surface where what crosses was merged.
pub(crate) struct Meshed {
    pub(super) generated: Generated,
    merged: Option<Merged>,
    /// Samples where tubes were made thinner than traced, since they would have grown together.
    pub(super) thinned: Vec<i64>,
    /// Seconds that refining and merging took, in all rounds; 0 where nothing is merged.
    pub(super) merging_seconds: f64,
}

impl Meshed {
    /// Meshes a tracing. `clock` tells the seconds since any moment; all ends soon after another thread sets
    /// `stopped`.
    pub(super) fn new(
        morphology: &Morphology,
        options: &MeshOptions,
        clock: impl Fn() -> f64,
        stopped: &AtomicBool,
    ) -> Result<Self, Failure> {
        let mut best = Self::once(morphology, options, &clock, stopped)?;
        if !options.simulation {
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
            let mut next = match Self::once(&thinning.morphology(), options, &clock, stopped) {
                Ok(next) => next,
                Err(failure) if stopped.load(Ordering::Relaxed) => return Err(failure),
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
        verdict::check(&best.surface(options), &best.generated)?;
        Ok(best)
    }

    fn once(
        morphology: &Morphology,
        options: &MeshOptions,
        clock: impl Fn() -> f64,
        stopped: &AtomicBool,
    ) -> Result<Self, Failure> {
        let generated = generate_stoppable(morphology, &options.generate, clock, stopped);
        let generated = generated.map_err(|e: GenerateError| Failure(e.to_string()))?;
        if generated.mesh.patches.is_empty() {
            return Err(Failure(
                "nothing is left to mesh: check --types and --soma".into(),
            ));
        }
        let merged = options
            .merge
            .then(|| Merged::new(&generated.mesh, options, stopped));
        let merged = merged.transpose()?;
        Ok(Self {
            merging_seconds: merged.as_ref().map_or(0.0, |merged| merged.seconds),
            merged,
            generated,
            thinned: Vec::new(),
        })
    }

    /// The surface that is written.
    pub(super) fn surface(&self, options: &MeshOptions) -> CellSurface<'_> {
        CellSurface::new(&self.generated.mesh, self.merged.as_ref(), options)
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
