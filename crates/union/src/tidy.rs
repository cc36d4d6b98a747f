//! Needles and caps at seams, the splinters that cuts leave: short edges are collapsed, flat triangles lose
//! their long edge.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;
use neurotess_mesh::SurfaceVertex;

use crate::work::Work;

/// Sides up to this many times what counts as bad are collapsed. With 6 for flat faces that cannot be flipped,
/// IF4 at level 2 had 171 instead of 194 angles below half a degree, but vd130423 had to be cut three times
/// instead of twice.
const SHORT: f64 = 2.0;

/// Cosine of how far a face may turn when a side is collapsed; by eye.
const TURN: f64 = 0.3;

/// What was done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Tidied {
    pub(crate) collapsed: usize,
    pub(crate) flipped: usize,
}

/// Passes over the seams; what one pass leaves is most often stuck.
const PASSES: usize = 6;

/// Tidies faces with a vertex that is ours: those of a height, or a shortest edge, of less
/// than `share` of the local radius.
pub(crate) fn tidy(work: &mut Work, share: f64) -> Tidied {
    let mut seam = Seam::new(work);
    let mut done = Tidied::default();
    for _ in 0..PASSES {
        let before = done;
        for face in seam.bad(share) {
            seam.mend(face, share, &mut done);
        }
        if done == before {
            break;
        }
    }
    let dead = std::mem::take(&mut seam.dead);
    if !dead.is_empty() {
        work.retain(|face| !dead.contains(&(face as u32)));
    }
    done
}

/// The surface near vertices that are ours.
struct Seam<'a> {
    work: &'a mut Work,
    /// Faces that may be mended.
    near: Vec<u32>,
    /// Faces of each vertex all whose faces are known: those up to two rings away.
    stars: BTreeMap<u32, BTreeSet<u32>>,
    dead: BTreeSet<u32>,
}

impl<'a> Seam<'a> {
    fn new(work: &'a mut Work) -> Self {
        let mut ring: Vec<u8> = work
            .seam
            .iter()
            .map(|&seam| if seam { 0 } else { 9 })
            .collect();
        for step in 1..=2 {
            let last = ring.clone();
            for face in &work.triangles {
                if face.iter().any(|&corner| last[corner as usize] < step) {
                    for &corner in face {
                        ring[corner as usize] = ring[corner as usize].min(step);
                    }
                }
            }
        }
        let mut near = Vec::new();
        let mut stars: BTreeMap<u32, BTreeSet<u32>> = BTreeMap::new();
        for (face, corners) in (0..).zip(&work.triangles) {
            let rings = corners.map(|corner| ring[corner as usize]);
            if rings.contains(&0) {
                near.push(face);
            }
            for (&corner, ring) in corners.iter().zip(rings) {
                if ring <= 2 {
                    stars.entry(corner).or_default().insert(face);
                }
            }
        }
        Self {
            work,
            near,
            stars,
            dead: BTreeSet::new(),
        }
    }

    /// Faces to mend, the flattest first.
    fn bad(&self, share: f64) -> Vec<u32> {
        let mut bad = Vec::new();
        for &face in self.near.iter().filter(|face| !self.dead.contains(face)) {
            let lengths = self.lengths(face);
            let [short, .., long] = sorted(lengths);
            let height = if long > 0.0 {
                double_area(&self.work.corners(face)) / long
            } else {
                0.0
            };
            if height.min(short) < share * self.scale(face) {
                bad.push((height, face));
            }
        }
        bad.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        bad.into_iter().map(|(_, face)| face).collect()
    }

    fn mend(&mut self, face: u32, share: f64, done: &mut Tidied) {
        if self.dead.contains(&face) {
            return;
        }
        let lengths = self.lengths(face);
        let side = (0..3)
            .min_by(|&a, &b| lengths[a].total_cmp(&lengths[b]))
            .unwrap_or(0);
        let near = share * self.scale(face);
        if lengths[side] < SHORT * near && self.collapse_side(face, side) {
            done.collapsed += 1;
        } else if self.flip(face) {
            done.flipped += 1;
        }
    }

