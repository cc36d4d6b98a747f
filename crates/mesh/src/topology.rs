//! Topology by index: is the mesh closed, manifold, oriented, of how many parts and which genus?
//!
//! Half-edges are sorted into buckets by their lower vertex (compressed rows), each bucket by the
//! other end; every run of equal ends is one edge. A disjoint-set forest over the corners then
//! joins what meets at an edge: a vertex whose corners form more than one set is where fans touch
//! in one point only.

use std::borrow::Cow;

use glam::Vec3;
use rayon::prelude::*;
use serde::Serialize;

use crate::forest::Forest;
use crate::{CoarseMesh, Faces, SurfaceMesh};

/// What the indices of a mesh say of its shape.
///
/// A face that repeats a corner is counted as degenerate; repeats next to each other are dropped,
/// and what has fewer than three corners left, or still repeats one, has no part in the rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Topology {
    /// All vertices, whether a face names them or not.
    pub vertices: usize,
    /// Vertices that a face names.
    pub used_vertices: usize,
    /// Edges.
    pub edges: usize,
    /// Faces, without those that repeat a corner and collapse.
    pub faces: usize,
    /// Every edge has exactly two faces.
    pub closed: bool,
    /// No edge has more than two faces.
    pub edge_manifold: bool,
    /// The faces at every vertex form one fan, closed or open.
    pub vertex_manifold: bool,
    /// Faces run through each edge that they share in opposite directions.
    pub oriented: bool,
    /// Parts that share no vertex.
    pub components: usize,
    /// Used vertices − edges + faces.
    pub euler: i64,
    /// Handles of all components together, the surface taken as orientable: (2 components −
    /// euler) / 2. None if it is not closed or not manifold.
    pub genus: Option<i64>,
    /// Faces that repeat a corner or have no area (below 10⁻¹² of the longest edge squared).
    pub degenerate_faces: usize,
}

impl SurfaceMesh {
    /// See [`topology`].
    pub fn topology(&self) -> Topology {
        topology(&self.positions(), &self.faces)
    }
}

impl CoarseMesh {
    /// See [`topology`].
    pub fn topology(&self) -> Topology {
        topology(&self.positions(), &self.quads())
    }
}

/// Topology of faces over vertices; time grows with the faces.
///
/// Panics if a face names a vertex that is not there.
pub fn topology(positions: &[Vec3], faces: &Faces) -> Topology {
    let degenerate_faces = degenerate_faces(positions, faces);
    let kept = Corners::of(faces);
    let tally = edges(&kept, positions.len());

    let (fans, (components, used_vertices)) = rayon::join(
        || fans(&kept, &tally.joins),
        || components(&kept, positions.len()),
    );
    let vertex_manifold = tally.edge_manifold && fans == used_vertices;
    let faces = kept.triangles.len() + kept.quads.len();
    let euler = used_vertices as i64 - tally.edges as i64 + faces as i64;
    let twice_genus = 2 * components as i64 - euler;
    Topology {
        vertices: positions.len(),
        used_vertices,
        edges: tally.edges,
        faces,
        closed: tally.closed,
        edge_manifold: tally.edge_manifold,
        vertex_manifold,
        oriented: tally.oriented,
        components,
        euler,
        genus: (tally.closed && vertex_manifold && twice_genus % 2 == 0).then_some(twice_genus / 2),
        degenerate_faces,
    }
}

/// Handles of each component of a closed manifold, the components in the order of their lowest vertices.
/// Where edges do not have two faces each it says nothing.
///
/// Panics if a face names a vertex that is not there.
pub fn genus_by_component(vertices: usize, faces: &Faces) -> Vec<i64> {
    let kept = Corners::of(faces);
    let mut forest = Forest::new(vertices);
    let mut used = vec![false; vertices];
    for (_, from, to) in kept.half_edges() {
        used[from as usize] = true;
        forest.unite(from, to);
    }
    // Twice vertices − edges + faces, an edge being two half-edges.
    let mut twice_euler = vec![0i64; vertices];
    let mut add = |vertex: u32, sum: i64| twice_euler[forest.root(vertex) as usize] += sum;
    for vertex in (0..vertices as u32).filter(|&vertex| used[vertex as usize]) {
        add(vertex, 2);
    }
    kept.triangles.iter().for_each(|face| add(face[0], 2 - 3));
    kept.quads.iter().for_each(|face| add(face[0], 2 - 4));
    let components = (0..vertices as u32).filter(|&v| used[v as usize] && forest.root(v) == v);
    components
        .map(|vertex| (4 - twice_euler[vertex as usize]) / 4)
        .collect()
}

