//! Pieces that merging cut off are joined again.
//!
//! **Theory.** Where the line of a neurite turns back within its own radius, its tube is inside out, its winding
//! number is −1 there, and a union keeps nothing of it: what lies beyond is cut off. The tube should have been as
//! thick there as on both sides. From a piece that was cut off we go the shortest way over the surface as it was
//! given, through what the cut left out, to where something of it is still there. The **convex hull** of the surface
//! around that way holds rings of the tube on both sides; it is merged into both.
//!
//! **Practice.** Time is spent only where something was cut off. Each hull is tried on a copy, and is kept if it joins
//! the piece and nothing crosses; one that closes no loop is taken before one that does.

use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap};

use glam::DVec3;
use neurotess_mesh::{SurfaceMesh, SurfaceVertex, Topology, Watch, measure};

use crate::arrange::hull;
use crate::body::{Body, handles, is_sound};
use crate::mend::parts::{cut_off, drop_hidden};
use crate::options::{UnionError, UnionOptions};
use crate::report::{Joined, Part};
use crate::surface::work::Work;

/// How far the surface around a way reaches that is taken into the hull, in radii of the branch, and in edges at
/// least: what is tried, in this order. A ring of the tube is two radii wide, but where edges are long few vertices are
/// within that.
const REACHES: [(f64, usize); 5] = [(1.5, 0), (2.5, 0), (1.5, 1), (2.5, 2), (4.0, 4)];

/// Sizes of a hull, in the order in which they are tried: within the tube, that its faces do not lie on those of the tube;
/// and beyond it, since the smaller one does not reach an end that is far thinner than the hull is long.
const SIZES: [f64; 2] = [0.96, 1.04];

/// Joins pieces of the `given` surface that merging cut off; tells each, and what lies within the joints and is left out.
pub(crate) fn rejoin(
    work: &mut Work,
    given: &SurfaceMesh,
    options: &UnionOptions,
    watch: &Watch<'_>,
) -> Result<(Vec<Joined>, Vec<Part>), UnionError> {
    let given = Given::new(given)?;
    let mut joined = Vec::new();
    let mut now = work.shape();
    while let Some((shape, one)) = join_one(work, &given, &now, options, watch)? {
        now = shape;
        joined.push(one);
    }
    // A hull may hold other pieces, which cross nothing.
    let hidden = match joined.is_empty() {
        true => Vec::new(),
        false => drop_hidden(work, &[]),
    };
    Ok((joined, hidden))
}

/// Joins one piece, if there is one that can be joined; returns the shape after.
fn join_one(
    work: &mut Work,
    given: &Given,
    before: &Topology,
    options: &UnionOptions,
    watch: &Watch<'_>,
) -> Result<Option<(Topology, Joined)>, UnionError> {
    let (numbers, pieces) = cut_off(work);
    for (piece, part) in pieces {
        let mut joins = None;
        let ways = [true, false].map(|moved| {
            let owners = owners(work, &numbers, given.work.vertices.len(), moved);
            given.way(&owners, piece)
        });
        let ways = || ways.iter().flatten();
        let tries = SIZES
            .iter()
            .flat_map(|&size| ways().map(move |way| (size, way)))
            .flat_map(|(size, way)| REACHES.map(|reach| (size, way, reach)));
        for (size, way, reach) in tries {
            watch.check()?;
            let names = given.around(way, reach);
            let Some(body) = hull_of(&names, size) else {
                continue;
            };
            let Some(tried) = body.merged(work, &names, part, options, watch)? else {
                continue;
            };
            let after = tried.shape();
            if !is_sound(&after) || after.components >= before.components {
                continue;
            }
            let closes_loop = handles(&after) > handles(before);
            if joins.is_none() || !closes_loop {
                let one = given.told(work, &tried, way);
                joins = Some((after, tried, one));
            }
            if !closes_loop {
                break;
            }
        }
        if let Some((after, tried, one)) = joins {
            *work = tried;
            return Ok(Some((after, one)));
        }
    }
    Ok(None)
}

/// For each vertex of the given surface the component that it is a vertex of, if it is still there; `moved`: even if
/// it was moved.
fn owners(work: &Work, numbers: &[u32], given: usize, moved: bool) -> Vec<Option<u32>> {
    let mut owners = vec![None; given];
    for (face, &number) in work.triangles.iter().zip(numbers) {
        for &corner in face {
            if (corner as usize) < given && (moved || !work.fresh[corner as usize]) {
                owners[corner as usize] = Some(number);
            }
        }
    }
    owners
}