    /// Collapses a side of a face if one of its ends is ours: what the tracing gave stays where it is.
    fn collapse_side(&mut self, face: u32, side: usize) -> bool {
        let corners = self.work.triangles[face as usize];
        let [a, b] = [corners[side], corners[(side + 1) % 3]];
        match [self.of_seam(a), self.of_seam(b)] {
            [true, _] => self.collapse(a, b),
            [false, true] => self.collapse(b, a),
            [false, false] => false,
        }
    }

    /// Makes one vertex of one of ours and another, if the surface keeps its shape and stays a surface.
    fn collapse(&mut self, from: u32, to: u32) -> bool {
        let (Some(star), Some(other)) = (self.stars.get(&from), self.stars.get(&to)) else {
            return false;
        };
        let shared: Vec<u32> = star.intersection(other).copied().collect();
        if !self.may_join(star, other, &shared, [from, to]) {
            return false;
        }
        let Some(joined) = self.joined(from, to, &shared) else {
            return false;
        };
        self.work.vertices[to as usize] = joined;
        for face in shared {
            for corner in self.work.triangles[face as usize] {
                if let Some(star) = self.stars.get_mut(&corner) {
                    star.remove(&face);
                }
            }
            self.dead.insert(face);
        }
        for face in self.stars.remove(&from).unwrap_or_default() {
            let corners = &mut self.work.triangles[face as usize];
            corners
                .iter_mut()
                .filter(|corner| **corner == from)
                .for_each(|corner| *corner = to);
            self.work.changed[face as usize] = true;
            self.stars.entry(to).or_default().insert(face);
        }
        true
    }

    /// Whether the only common neighbors of two vertices are those across their edge: else the surface would
    /// be pinched.
    fn may_join(
        &self,
        star: &BTreeSet<u32>,
        other: &BTreeSet<u32>,
        shared: &[u32],
        ends: [u32; 2],
    ) -> bool {
        let around = |faces: &mut dyn Iterator<Item = &u32>| -> BTreeSet<u32> {
            let corners = faces.flat_map(|&face| self.work.triangles[face as usize]);
            corners.filter(|corner| !ends.contains(corner)).collect()
        };
        let (a, b) = (around(&mut star.iter()), around(&mut other.iter()));
        let across = around(&mut shared.iter());
        let common: BTreeSet<u32> = a.intersection(&b).copied().collect();
        let roomy = |corner: &u32| self.stars.get(corner).is_none_or(|star| star.len() > 3);
        shared.len() == 2 && across.len() == 2 && common == across && across.iter().all(roomy)
    }

    /// The vertex that two become: at one of them, or between two of ours.
    fn joined(&self, from: u32, to: u32, shared: &[u32]) -> Option<SurfaceVertex> {
        let [a, b] = [from, to].map(|vertex| self.work.vertices[vertex as usize]);
        let between = SurfaceVertex {
            position: (a.position + b.position) / 2.0,
            radius: f32::midpoint(a.radius, b.radius),
            ..b
        };
        let choices = if self.of_seam(to) {
            vec![between, b, a]
        } else {
            vec![b]
        };
        let fits = |choice: &SurfaceVertex| {
            [from, to].iter().all(|vertex| {
                let mut faces = self.stars[vertex]
                    .iter()
                    .filter(|face| !shared.contains(face));
                faces.all(|&face| self.may_move(face, *vertex, choice.position.as_dvec3()))
            })
        };
        choices.into_iter().find(fits)
    }

    /// Whether a face turns and flattens little when one corner moves.
    fn may_move(&self, face: u32, vertex: u32, to: DVec3) -> bool {
        let before = self.work.corners(face);
        let mut after = before;
        for (corner, position) in self.work.triangles[face as usize].iter().zip(&mut after) {
            if *corner == vertex {
                *position = to;
            }
        }
        let [old, new] = [normal(&before), normal(&after)];
        let [good, better] = [quality(&before), quality(&after)];
        let turns = old.dot(new) < TURN * old.length() * new.length() && good > POOR;
        let flattens = better < POOR && better < 0.8 * good;
        new.length() > 0.0 && !turns && !flattens
    }