/// Corners of faces in one row: those of triangles, then those of quads. A corner also stands for
/// the half-edge that leaves it.
struct Corners<'a> {
    triangles: Cow<'a, [[u32; 3]]>,
    quads: Cow<'a, [[u32; 4]]>,
}

impl<'a> Corners<'a> {
    /// Faces without those that collapse.
    fn of(faces: &'a Faces) -> Self {
        let collapsed = faces.triangles.par_iter().any(|face| repeats(face))
            || faces.quads.par_iter().any(|face| repeats(face));
        if !collapsed {
            return Self {
                triangles: Cow::Borrowed(&faces.triangles),
                quads: Cow::Borrowed(&faces.quads),
            };
        }
        let mut triangles: Vec<_> = faces
            .triangles
            .iter()
            .filter(|face| !repeats(*face))
            .copied()
            .collect();
        let mut quads = Vec::new();
        for face in &faces.quads {
            let mut left = face.to_vec();
            left.dedup();
            if left.len() > 1 && left.first() == left.last() {
                left.pop();
            }
            match left[..] {
                _ if repeats(&left) => {}
                [a, b, c] => triangles.push([a, b, c]),
                [a, b, c, d] => quads.push([a, b, c, d]),
                _ => {}
            }
        }
        Self {
            triangles: Cow::Owned(triangles),
            quads: Cow::Owned(quads),
        }
    }

    fn len(&self) -> usize {
        3 * self.triangles.len() + 4 * self.quads.len()
    }

    fn vertex(&self, corner: usize) -> u32 {
        let split = 3 * self.triangles.len();
        if corner < split {
            self.triangles[corner / 3][corner % 3]
        } else {
            self.quads[(corner - split) / 4][(corner - split) % 4]
        }
    }

    fn next(&self, corner: usize) -> usize {
        let split = 3 * self.triangles.len();
        let (first, sides) = if corner < split { (0, 3) } else { (split, 4) };
        if (corner - first) % sides == sides - 1 {
            corner + 1 - sides
        } else {
            corner + 1
        }
    }

    /// All half-edges as (corner, from, to).
    fn half_edges(&self) -> impl Iterator<Item = (u32, u32, u32)> + '_ {
        let triangles = self
            .triangles
            .iter()
            .flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]);
        let quads = self
            .quads
            .iter()
            .flat_map(|&[a, b, c, d]| [(a, b), (b, c), (c, d), (d, a)]);
        (0..)
            .zip(triangles.chain(quads))
            .map(|(corner, (from, to))| (corner, from, to))
    }
}

/// What the edges say, and which corners meet at an edge.
struct EdgeTally {
    edges: usize,
    closed: bool,
    edge_manifold: bool,
    oriented: bool,
    /// By stretch of vertices: pairs of corners at the same vertex whose faces share an edge.
    joins: Vec<Vec<[u32; 2]>>,
}

/// Vertices whose buckets one task sorts; by eye: some tens of tasks for a million.
const STRETCH: usize = 1 << 14;

fn edges(corners: &Corners<'_>, vertices: usize) -> EdgeTally {
    assert!(
        corners.len() < u32::MAX as usize,
        "corners are numbered in 32 bits"
    );
    // Compressed rows: `end[v]` is where the bucket of v ends, once all are filled.
    let mut end = vec![0u32; vertices + 1];
    for (_, from, to) in corners.half_edges() {
        assert!(
            (from.max(to) as usize) < vertices,
            "a face names a vertex that is not there"
        );
        end[from.min(to) as usize + 1] += 1;
    }
    for vertex in 0..vertices {
        end[vertex + 1] += end[vertex];
    }
    let mut buckets = vec![(0u32, 0u32); corners.len()];
    for (corner, from, to) in corners.half_edges() {
        let slot = &mut end[from.min(to) as usize];
        buckets[*slot as usize] = (from.max(to), corner);
        *slot += 1;
    }

    let mut stretches = Vec::new();
    let mut rest = &mut buckets[..];
    let mut start = 0;
    for ends in end[..vertices].chunks(STRETCH) {
        let stop = ends[ends.len() - 1];
        let (mine, others) = rest.split_at_mut((stop - start) as usize);
        stretches.push((start, ends, mine));
        rest = others;
        start = stop;
    }
    let tallies: Vec<EdgeTally> = stretches
        .into_par_iter()
        .map(|(start, ends, buckets)| tally(corners, start, ends, buckets))
        .collect();
    tallies.into_iter().fold(
        EdgeTally {
            edges: 0,
            closed: true,
            edge_manifold: true,
            oriented: true,
            joins: vec![],
        },
        |mut sum, part| {
            sum.edges += part.edges;
            sum.closed &= part.closed;
            sum.edge_manifold &= part.edge_manifold;
            sum.oriented &= part.oriented;
            sum.joins.extend(part.joins);
            sum
        },
    )
}

