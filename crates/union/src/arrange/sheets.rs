//! From pieces to faces with vertices of their own.
//!
//! Where the union touches itself along an edge or in a vertex, sheets are told apart: each **fan** of faces
//! around a vertex has a vertex of its own, at the same position; [`crate::mend::touch`] parts them.

use std::collections::{HashMap, HashSet};

use glam::DVec3;
use neurotess_mesh::{Forest, SurfaceVertex};

use crate::arrange::engine::{Arrangement, HalfFace};
use crate::arrange::region::Region;
use crate::surface::work::Work;

/// A piece that is kept.
pub(crate) struct Kept {
    /// Number in the region.
    pub(crate) source: u32,
    /// Vertices of the arrangement.
    pub(crate) corners: [u32; 3],
}

/// Faces of the union near the region, and which of their corners are one vertex.
pub(crate) struct Sheets<'a> {
    region: &'a Region,
    arrangement: &'a Arrangement,
    kept: &'a [Kept],
    /// Faces outside the region that stay and touch it.
    beside: Vec<u32>,
    /// Corners of `kept`, then of `beside`: the same set if the same vertex.
    fans: Forest,
    /// Half-edges of `kept` joined at edges of more than two faces.
    wedges: Vec<[u32; 2]>,
}

/// A half-edge of [`Sheets`]: ends, lower first, and the corner that it leaves.
type HalfEdge = ([u32; 2], u32);

impl<'a> Sheets<'a> {
    /// None if what is kept does not close.
    pub(crate) fn new(
        work: &Work,
        region: &'a Region,
        arrangement: &'a Arrangement,
        kept: &'a [Kept],
        stays: &[bool],
    ) -> Option<Self> {
        let (beside, numbers) = beside(work, region, arrangement, stays);
        let corners: Vec<u32> = kept
            .iter()
            .map(|piece| piece.corners)
            .chain(numbers)
            .flatten()
            .collect();
        let mut sheets = Self {
            region,
            arrangement,
            kept,
            beside,
            fans: Forest::new(corners.len()),
            wedges: Vec::new(),
        };
        sheets.join(&corners)?;
        Some(sheets)
    }

    /// Joins the corners of faces that share an edge.
    fn join(&mut self, corners: &[u32]) -> Option<()> {
        let mut edges: Vec<HalfEdge> = (0..corners.len())
            .map(|n| {
                let (from, to) = (corners[n], corners[next(n)]);
                ([from.min(to), from.max(to)], n as u32)
            })
            .collect();
        edges.sort_unstable();
        let rises = |edge: &HalfEdge| corners[edge.1 as usize] == edge.0[0];
        let inside = 3 * self.kept.len() as u32;
        for edge in edges.chunk_by(|a, b| a.0 == b.0) {
            match edge {
                // The outer side of a face beside the region.
                [one] if one.1 >= inside => {}
                [a, b] if rises(a) != rises(b) => self.unite(a.1, b.1),
                _ if edge.len() > 2 && edge.iter().all(|half| half.1 < inside) => {
                    for [a, b] in self.wedges(corners, edge)? {
                        self.unite(a, b);
                        self.wedges.push([a, b]);
                    }
                }
                _ => return None,
            }
        }
        Some(())
    }

    /// Joins two half-edges that run opposite ways.
    fn unite(&mut self, a: u32, b: u32) {
        self.fans.unite(a, next(b as usize) as u32);
        self.fans.unite(next(a as usize) as u32, b);
    }

    /// Half-edges of more than two faces in pairs: those that have the solid between them, so that bodies
    /// that touch along an edge stay two.
    fn wedges(&self, corners: &[u32], edge: &[HalfEdge]) -> Option<Vec<[u32; 2]>> {
        let [low, high] = edge[0].0;
        let rising = |corner: u32| corners[corner as usize] == low;
        let faces: Vec<HalfFace> = edge
            .iter()
            .map(|&(_, corner)| HalfFace {
                id: corner as usize,
                rising: rising(corner),
                apex: corners[next(next(corner as usize))],
            })
            .collect();
        let around = self.arrangement.around(low, high, &faces);
        if around.len() != edge.len() {
            return None;
        }
        // The solid lies clockwise of a face that rises, and counter-clockwise of one that falls.
        let mut pairs = Vec::new();
        for (n, &face) in around.iter().enumerate() {
            let (face, before) = (
                face as u32,
                around[(n + around.len() - 1) % around.len()] as u32,
            );
            match (rising(face), rising(before)) {
                (true, false) => pairs.push([face, before]),
                (false, true) => {}
                _ => return None,
            }
        }
        Some(pairs)
    }