    /// Gives the longest edge of a flat face to the two corners across it.
    fn flip(&mut self, face: u32) -> bool {
        let lengths = self.lengths(face);
        let side = (0..3)
            .max_by(|&a, &b| lengths[a].total_cmp(&lengths[b]))
            .unwrap_or(0);
        let corners = self.work.triangles[face as usize];
        let [from, to, apex] = [
            corners[side],
            corners[(side + 1) % 3],
            corners[(side + 2) % 3],
        ];
        let Some((other, far)) = self.across(face, from, to) else {
            return false;
        };
        let joined = |a: u32, b: u32| -> Option<bool> {
            let (a, b) = (self.stars.get(&a)?, self.stars.get(&b)?);
            Some(a.intersection(b).next().is_some())
        };
        // An edge that is there already would be there twice.
        if far == apex || joined(apex, far) != Some(false) {
            return false;
        }
        let new = [[apex, from, far], [apex, far, to]];
        if !self.is_better([face, other], new) {
            return false;
        }
        for (face, corners) in [face, other].into_iter().zip(new) {
            self.work.changed[face as usize] = true;
            for corner in std::mem::replace(&mut self.work.triangles[face as usize], corners) {
                if let Some(star) = self.stars.get_mut(&corner) {
                    star.remove(&face);
                }
            }
        }
        for (face, corners) in [face, other].into_iter().zip(new) {
            for corner in corners {
                if let Some(star) = self.stars.get_mut(&corner) {
                    star.insert(face);
                }
            }
        }
        true
    }

    /// The face on the other side of an edge, and its third corner.
    fn across(&self, face: u32, from: u32, to: u32) -> Option<(u32, u32)> {
        let shared: Vec<u32> = self
            .stars
            .get(&from)?
            .intersection(self.stars.get(&to)?)
            .copied()
            .collect();
        let other = *shared.iter().find(|&&other| other != face)?;
        let corners = self.work.triangles[other as usize];
        let far = *corners
            .iter()
            .find(|&&corner| corner != from && corner != to)?;
        (shared.len() == 2).then_some((other, far))
    }

    /// Whether two faces in place of two others are of better shape and turn as those did.
    fn is_better(&self, old: [u32; 2], new: [[u32; 3]; 2]) -> bool {
        let old = old.map(|face| self.work.corners(face));
        let new = new.map(|face| face.map(|corner| self.work.position(corner).as_dvec3()));
        let facing = normal(&old[1]);
        let turns = new.iter().all(|face| {
            let normal = normal(face);
            facing.dot(normal) > 0.5 * facing.length() * normal.length()
        });
        let worst = |faces: [[DVec3; 3]; 2]| quality(&faces[0]).min(quality(&faces[1]));
        turns && worst(new) > worst(old)
    }

    fn of_seam(&self, vertex: u32) -> bool {
        self.work.seam[vertex as usize]
    }

    /// Lengths of the sides of a face: from each corner to the next.
    fn lengths(&self, face: u32) -> [f64; 3] {
        let corners = self.work.corners(face);
        [0, 1, 2].map(|n| corners[n].distance(corners[(n + 1) % 3]))
    }

    /// What is small or not is told by the radius there; without one, by the longest side.
    fn scale(&self, face: u32) -> f64 {
        let corners = self.work.triangles[face as usize];
        let radius = corners.map(|corner| f64::from(self.work.vertices[corner as usize].radius));
        let mean = radius.iter().sum::<f64>() / 3.0;
        if mean > 0.0 {
            mean
        } else {
            sorted(self.lengths(face))[2]
        }
    }
}

/// Below this [`quality`] the normal of a face says little: it is 1 for equal sides.
const POOR: f64 = 0.02;

fn normal([a, b, c]: &[DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a)
}

fn double_area(triangle: &[DVec3; 3]) -> f64 {
    normal(triangle).length()
}

/// 4 √3 area / (sum of the squared sides): 1 for equal sides, 0 for no area.
fn quality(triangle: &[DVec3; 3]) -> f64 {
    let [a, b, c] = *triangle;
    let squares = a.distance_squared(b) + b.distance_squared(c) + c.distance_squared(a);
    if squares > 0.0 {
        2.0 * 3.0_f64.sqrt() * double_area(triangle) / squares
    } else {
        0.0
    }
}

fn sorted(mut lengths: [f64; 3]) -> [f64; 3] {
    lengths.sort_by(f64::total_cmp);
    lengths
}
