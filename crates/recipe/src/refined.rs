//! The surface of a coarse mesh as it is refined.

use neurotess_mesh::{CoarseMesh, Surface};
use neurotess_refine::{CoarseSurface, Lod, Refinement};

use crate::{Levels, MeshOptions};

/// The surface of a coarse mesh, made block by block.
pub(crate) fn refined<'m>(
    mesh: &'m CoarseMesh,
    options: &MeshOptions,
) -> Box<dyn Surface + Send + 'm> {
    let refined = |lod: Lod<'_>| Box::new(Refinement::new(mesh, lod, &options.refine));
    match options.levels {
        Levels::Coarse => Box::new(CoarseSurface::new(mesh, options.coarse_quads)),
        Levels::Criterion(criterion) => refined(criterion.into()),
        Levels::Edges(rule) => refined(Lod::by_edge(rule)),
    }
}
