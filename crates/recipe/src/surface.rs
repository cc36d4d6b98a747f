//! The surface of a cell: refined block by block, or whole in memory where what crosses is merged.

use neurotess_mesh::{CoarseMesh, Surface, Topology, measure_surface};

use crate::MeshOptions;
use crate::merged::Merged;
use crate::refined::refined;

/// A surface to be written, and what is known of it.
pub struct CellSurface<'m> {
    made: MadeSurface<'m>,
    /// What its indices say.
    pub topology: Topology,
}

enum MadeSurface<'m> {
    /// Block by block.
    Refined(Box<dyn Surface + 'm>),
    /// Whole in memory.
    Merged(&'m Merged),
}

impl<'m> CellSurface<'m> {
    /// The surface of a coarse mesh as it is refined, or merged with itself.
    pub(crate) fn new(
        mesh: &'m CoarseMesh,
        merged: Option<&'m Merged>,
        options: &MeshOptions,
        coarse_quads: bool,
    ) -> Self {
        if let Some(merged) = merged {
            return Self {
                made: MadeSurface::Merged(merged),
                topology: merged.topology,
            };
        }
        // Refinement does not change the topology.
        let (refined, topology) =
            rayon::join(|| refined(mesh, options, coarse_quads), || mesh.topology());
        Self {
            made: MadeSurface::Refined(refined),
            topology,
        }
    }

    /// What is written.
    pub fn surface(&self) -> &(dyn Surface + 'm) {
        match &self.made {
            MadeSurface::Refined(refined) => &**refined,
            MadeSurface::Merged(merged) => &merged.mesh,
        }
    }

    /// How it was merged, if it was.
    pub fn merged(&self) -> Option<&'m Merged> {
        match self.made {
            MadeSurface::Refined(_) => None,
            MadeSurface::Merged(merged) => Some(merged),
        }
    }

    /// Volume (µm³) and area (µm²). Evaluates the whole surface.
    pub fn volume_and_area(&self) -> (f64, f64) {
        let measure = measure_surface(self.surface());
        (measure.volume, measure.area)
    }
}