/// Edges of a stretch of vertices: `ends` are where their buckets end, `start` where they begin.
fn tally(corners: &Corners<'_>, start: u32, ends: &[u32], buckets: &mut [(u32, u32)]) -> EdgeTally {
    let mut sum = EdgeTally {
        edges: 0,
        closed: true,
        edge_manifold: true,
        oriented: true,
        joins: vec![],
    };
    let mut joins = Vec::with_capacity(buckets.len());
    let mut from = 0;
    for &end in ends {
        let to = (end - start) as usize;
        let bucket = &mut buckets[from..to];
        from = to;
        bucket.sort_unstable();
        for edge in bucket.chunk_by(|a, b| a.0 == b.0) {
            // A half-edge that leaves the lower vertex has that vertex at its corner.
            let rises = |&(high, corner): &(u32, u32)| corners.vertex(corner as usize) != high;
            let rising = edge.iter().filter(|half| rises(half)).count();
            sum.edges += 1;
            sum.closed &= edge.len() == 2;
            sum.edge_manifold &= edge.len() <= 2;
            sum.oriented &= edge.len() == 1 || 2 * rising == edge.len();
            for pair in edge.windows(2) {
                let ends = |half: &(u32, u32)| {
                    let next = corners.next(half.1 as usize) as u32;
                    if rises(half) {
                        [half.1, next]
                    } else {
                        [next, half.1]
                    }
                };
                let ([low, high], [other_low, other_high]) = (ends(&pair[0]), ends(&pair[1]));
                joins.extend([[low, other_low], [high, other_high]]);
            }
        }
    }
    sum.joins.push(joins);
    sum
}

/// Number of fans: sets of corners at one vertex that hang together by edges.
fn fans(corners: &Corners<'_>, joins: &[Vec<[u32; 2]>]) -> usize {
    let mut forest = Forest::new(corners.len());
    let joined = joins
        .iter()
        .flatten()
        .filter(|&&[a, b]| forest.unite(a, b))
        .count();
    corners.len() - joined
}

/// Number of components and of vertices that a face names.
fn components(corners: &Corners<'_>, vertices: usize) -> (usize, usize) {
    let mut forest = Forest::new(vertices);
    let mut used = vec![false; vertices];
    let mut joined = 0;
    for (_, from, to) in corners.half_edges() {
        used[from as usize] = true;
        joined += usize::from(forest.unite(from, to));
    }
    let used = used.into_iter().filter(|&used| used).count();
    (used - joined, used)
}

fn repeats(face: &[u32]) -> bool {
    face.iter()
        .enumerate()
        .any(|(at, corner)| face[..at].contains(corner))
}

fn degenerate_faces(positions: &[Vec3], faces: &Faces) -> usize {
    let flat = |corners: [u32; 3]| !has_area(corners.map(|corner| positions[corner as usize]));
    let triangles = faces
        .triangles
        .par_iter()
        .filter(|face| repeats(*face) || flat(**face));
    let quads = faces
        .quads
        .par_iter()
        .filter(|&&[a, b, c, d]| repeats(&[a, b, c, d]) || (flat([a, b, c]) && flat([a, c, d])));
    triangles.count() + quads.count()
}

/// Rounding in f64 stays far below this share of the longest edge squared.
const FLAT: f64 = 1e-12;

fn has_area([a, b, c]: [Vec3; 3]) -> bool {
    let [a, b, c] = [a.as_dvec3(), b.as_dvec3(), c.as_dvec3()];
    let longest = (b - a).length_squared().max((c - b).length_squared());
    (b - a).cross(c - a).length() > FLAT * longest.max((a - c).length_squared())
}
