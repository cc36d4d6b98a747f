//! A coarse mesh's tubes as paths: from a start through forks to a tip, always along the branch
//! that reaches farthest. A branch that leaves such a path is a path of its own, which starts at
//! the fork, or ends there where the fork's children are the trunk.
//!
//! Since paths go on through forks, there are only as many paths as tips, and a neuron far away
//! takes only as many chunks; and there is no seam along the main branch of a fork.

use std::collections::BTreeMap;

use glam::Vec3;
use neurotess_mesh::{CoarseMesh, PatchKind, Role};

const NONE: u32 = u32::MAX;

/// A path along tracing points.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct TubePath {
    /// At least two.
    pub(crate) points: Vec<PathPoint>,
    /// Tracing point of the fork that it starts from.
    pub(crate) fork: Option<u32>,
    /// Whether nothing closes it at its beginning: no soma, no fork.
    pub(crate) starts_free: bool,
}

/// A tracing point on a path.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct PathPoint {
    pub(crate) center: Vec3,
    pub(crate) radius: f32,
    /// Tracing point that it takes its color from.
    pub(crate) tracing: u32,
}

/// All paths of a mesh, each after the one that it branches off from.
pub(crate) fn tube_paths(mesh: &CoarseMesh) -> Vec<TubePath> {
    let tree = Tree::new(mesh);
    let far = tree.reaches(mesh);
    let mut paths = Vec::new();
    let mut starts: Vec<(u32, u32)> = (0..mesh.tracing.len() as u32)
        .filter(|&point| tree.parents[point as usize] == NONE && !tree.of(point).is_empty())
        .map(|point| (NONE, point))
        .collect();
    starts.reverse();
    while let Some((fork, first)) = starts.pop() {
        let mut path = TubePath {
            fork: (fork != NONE).then_some(fork),
            starts_free: fork == NONE && !leaves_soma(mesh, first),
            ..TubePath::default()
        };
        if fork != NONE {
            // The branch starts with its own width and color, since the main branch draws the fork.
            path.points.push(PathPoint {
                center: mesh.tracing[fork as usize].center,
                ..point(mesh, first)
            });
        }
        if fork == NONE && leaves_soma(mesh, first) {
            // Starts inside the soma, so that no gap shows however the neurite bends.
            let mut inside = point(mesh, first);
            inside.center -= mesh.tracing[first as usize].tangent * inside.radius;
            path.points.push(inside);
        }
        let mut at = first;
        loop {
            path.points.push(point(mesh, at));
            let children = tree.of(at);
            let farthest = |&&child: &&u32| {
                let [a, b] = [at, child].map(|p| mesh.tracing[p as usize].center);
                far[child as usize] + a.distance(b)
            };
            let main = children
                .iter()
                .max_by(|a, b| farthest(a).total_cmp(&farthest(b)).then(b.cmp(a)));
            let Some(&main) = main else {
                // The parent of a trunk ends inside it, so that no gap shows.
                if let Some(trunk) = tree.trunks.get(&at) {
                    let [a, b] = trunk.map(|ring| mesh.tracing[ring as usize].center);
                    let end = point(mesh, at);
                    path.points.push(PathPoint {
                        center: a.midpoint(b),
                        ..end
                    });
                }
                break;
            };
            let others = children.iter().rev().filter(|&&child| child != main);
            starts.extend(others.map(|&child| (at, child)));
            at = main;
        }
        if path.points.len() > 1 {
            paths.push(path);
        }
    }
    paths
}

fn leaves_soma(mesh: &CoarseMesh, point: u32) -> bool {
    matches!(
        mesh.tracing[point as usize].role,
        Role::Insertion | Role::Inset
    )
}

fn point(mesh: &CoarseMesh, tracing: u32) -> PathPoint {
    let of_mesh = &mesh.tracing[tracing as usize];
    let radius = of_mesh.radius.max(0.0);
    PathPoint {
        center: of_mesh.center,
        radius: if radius.is_finite() { radius } else { 0.0 },
        tracing,
    }
}

/// Which tracing point follows which.
struct Tree {
    parents: Vec<u32>,
    /// Children of all points, one after the other, and where those of each point begin.
    children: Vec<u32>,
    first: Vec<u32>,
    /// The trunk's rings before and after the inset that a path ends in, by that.
    trunks: BTreeMap<u32, [u32; 2]>,
}

impl Tree {
    /// Lateral patches lead from the ring of a parent (corners 0 and 1) to that of a child (3 and 2),
    /// lofts from a trunk's to an inset that a path begins in.
    fn new(mesh: &CoarseMesh) -> Self {
        let count = mesh.tracing.len();
        let mut parents = vec![NONE; count];
        let mut trunks = BTreeMap::new();
        let of = |corner: u32| mesh.vertices[corner as usize].tracing;
        for patch in &mesh.patches {
            let [near, beside, _, far] = patch.corners.map(of);
            let leads = match patch.kind {
                PatchKind::Lateral => true,
                PatchKind::Loft if mesh.tracing[far as usize].collar < 0.0 => {
                    let [before, after] = trunks.entry(far).or_insert([near, near]);
                    *before = near.min(beside).min(*before);
                    *after = near.max(beside).max(*after);
                    false
                }
                PatchKind::Loft => mesh.tracing[near as usize].role != Role::Soma,
                PatchKind::Cap | PatchKind::Soma => false,
            };
            let tube = leads && near != far;
            if tube && parents[far as usize] == NONE && !leads_to(&parents, near, far) {
                parents[far as usize] = near;
            }
        }
        let mut first = vec![0; count + 1];
        for &parent in parents.iter().filter(|&&parent| parent != NONE) {
            first[parent as usize + 1] += 1;
        }
        for i in 0..count {
            first[i + 1] += first[i];
        }
        let mut next = first.clone();
        let mut children = vec![0; first[count] as usize];
        for (child, &parent) in parents.iter().enumerate() {
            if parent != NONE {
                children[next[parent as usize] as usize] = child as u32;
                next[parent as usize] += 1;
            }
        }
        Self {
            parents,
            children,
            first,
            trunks,
        }
    }

