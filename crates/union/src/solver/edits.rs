//! Which edit makes a narrow face wider: an edge given to the two corners across it, an edge collapsed, or a
//! corner moved along the surface. What is found here depends on the faces around the corners of a face alone, so
//! many faces can be looked at side by side.

use glam::{DVec3, Vec3};
use neurotess_mesh::SurfaceVertex;
use smallvec::SmallVec;

use crate::surface::stars::{Stars, normal};

/// Cosine of how far a face may turn at once: 26°. A tube of six sides has 60° between them.
const TURN: f64 = 0.9;

/// How far a vertex may go from where it was, in radii.
const REACH: f64 = 0.5;

/// What a collapse may cost the faces that stay, since two narrow ones vanish: a strip of narrow faces, as between
/// two rings that are near each other, goes one by one, and the next one wins back what the first has cost. With 1 such strips
/// stay, and nothing else changes.
const LOSS: f64 = 0.8;

/// Cosine of the angle (50°) up to which a collapse may bend the surface at an edge, or beyond which it may not bend it any
/// more: a tube of eight sides has 45° between them, one of six 60°.
const CREASE: f64 = 0.64;

/// Sine of an angle (6°) below which a face is worse for a solver than a crease: what mends it may bend the surface.
const NEEDLE: f64 = 0.1;

/// Below this sine the normal of a face says little. A guard.
const SHAPELESS: f64 = 0.02;

/// What is done for a face.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Edit {
    /// A side of the face, from that corner to the next.
    Flip(usize),
    /// From, to, and what it becomes.
    Collapse(u32, u32, SurfaceVertex),
    Move(u32, DVec3),
}

/// A surface on which edits are looked for.
pub(crate) struct Edits<'s, 'w> {
    pub(crate) stars: &'s Stars<'w>,
    /// Vertices that stay as they are.
    pub(crate) fixed: &'s [bool],
    /// Where vertices were before anything was moved.
    pub(crate) first: &'s [Vec3],
}

impl Edits<'_, '_> {
    /// The edit after which the smallest angle around a face is largest, if one is worth it and allowed.
    pub(crate) fn best(&self, face: u32) -> Option<Edit> {
        let mut best: Option<(f64, Edit)> = None;
        let mut rate = |rated: Option<(f64, Edit)>| {
            if let Some(rated) = rated
                && best.is_none_or(|best| rated.0 > best.0)
            {
                best = Some(rated);
            }
        };
        rate(self.flip(face));
        for corner in self.stars.work.triangles[face as usize] {
            rate(self.shift(corner));
        }
        rate(self.collapse(face));
        best.map(|(_, edit)| edit)
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
            || !self.stars.may_connect(apex, far)
        {
            return None;
        }
        let at = |corner: u32| self.stars.work.position(corner).as_dvec3();
        let old = [face, other].map(|face| self.stars.work.corners(face));
        let new = [[apex, from, far], [apex, far, to]].map(|face| face.map(at));
        let whole = normal(&old[0]) + normal(&old[1]);
        let flat = old.iter().chain(&new).all(|face| agrees(face, whole));
        let (before, after) = (least(&old), least(&new));
        let better = flat
            && after > before
            && (before < NEEDLE || {
                let corners = |face: u32| self.stars.work.triangles[face as usize];
                let was = [
                    Facet::new(face, corners(face), normal(&old[0])),
                    Facet::new(other, corners(other), normal(&old[1])),
                ];
                let is = [
                    Facet::new(face, [apex, from, far], normal(&new[0])),
                    Facet::new(other, [apex, far, to], normal(&new[1])),
                ];
                self.is_as_smooth(&was, &is)
            });
        better.then_some((after, Edit::Flip(side)))
    }

    /// The best of some places on the way of a vertex to the middle of its neighbors, in the plane that touches
    /// the surface: the volume stays.
    fn shift(&self, vertex: u32) -> Option<(f64, Edit)> {
        let star = self.stars.of(vertex).filter(|_| !self.is_fixed(vertex))?;
        let at = self.stars.work.position(vertex).as_dvec3();
        let (mut middle, mut upwards) = (DVec3::ZERO, DVec3::ZERO);
        let mut before = f64::INFINITY;
        let mut around: SmallVec<[Around; 12]> = SmallVec::new();
        for &face in star {
            let corners = self.stars.work.corners(face);
            let normal = normal(&corners);
            let old = sharpness_by(&corners, normal);
            let turned = self.stars.work.triangles[face as usize];
            let first = turned.iter().position(|&corner| corner == vertex)?;
            let [next, last] = [1, 2].map(|n| corners[(first + n) % 3]);
            around.push(Around {
                ends: [next, last],
                normal: (old >= SHAPELESS).then_some(normal),
            });
            before = before.min(old);
            // Each neighbor comes twice.
            middle += next + last;
            upwards += normal;
        }
        let way = middle / (2 * star.len()) as f64 - at;
        let along = way - way.project_onto_normalized(upwards.try_normalize()?);
        let mut best: Option<(f64, Edit)> = None;
        for share in [1.0, 0.5] {
            let to = (at + share * along).as_vec3().as_dvec3();
            let enough = best.map_or(before, |(best, _)| best);
            if self.is_near(vertex, to)
                && let Some(after) = after_shift(&around, to, enough)
                && (before < NEEDLE || self.is_smooth_after_shift(vertex, star, to))
            {
                best = Some((after, Edit::Move(vertex, to)));
            }
        }
        best
    }

