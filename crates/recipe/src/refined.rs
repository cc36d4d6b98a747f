//! The surface of a coarse mesh as it is refined.

use neurotess_mesh::{CoarseMesh, Surface};
use neurotess_refine::{CoarseSurface, HIGHEST_LEVEL, HIGHEST_LEVEL_BY_LENGTH, Lod, Refinement};

use crate::{Levels, MeshOptions};

/// How many vertices the refined surface has; of surfaces that are far from what 32 bits count, at most how many.
pub(crate) fn vertex_count(mesh: &CoarseMesh, options: &MeshOptions) -> usize {
    let highest = match options.levels {
        Levels::Edges(_) => HIGHEST_LEVEL_BY_LENGTH,
        _ => HIGHEST_LEVEL,
    };
    let most_of_patch = (highest as usize + 1).pow(2);
    let most = mesh.patches.len().saturating_mul(most_of_patch);
    // Merging needs memory for each.
    match most > u32::MAX as usize || options.merges() {
        true => refined(mesh, options, true).vertex_count(),
        false => most,
    }
}

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