    /// The faces of `kept`, each with the number of its source; makes the vertices that are new.
    pub(crate) fn faces(mut self, work: &mut Work) -> Vec<(u32, [u32; 3])> {
        let corners = self.vertices(work);
        let middles = self.middles(work, &corners);
        let mut faces = Vec::with_capacity(corners.len());
        for (n, (piece, corners)) in self.kept.iter().zip(corners).enumerate() {
            let middles = [0, 1, 2].map(|side| middles.get(&(3 * n as u32 + side)).copied());
            faces.extend(divided(corners, middles).map(|face| (piece.source, face)));
        }
        faces
    }

    /// Two wedges at one edge may be one fan at both its ends; then the edge would have four faces. Each gets a
    /// vertex in its middle, of its own: for each half-edge, that vertex.
    fn middles(&self, work: &mut Work, corners: &[[u32; 3]]) -> HashMap<u32, u32> {
        let vertex = |corner: usize| corners[corner / 3][corner % 3];
        let ends = |corner: u32| {
            let [a, b] = [vertex(corner as usize), vertex(next(corner as usize))];
            [a.min(b), a.max(b)]
        };
        let mut count: HashMap<[u32; 2], usize> = HashMap::new();
        for &[a, _] in &self.wedges {
            *count.entry(ends(a)).or_default() += 1;
        }
        let mut middles = HashMap::new();
        for &[a, b] in self.wedges.iter().filter(|[a, _]| count[&ends(*a)] > 1) {
            let [from, to] = ends(a).map(|vertex| work.vertices[vertex as usize]);
            let middle = work.push(
                SurfaceVertex {
                    position: (from.position + to.position) / 2.0,
                    radius: f32::midpoint(from.radius, to.radius),
                    ..from
                },
                true,
            );
            middles.extend([(a, middle), (b, middle)]);
        }
        middles
    }

    /// The vertex of each corner of `kept`; makes those that are new.
    fn vertices(&mut self, work: &mut Work) -> Vec<[u32; 3]> {
        let inside = 3 * self.kept.len();
        let total = inside + 3 * self.beside.len();
        let roots: Vec<usize> = (0..total)
            .map(|n| self.fans.root(n as u32) as usize)
            .collect();
        let mut vertex: Vec<Option<u32>> = vec![None; total];
        let mut taken = HashSet::new();
        for (n, &face) in self.beside.iter().enumerate() {
            for (side, corner) in work.triangles[face as usize].into_iter().enumerate() {
                vertex[roots[inside + 3 * n + side]] = Some(corner);
                taken.insert(corner);
            }
        }
        for (corner, &root) in roots[..inside].iter().enumerate() {
            if vertex[root].is_none()
                && let Some(old) = self.old_vertex(work, corner)
            {
                let copy = !taken.insert(old);
                let own = if copy {
                    work.push(work.vertices[old as usize], false)
                } else {
                    old
                };
                vertex[root] = Some(own);
            }
        }
        let mut made = |corner: usize| {
            let root = roots[corner];
            *vertex[root].get_or_insert_with(|| work.push(self.new_vertex(work, corner), true))
        };
        (0..self.kept.len())
            .map(|n| [3 * n, 3 * n + 1, 3 * n + 2].map(&mut made))
            .collect()
    }

    /// The corner of the source face that a corner of a piece is at, if it is at one.
    fn old_vertex(&self, work: &Work, corner: usize) -> Option<u32> {
        let piece = &self.kept[corner / 3];
        let at = self.arrangement.position(piece.corners[corner % 3]);
        let source = work.triangles[self.region.faces[piece.source as usize] as usize];
        source
            .into_iter()
            .find(|&old| work.position(old).as_dvec3() == at)
    }

