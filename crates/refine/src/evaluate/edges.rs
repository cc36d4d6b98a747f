//! Edges between corners, which depend on them alone.

use glam::Vec3;
use neurotess_mesh::Role;

use super::center_line::CenterLine;
use super::corner::{Corner, Jet};
use super::profile::{Profile, Share};
use crate::Path;

/// How an edge runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum EdgeKind {
    /// Around a tracing point.
    Ring,
    /// Along the path, from the parent's ring to the child's.
    Along,
    /// Over a soma.
    Soma,
    /// From a corner of a trunk's or soma's quad to one of the inset within it.
    Loft,
}

/// Divides by the length of a vector.
#[derive(Clone, Copy, Debug)]
pub(super) struct OverLength {
    by: Vec3,
    inverse: f32,
}

impl OverLength {
    pub(super) fn of(by: Vec3) -> Self {
        Self {
            by,
            inverse: 1.0 / by.length().max(1e-3),
        }
    }

    /// `A / |B|` and its derivative, from those of A and B.
    pub(super) fn jet(&self, a: Vec3, a_dot: Vec3, by_dot: Vec3) -> Jet {
        let position = a * self.inverse;
        let shrinking = self.by.dot(by_dot) * self.inverse * self.inverse;
        Jet {
            position,
            derivative: a_dot * self.inverse - position * shrinking,
        }
    }
}

/// No point is farther from the center line than this many times the longest offset of a ring's corners, interpolated
/// between two rings. Where a path turns back within its own tube, the radials of two rings cancel: what is left of the
/// offsets of a thick ring and a thin one, divided by next to nothing, would be anywhere. At 1.0 a third of a per cent of
/// the vertices of real cells are shortened, at forks whose corners are obtuse; at 1.2 a fiftieth of a per cent.
pub(crate) const MAX_OFFSET: f32 = 1.2;

/// The longer of the offsets of two corners of a ring.
pub(super) fn longer(a: Vec3, b: Vec3) -> f32 {
    a.length_squared().max(b.length_squared()).sqrt()
}

/// Square of the greatest distance from the center line at y, between rings with these longest offsets.
pub(super) fn most_squared(near: f32, far: f32, y: f32) -> f32 {
    let most = MAX_OFFSET * (near * (1.0 - y) + far * y);
    most * most
}

impl Jet {
    /// With its position shortened to a length where it is longer, by the square of that.
    pub(super) fn within(self, most_squared: f32) -> Self {
        let squared = self.position.length_squared();
        if squared <= most_squared {
            return self;
        }
        let along = self.position * (self.position.dot(self.derivative) / squared);
        let share = (most_squared / squared).sqrt();
        Self {
            position: self.position * share,
            derivative: (self.derivative - along) * share,
        }
    }

    /// Multiplied by the share of a tube's radius, with the derivative around the tube.
    pub(super) fn around(self, share: Share) -> Self {
        Self {
            position: self.position * share.value,
            derivative: self.derivative * share.value,
        }
    }

    /// The same with the derivative along the tube.
    pub(super) fn along(self, share: Share) -> Self {
        Self {
            position: self.position * share.value,
            derivative: self.derivative * share.value + self.position * share.derivative,
        }
    }
}

pub(super) fn mix(a: Vec3, b: Vec3, t: f32) -> Vec3 {
    a * (1.0 - t) + b * t
}

/// A point of an edge, t ∈ [0, 1] from `a` to `b`.
pub(crate) fn edge(kind: EdgeKind, a: &Corner, b: &Corner, path: Path, t: f32) -> Jet {
    EdgeCurve::new(kind, a, b, path).at(t)
}

/// An edge, ready to be evaluated at many points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EdgeCurve<'c> {
    a: &'c Corner,
    b: &'c Corner,
    course: Course,
}

/// What the points of an edge have in common.
#[derive(Clone, Copy, Debug)]
enum Course {
    Ring,
    Along(CenterLine, Profile),
    Cubic([Vec3; 4]),
}

impl<'c> EdgeCurve<'c> {
    /// From `a` to `b`.
    pub(crate) fn new(kind: EdgeKind, a: &'c Corner, b: &'c Corner, path: Path) -> Self {
        let course = match kind {
            EdgeKind::Ring => Course::Ring,
            EdgeKind::Along => {
                let line = CenterLine::new(a, b, path);
                Course::Along(line, Profile::new(a, b, &line))
            }
            EdgeKind::Soma => Course::Cubic(soma_controls(a, b)),
            EdgeKind::Loft => Course::Cubic(loft_controls(a, b)),
        };
        Self { a, b, course }
    }

    /// At t ∈ [0, 1].
    pub(crate) fn at(&self, t: f32) -> Jet {
        match self.course {
            Course::Ring => {
                let offset = self.offset(t);
                Jet {
                    position: self.a.center + offset.position,
                    ..offset
                }
            }
            Course::Along(line, profile) => {
                let (center, offset) = (line.at(t), self.offset(t).along(profile.share(t)));
                Jet {
                    position: center.position + offset.position,
                    derivative: center.derivative + offset.derivative,
                }
            }
            Course::Cubic(controls) => cubic(controls, t),
        }
    }

