//! How sound some patches are: crossing pairs of facets of their refined surface, and folded edges.
//!
//! A judgement of one choice beside another, thousands of times a cell: in single precision, and without
//! the exact predicates of [`neurotess_mesh::self_intersections`], which has the last word.

use glam::Vec3;
use neurotess_mesh::{CoarseMesh, Patch, SurfaceMesh, Vertex};
use neurotess_refine::{LodCriterion, RefineOptions, Refinement};

/// Level at which patches are judged.
const LEVEL: u32 = 2;
/// Facets folded by more than this count: cosine of 120°.
const FOLDED: f32 = -0.5;

/// Crossing pairs and folded edges of some patches' refined surface.
pub(crate) fn faults(mesh: &CoarseMesh, patches: &[u32]) -> usize {
    let part = part(mesh, patches);
    let options = RefineOptions::default();
    let level = LodCriterion::Homogeneous(LEVEL);
    let surface = SurfaceMesh::collect(&Refinement::new(&part, level, &options));
    let mut facets: Vec<Facet> = surface
        .faces
        .triangles
        .iter()
        .map(|&corners| Facet::new(corners, &surface))
        .collect();
    folds(&facets) + crossings(&mut facets)
}

/// A mesh of some patches only.
fn part(mesh: &CoarseMesh, patches: &[u32]) -> CoarseMesh {
    let mut patches = patches.to_vec();
    patches.sort_unstable();
    patches.dedup();
    let corners = |&patch: &u32| mesh.patches[patch as usize].corners;
    // In the mesh's order: edges run from the lower number.
    let mut vertices: Vec<u32> = patches.iter().flat_map(corners).collect();
    vertices.sort_unstable();
    vertices.dedup();
    let tracing_of = |v: u32| mesh.vertices[v as usize].tracing;
    let mut tracing: Vec<u32> = vertices.iter().map(|&v| tracing_of(v)).collect();
    tracing.sort_unstable();
    tracing.dedup();
    let number = |list: &[u32], of: u32| list.partition_point(|&x| x < of) as u32;
    CoarseMesh {
        origin: mesh.origin,
        vertices: vertices
            .iter()
            .map(|&v| {
                let vertex = mesh.vertices[v as usize];
                let tracing = number(&tracing, vertex.tracing);
                Vertex { tracing, ..vertex }
            })
            .collect(),
        tracing: tracing.iter().map(|&t| mesh.tracing[t as usize]).collect(),
        patches: patches
            .iter()
            .map(|&p| {
                let patch = mesh.patches[p as usize];
                let corners = patch.corners.map(|v| number(&vertices, v));
                Patch { corners, ..patch }
            })
            .collect(),
    }
}

struct Facet {
    /// Vertices' numbers.
    corners: [u32; 3],
    points: [Vec3; 3],
    low: Vec3,
    high: Vec3,
    /// Unit, or zero where the facet has no area.
    normal: Vec3,
}

impl Facet {
    fn new(corners: [u32; 3], surface: &SurfaceMesh) -> Self {
        let points = corners.map(|v| surface.vertices[v as usize].position);
        let [a, b, c] = points;
        Self {
            corners,
            points,
            low: a.min(b).min(c),
            high: a.max(b).max(c),
            normal: (b - a).cross(c - a).normalize_or_zero(),
        }
    }

    /// Height of a point over the facet's plane.
    fn height(&self, p: Vec3) -> f32 {
        (p - self.points[0]).dot(self.normal)
    }

    /// Whether a segment, whose ends are at these heights, passes through.
    fn is_passed(&self, [p, q]: [Vec3; 2], [from, to]: [f32; 2]) -> bool {
        if from * to >= 0.0 {
            return false;
        }
        let at = p + (q - p) * (from / (from - to));
        let inside = |k: usize| {
            let (a, b) = (self.points[k], self.points[(k + 1) % 3]);
            (b - a).cross(at - a).dot(self.normal)
        };
        (0..3).all(|k| inside(k) > 0.0)
    }

    /// Whether an edge of `other` passes through; `shared`: vertices that both have.
    fn is_passed_by(&self, other: &Self, shared: impl Fn(u32) -> bool) -> bool {
        let mut heights = other.points.map(|p| self.height(p));
        for (height, corner) in heights.iter_mut().zip(other.corners) {
            if shared(corner) {
                *height = 0.0;
            }
        }
        (0..3).any(|k| {
            let next = (k + 1) % 3;
            let edge = [other.points[k], other.points[next]];
            self.is_passed(edge, [heights[k], heights[next]])
        })
    }
}

/// Pairs of facets that cross; those with a common edge are the folds' concern.
fn crossings(facets: &mut [Facet]) -> usize {
    facets.sort_by(|a, b| a.low.x.total_cmp(&b.low.x));
    let mut count = 0;
    for (i, a) in facets.iter().enumerate() {
        let near = facets[i + 1..].iter().take_while(|b| b.low.x <= a.high.x);
        for b in near {
            let overlap = a.low.cmple(b.high) & b.low.cmple(a.high);
            if overlap.all() && cross(a, b) {
                count += 1;
            }
        }
    }
    count
}

fn cross(a: &Facet, b: &Facet) -> bool {
    let shared = |corner: u32| a.corners.contains(&corner) && b.corners.contains(&corner);
    let common = a.corners.iter().filter(|c| b.corners.contains(c)).count();
    common < 2 && (a.is_passed_by(b, shared) || b.is_passed_by(a, shared))
}

/// Edges between facets that are folded over.
fn folds(facets: &[Facet]) -> usize {
    let mut edges: Vec<(u32, u32, u32)> = Vec::with_capacity(3 * facets.len());
    for (t, facet) in (0..).zip(facets) {
        let [a, b, c] = facet.corners;
        for (p, q) in [(a, b), (b, c), (c, a)] {
            edges.push((p.min(q), p.max(q), t));
        }
    }
    edges.sort_unstable();
    let folded = |pair: &&[(u32, u32, u32)]| {
        let [a, b] = [pair[0], pair[1]];
        let normals = [a.2, b.2].map(|t| facets[t as usize].normal);
        (a.0, a.1) == (b.0, b.1) && normals[0].dot(normals[1]) < FOLDED
    };
    edges.windows(2).filter(folded).count()
}