    fn of(&self, point: u32) -> &[u32] {
        let point = point as usize;
        &self.children[self.first[point] as usize..self.first[point + 1] as usize]
    }

    /// Length (µm) of the longest path from each point to a tip.
    fn reaches(&self, mesh: &CoarseMesh) -> Vec<f32> {
        let mut order: Vec<u32> = Vec::with_capacity(self.parents.len());
        let roots = (0..).zip(&self.parents).filter(|(_, p)| **p == NONE);
        order.extend(roots.map(|(root, _)| root));
        let mut i = 0;
        while i < order.len() {
            order.extend(self.of(order[i]));
            i += 1;
        }
        let mut far = vec![0.0_f32; self.parents.len()];
        for &point in order.iter().rev() {
            let parent = self.parents[point as usize];
            if parent != NONE {
                let [a, b] = [point, parent].map(|p| mesh.tracing[p as usize].center);
                far[parent as usize] =
                    far[parent as usize].max(far[point as usize] + a.distance(b));
            }
        }
        far
    }
}

/// Whether `from` descends from `ancestor`: then a patch from `from` to `ancestor` would close a
/// circle, which only a mesh of something other than a tree has.
fn leads_to(parents: &[u32], from: u32, ancestor: u32) -> bool {
    // Meshes that we generate have the patches of parents before those of children, so that the
    // child has no descendants yet. Where a parent comes later it is rare, and its chain is short.
    let mut at = from;
    for _ in 0..parents.len() {
        if at == ancestor {
            return true;
        }
        match parents[at as usize] {
            NONE => return false,
            parent if parent < at && ancestor > at => return false,
            parent => at = parent,
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use neurotess_mesh::{Patch, TracingPoint, Vertex};

    use super::*;

    /// Rings of four vertices at these centers, joined in pairs.
    fn rings(centers: &[Vec3], pairs: &[[u32; 2]]) -> CoarseMesh {
        let mut mesh = CoarseMesh::default();
        for (i, &center) in centers.iter().enumerate() {
            mesh.tracing.push(TracingPoint {
                center,
                radius: 1.0 + i as f32,
                ..TracingPoint::default()
            });
            mesh.vertices.extend(
                [Vertex {
                    tracing: i as u32,
                    ..Vertex::default()
                }; 4],
            );
        }
        for &[a, b] in pairs {
            for k in 0..4 {
                let after = (k + 1) % 4;
                mesh.patches.push(Patch {
                    corners: [4 * a + k, 4 * a + after, 4 * b + after, 4 * b + k],
                    kind: PatchKind::Lateral,
                });
            }
        }
        mesh
    }

    fn ids(path: &TubePath) -> Vec<u32> {
        path.points.iter().map(|point| point.tracing).collect()
    }

    #[test]
    fn paths_go_on_along_the_branch_that_reaches_farthest() {
        let centers = [0.0, 1.0, 2.0, 9.0, 3.0].map(|x| Vec3::X * x);
        let mesh = rings(&centers, &[[0, 1], [1, 2], [1, 3], [2, 4]]);
        let paths = tube_paths(&mesh);
        assert_eq!(paths.len(), 2);
        assert_eq!(ids(&paths[0]), [0, 1, 3]);
        // The other branch starts at the fork, as wide as its own first point.
        assert_eq!(ids(&paths[1]), [2, 2, 4]);
        assert_eq!(paths[1].points[0].center, Vec3::X);
        assert_eq!(paths[1].points[0].radius, 3.0);
        assert!(paths[0].starts_free && !paths[1].starts_free);
    }

    #[test]
    fn a_path_ends_inside_the_trunk_across_it() {
        let centers = [0.0, 1.0, 2.0].map(|x| Vec3::X * x);
        let beside = [2.0, 1.0].map(|y| Vec3::new(1.0, y, 0.0));
        let mut mesh = rings(
            &[centers.as_slice(), &beside].concat(),
            &[[0, 1], [1, 2], [3, 4]],
        );
        mesh.tracing[4].collar = -0.2;
        for corners in [[4, 5, 17, 16], [5, 9, 18, 17]] {
            let kind = PatchKind::Loft;
            mesh.patches.push(Patch { corners, kind });
        }
        let paths = tube_paths(&mesh);
        assert_eq!(
            paths.iter().map(ids).collect::<Vec<_>>(),
            [[0, 1, 2], [3, 4, 4]]
        );
        assert_eq!(paths[1].points[2].center, Vec3::X * 1.5);
        assert!(paths[0].starts_free && paths[1].starts_free);
    }

    #[test]
    fn a_circle_of_rings_is_cut_open() {
        let centers = [Vec3::ZERO, Vec3::X, Vec3::Y];
        let paths = tube_paths(&rings(&centers, &[[0, 1], [1, 2], [2, 0]]));
        assert_eq!(paths.iter().map(ids).collect::<Vec<_>>(), [[0, 1, 2]]);
    }
}
