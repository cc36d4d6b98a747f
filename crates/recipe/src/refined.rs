//! The surface of a coarse mesh as it is refined.

use neurotess_mesh::{CoarseMesh, Surface};
use neurotess_refine::{CoarseSurface, Lod, Refinement};

use crate::{Levels, MeshOptions};

/// The surface of a coarse mesh, made block by block. `coarse_quads`: whether quads of [`Levels::Coarse`] stay quads; else
/// each becomes two triangles.
pub(crate) fn refined<'m>(
    mesh: &'m CoarseMesh,
    options: &MeshOptions,
    coarse_quads: bool,
) -> Box<dyn Surface + Send + 'm> {
    let refined = |lod: Lod<'_>| Box::new(Refinement::new(mesh, lod, &options.refine));
    match options.levels {
        Levels::Coarse => Box::new(CoarseSurface::new(mesh, coarse_quads)),
        Levels::Criterion(criterion) => refined(criterion.into()),
        Levels::Edges(rule) => refined(Lod::by_edge(rule)),
        Levels::Seen { criterion, view } => refined(Lod::seen_from(criterion, view)),
    }
}
