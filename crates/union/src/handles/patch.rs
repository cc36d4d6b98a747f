//! A piece of the surface, and the short loops of the handles that lie whole within it.
//!
//! **Theory.** The borders of the piece are thought closed, each by a face of its own. So a tube that comes in and
//! goes out makes no handle, and neither does a stretch of a large loop: only what is local counts (I. Guskov,
//! Z. Wood, Topological Noise Removal, 2001). Loops are those of J. Erickson, K. Whittlesey, Greedy Optimal Homotopy
//! and Homology Generators, 2005: a tree of shortest paths over edges, a tree over the faces across the other edges,
//! and one loop for each edge that is in neither.

use std::cmp::Ordering;
use std::collections::{BinaryHeap, HashMap};

use glam::DVec3;
use neurotess_mesh::Forest;

use crate::surface::work::Work;

/// Faces with vertices of their own: one that two fans of these faces have in common is two.
pub(super) struct Patch {
    /// The surface's vertex of each vertex.
    names: Vec<u32>,
    edges: Vec<Edge>,
    /// Edges of each vertex.
    spokes: Vec<Vec<u32>>,
    /// How many faces and borders there are.
    sides: usize,
}

struct Edge {
    ends: [u32; 2],
    /// What lies on both sides: numbers of faces, and after these of borders.
    sides: [u32; 2],
    length: f64,
}

/// A closed path over edges of the surface.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Loop {
    /// Vertices of the surface, in order.
    pub(super) vertices: Vec<u32>,
    /// µm.
    pub(super) length: f64,
}

impl Loop {
    /// Its corners.
    pub(super) fn points(&self, work: &Work) -> Vec<DVec3> {
        let points = self.vertices.iter();
        points.map(|&v| work.position(v).as_dvec3()).collect()
    }
}

impl Patch {
    pub(super) fn new(work: &Work, faces: &[u32]) -> Self {
        let corners: Vec<u32> = faces
            .iter()
            .flat_map(|&face| work.triangles[face as usize])
            .collect();
        let twins = twins(&corners);
        let (fans, names) = fans(&corners, &twins);
        let borders = borders(&twins);
        let edge = |corner: usize| {
            let ends = [fans[corner], fans[next(corner)]];
            let [a, b] = ends.map(|end| work.position(names[end as usize]).as_dvec3());
            let across = match twins[corner] {
                Some(twin) => twin / 3,
                None => borders[corner] + faces.len() as u32,
            };
            Edge {
                ends,
                sides: [corner as u32 / 3, across],
                length: a.distance(b),
            }
        };
        let is_first = |&corner: &usize| twins[corner].is_none_or(|twin| corner < twin as usize);
        let edges: Vec<Edge> = (0..corners.len()).filter(is_first).map(edge).collect();
        let mut spokes = vec![Vec::new(); names.len()];
        for (n, edge) in (0..).zip(&edges) {
            for end in edge.ends {
                spokes[end as usize].push(n);
            }
        }
        let sides = edges.iter().flat_map(|edge| edge.sides).max();
        Self {
            names,
            edges,
            spokes,
            sides: sides.map_or(0, |last| last as usize + 1),
        }
    }

    /// Handles that lie whole within the patch.
    pub(super) fn handles(&self) -> i64 {
        let mut forest = Forest::new(self.names.len());
        let joined = |edge: &&Edge| forest.unite(edge.ends[0], edge.ends[1]);
        let pieces = self.names.len() - self.edges.iter().filter(joined).count();
        let euler = self.names.len() as i64 - self.edges.len() as i64 + self.sides as i64;
        (2 * pieces as i64 - euler) / 2
    }

    /// Two loops for each handle of the piece that a vertex of the surface is in, of those within `reach` of it along
    /// edges: the shortest ones through it, or shorter ones that hang on a common path to it.
    pub(super) fn loops(&self, name: u32, reach: f64) -> Vec<Loop> {
        let Some(from) = self.names.iter().position(|&other| other == name) else {
            return Vec::new();
        };
        let paths = self.shortest_paths(from as u32, reach);
        // The tree over faces takes the edges in the order of the loops that they would make, the longest first.
        let mut faces = Forest::new(self.sides);
        let mut near: Vec<(f64, u32)> = Vec::new();
        for (n, edge) in (0..).zip(&self.edges) {
            let length = paths.around(edge);
            if !length.is_finite() {
                faces.unite(edge.sides[0], edge.sides[1]);
            } else if !edge.ends.iter().any(|&end| paths.is_last(n, end)) {
                near.push((length, n));
            }
        }
        near.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let mut crosses = |n: u32| {
            let [a, b] = self.edges[n as usize].sides;
            faces.unite(a, b)
        };
        let left = near.into_iter().filter(|&(_, n)| !crosses(n));
        left.map(|(_, n)| self.closed(&paths, n)).collect()
    }

