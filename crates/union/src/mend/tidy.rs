//! Needles and caps at seams, the splinters that cuts leave: short edges are collapsed, flat triangles lose
//! their long edge.

use glam::DVec3;
use neurotess_mesh::SurfaceVertex;

use crate::surface::stars::{Stars, normal};
use crate::surface::work::Work;

/// Sides up to this many times what counts as bad are collapsed. With 6 for flat faces that cannot be flipped,
/// IF4 at level 2 had 171 instead of 194 angles below half a degree, but vd130423 had to be cut three times
/// instead of twice. With 1 a seam of two tubes keeps angles of 14°.
const SHORT: f64 = 2.0;

/// Cosine of how far (60°) a face may turn when a side is collapsed or flipped.
const TURN: f64 = 0.5;

/// What was done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Tidied {
    pub(crate) collapsed: usize,
    pub(crate) flipped: usize,
}

/// Passes over the seams; what one pass leaves is most often stuck. A guard.
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
    seam.stars.finish();
    done
}

/// The surface near vertices that are ours.
struct Seam<'a> {
    /// Faces that may be mended.
    near: Vec<u32>,
    /// Faces of vertices up to two edges away.
    stars: Stars<'a>,
}

impl<'a> Seam<'a> {
    fn new(work: &'a mut Work) -> Self {
        let mut ours = vec![false; work.vertices.len()];
        for &corner in work.triangles.iter().flatten() {
            ours[corner as usize] = work.seam[corner as usize];
        }
        let at_ours = |face: &[u32; 3]| face.iter().any(|&corner| ours[corner as usize]);
        let near = (0..)
            .zip(&work.triangles)
            .filter(|(_, face)| at_ours(face))
            .map(|(face, _)| face)
            .collect();
        let known = work.widened(ours, 2);
        Self {
            near,
            stars: Stars::new(work, |vertex| known[vertex as usize]),
        }
    }

    /// Faces to mend, the flattest first.
    fn bad(&self, share: f64) -> Vec<u32> {
        let mut bad = Vec::new();
        for &face in self.near.iter().filter(|face| !self.stars.is_dead(**face)) {
            let lengths = self.stars.lengths(face);
            let [short, .., long] = sorted(lengths);
            let height = if long > 0.0 {
                double_area(&self.stars.work.corners(face)) / long
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
        if self.stars.is_dead(face) {
            return;
        }
        let lengths = self.stars.lengths(face);
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
        let corners = self.stars.work.triangles[face as usize];
        let [a, b] = [corners[side], corners[(side + 1) % 3]];
        match [self.of_seam(a), self.of_seam(b)] {
            [true, _] => self.collapse(a, b),
            [false, true] => self.collapse(b, a),
            [false, false] => false,
        }
    }

    /// Makes one vertex of one of ours and another, if the surface keeps its shape and stays a surface.
    fn collapse(&mut self, from: u32, to: u32) -> bool {
        self.stars
            .collapse(from, to, |stars, shared| joined(stars, from, to, shared))
    }

    /// Gives the longest edge of a flat face to the two corners across it.
    fn flip(&mut self, face: u32) -> bool {
        let lengths = self.stars.lengths(face);
        let side = (0..3)
            .max_by(|&a, &b| lengths[a].total_cmp(&lengths[b]))
            .unwrap_or(0);
        self.stars.flip(face, side, is_better)
    }

    fn of_seam(&self, vertex: u32) -> bool {
        of_seam(&self.stars, vertex)
    }

    /// What is small or not is told by the radius there; without one, by the longest side.
    fn scale(&self, face: u32) -> f64 {
        let work = &self.stars.work;
        let corners = work.triangles[face as usize];
        let radius = corners.map(|corner| f64::from(work.vertices[corner as usize].radius));
        let mean = radius.iter().sum::<f64>() / 3.0;
        if mean > 0.0 {
            mean
        } else {
            sorted(self.stars.lengths(face))[2]
        }
    }
}

fn of_seam(stars: &Stars<'_>, vertex: u32) -> bool {
    stars.work.seam[vertex as usize]
}

/// The vertex that two become: at one of them, or between two of ours.
fn joined(stars: &Stars<'_>, from: u32, to: u32, shared: &[u32]) -> Option<SurfaceVertex> {
    let [a, b] = [from, to].map(|vertex| stars.work.vertices[vertex as usize]);
    let between = SurfaceVertex {
        position: (a.position + b.position) / 2.0,
        radius: f32::midpoint(a.radius, b.radius),
        ..b
    };
    let choices = if of_seam(stars, to) {
        vec![between, b, a]
    } else {
        vec![b]
    };
    let fits = |choice: &SurfaceVertex| {
        [from, to].iter().all(|&vertex| {
            let faces = stars.of(vertex).unwrap_or_default();
            let mut faces = faces.iter().filter(|face| !shared.contains(face));
            faces.all(|&face| may_move(stars, face, vertex, choice.position.as_dvec3()))
        })
    };
    choices.into_iter().find(fits)
}

/// Whether a face turns and flattens little when one corner moves.
fn may_move(stars: &Stars<'_>, face: u32, vertex: u32, to: DVec3) -> bool {
    let before = stars.work.corners(face);
    let after = stars.corners_with(face, vertex, to);
    let [old, new] = [normal(&before), normal(&after)];
    let [good, better] = [quality(&before), quality(&after)];
    let turns = old.dot(new) < TURN * old.length() * new.length() && good > POOR;
    let flattens = better < POOR && better < good;
    new.length() > 0.0 && !turns && !flattens
}

/// Whether two faces in place of two others are of better shape and turn as those did.
fn is_better(stars: &Stars<'_>, old: [u32; 2], new: [[u32; 3]; 2]) -> bool {
    let old = old.map(|face| stars.work.corners(face));
    let new = new.map(|face| face.map(|corner| stars.work.position(corner).as_dvec3()));
    let facing = normal(&old[1]);
    let turns = new.iter().all(|face| {
        let normal = normal(face);
        facing.dot(normal) > TURN * facing.length() * normal.length()
    });
    let worst = |faces: [[DVec3; 3]; 2]| quality(&faces[0]).min(quality(&faces[1]));
    turns && worst(new) > worst(old)
}

/// Below this [`quality`] the normal of a face says little: it is 1 for equal sides. A guard.
const POOR: f64 = 0.02;

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
