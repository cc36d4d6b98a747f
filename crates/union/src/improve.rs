//! Triangles that a solver likes: no narrow ones, as far as the surface allows.
//!
//! Where an angle is small, three things are tried, and the one after which the smallest angle nearby is
//! largest is done: an edge is given to the two corners across it, the shortest edge is collapsed, or a corner
//! moves along the surface towards the middle of its neighbors (L. Freitag, C. Ollivier-Gooch, Tetrahedral Mesh
//! Improvement Using Swapping and Smoothing, 1997, for volumes). No face turns by more than a bound, and no
//! vertex goes far from where it was, so that the surface stays what it is. What would cross is left as it was.

use std::collections::HashMap;

use glam::DVec3;
use neurotess_mesh::{SurfaceVertex, self_intersections_of};
use rayon::prelude::*;

use crate::stars::{Stars, normal};
use crate::work::Work;

/// What was done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Improved {
    pub(crate) flipped: usize,
    pub(crate) collapsed: usize,
    pub(crate) moved: usize,
}

impl Improved {
    /// Edits of any kind.
    pub(crate) fn total(&self) -> usize {
        self.flipped + self.collapsed + self.moved
    }
}

/// Passes over narrow faces; the last ones find little.
const PASSES: usize = 8;

/// Edges from a narrow face to what may be edited; passes reach a little farther than one would.
const RINGS: usize = 3;

/// How often all is done again, without what crossed.
const TRIES: usize = 6;

/// Cosine of how far a face may turn at once: 26°. A tube of six sides has 60° between them.
const TURN: f64 = 0.9;

/// How far a vertex may go from where it was, in radii.
const REACH: f64 = 0.5;

/// An edit must make the smallest angle larger by this much to be worth it.
const GAIN: f64 = 1.02;

/// What a collapse may cost the faces that stay, since two narrow ones vanish: a strip of narrow faces, as between
/// two rings that are near each other, goes one by one, and the next one wins back what the first has cost.
const LOSS: f64 = 0.8;

/// Makes angles below `least` (degrees) larger where that can be done; leaves no new crossing.
pub(crate) fn improve(work: &mut Work, least: f64) -> Improved {
    let goal = least.to_radians().sin();
    let mut fixed = vec![false; work.vertices.len()];
    for rings in 0..TRIES {
        let mut tried = work.clone();
        let done = passes(&mut tried, goal, &fixed);
        let crossing = crossing_corners(&tried);
        if crossing.is_empty() {
            *work = tried;
            return done;
        }
        let mut near = vec![false; work.vertices.len()];
        for corner in crossing {
            near[corner as usize] = true;
        }
        let near = work.widened(near, 1 + rings);
        for (fixed, near) in fixed.iter_mut().zip(near) {
            *fixed |= near;
        }
    }
    Improved::default()
}

/// Corners of faces that are not of the input and cross others.
fn crossing_corners(work: &Work) -> Vec<u32> {
    let pairs = self_intersections_of(&work.positions(), &work.faces(), &work.changed_faces());
    let faces = pairs.into_iter().flatten();
    faces
        .flat_map(|face| work.triangles[face as usize])
        .collect()
}

fn passes(work: &mut Work, goal: f64, fixed: &[bool]) -> Improved {
    let mut done = Improved::default();
    let mut region = Region::new(work, goal, fixed);
    for _ in 0..PASSES {
        let before = done;
        for face in region.narrow() {
            region.widen(face, &mut done);
        }
        if done == before {
            break;
        }
    }
    region.stars.finish();
    done
}

/// Narrow faces and what is around them.
struct Region<'a> {
    stars: Stars<'a>,
    /// Faces around, in order.
    faces: Vec<u32>,
    goal: f64,
    fixed: &'a [bool],
    /// Where vertices were before they first moved.
    start: HashMap<u32, DVec3>,
}

/// What may be done for a face.
enum Edit {
    /// A side of the face.
    Flip(usize),
    /// From, to, and what it becomes.
    Collapse(u32, u32, SurfaceVertex),
    Move(u32, DVec3),
}

impl<'a> Region<'a> {
    fn new(work: &'a mut Work, goal: f64, fixed: &'a [bool]) -> Self {
        let mut near = vec![false; work.vertices.len()];
        let all = 0..work.triangles.len() as u32;
        let narrow: Vec<u32> = all
            .into_par_iter()
            .filter(|&face| sharpness(&work.corners(face)) < goal)
            .collect();
        for face in narrow {
            for corner in work.triangles[face as usize] {
                near[corner as usize] = true;
            }
        }
        let known = work.widened(near, RINGS);
        let is_near = |face: &[u32; 3]| face.iter().any(|&corner| known[corner as usize]);
        let faces = (0..).zip(&work.triangles);
        let faces = faces.filter(|(_, face)| is_near(face)).map(|(n, _)| n);
        Self {
            faces: faces.collect(),
            stars: Stars::new(work, |vertex| known[vertex as usize]),
            goal,
            fixed,
            start: HashMap::new(),
        }
    }