    /// The shortest side, collapsed into one of its ends or between them, and moved off the surface by as much as
    /// keeps the volume.
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
        let (volume, area) = self.enclosed([from, to], between.position.as_dvec3())?;
        let mut best: Option<(f64, Edit)> = None;
        for mut vertex in [a, b, between] {
            let away = (vertex.position - between.position).as_dvec3();
            let lost = volume - away.dot(area);
            let place = vertex.position.as_dvec3() + lost / area.length_squared() * area;
            vertex.position = place.as_vec3();
            if let Some(after) = self.after_collapse([from, to], vertex.position.as_dvec3())
                && best.is_none_or(|(best, _)| after >= best)
            {
                best = Some((after, Edit::Collapse(from, to, vertex)));
            }
        }
        best.filter(|_| self.stars.may_collapse(from, to))
    }

    /// What the faces around two neighbors enclose with a place between them, and the area vector of the faces
    /// around a vertex that takes their place, six and two times as large. With the vertex elsewhere by `v` these
    /// enclose `v` times the area; where that is what was enclosed before, the surface keeps its volume
    /// (P. Lindstrom, G. Turk, Fast and Memory Efficient Polygonal Simplification, 1998).
    fn enclosed(&self, [from, to]: [u32; 2], place: DVec3) -> Option<(f64, DVec3)> {
        let (mut volume, mut area) = (0.0, DVec3::ZERO);
        let mut add = |face: u32, vertex: u32, other: u32| {
            let corners = self.stars.work.triangles[face as usize];
            let [a, b, c] = self.stars.work.corners(face).map(|corner| corner - place);
            let both = corners.contains(&other);
            if !both || vertex == from {
                volume += a.dot(b.cross(c));
            }
            if !both {
                area += match corners.map(|corner| corner == vertex) {
                    [true, ..] => b.cross(c),
                    [_, true, _] => c.cross(a),
                    _ => a.cross(b),
                };
            }
        };
        for &face in self.stars.of(from)? {
            add(face, from, to);
        }
        for &face in self.stars.of(to)? {
            add(face, to, from);
        }
        (area.length_squared() > 0.0).then_some((volume, area))
    }

    /// The sharpness around two vertices after they have become one, if that is better and allowed.
    fn after_collapse(&self, ends: [u32; 2], place: DVec3) -> Option<f64> {
        if !ends.iter().all(|&vertex| self.is_near(vertex, place)) {
            return None;
        }
        let (mut before, mut after) = (f64::INFINITY, f64::INFINITY);
        let (mut old_faces, mut new_faces) = (Fan::new(), Fan::new());
        for (vertex, other) in [(ends[0], ends[1]), (ends[1], ends[0])] {
            for &face in self.stars.of(vertex)? {
                let corners = self.stars.work.triangles[face as usize];
                let old = self.stars.work.corners(face);
                before = before.min(sharpness(&old));
                let vanishes = corners.contains(&other);
                if !vanishes || vertex == ends[0] {
                    old_faces.push(Facet::new(face, corners, normal(&old)));
                }
                if vanishes {
                    continue;
                }
                let new = self.stars.corners_with(face, vertex, place);
                let turned = normal(&new);
                if !agrees(&old, turned) {
                    return None;
                }
                after = after.min(sharpness_by(&new, turned));
                let corners =
                    corners.map(|corner| if corner == ends[0] { ends[1] } else { corner });
                new_faces.push(Facet::new(face, corners, turned));
            }
        }
        let allowed =
            after > LOSS * before && (before < NEEDLE || self.is_as_smooth(&old_faces, &new_faces));
        allowed.then_some(after)
    }

    /// Whether the faces around a vertex make no crease once it has moved.
    fn is_smooth_after_shift(&self, vertex: u32, star: &[u32], to: DVec3) -> bool {
        let facet = |&face: &u32, corners: [DVec3; 3]| {
            Facet::new(
                face,
                self.stars.work.triangles[face as usize],
                normal(&corners),
            )
        };
        let new = star
            .iter()
            .map(|face| facet(face, self.stars.corners_with(*face, vertex, to)));
        let old = star
            .iter()
            .map(|face| facet(face, self.stars.work.corners(*face)));
        self.is_as_smooth(&old.collect::<Fan>(), &new.collect::<Fan>())
    }

    /// Whether new faces make no crease, or none that is sharper than those of the old ones.
    fn is_as_smooth(&self, old: &[Facet], new: &[Facet]) -> bool {
        let crease = self.crease(new);
        crease >= CREASE || crease >= self.crease(old)
    }

    /// Cosine of the sharpest angle between some faces, and between these and their neighbors.
    fn crease(&self, faces: &[Facet]) -> f64 {
        let mut least = 1.0_f64;
        for facet in faces {
            for side in 0..3 {
                let [from, to] = [facet.corners[side], facet.corners[(side + 1) % 3]];
                let beside = match faces.iter().find(|other| other.has_side(to, from)) {
                    Some(other) => Some(other.normal),
                    None => self.beside(facet.face, [from, to], faces),
                };
                least = beside.map_or(least, |beside| least.min(facet.normal.dot(beside)));
            }
        }
        least
    }

    /// Unit normal of the face beside some, across one of their sides.
    fn beside(&self, face: u32, [from, to]: [u32; 2], faces: &[Facet]) -> Option<DVec3> {
        let (mut other, _) = self.stars.across(face, from, to)?;
        // The side was another one's before.
        if faces.iter().any(|facet| facet.face == other) {
            (other, _) = self.stars.across(other, from, to)?;
        }
        Some(unit(normal(&self.stars.work.corners(other))))
    }

    fn is_fixed(&self, vertex: u32) -> bool {
        self.fixed[vertex as usize]
    }

    /// Whether a place is within the reach of a vertex.
    fn is_near(&self, vertex: u32, place: DVec3) -> bool {
        let radius = f64::from(self.stars.work.vertices[vertex as usize].radius);
        let first = self.first[vertex as usize].as_dvec3();
        radius <= 0.0 || first.distance(place) <= REACH * radius
    }
}