    /// The shortest paths over edges from a vertex, no longer than `reach` (E. Dijkstra, 1959).
    fn shortest_paths(&self, from: u32, reach: f64) -> Paths {
        let mut paths = Paths {
            lengths: vec![f64::INFINITY; self.names.len()],
            last: vec![None; self.names.len()],
        };
        paths.lengths[from as usize] = 0.0;
        let mut open = BinaryHeap::from([Reached(0.0, from)]);
        while let Some(Reached(length, vertex)) = open.pop() {
            if length > paths.lengths[vertex as usize] {
                continue;
            }
            for &n in &self.spokes[vertex as usize] {
                let edge = &self.edges[n as usize];
                let other = edge.other(vertex);
                let there = length + edge.length;
                if there <= reach && there < paths.lengths[other as usize] {
                    paths.lengths[other as usize] = there;
                    paths.last[other as usize] = Some(n);
                    open.push(Reached(there, other));
                }
            }
        }
        paths
    }

    /// The loop of an edge and the paths to its ends, without what both have in common.
    fn closed(&self, paths: &Paths, edge: u32) -> Loop {
        let back = |end: u32| {
            let mut path = vec![end];
            let mut at = end;
            while let Some(last) = paths.last[at as usize] {
                at = self.edges[last as usize].other(at);
                path.push(at);
            }
            path
        };
        let edge = &self.edges[edge as usize];
        let [mut path, mut other] = edge.ends.map(back);
        while path.len() > 1 && other.len() > 1 && path[path.len() - 2] == other[other.len() - 2] {
            path.pop();
            other.pop();
        }
        let common = other.pop().map_or(0.0, |at| paths.lengths[at as usize]);
        path.extend(other.into_iter().rev());
        Loop {
            vertices: path.into_iter().map(|v| self.names[v as usize]).collect(),
            length: paths.around(edge) - 2.0 * common,
        }
    }
}

impl Edge {
    fn other(&self, end: u32) -> u32 {
        self.ends[usize::from(self.ends[0] == end)]
    }
}

/// Shortest paths from one vertex: for each other their length, infinite if there is none, and their last edge.
struct Paths {
    lengths: Vec<f64>,
    last: Vec<Option<u32>>,
}

impl Paths {
    fn is_last(&self, edge: u32, vertex: u32) -> bool {
        self.last[vertex as usize] == Some(edge)
    }

    /// Length of an edge and of the paths to both of its ends.
    fn around(&self, edge: &Edge) -> f64 {
        let [a, b] = edge.ends.map(|end| self.lengths[end as usize]);
        a + edge.length + b
    }
}

/// A vertex, and how long a path to it is; the shortest is the greatest.
#[derive(PartialEq)]
struct Reached(f64, u32);

impl Eq for Reached {}

impl Ord for Reached {
    fn cmp(&self, other: &Self) -> Ordering {
        other.0.total_cmp(&self.0).then(other.1.cmp(&self.1))
    }
}