    /// The faces with a small angle, the narrowest first.
    fn narrow(&self) -> Vec<u32> {
        let faces = self.faces.par_iter();
        let mut narrow: Vec<(f64, u32)> = faces
            .filter(|&&face| !self.stars.is_dead(face))
            .map(|&face| (sharpness(&self.stars.work.corners(face)), face))
            .filter(|&(sharpness, _)| sharpness < self.goal)
            .collect();
        narrow.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        narrow.into_iter().map(|(_, face)| face).collect()
    }

    /// Does the best edit for a narrow face, if there is one.
    fn widen(&mut self, face: u32, done: &mut Improved) {
        if self.stars.is_dead(face) || sharpness(&self.stars.work.corners(face)) >= self.goal {
            return;
        }
        let mut edits: Vec<(f64, Edit)> = Vec::new();
        edits.extend(self.flip(face));
        edits.extend(self.moves(face));
        edits.extend(self.collapse(face));
        edits.sort_by(|a, b| b.0.total_cmp(&a.0));
        for (_, edit) in edits {
            let count = match edit {
                Edit::Flip(side) => {
                    let flipped = self.stars.flip(face, side, |_, _, _| true);
                    flipped.then_some(&mut done.flipped)
                }
                Edit::Collapse(from, to, vertex) => {
                    let start = self.start(to);
                    let collapsed = self.stars.collapse(from, to, |_, _| Some(vertex));
                    if collapsed {
                        self.moved(to, start);
                    }
                    collapsed.then_some(&mut done.collapsed)
                }
                Edit::Move(vertex, to) => {
                    let start = self.start(vertex);
                    self.stars.work.vertices[vertex as usize].position = to.as_vec3();
                    self.moved(vertex, start);
                    Some(&mut done.moved)
                }
            };
            if let Some(count) = count {
                *count += 1;
                return;
            }
        }
    }

    /// Where a vertex was before it first moved.
    fn start(&self, vertex: u32) -> DVec3 {
        let now = || self.stars.work.position(vertex).as_dvec3();
        self.start.get(&vertex).copied().unwrap_or_else(now)
    }

    fn moved(&mut self, vertex: u32, start: DVec3) {
        self.start.insert(vertex, start);
        self.stars.work.fresh[vertex as usize] = true;
    }

    /// The longest side, given to the corners across it.
    fn flip(&self, face: u32) -> Option<(f64, Edit)> {
        let lengths = self.stars.lengths(face);
        let side = (0..3).max_by(|&a, &b| lengths[a].total_cmp(&lengths[b]))?;
        let corners = self.stars.work.triangles[face as usize];
        let [from, to, apex] = [0, 1, 2].map(|n| corners[(side + n) % 3]);
        let (other, far) = self.stars.across(face, from, to)?;
        if [from, to, apex, far]
            .iter()
            .any(|&corner| self.is_fixed(corner))
        {
            return None;
        }
        let at = |corner: u32| self.stars.work.position(corner).as_dvec3();
        let old = [face, other].map(|face| self.stars.work.corners(face));
        let new = [[apex, from, far], [apex, far, to]].map(|face| face.map(at));
        let whole = normal(&old[0]) + normal(&old[1]);
        let flat = old.iter().chain(&new).all(|face| agrees(face, whole));
        let (before, after) = (least(&old), least(&new));
        (flat && after > GAIN * before).then_some((after, Edit::Flip(side)))
    }

    /// Corners of a face, moved along the surface.
    fn moves(&self, face: u32) -> Vec<(f64, Edit)> {
        let corners = self.stars.work.triangles[face as usize];
        let best = |vertex: u32| {
            let targets = self.targets(vertex)?;
            let rated = targets.into_iter().filter_map(|to| {
                let after = self.after_move(vertex, to)?;
                Some((after, Edit::Move(vertex, to)))
            });
            rated.max_by(|a, b| a.0.total_cmp(&b.0))
        };
        corners.into_iter().filter_map(best).collect()
    }