/// The hull of vertices, of some times its size.
fn hull_of(names: &[SurfaceVertex], size: f64) -> Option<Body> {
    let points: Vec<DVec3> = names.iter().map(|name| name.position.as_dvec3()).collect();
    let middle = points.iter().sum::<DVec3>() / points.len() as f64;
    let (corners, faces) = hull(&points)?;
    let sized = corners
        .into_iter()
        .map(|corner| middle + size * (corner - middle));
    Some(Body {
        points: sized.collect(),
        faces,
    })
}

/// The surface as it was given.
struct Given {
    work: Work,
    /// Neighbors of all vertices, and where those of each begin.
    neighbors: Vec<u32>,
    first: Vec<usize>,
}

impl Given {
    fn new(mesh: &SurfaceMesh) -> Result<Self, UnionError> {
        let work = Work::new(mesh)?;
        // Closed and oriented: each edge is named once in each direction.
        let mut first = vec![0; work.vertices.len() + 1];
        for &corner in work.triangles.iter().flatten() {
            first[corner as usize + 1] += 1;
        }
        for n in 1..first.len() {
            first[n] += first[n - 1];
        }
        let mut next = first.clone();
        let mut neighbors = vec![0; 3 * work.triangles.len()];
        for &[a, b, c] in &work.triangles {
            for [from, to] in [[a, b], [b, c], [c, a]] {
                neighbors[next[from as usize]] = to;
                next[from as usize] += 1;
            }
        }
        Ok(Self {
            work,
            neighbors,
            first,
        })
    }

    fn neighbors(&self, vertex: u32) -> &[u32] {
        &self.neighbors[self.first[vertex as usize]..self.first[vertex as usize + 1]]
    }

    fn distance(&self, a: u32, b: u32) -> f64 {
        f64::from(self.work.position(a).distance(self.work.position(b)))
    }

    /// The shortest way over edges from a piece to anything else that is still there.
    fn way(&self, owners: &[Option<u32>], piece: u32) -> Option<Vec<u32>> {
        let count = owners.len();
        let mut from = vec![u32::MAX; count];
        let mut length = vec![f64::INFINITY; count];
        let mut open = BinaryHeap::new();
        // Lengths are not negative: their bits are in the order of the numbers.
        let key = |length: f64, vertex: u32| Reverse((length.to_bits(), vertex));
        for vertex in (0..count as u32).filter(|&v| owners[v as usize] == Some(piece)) {
            length[vertex as usize] = 0.0;
            open.push(key(0.0, vertex));
        }
        while let Some(Reverse((bits, vertex))) = open.pop() {
            let so_far = f64::from_bits(bits);
            if so_far > length[vertex as usize] {
                continue;
            }
            if owners[vertex as usize].is_some_and(|owner| owner != piece) {
                let back = |&v: &u32| Some(from[v as usize]).filter(|&v| v != u32::MAX);
                return Some(std::iter::successors(Some(vertex), back).collect());
            }
            for &next in self.neighbors(vertex) {
                let further = so_far + self.distance(vertex, next);
                if further < length[next as usize] {
                    length[next as usize] = further;
                    from[next as usize] = vertex;
                    open.push(key(further, next));
                }
            }
        }
        None
    }

    /// The surface around a way: what hangs together with it within some radii, or within some edges.
    fn around(&self, way: &[u32], (reach, edges): (f64, usize)) -> Vec<SurfaceVertex> {
        let radius = |&v: &u32| f64::from(self.work.vertices[v as usize].radius);
        let thinnest = way.iter().map(radius).fold(f64::INFINITY, f64::min);
        let is_near = |vertex: u32| {
            let mut distances = way.iter().map(|&v| self.distance(v, vertex));
            distances.any(|distance| distance <= reach * thinnest)
        };
        let mut found: BTreeSet<u32> = way.iter().copied().collect();
        let mut last: Vec<u32> = way.to_vec();
        for step in 1.. {
            let next = last.iter().flat_map(|&v| self.neighbors(v)).copied();
            let next: BTreeSet<u32> = next
                .filter(|&v| !found.contains(&v) && (step <= edges || is_near(v)))
                .collect();
            if next.is_empty() {
                break;
            }
            found.extend(&next);
            last = next.into_iter().collect();
        }
        let vertices = found.into_iter().map(|v| self.work.vertices[v as usize]);
        vertices.collect()
    }

    fn told(&self, before: &Work, after: &Work, way: &[u32]) -> Joined {
        let volume = |work: &Work| measure(&work.positions(), &work.faces()).volume;
        let points = way.iter().map(|&v| self.work.position(v).as_dvec3());
        let piece = way.last().copied().unwrap_or_default();
        let piece = self.work.vertices[piece as usize];
        Joined {
            position: self.work.place(points.sum::<DVec3>() / way.len() as f64),
            point: piece.point,
            section: piece.section,
            gap: way
                .windows(2)
                .map(|ends| self.distance(ends[0], ends[1]))
                .sum(),
            volume: volume(after) - volume(before),
        }
    }
}
