//! Points of single patches, for whoever judges shapes while they still change.

use glam::Vec3;
use neurotess_mesh::CoarseMesh;

use crate::RefineOptions;
use crate::evaluate::{F32x4, PatchShape, SIDES};
use crate::plan::side_of;

/// Appends the points of one patch on a grid of `steps` by `steps` cells, row by row: (steps + 1)² of them.
///
/// The same surface as a [`Refinement`](crate::Refinement)'s, point by point, without a plan for the whole
/// mesh. A round cap gets as many cells as any other patch here.
pub fn patch_points(
    mesh: &CoarseMesh,
    patch: usize,
    steps: u32,
    options: &RefineOptions,
    out: &mut Vec<Vec3>,
) {
    let sides = [0, 1, 2, 3].map(|side| side_of(mesh, patch, side));
    let shape = PatchShape::new(mesh, patch, sides);
    let share = |i: u32| i as f32 / steps as f32;
    for j in 0..=steps {
        for i in 0..=steps {
            let ends = [i, j].map(|k| k == 0 || k == steps);
            let side = match (i, j) {
                (_, 0) => Some((0, i)),
                (_, j) if j == steps => Some((2, i)),
                (0, _) => Some((3, j)),
                (i, _) if i == steps => Some((1, j)),
                _ => None,
            };
            out.push(match side {
                Some((side, at)) if ends == [true; 2] => {
                    let (from, to) = SIDES[side];
                    let corner = mesh.patches[patch].corners[if at == 0 { from } else { to }];
                    mesh.vertices[corner as usize].position
                }
                Some((side, at)) => {
                    let at = F32x4::splat(share(at));
                    shape.side(side, options.path, at).position.each()[0]
                }
                None => shape.interior(options, share(i), share(j)).0,
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{LodCriterion, Refinement};
    use neurotess_mesh::{Patch, PatchKind, TracingPoint, Vertex};

    /// A bent tube of three rings, closed by caps.
    fn tube() -> CoarseMesh {
        let mut mesh = CoarseMesh::default();
        for (i, (center, tangent)) in [
            (Vec3::ZERO, Vec3::X),
            (Vec3::X * 3.0, Vec3::new(0.8, 0.6, 0.0)),
            (Vec3::new(4.0, 3.0, 0.0), Vec3::Y),
        ]
        .into_iter()
        .enumerate()
        {
            mesh.tracing.push(TracingPoint {
                center,
                radius: 1.0,
                tangent,
                ..TracingPoint::default()
            });
            let side = tangent.cross(Vec3::Z);
            for offset in [Vec3::Z, side, -Vec3::Z, -side] {
                mesh.vertices.push(Vertex {
                    position: center + offset,
                    normal: offset,
                    tracing: i as u32,
                });
            }
        }
        for ring in [0, 4] {
            for k in 0..4 {
                let next = (k + 1) % 4;
                mesh.patches.push(Patch {
                    corners: [ring + k, ring + next, ring + 4 + next, ring + 4 + k],
                    kind: PatchKind::Lateral,
                });
            }
        }
        mesh.patches.extend([
            Patch {
                corners: [3, 2, 1, 0],
                kind: PatchKind::Cap,
            },
            Patch {
                corners: [8, 9, 10, 11],
                kind: PatchKind::Cap,
            },
        ]);
        mesh
    }

    #[test]
    fn points_are_those_of_the_refinement() {
        let (mesh, options) = (tube(), RefineOptions::default());
        let refined = Refinement::new(&mesh, LodCriterion::Homogeneous(2), &options);
        for patch in 0..8 {
            let mut points = Vec::new();
            patch_points(&mesh, patch, 2, &options, &mut points);
            for (k, point) in (0..).zip(points) {
                let vertex = refined.grid_vertex(patch, k % 3, k / 3);
                assert!(vertex.position.distance(point) < 1e-6, "{patch} {k}");
            }
        }
    }
}