    /// Places on the way of a vertex to the middle of its neighbors, in the plane that touches the surface.
    fn targets(&self, vertex: u32) -> Option<[DVec3; 3]> {
        let star = self.stars.of(vertex).filter(|_| !self.is_fixed(vertex))?;
        let at = self.stars.work.position(vertex).as_dvec3();
        let (mut middle, mut upwards) = (DVec3::ZERO, DVec3::ZERO);
        for &face in star {
            let corners = self.stars.work.corners(face);
            // Each neighbor comes twice.
            middle += corners.iter().sum::<DVec3>() - at;
            upwards += normal(&corners);
        }
        let way = middle / (2 * star.len()) as f64 - at;
        let along = way - way.project_onto_normalized(upwards.try_normalize()?);
        Some([1.0, 0.5, 0.25].map(|share| (at + share * along).as_vec3().as_dvec3()))
    }

    /// The sharpness around a vertex after it has moved, if that is better and allowed.
    fn after_move(&self, vertex: u32, to: DVec3) -> Option<f64> {
        let star = self.stars.of(vertex)?;
        let old: Vec<_> = star
            .iter()
            .map(|&face| self.stars.work.corners(face))
            .collect();
        let moved = |&face: &u32| self.stars.corners_with(face, vertex, to);
        let new: Vec<_> = star.iter().map(moved).collect();
        let (before, after) = (least(&old), least(&new));
        let keeps =
            self.is_near(vertex, to) && old.iter().zip(&new).all(|(a, b)| agrees(a, normal(b)));
        (keeps && after > GAIN * before).then_some(after)
    }

    /// The shortest side, collapsed into one of its ends or between them.
    fn collapse(&self, face: u32) -> Option<(f64, Edit)> {
        let lengths = self.stars.lengths(face);
        let side = (0..3).min_by(|&a, &b| lengths[a].total_cmp(&lengths[b]))?;
        let corners = self.stars.work.triangles[face as usize];
        let [from, to] = [corners[side], corners[(side + 1) % 3]];
        if self.is_fixed(from) || self.is_fixed(to) {
            return None;
        }
        let [a, b] = [from, to].map(|vertex| self.stars.work.vertices[vertex as usize]);
        let between = SurfaceVertex {
            position: (a.position + b.position) / 2.0,
            radius: f32::midpoint(a.radius, b.radius),
            ..b
        };
        let rated = [between, b, a].into_iter().filter_map(|vertex| {
            let after = self.after_collapse([from, to], vertex.position.as_dvec3())?;
            Some((after, Edit::Collapse(from, to, vertex)))
        });
        rated.max_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// The sharpness around two vertices after they have become one, if that is better and allowed.
    fn after_collapse(&self, ends: [u32; 2], place: DVec3) -> Option<f64> {
        let (mut before, mut after) = (f64::INFINITY, f64::INFINITY);
        for (vertex, other) in [(ends[0], ends[1]), (ends[1], ends[0])] {
            if !self.is_near(vertex, place) {
                return None;
            }
            for &face in self.stars.of(vertex)? {
                let old = self.stars.work.corners(face);
                before = before.min(sharpness(&old));
                if self.stars.work.triangles[face as usize].contains(&other) {
                    continue;
                }
                let new = self.stars.corners_with(face, vertex, place);
                if !agrees(&old, normal(&new)) {
                    return None;
                }
                after = after.min(sharpness(&new));
            }
        }
        (after > LOSS * before).then_some(after)
    }

    fn is_fixed(&self, vertex: u32) -> bool {
        self.fixed[vertex as usize]
    }

    /// Whether a place is within the reach of a vertex.
    fn is_near(&self, vertex: u32, place: DVec3) -> bool {
        let radius = f64::from(self.stars.work.vertices[vertex as usize].radius);
        radius <= 0.0 || self.start(vertex).distance(place) <= REACH * radius
    }
}

/// Whether a face looks about the way of a normal; one without a shape looks any way.
fn agrees(face: &[DVec3; 3], way: DVec3) -> bool {
    let normal = normal(face);
    sharpness(face) < SHAPELESS || normal.dot(way) >= TURN * normal.length() * way.length()
}

/// Below this sine the normal of a face says little.
const SHAPELESS: f64 = 0.02;

/// The least [`sharpness`] of some faces.
fn least(faces: &[[DVec3; 3]]) -> f64 {
    faces.iter().map(sharpness).fold(f64::INFINITY, f64::min)
}

/// Sine of the smallest angle of a triangle, which is between its longer sides.
fn sharpness(triangle: &[DVec3; 3]) -> f64 {
    let [a, b, c] = *triangle;
    let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(from, to)| from.distance_squared(to));
    let product = (ab * bc).max(bc * ca).max(ca * ab);
    if product > 0.0 {
        normal(triangle).length() / product.sqrt()
    } else {
        0.0
    }
}
