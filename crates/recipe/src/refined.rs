//! The surface of a coarse mesh as it is refined.

use neurotess_mesh::{CoarseMesh, Role, Surface};
use neurotess_refine::{
    CoarseSurface, EdgeRule, HIGHEST_LEVEL, HIGHEST_LEVEL_BY_LENGTH, Lod, Refinement,
};

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
        Levels::Edges(rule) if options.is_simulation() => {
            refined(Lod::by_edge(without_tiny_pieces(rule, mesh)))
        }
        Levels::Edges(rule) => refined(Lod::by_edge(rule)),
        Levels::Seen { criterion, view } => refined(Lod::seen_from(criterion, view)),
    }
}

/// Least length of a piece in a mesh for simulators, of one that the upper quartile of the radii asks for. Where a few points are a
/// hundredth or a thousandth as thick as all others, pieces as short as these made two thirds of all triangles, which each
/// stage looks at again and again.
const SHORTEST: f32 = 0.04;

/// The rule with no piece shorter than that.
fn without_tiny_pieces(rule: EdgeRule, mesh: &CoarseMesh) -> EdgeRule {
    let EdgeRule::Lengths {
        radii,
        aspect,
        least,
        most,
    } = rule
    else {
        return rule;
    };
    let points = mesh.tracing.iter().filter(|point| point.role != Role::Soma);
    let mut thick: Vec<f32> = points.map(|point| point.radius).collect();
    if thick.is_empty() {
        return rule;
    }
    let quarter = 3 * thick.len() / 4;
    let (_, usual, _) = thick.select_nth_unstable_by(quarter, f32::total_cmp);
    EdgeRule::Lengths {
        radii,
        aspect,
        least: least.max(SHORTEST * radii * *usual),
        most,
    }
}
