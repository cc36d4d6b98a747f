//! Corners, and the edges between them, which depend on them alone.

use glam::Vec3;
use neurotess_mesh::{CoarseMesh, Role};

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

/// A point of a curve or surface with its derivative.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Jet {
    pub(crate) position: Vec3,
    pub(crate) derivative: Vec3,
}

/// A corner with all that its edges depend on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Corner {
    pub(crate) position: Vec3,
    pub(crate) normal: Vec3,
    /// Center of its tracing point.
    pub(crate) center: Vec3,
    /// From the center to the corner.
    pub(crate) offset: Vec3,
    /// Unit direction of the offset; of an inset's corner, across the tangent.
    pub(crate) radial: Vec3,
    pub(crate) tangent: Vec3,
    /// Radius of its tracing point.
    pub(crate) radius: f32,
    pub(crate) role: Role,
    /// Of an inset's corner: length of a loft's last leg along the tangent, negative against it.
    pub(crate) collar: f32,
}

impl Corner {
    pub(crate) fn new(mesh: &CoarseMesh, vertex: u32) -> Self {
        let vertex = &mesh.vertices[vertex as usize];
        let tracing = &mesh.tracing[vertex.tracing as usize];
        let offset = vertex.position - tracing.center;
        // An inset follows the trunk's surface, so its corners' offsets lean; its tube must not.
        let radial = match tracing.role {
            Role::Inset => vertex.normal,
            _ => offset.normalize_or(vertex.normal),
        };
        Self {
            position: vertex.position,
            normal: vertex.normal,
            center: tracing.center,
            offset,
            radial,
            tangent: tracing.tangent,
            radius: tracing.radius,
            role: tracing.role,
            collar: tracing.collar,
        }
    }

    /// Whether it is of a circle around a path, across its tangent.
    fn on_ring(&self) -> bool {
        !matches!(self.role, Role::Joint | Role::Soma)
    }

    /// The cubics of somata and lofts leave a corner at right angles to this normal. At a neurite's ring it
    /// is the tube's, so that the soma runs smoothly into the neurite.
    pub(super) fn cubic_normal(&self) -> Vec3 {
        if self.role == Role::Soma {
            self.normal
        } else {
            self.radial
        }
    }
}

/// The center line between two tracing points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CenterLine {
    from: Vec3,
    to: Vec3,
    way: Vec3,
    /// Of a curve: those at its ends.
    tangents: Option<(Vec3, Vec3)>,
}

impl CenterLine {
    pub(crate) fn new(a: &Corner, b: &Corner, path: Path) -> Self {
        Self {
            from: a.center,
            to: b.center,
            way: b.center - a.center,
            tangents: (path == Path::Hermite).then(|| hermite_tangents(a, b)),
        }
    }

    /// At y ∈ [0, 1].
    pub(crate) fn at(&self, y: f32) -> Jet {
        let Self { from, to, way, .. } = *self;
        let Some((m0, m1)) = self.tangents else {
            return Jet {
                position: from * (1.0 - y) + to * y,
                derivative: way,
            };
        };
        let (y2, y3) = (y * y, y * y * y);
        let position = from * (2.0 * y3 - 3.0 * y2 + 1.0)
            + m0 * (y3 - 2.0 * y2 + y)
            + to * (3.0 * y2 - 2.0 * y3)
            + m1 * (y3 - y2);
        let derivative = way * (6.0 * y - 6.0 * y2)
            + m0 * (3.0 * y2 - 4.0 * y + 1.0)
            + m1 * (3.0 * y2 - 2.0 * y);
        Jet {
            position,
            derivative,
        }
    }
}

/// Greatest distance by which the tangent at one end may bend the center line away from the
/// straight segment, in radii of the thinner end.
///
/// With its full tangents, a thin neurite with long segments would sway by many times its radius,
/// away from the cones that were traced and into its neighbors. Chosen from 0.1, 0.12, 0.25, 0.5
/// and no limit with the example `fidelity`: the largest that keeps the median distance to the
/// traced cones under 0.05 of the median radius on every real cell (no limit: 0.25 on Cha-F-700113,
/// 0.20 on IF4_140201). The price is visible corners on thin axons with long segments.
pub(crate) const MOST_SWAY: f32 = 0.12;

/// Tangents of the center line: the directions at its ends times the segment's length, so that it
/// makes no loops, shortened where it would sway too far. At a joint the segment itself, since the
/// tubes there have no common direction.
///
/// A tangent bends a cubic away from the segment by at most 4/27 of the tangent's part across the
/// segment.
pub(crate) fn hermite_tangents(a: &Corner, b: &Corner) -> (Vec3, Vec3) {
    let way = b.center - a.center;
    let length = way.length();
    let direction = way / length.max(f32::MIN_POSITIVE);
    let most = MOST_SWAY * a.radius.min(b.radius) * (27.0 / 4.0);
    let tangent = |corner: &Corner| {
        if corner.role == Role::Joint {
            return way;
        }
        let across = corner.tangent - direction * corner.tangent.dot(direction);
        let sway = across.length() * length;
        corner.tangent * (length * (most / sway.max(most)))
    };
    (tangent(a), tangent(b))
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
pub(crate) const MOST_OFFSET: f32 = 1.2;

/// The longer of the offsets of two corners of a ring.
pub(super) fn longer(a: Vec3, b: Vec3) -> f32 {
    a.length_squared().max(b.length_squared()).sqrt()
}

/// Square of the greatest distance from the center line at y, between rings with these longest offsets.
pub(super) fn most_squared(near: f32, far: f32, y: f32) -> f32 {
    let most = MOST_OFFSET * (near * (1.0 - y) + far * y);
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
    Along(CenterLine),
    Cubic([Vec3; 4]),
}

impl<'c> EdgeCurve<'c> {
    /// From `a` to `b`.
    pub(crate) fn new(kind: EdgeKind, a: &'c Corner, b: &'c Corner, path: Path) -> Self {
        let course = match kind {
            EdgeKind::Ring => Course::Ring,
            EdgeKind::Along => Course::Along(CenterLine::new(a, b, path)),
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
            Course::Along(line) => {
                let (center, offset) = (line.at(t), self.offset(t));
                Jet {
                    position: center.position + offset.position,
                    derivative: center.derivative + offset.derivative,
                }
            }
            Course::Cubic(controls) => cubic(controls, t),
        }
    }

    /// From the center line.
    fn offset(&self, t: f32) -> Jet {
        let Self { a, b, .. } = self;
        let most = match self.course {
            Course::Along(_) => most_squared(a.offset.length(), b.offset.length(), t),
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
pub(crate) const SOMA_FILLET: f32 = 0.5;

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