impl PartialOrd for Reached {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// The corner after a corner of the same triangle. A corner also stands for the half-edge that leaves it.
fn next(corner: usize) -> usize {
    corner - corner % 3 + (corner + 1) % 3
}

/// For each half-edge the one of the face across; none at borders.
fn twins(corners: &[u32]) -> Vec<Option<u32>> {
    let ends = |corner: usize| (corners[corner], corners[next(corner)]);
    let half_edges: HashMap<(u32, u32), u32> = (0..corners.len())
        .map(|corner| (ends(corner), corner as u32))
        .collect();
    let twin = |corner: usize| {
        let (from, to) = ends(corner);
        half_edges.get(&(to, from)).copied()
    };
    (0..corners.len()).map(twin).collect()
}

/// Corners at one vertex whose faces share edges there are one vertex of the patch: for each corner its number, and
/// for each number the name.
fn fans(corners: &[u32], twins: &[Option<u32>]) -> (Vec<u32>, Vec<u32>) {
    let mut forest = Forest::new(corners.len());
    for (corner, twin) in twins.iter().enumerate() {
        if let Some(twin) = *twin {
            forest.unite(corner as u32, next(twin as usize) as u32);
        }
    }
    let mut numbers = vec![0; corners.len()];
    let mut names = Vec::new();
    for corner in 0..corners.len() {
        let root = forest.root(corner as u32) as usize;
        if root == corner {
            numbers[corner] = names.len() as u32;
            names.push(corners[corner]);
        } else {
            numbers[corner] = numbers[root];
        }
    }
    (numbers, names)
}

/// For each half-edge at a border the number of that border.
fn borders(twins: &[Option<u32>]) -> Vec<u32> {
    let mut numbers = vec![u32::MAX; twins.len()];
    let mut count = 0;
    for first in 0..twins.len() {
        if twins[first].is_some() || numbers[first] != u32::MAX {
            continue;
        }
        let mut at = first;
        while numbers[at] == u32::MAX {
            numbers[at] = count;
            // Around the vertex at its end, through the faces of the patch.
            at = next(at);
            while let Some(twin) = twins[at] {
                at = next(twin as usize);
            }
        }
        count += 1;
    }
    numbers
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use neurotess_mesh::{SurfaceMesh, SurfaceVertex};

    use super::*;

    /// A torus of rings about the z axis.
    fn torus(rings: u32, sides: u32, hole: f32) -> Work {
        let mut mesh = SurfaceMesh::default();
        for ring in 0..rings {
            for side in 0..sides {
                let [around, across] = [(ring, rings), (side, sides)]
                    .map(|(n, of)| std::f32::consts::TAU * n as f32 / of as f32);
                let out = 1.0 + hole + across.cos();
                mesh.vertices.push(SurfaceVertex {
                    position: Vec3::new(out * around.cos(), out * around.sin(), across.sin()),
                    ..SurfaceVertex::default()
                });
                let at = |r: u32, s: u32| (ring + r) % rings * sides + (side + s) % sides;
                mesh.faces
                    .quads
                    .push([at(0, 0), at(1, 0), at(1, 1), at(0, 1)]);
            }
        }
        Work::new(&mesh).expect("a surface")
    }

    #[test]
    fn a_torus_has_a_handle_with_two_loops() {
        let work = torus(12, 8, 0.5);
        let faces: Vec<u32> = (0..work.triangles.len() as u32).collect();
        let patch = Patch::new(&work, &faces);
        assert_eq!(patch.handles(), 1);
        // From a vertex at the hole: once around the hole, and once around the tube.
        let loops = patch.loops(4, f64::INFINITY);
        let mut lengths: Vec<f64> = loops.iter().map(|l| l.length).collect();
        lengths.sort_by(f64::total_cmp);
        assert_eq!(lengths.len(), 2);
        assert!((lengths[0] - 24.0 * 0.5 * (std::f64::consts::PI / 12.0).sin()).abs() < 1e-4);
        assert!((lengths[1] - 16.0 * (std::f64::consts::PI / 8.0).sin()).abs() < 1e-4);
        assert!(
            loops
                .iter()
                .all(|l| l.vertices.len() == 12 || l.vertices.len() == 8)
        );
    }

    #[test]
    fn a_piece_of_a_torus_has_no_handle() {
        let work = torus(12, 8, 0.5);
        // Without a ring of faces: a tube.
        let faces: Vec<u32> = (16..work.triangles.len() as u32).collect();
        let patch = Patch::new(&work, &faces);
        assert_eq!(patch.handles(), 0);
        assert!(patch.loops(4, f64::INFINITY).is_empty());
        // Without a face the handle is there.
        let faces: Vec<u32> = (1..work.triangles.len() as u32).collect();
        assert_eq!(Patch::new(&work, &faces).handles(), 1);
        // Two faces that share a corner only are two pieces.
        let apart = Patch::new(&work, &[0, 18]);
        assert_eq!((apart.handles(), apart.names.len()), (0, 6));
    }
}