    /// The radius of its tube (µm) at t ∈ [0, 1]; linear between corners of other edges.
    pub(crate) fn radius(&self, t: f32) -> f32 {
        match &self.course {
            Course::Along(_, profile) => profile.radius(t),
            _ => self.a.radius * (1.0 - t) + self.b.radius * t,
        }
    }

    /// From the center line, where the radius is linear along it.
    fn offset(&self, t: f32) -> Jet {
        let Self { a, b, .. } = self;
        let most = match self.course {
            Course::Along(..) => most_squared(a.offset.length(), b.offset.length(), t),
            _ => {
                let ring = longer(a.offset, b.offset);
                most_squared(ring, ring, 0.0)
            }
        };
        OverLength::of(mix(a.radial, b.radial, t))
            .jet(
                mix(a.offset, b.offset, t),
                b.offset - a.offset,
                b.radial - a.radial,
            )
            .within(most)
    }
}

/// Control points of a soma edge.
pub(crate) fn soma_controls(a: &Corner, b: &Corner) -> [Vec3; 4] {
    let way = b.position - a.position;
    let leave = |normal: Vec3| (way - normal * way.dot(normal)) / 3.0;
    [
        a.position,
        a.position + leave(a.cubic_normal()),
        b.position - leave(b.cubic_normal()),
        b.position,
    ]
}

/// Control points of a loft's edge, from the trunk's corner `a` to the inset's corner `b`.
pub(crate) fn loft_controls(a: &Corner, b: &Corner) -> [Vec3; 4] {
    let way = b.position - a.position;
    let normal = a.cubic_normal();
    let over = way - normal * way.dot(normal);
    let third = way.length() / 3.0;
    [
        a.position,
        a.position + over * first_leg(a, b, over, Vec3::ZERO).0,
        b.position - b.tangent * b.collar.max(-third).min(third),
        b.position,
    ]
}

/// Width of the fillet around a branch on a soma, in the branch's radii.
pub const SOMA_FILLET: f32 = 0.5;

/// Share of the way `over` its trunk's tangent plane that the first leg of a loft takes, and its derivative;
/// `over_x` is that of the way.
///
/// On a soma the quad is square and the branch is round: the corners are twice as far from the branch as the
/// middles of the sides. With a third everywhere four ridges led to the corners. There the first leg leaves
/// no more than [`SOMA_FILLET`], so that the fillet is as wide all around. A trunk is too curved for that.
pub(super) fn first_leg(a: &Corner, b: &Corner, over: Vec3, over_x: Vec3) -> (f32, f32) {
    let length = over.length().max(f32::MIN_POSITIVE);
    let left = SOMA_FILLET * b.radius / length;
    if a.role == Role::Soma && left < 2.0 / 3.0 {
        (1.0 - left, left * over.dot(over_x) / (length * length))
    } else {
        (1.0 / 3.0, 0.0)
    }
}

pub(super) fn cubic([p0, p1, p2, p3]: [Vec3; 4], t: f32) -> Jet {
    let s = 1.0 - t;
    let position =
        p0 * (s * s * s) + p1 * (3.0 * s * s * t) + p2 * (3.0 * s * t * t) + p3 * (t * t * t);
    let derivative =
        (p1 - p0) * (3.0 * s * s) + (p2 - p1) * (6.0 * s * t) + (p3 - p2) * (3.0 * t * t);
    Jet {
        position,
        derivative,
    }
}

/// Normals on an edge, at right angles to the edge's own direction. They depend on the edge alone, so that both
/// patches beside it have the same. Along a tube they are at right angles to the directions around it, too, which a
/// sheared tube's edges are not; elsewhere they are nearest to those of the corners.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EdgeNormals {
    normals: [Vec3; 2],
    /// Along a tube: directions around it at both ends.
    around: Option<[Vec3; 2]>,
}

impl EdgeNormals {
    pub(crate) fn new(kind: EdgeKind, a: &Corner, b: &Corner) -> Self {
        let along_tube = kind == EdgeKind::Along && a.on_ring() && b.on_ring();
        Self {
            normals: [a.normal, b.normal],
            around: along_tube.then(|| [a, b].map(|k| k.tangent.cross(k.radial))),
        }
    }

    /// At t ∈ [0, 1], where the edge has this derivative.
    pub(crate) fn at(&self, derivative: Vec3, t: f32) -> Vec3 {
        let mixed = mix(self.normals[0], self.normals[1], t);
        if let Some([a, b]) = self.around {
            let normal = mix(a, b, t).cross(derivative).normalize_or_zero();
            if normal != Vec3::ZERO && normal.dot(mixed) >= 0.0 {
                return normal;
            }
        }
        let along = derivative.normalize_or_zero();
        let across = (mixed - along * mixed.dot(along)).try_normalize();
        across.unwrap_or_else(|| mixed.normalize_or(Vec3::Y))
    }
}