    /// A vertex within a source face: its radius is interpolated, its labels are the nearest corner's.
    fn new_vertex(&self, work: &Work, corner: usize) -> SurfaceVertex {
        let piece = &self.kept[corner / 3];
        let at = self.arrangement.position(piece.corners[corner % 3]);
        let source = work.triangles[self.region.faces[piece.source as usize] as usize];
        let corners = source.map(|old| work.vertices[old as usize]);
        let weights = barycentric(corners.map(|c| c.position.as_dvec3()), at);
        let distance = |n: &usize| corners[*n].position.as_dvec3().distance_squared(at);
        let nearest = (0..3).min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let sum = |of: fn(&SurfaceVertex) -> DVec3| -> DVec3 {
            (0..3).map(|n| weights[n] * of(&corners[n])).sum()
        };
        let radius = sum(|c| DVec3::splat(f64::from(c.radius))).x;
        let normal = sum(|c| c.normal.as_dvec3()).as_vec3();
        SurfaceVertex {
            position: at.as_vec3(),
            normal: normal.try_normalize().unwrap_or_default(),
            radius: radius as f32,
            ..corners[nearest.unwrap_or(0)]
        }
    }
}

/// Faces outside the region that stay and touch it, with numbers for their corners: the arrangement's where
/// it has the vertex, others beyond them.
fn beside(
    work: &Work,
    region: &Region,
    arrangement: &Arrangement,
    stays: &[bool],
) -> (Vec<u32>, Vec<[u32; 3]>) {
    let mut number: HashMap<u32, u32> = HashMap::new();
    for piece in &arrangement.pieces {
        for corner in work.triangles[region.faces[piece.source as usize] as usize] {
            let at = work.position(corner).as_dvec3();
            let vertex = piece
                .corners
                .into_iter()
                .find(|&v| arrangement.position(v) == at);
            if let Some(vertex) = vertex {
                number.entry(corner).or_insert(vertex);
            }
        }
    }
    let mut faces = Vec::new();
    let mut numbers = Vec::new();
    for (face, corners) in (0..).zip(&work.triangles) {
        if stays[face as usize] && corners.iter().any(|corner| number.contains_key(corner)) {
            faces.push(face);
            let beyond = |corner: u32| arrangement.vertices() as u32 + corner;
            numbers.push(corners.map(|c| number.get(&c).copied().unwrap_or(beyond(c))));
        }
    }
    (faces, numbers)
}

/// A face whose sides may have a vertex in their middle, as faces without.
fn divided([a, b, c]: [u32; 3], middles: [Option<u32>; 3]) -> impl Iterator<Item = [u32; 3]> {
    let faces = match middles {
        [None, None, None] => vec![[a, b, c]],
        [Some(m), None, None] => vec![[a, m, c], [m, b, c]],
        [None, Some(m), None] => vec![[b, m, a], [m, c, a]],
        [None, None, Some(m)] => vec![[c, m, b], [m, a, b]],
        [Some(m), Some(n), None] => vec![[m, b, n], [a, m, n], [a, n, c]],
        [None, Some(m), Some(n)] => vec![[m, c, n], [b, m, n], [b, n, a]],
        [Some(n), None, Some(m)] => vec![[m, a, n], [c, m, n], [c, n, b]],
        [Some(m), Some(n), Some(o)] => vec![[a, m, o], [m, b, n], [n, c, o], [m, n, o]],
    };
    faces.into_iter()
}

/// The corner after a corner of the same triangle.
fn next(corner: usize) -> usize {
    corner - corner % 3 + (corner + 1) % 3
}

/// Weights of the corners of a triangle at a point of it, each from 0 to 1; of the nearest corner only if
/// it has no area.
fn barycentric([a, b, c]: [DVec3; 3], p: DVec3) -> [f64; 3] {
    let normal = (b - a).cross(c - a);
    let area = normal.length_squared();
    if area <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let weight = |q: DVec3, r: DVec3| ((q - p).cross(r - p).dot(normal) / area).clamp(0.0, 1.0);
    let weights = [weight(b, c), weight(c, a), weight(a, b)];
    let sum: f64 = weights.iter().sum();
    if sum > 0.0 {
        weights.map(|weight| weight / sum)
    } else {
        [1.0, 0.0, 0.0]
    }
}
