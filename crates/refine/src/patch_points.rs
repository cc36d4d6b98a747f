//! Points of some patches, for whoever judges shapes while they still change.

use glam::Vec3;
use neurotess_mesh::{CoarseMesh, PatchKind};

use crate::RefineOptions;
use crate::evaluate::{Corners, EdgeCurves, EdgeKind, F32x4, PatchShape, SIDES, Tubes};
use crate::fours::{Fours, four};
use crate::plan::side_of;

/// Appends the points of some patches, each on a grid of `steps` by `steps` cells, row by row: (steps + 1)² of each.
///
/// The same surface as a [`Refinement`](crate::Refinement)'s, point by point, without a plan for the whole
/// mesh. A round cap gets as many cells as any other patch here.
pub fn patch_points(
    mesh: &CoarseMesh,
    patches: &[u32],
    steps: u32,
    options: &RefineOptions,
    out: &mut Vec<Vec3>,
) {
    let grids = Grids {
        mesh,
        options,
        steps: steps as usize,
    };
    let (start, count) = (out.len(), (grids.steps + 1).pow(2));
    out.resize(start + count * patches.len(), Vec3::ZERO);
    let out = &mut out[start..];
    // Four sides of one kind, and four lateral patches, are evaluated at once.
    let (mut sides, mut tubes) = (Fours::default(), Fours::default());
    for (first, &patch) in (0..).step_by(count).zip(patches) {
        let patch = patch as usize;
        let kinds = [0, 1, 2, 3].map(|side| side_of(mesh, patch, side));
        for (number, (kind, reversed)) in kinds.into_iter().enumerate() {
            let side = grids.side(patch, first, number, reversed);
            if let Some(four) = sides.add(kind as u32, (kind, side)) {
                grids.put_sides(four, out);
            }
        }
        if mesh.patches[patch].kind != PatchKind::Lateral {
            let shape = PatchShape::new(mesh, patch, kinds);
            shape.for_each_inside(options, [steps; 2], |[i, j], points, _| {
                let positions = points.position.each();
                for (i, position) in (i..steps).zip(positions) {
                    out[first + grids.place(i, j)] = position;
                }
            });
        } else if let Some(four) = tubes.add(0, (patch, first)) {
            grids.put_tubes(four, out);
        }
    }
    sides.rest().for_each(|four| grids.put_sides(four, out));
    tubes.rest().for_each(|four| grids.put_tubes(four, out));
}

/// The grids of patches of a mesh.
struct Grids<'m> {
    mesh: &'m CoarseMesh,
    options: &'m RefineOptions,
    steps: usize,
}

/// A side of a patch, as its edge runs: its vertices, and where its points go.
#[derive(Clone, Copy, Debug)]
struct Side {
    ends: [u32; 2],
    first: usize,
    last: usize,
}

impl Grids<'_> {
    /// Place in a grid of column i, row j.
    fn place(&self, i: u32, j: u32) -> usize {
        j as usize * (self.steps + 1) + i as usize
    }

    /// `first`: where the patch's grid begins.
    fn side(&self, patch: usize, first: usize, side: usize, reversed: bool) -> Side {
        let steps = self.steps as u32;
        let corners = [[0, 0], [steps, 0], [steps; 2], [0, steps]];
        let (from, to) = match reversed {
            false => SIDES[side],
            true => (SIDES[side].1, SIDES[side].0),
        };
        let place = |corner: usize| first + self.place(corners[corner][0], corners[corner][1]);
        let vertices = &self.mesh.patches[patch].corners;
        Side {
            ends: [vertices[from], vertices[to]],
            first: place(from),
            last: place(to),
        }
    }

    /// Puts the points of four sides of one kind, corners included, into `out`.
    fn put_sides(&self, sides: [(EdgeKind, Side); 4], out: &mut [Vec3]) {
        let kind = sides[0].0;
        let sides = sides.map(|(_, side)| side);
        // Each kind needs other things of corners.
        match kind {
            EdgeKind::Ring => self.put_sides_of(EdgeKind::Ring, sides, out),
            EdgeKind::Along => self.put_sides_of(EdgeKind::Along, sides, out),
            kind => self.put_sides_of(kind, sides, out),
        }
    }

    #[inline(always)]
    fn put_sides_of(&self, kind: EdgeKind, sides: [Side; 4], out: &mut [Vec3]) {
        for Side { ends, first, last } in sides {
            for (place, vertex) in [first, last].into_iter().zip(ends) {
                out[place] = self.mesh.vertices[vertex as usize].position;
            }
        }
        let [a, b] = Corners::of_edges(self.mesh, sides.map(|side| side.ends));
        let curves = EdgeCurves::new(kind, &a, &b, self.options.path);
        for k in 1..self.steps {
            let t = F32x4::splat(k as f32 / self.steps as f32);
            let positions = curves.at(t).position.each();
            for (Side { first, last, .. }, position) in sides.into_iter().zip(positions) {
                // Whole steps apart, either way.
                out[(first * (self.steps - k) + last * k) / self.steps] = position;
            }
        }
    }

    /// Puts the points inside four lateral patches, whose grids begin at these places, into `out`.
    fn put_tubes(&self, patches: [(usize, usize); 4], out: &mut [Vec3]) {
        let of = |k: usize| self.mesh.patches[patches[k].0].corners;
        let corners = Corners::of_patches(self.mesh, four(of));
        let tubes = Tubes::new(&corners, self.options.path);
        let steps = self.steps as u32;
        let share = |k: u32| F32x4::splat(k as f32 / steps as f32);
        for j in 1..steps {
            let row = tubes.row(share(j));
            for i in 1..steps {
                let positions = row.points(share(i)).position.each();
                for ((_, first), position) in patches.into_iter().zip(positions) {
                    out[first + self.place(i, j)] = position;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{LodCriterion, Refinement};
    use neurotess_mesh::{Patch, TracingPoint, Vertex};

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
        let patches = [3, 0, 8, 5, 1, 9, 2, 7];
        for steps in [2, 4] {
            let refined = Refinement::new(&mesh, LodCriterion::Homogeneous(steps), &options);
            let mut points = Vec::new();
            patch_points(&mesh, &patches, steps, &options, &mut points);
            let of_patches = points.chunks((steps as usize + 1).pow(2));
            for (points, &patch) in of_patches.zip(&patches) {
                for (k, &point) in (0..).zip(points) {
                    let [i, j] = [k % (steps + 1), k / (steps + 1)];
                    // A refinement gives caps fewer cells.
                    if refined.patch_grid(patch as usize) == (steps, steps) {
                        let vertex = refined.grid_vertex(patch as usize, i, j);
                        assert_eq!(vertex.position, point, "{patch} {i} {j}");
                    }
                }
            }
        }
    }
}
