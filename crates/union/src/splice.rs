//! The union near crossings, put into the surface in place of what was there.
//!
//! Faces of a region are arranged and those pieces kept that have the solid behind them and nothing in
//! front. The rest of the surface is not cut by anything, so whatever of it hangs together is kept or goes
//! as a whole, as the faces of the region beside it do.
//!
//! Where the union touches itself along an edge or in a vertex, sheets are told apart: each **fan** of faces
//! around a vertex has a vertex of its own, at the same position; [`crate::touch`] parts them.

use std::collections::{HashMap, HashSet};

use glam::DVec3;
use neurotess_mesh::{Forest, SurfaceVertex};

use crate::cells::{Wall, cell_windings, turns_alike, walls};
use crate::engine::{Arrangement, HalfFace, arrange};
use crate::region::Region;
use crate::work::Work;

/// Why a region could not be replaced. With more rings of neighbors it may.
#[derive(Debug)]
pub(crate) enum Fault {
    /// The arrangement failed.
    Engine(String),
    /// What is kept does not close.
    Open,
    /// Two ways to a cell give different winding numbers.
    Inconsistent,
}

/// A piece that is kept.
struct Kept {
    /// Number in the region.
    source: u32,
    /// Vertices of the arrangement.
    corners: [u32; 3],
}

/// Replaces the faces of a region by the union of the surface with itself there.
pub(crate) fn splice(work: &mut Work, region: &Region) -> Result<(), Fault> {
    let corners: Vec<[DVec3; 3]> = region.faces.iter().map(|&f| work.corners(f)).collect();
    let arrangement = arrange(&corners).map_err(Fault::Engine)?;
    let walls = walls(&arrangement);
    let windings = cell_windings(work, region, &arrangement, &walls).ok_or(Fault::Inconsistent)?;
    let kept = kept(&arrangement, &walls, &windings);
    let stays = rest(work, region, &kept)?;
    let corners = Sheets::new(work, region, &arrangement, &kept, &stays)?.vertices(work);
    replace(work, region, &kept, &corners, &stays);
    Ok(())
}

/// The boundary of where the winding number is 1 or more, in the order of the sources.
fn kept(arrangement: &Arrangement, walls: &[Wall], windings: &[i32]) -> Vec<Kept> {
    let solid = |cell: u32| windings[cell as usize] >= 1;
    let mut kept = Vec::new();
    for wall in walls {
        let [front, behind] = wall.cells.map(solid);
        if front == behind {
            continue;
        }
        let pieces = wall.pieces.iter().map(|&n| &arrangement.pieces[n as usize]);
        let first = &arrangement.pieces[wall.pieces[0] as usize];
        // The first that has the solid behind it; where faces cancel, none may.
        let fits = |turns: bool| turns == behind;
        let of = pieces.clone().find(|piece| fits(turns_alike(first, piece)));
        kept.push(match of {
            Some(piece) => Kept {
                source: piece.source,
                corners: piece.corners,
            },
            None => Kept {
                source: first.source,
                corners: [first.corners[0], first.corners[2], first.corners[1]],
            },
        });
    }
    kept.sort_by_key(|piece| piece.source);
    kept
}

/// For each face of the surface outside the region, whether it stays.
fn rest(work: &Work, region: &Region, kept: &[Kept]) -> Result<Vec<bool>, Fault> {
    let count = work.vertices.len();
    let mut forest = Forest::new(count);
    let mut outside = vec![false; count];
    for (&[a, b, c], _) in work
        .triangles
        .iter()
        .zip(&region.has)
        .filter(|(_, has)| !**has)
    {
        forest.unite(a, b);
        forest.unite(b, c);
        [a, b, c]
            .iter()
            .for_each(|&corner| outside[corner as usize] = true);
    }
    let mut is_kept = vec![false; region.faces.len()];
    for piece in kept {
        is_kept[piece.source as usize] = true;
    }
    let mut stays: Vec<Option<bool>> = vec![None; count];
    for ((&face, &crossing), &is_kept) in region.faces.iter().zip(&region.crossing).zip(&is_kept) {
        for corner in work.triangles[face as usize] {
            if outside[corner as usize] {
                let stays = &mut stays[forest.root(corner) as usize];
                // A face that is cut says nothing of the whole of its neighbor.
                if crossing || stays.is_some_and(|stays| stays != is_kept) {
                    return Err(Fault::Open);
                }
                *stays = Some(is_kept);
            }
        }
    }
    let stays = work.triangles.iter().zip(&region.has).map(|(face, &has)| {
        // What has no neighbor in the region crosses nothing.
        !has && stays[forest.root(face[0]) as usize].unwrap_or(true)
    });
    Ok(stays.collect())
}

/// Faces of the union near the region, and which of their corners are one vertex.
struct Sheets<'a> {
    region: &'a Region,
    arrangement: &'a Arrangement,
    kept: &'a [Kept],
    /// Faces outside the region that stay and touch it.
    beside: Vec<u32>,
    /// Corners of `kept`, then of `beside`: the same set if the same vertex.
    fans: Forest,
}

/// A half-edge of [`Sheets`]: ends, lower first, and the corner that it leaves.
type HalfEdge = ([u32; 2], u32);

impl<'a> Sheets<'a> {
    fn new(
        work: &Work,
        region: &'a Region,
        arrangement: &'a Arrangement,
        kept: &'a [Kept],
        stays: &[bool],
    ) -> Result<Self, Fault> {
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
        };
        sheets.join(&corners)?;
        Ok(sheets)
    }

    /// Joins the corners of faces that share an edge.
    fn join(&mut self, corners: &[u32]) -> Result<(), Fault> {
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
                    }
                }
                _ => return Err(Fault::Open),
            }
        }
        Ok(())
    }

    /// Joins two half-edges that run opposite ways.
    fn unite(&mut self, a: u32, b: u32) {
        self.fans.unite(a, next(b as usize) as u32);
        self.fans.unite(next(a as usize) as u32, b);
    }

    /// Half-edges of more than two faces in pairs: those that have the solid between them, so that bodies
    /// that touch along an edge stay two.
    fn wedges(&self, corners: &[u32], edge: &[HalfEdge]) -> Result<Vec<[u32; 2]>, Fault> {
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
            return Err(Fault::Open);
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
                _ => return Err(Fault::Open),
            }
        }
        Ok(pairs)
    }

    /// The vertex of each corner of `kept`; makes those that are new.
    fn vertices(mut self, work: &mut Work) -> Vec<[u32; 3]> {
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

/// Puts pieces where their sources were.
fn replace(work: &mut Work, region: &Region, kept: &[Kept], corners: &[[u32; 3]], stays: &[bool]) {
    let mut triangles = Vec::with_capacity(work.triangles.len());
    let mut parts = Vec::with_capacity(work.triangles.len());
    let mut changed = Vec::with_capacity(work.triangles.len());
    let mut pieces = kept.iter().zip(corners).peekable();
    let mut source = 0;
    for (face, &stays) in stays.iter().enumerate() {
        let part = work.parts[face];
        if region.has[face] {
            while let Some((_, corners)) = pieces.next_if(|(piece, _)| piece.source == source) {
                triangles.push(*corners);
                parts.push(part);
                changed.push(work.changed[face] || region.crossing[source as usize]);
            }
            source += 1;
        } else if stays {
            triangles.push(work.triangles[face]);
            parts.push(part);
            changed.push(work.changed[face]);
        }
    }
    work.triangles = triangles;
    work.parts = parts;
    work.changed = changed;
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
