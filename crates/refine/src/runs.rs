//! Runs of rings in a coarse mesh, and which rings are circles that can be computed from their
//! points.

use glam::Vec3;
use neurotess_mesh::{CoarseMesh, PatchKind, Role};

use crate::decode::{ImplicitRing, to_octahedral, to_radius, to_slope, to_turn};

/// Most segments of a run; longer ones are cut.
const MOST_SEGMENTS: usize = 1 << 14;
/// Greatest distance, in radii, of a computed corner from the mesh's own, apart from the center's
/// error.
const MOST_APART: f32 = 0.0095;

/// A run: rings in a row, with four lateral patches from each to the next.
#[derive(Clone, Debug)]
pub(crate) struct Tube {
    pub(crate) first_patch: usize,
    pub(crate) rings: Vec<[u32; 4]>,
}

/// All runs, and the patches that belong to none.
pub(crate) fn find_runs(mesh: &CoarseMesh) -> (Vec<Tube>, Vec<usize>) {
    let mut runs: Vec<Tube> = Vec::new();
    let mut others = Vec::new();
    let mut i = 0;
    while i < mesh.patches.len() {
        let Some((ring, next)) = tube(mesh, i) else {
            others.push(i);
            i += 1;
            continue;
        };
        let goes_on = |run: &Tube| {
            let segments = run.rings.len() - 1;
            run.first_patch + 4 * segments == i
                && run.rings[segments] == ring
                && segments < MOST_SEGMENTS
        };
        match runs.last_mut().filter(|run| goes_on(run)) {
            Some(run) => run.rings.push(next),
            None => runs.push(Tube {
                first_patch: i,
                rings: vec![ring, next],
            }),
        }
        i += 4;
    }
    (runs, others)
}

/// The two rings of four lateral patches that follow one another around a tube.
fn tube(mesh: &CoarseMesh, first: usize) -> Option<([u32; 4], [u32; 4])> {
    let patches = mesh.patches.get(first..first + 4)?;
    let ring = [0, 1, 2, 3].map(|k: usize| patches[k].corners[0]);
    let next = [0, 1, 2, 3].map(|k: usize| patches[k].corners[3]);
    let fits = (0..4).all(|k| {
        let patch = &patches[k];
        let after = (k + 1) % 4;
        patch.kind == PatchKind::Lateral
            && patch.corners == [ring[k], ring[after], next[after], next[k]]
    });
    fits.then_some((ring, next))
}

/// A ring as a circle around its tracing point, if it is one.
pub(crate) fn implicit_ring(mesh: &CoarseMesh, ring: [u32; 4]) -> Option<ImplicitRing> {
    let vertices = [0, 1, 2, 3].map(|k: usize| &mesh.vertices[ring[k] as usize]);
    let tracing = vertices[0].tracing;
    let point = &mesh.tracing[tracing as usize];
    let ours = (0..4).all(|k| ring[k] == ring[0] + k as u32 && vertices[k].tracing == tracing);
    if !ours || !matches!(point.role, Role::Ordinary | Role::End) {
        return None;
    }
    let (x, y) = to_octahedral(point.tangent, 511.0);
    let mut implicit = ImplicitRing {
        tracing,
        radius: to_radius(point.radius)?,
        tangent: (x, y),
        turn: 0,
        slope: (0, false),
        role: point.role,
    };
    let offset = vertices[0].position - point.center;
    implicit.turn = to_turn(implicit.tangent(), offset.normalize_or(Vec3::X));
    let normal = vertices[0].normal;
    let out = offset.normalize_or(normal);
    implicit.slope = to_slope(-normal.dot(point.tangent) / normal.dot(out).max(1e-3));
    let near = (0..4).all(|k| {
        let apart = implicit
            .corner(point.center, k as u32)
            .0
            .distance(vertices[k].position);
        apart <= MOST_APART * point.radius
    });
    near.then_some(implicit)
}
