//! Edges between corners, which depend on them alone: four at once.

use glam::Vec3;
use neurotess_mesh::Role;

use super::center_line::CenterLines;
use super::corner::{Corners, Jets};
use super::four::{F32x4, Mask, Vec3x4};
use super::profile::{Profiles, Shares};
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

/// Divides by the lengths of vectors.
#[derive(Clone, Copy, Debug)]
pub(super) struct OverLength {
    by: Vec3x4,
    inverse: F32x4,
}

impl OverLength {
    #[inline(always)]
    pub(super) fn of(by: Vec3x4) -> Self {
        Self {
            by,
            inverse: F32x4::ONE / by.length().max(F32x4::splat(1e-3)),
        }
    }

    /// `A / |B|` and its derivative, from those of A and B.
    #[inline(always)]
    pub(super) fn jet(&self, a: Vec3x4, a_dot: Vec3x4, by_dot: Vec3x4) -> Jets {
        let position = a * self.inverse;
        let shrinking = self.by.dot(by_dot) * self.inverse * self.inverse;
        Jets {
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

/// The longer of the offsets of two corners of each ring.
#[inline(always)]
pub(super) fn longer(a: Vec3x4, b: Vec3x4) -> F32x4 {
    a.length_squared().max(b.length_squared()).sqrt()
}

/// Squares of the greatest distances from the center lines at y, between rings with these longest offsets.
#[inline(always)]
pub(super) fn most_squared(near: F32x4, far: F32x4, y: F32x4) -> F32x4 {
    let most = MAX_OFFSET * (near * (1.0 - y) + far * y);
    most * most
}

impl Jets {
    /// With their positions shortened to a length where they are longer, by the square of that.
    #[inline(always)]
    pub(super) fn within(self, most_squared: F32x4) -> Self {
        let squared = self.position.length_squared();
        let is_within = squared.cmple(most_squared);
        // Nearly always.
        if is_within.all() {
            return self;
        }
        self.shortened(is_within, squared, most_squared)
    }

    #[cold]
    fn shortened(self, is_within: Mask, squared: F32x4, most_squared: F32x4) -> Self {
        let along = self.position * (self.position.dot(self.derivative) / squared);
        let share = (most_squared / squared).sqrt();
        let position = self.position * share;
        let derivative = (self.derivative - along) * share;
        Self {
            position: Vec3x4::select(is_within, self.position, position),
            derivative: Vec3x4::select(is_within, self.derivative, derivative),
        }
    }

    /// Multiplied by the share of a tube's radius, with the derivative around the tube.
    #[inline(always)]
    pub(super) fn around(self, share: Shares) -> Self {
        Self {
            position: self.position * share.value,
            derivative: self.derivative * share.value,
        }
    }

    /// The same with the derivative along the tube.
    #[inline(always)]
    pub(super) fn along(self, share: Shares) -> Self {
        Self {
            position: self.position * share.value,
            derivative: self.derivative * share.value + self.position * share.derivative,
        }
    }
}

#[inline(always)]
pub(super) fn mix(a: Vec3x4, b: Vec3x4, t: F32x4) -> Vec3x4 {
    a * (1.0 - t) + b * t
}

/// Four edges of one kind, ready to be evaluated at many points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EdgeCurves<'c> {
    a: &'c Corners,
    b: &'c Corners,
    course: Course,
}

/// What the points of an edge have in common.
#[derive(Clone, Copy, Debug)]
enum Course {
    Ring,
    Along(CenterLines, Profiles),
    Cubic([Vec3x4; 4]),
}

impl<'c> EdgeCurves<'c> {
    /// From `a` to `b`.
    #[inline(always)]
    pub(crate) fn new(kind: EdgeKind, a: &'c Corners, b: &'c Corners, path: Path) -> Self {
        let course = match kind {
            EdgeKind::Ring => Course::Ring,
            EdgeKind::Along => {
                let line = CenterLines::new(a, b, path);
                Course::Along(line, Profiles::new(a, b, &line))
            }
            EdgeKind::Soma => Course::Cubic(soma_controls(a, b)),
            EdgeKind::Loft => Course::Cubic(loft_controls(a, b)),
        };
        Self { a, b, course }
    }

    /// At t ∈ [0, 1].
    #[inline(always)]
    pub(crate) fn at(&self, t: F32x4) -> Jets {
        match self.course {
            Course::Ring => {
                let offset = self.offset(t);
                Jets {
                    position: self.a.center + offset.position,
                    ..offset
                }
            }
            Course::Along(line, profile) => {
                let (center, offset) = (line.at(t), self.offset(t).along(profile.share(t)));
                Jets {
                    position: center.position + offset.position,
                    derivative: center.derivative + offset.derivative,
                }
            }
            Course::Cubic(controls) => cubic(controls, t),
        }
    }

    /// The radii of their tubes (µm) at t ∈ [0, 1]; linear between corners of other edges.
    #[inline(always)]
    pub(crate) fn radius(&self, t: F32x4) -> F32x4 {
        match &self.course {
            Course::Along(_, profile) => profile.radius(t),
            _ => self.a.radius * (1.0 - t) + self.b.radius * t,
        }
    }

    /// From the center line, where the radius is linear along it.
    #[inline(always)]
    fn offset(&self, t: F32x4) -> Jets {
        let Self { a, b, .. } = self;
        let most = match self.course {
            Course::Along(..) => most_squared(a.offset.length(), b.offset.length(), t),
            _ => {
                let ring = longer(a.offset, b.offset);
                most_squared(ring, ring, F32x4::ZERO)
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

/// Control points of edges on somata.
pub(crate) fn soma_controls(a: &Corners, b: &Corners) -> [Vec3x4; 4] {
    let way = b.position - a.position;
    let three = F32x4::splat(3.0);
    let leave = |normal: Vec3x4| (way - normal * way.dot(normal)) / three;
    [
        a.position,
        a.position + leave(a.cubic_normal()),
        b.position - leave(b.cubic_normal()),
        b.position,
    ]
}

/// Control points of edges of lofts, from the trunk's corner `a` to the inset's corner `b`.
pub(crate) fn loft_controls(a: &Corners, b: &Corners) -> [Vec3x4; 4] {
    let way = b.position - a.position;
    let normal = a.cubic_normal();
    let over = way - normal * way.dot(normal);
    let third = way.length() / 3.0;
    [
        a.position,
        a.position + over * first_leg(a, b, over, Vec3x4::ZERO).0,
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
pub(super) fn first_leg(a: &Corners, b: &Corners, over: Vec3x4, over_x: Vec3x4) -> (F32x4, F32x4) {
    let length = over.length().max(F32x4::splat(f32::MIN_POSITIVE));
    let left = SOMA_FILLET * b.radius / length;
    let is_fillet = a.has_role(Role::Soma) & left.cmplt(F32x4::splat(2.0 / 3.0));
    let left_x = left * over.dot(over_x) / (length * length);
    (
        F32x4::select(is_fillet, 1.0 - left, F32x4::splat(1.0 / 3.0)),
        F32x4::select(is_fillet, left_x, F32x4::ZERO),
    )
}

#[inline(always)]
pub(super) fn cubic([p0, p1, p2, p3]: [Vec3x4; 4], t: F32x4) -> Jets {
    let s = 1.0 - t;
    let position =
        p0 * (s * s * s) + p1 * (3.0 * s * s * t) + p2 * (3.0 * s * t * t) + p3 * (t * t * t);
    let derivative =
        (p1 - p0) * (3.0 * s * s) + (p2 - p1) * (6.0 * s * t) + (p3 - p2) * (3.0 * t * t);
    Jets {
        position,
        derivative,
    }
}

/// Normals on four edges of one kind, at right angles to the edge's own direction. They depend on the edge alone, so
/// that both patches beside it have the same. Along a tube they are at right angles to the directions around it, too,
/// which a sheared tube's edges are not; elsewhere they are nearest to those of the corners.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EdgeNormals {
    normals: [Vec3x4; 2],
    /// Along tubes: which, and the directions around them at both ends.
    around: Option<(Mask, [Vec3x4; 2])>,
}

impl EdgeNormals {
    #[inline(always)]
    pub(crate) fn new(kind: EdgeKind, a: &Corners, b: &Corners) -> Self {
        Self {
            normals: [a.normal, b.normal],
            around: (kind == EdgeKind::Along).then(|| {
                let along_tube = a.on_ring() & b.on_ring();
                (along_tube, [a, b].map(|k| k.tangent.cross(k.radial)))
            }),
        }
    }

    /// At t ∈ [0, 1], where the edges have this derivative.
    #[inline(always)]
    pub(crate) fn at(&self, derivative: Vec3x4, t: F32x4) -> Vec3x4 {
        let mixed = mix(self.normals[0], self.normals[1], t);
        let Some((along_tube, [a, b])) = self.around else {
            return across(derivative, mixed);
        };
        let normal = mix(a, b, t).cross(derivative).normalize_or_zero();
        let fits = normal.dot(mixed).cmpge(F32x4::ZERO) & !normal.is_zero() & along_tube;
        if fits.all() {
            return normal;
        }
        Vec3x4::select(fits, normal, across(derivative, mixed))
    }
}

/// The unit vectors at right angles to these derivatives that are nearest to `mixed`.
#[inline(always)]
fn across(derivative: Vec3x4, mixed: Vec3x4) -> Vec3x4 {
    let along = derivative.normalize_or_zero();
    let (unit, has_direction) = (mixed - along * mixed.dot(along)).normalize();
    if has_direction.all() {
        return unit;
    }
    let fallback = mixed.normalize_or(Vec3x4::splat(Vec3::Y));
    Vec3x4::select(has_direction, unit, fallback)
}