type Fan = SmallVec<[Facet; 16]>;

/// A face as it is, or would be.
struct Facet {
    face: u32,
    corners: [u32; 3],
    /// Unit normal.
    normal: DVec3,
}

impl Facet {
    fn new(face: u32, corners: [u32; 3], normal: DVec3) -> Self {
        Self {
            face,
            corners,
            normal: unit(normal),
        }
    }

    fn has_side(&self, from: u32, to: u32) -> bool {
        (0..3).any(|side| self.corners[side] == from && self.corners[(side + 1) % 3] == to)
    }
}

fn unit(normal: DVec3) -> DVec3 {
    normal.try_normalize().unwrap_or(DVec3::ZERO)
}

/// A face around a vertex that may move.
struct Around {
    /// Its other corners, in its order.
    ends: [DVec3; 2],
    /// None of a face without a shape.
    normal: Option<DVec3>,
}

/// The sharpness around a vertex after it has moved, if that is more than enough and no face turns too far.
fn after_shift(around: &[Around], to: DVec3, enough: f64) -> Option<f64> {
    let mut after = f64::INFINITY;
    for Around { ends, normal: old } in around {
        let moved = [to, ends[0], ends[1]];
        let new = normal(&moved);
        if old.is_some_and(|old| !is_alike(old, new)) {
            return None;
        }
        after = after.min(sharpness_by(&moved, new));
        if after <= enough {
            return None;
        }
    }
    Some(after)
}

/// Whether a face looks about the way of a normal; one without a shape looks any way.
fn agrees(face: &[DVec3; 3], way: DVec3) -> bool {
    let normal = normal(face);
    sharpness_by(face, normal) < SHAPELESS || is_alike(normal, way)
}

fn is_alike(a: DVec3, b: DVec3) -> bool {
    let cosine = a.dot(b);
    cosine >= 0.0 && cosine * cosine >= TURN * TURN * a.length_squared() * b.length_squared()
}

/// The least [`sharpness`] of some faces.
fn least(faces: &[[DVec3; 3]]) -> f64 {
    faces.iter().map(sharpness).fold(f64::INFINITY, f64::min)
}

/// Sine of the smallest angle of a triangle, which is between its longer sides.
pub(crate) fn sharpness(triangle: &[DVec3; 3]) -> f64 {
    sharpness_by(triangle, normal(triangle))
}

/// The same of a triangle whose [`normal`] is known.
fn sharpness_by(triangle: &[DVec3; 3], normal: DVec3) -> f64 {
    let [a, b, c] = *triangle;
    let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(from, to)| from.distance_squared(to));
    let product = (ab * bc).max(bc * ca).max(ca * ab);
    if product > 0.0 {
        (normal.length_squared() / product).sqrt()
    } else {
        0.0
    }
}
