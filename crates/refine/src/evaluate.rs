//! The refined surface as a function: edges, patches, normals.
//!
//! **Theory.** García-Cantero et al. 2017, eq. 1 and 2: a point of a tube is `v = c + r n̂`, with
//! the center c on a cubic Hermite curve between two tracing points, r and n̂ interpolated and n̂
//! renormalized so that the tube does not pinch. We interpolate the offsets d = v − c of the four
//! corners and divide by the length of the interpolated unit normals,
//!
//! `v(x, y) = c(y) + Σ wᵢ dᵢ / |Σ wᵢ n̂ᵢ|`,
//!
//! which is the same for circles and makes a quarter of an ellipse where a joint's vertices lie
//! at different distances. Somata are bilinearly blended Coons patches over four cubics made from
//! the corners' positions and normals (Vlachos et al., Curved PN triangles, 2001, for the cubics).
//!
//! Around an inset, where a branch leaves a quad of its trunk, lie four lofts: at each x a cubic that
//! leaves the trunk's side within the trunk's tangent plane and arrives at the inset's side along the
//! branch. So the branch meets its trunk in a fillet, whatever the angle between them.
//!
//! **Conformity.** A point of an edge depends on the edge alone: two corners and their tracing
//! points, always taken in the edge's own direction. So faces that share an edge agree to the bit.

use glam::Vec3;
use neurotess_mesh::{CoarseMesh, PatchKind, Role};

use crate::{Caps, Path, RefineOptions};

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
    /// Of an inset's corner: length of a loft's last leg along the tangent.
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

    /// The cubics of somata and lofts leave a corner at right angles to this normal. At a neurite's ring it
    /// is the tube's, so that the soma runs smoothly into the neurite.
    fn cubic_normal(&self) -> Vec3 {
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

/// `A / |B|` and its derivative.
fn over_length(a: Vec3, a_dot: Vec3, b: Vec3, b_dot: Vec3) -> Jet {
    let inverse = 1.0 / b.length().max(1e-3);
    let derivative = a_dot * inverse - a * (b.dot(b_dot) * inverse * inverse * inverse);
    Jet {
        position: a * inverse,
        derivative,
    }
}

fn mix(a: Vec3, b: Vec3, t: f32) -> Vec3 {
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
        over_length(
            mix(a.offset, b.offset, t),
            b.offset - a.offset,
            mix(a.radial, b.radial, t),
            b.radial - a.radial,
        )
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
    [
        a.position,
        a.position + over * first_leg(a, b, over, Vec3::ZERO).0,
        b.position - b.tangent * b.collar.min(way.length() / 3.0),
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
fn first_leg(a: &Corner, b: &Corner, over: Vec3, over_x: Vec3) -> (f32, f32) {
    let length = over.length().max(f32::MIN_POSITIVE);
    let left = SOMA_FILLET * b.radius / length;
    if a.role == Role::Soma && left < 2.0 / 3.0 {
        (1.0 - left, left * over.dot(over_x) / (length * length))
    } else {
        (1.0 / 3.0, 0.0)
    }
}

fn cubic([p0, p1, p2, p3]: [Vec3; 4], t: f32) -> Jet {
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

/// Normal on an edge: that of the corners, made perpendicular to the edge's own direction. It
/// depends on the edge alone, so that both patches beside it have the same.
pub(crate) fn edge_normal(a: &Corner, b: &Corner, derivative: Vec3, t: f32) -> Vec3 {
    let along = derivative.normalize_or_zero();
    let normal = mix(a.normal, b.normal, t);
    (normal - along * normal.dot(along)).normalize_or(normal.normalize_or(Vec3::Y))
}

/// A patch ready to be evaluated inside.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PatchShape {
    pub(crate) kind: PatchKind,
    pub(crate) corners: [Corner; 4],
    /// By side: the kind of its edge, and whether the edge runs against the patch's coordinate.
    pub(crate) sides: [(EdgeKind, bool); 4],
}

/// Corners at the start and end of each side, along the patch's coordinates: sides 0 and 2 along x
/// at y = 0 and 1, sides 1 and 3 along y at x = 1 and 0.
pub(crate) const SIDES: [(usize, usize); 4] = [(0, 1), (1, 2), (3, 2), (0, 3)];

/// A patch ready to be evaluated row by row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PatchRows<'s> {
    shape: &'s PatchShape,
    options: &'s RefineOptions,
    /// Of a tube: its center line, which all rows have.
    line: Option<CenterLine>,
}

impl<'s> PatchRows<'s> {
    /// The points inside at this y ∈ (0, 1).
    pub(crate) fn at(&self, y: f32) -> PatchRow<'s> {
        PatchRow {
            shape: self.shape,
            options: self.options,
            y,
            center: self.line.map_or(Jet::default(), |line| line.at(y)),
        }
    }
}

/// Points of a patch with the same y.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PatchRow<'s> {
    shape: &'s PatchShape,
    options: &'s RefineOptions,
    y: f32,
    /// Of a tube: the center line at y, which the whole row has.
    center: Jet,
}

impl PatchRow<'_> {
    /// A point inside with its normal, x ∈ (0, 1).
    pub(crate) fn point(&self, x: f32) -> (Vec3, Vec3) {
        let Self { shape, options, .. } = self;
        match shape.kind {
            PatchKind::Lateral => shape.lateral(&self.center, x, self.y),
            PatchKind::Soma => shape.coons(x, self.y),
            PatchKind::Loft => shape.loft(options.path, x, self.y),
            PatchKind::Cap => shape.cap(options.caps, x, self.y),
        }
    }
}

impl PatchShape {
    /// The points inside, row by row.
    pub(crate) fn rows<'s>(&'s self, options: &'s RefineOptions) -> PatchRows<'s> {
        let [a, .., d] = &self.corners;
        let is_tube = self.kind == PatchKind::Lateral;
        PatchRows {
            shape: self,
            options,
            line: is_tube.then(|| CenterLine::new(a, d, options.path)),
        }
    }

    /// A point inside with its normal, x and y ∈ (0, 1).
    pub(crate) fn interior(&self, options: &RefineOptions, x: f32, y: f32) -> (Vec3, Vec3) {
        self.rows(options).at(y).point(x)
    }

    fn lateral(&self, center: &Jet, x: f32, y: f32) -> (Vec3, Vec3) {
        let [a, b, c, d] = &self.corners;
        let blend = |f: fn(&Corner) -> Vec3| {
            let (near, far) = (mix(f(a), f(b), x), mix(f(d), f(c), x));
            let across = mix(f(b) - f(a), f(c) - f(d), y);
            (mix(near, far, y), across, far - near)
        };
        let (offset, offset_x, offset_y) = blend(|k| k.offset);
        let (radial, radial_x, radial_y) = blend(|k| k.radial);
        let around = over_length(offset, offset_x, radial, radial_x);
        let along = over_length(offset, offset_y, radial, radial_y);
        let normal = around
            .derivative
            .cross(center.derivative + along.derivative);
        let outwards = radial.normalize_or(a.normal);
        // Where a sharp bend folds the surface over, it gets the normal of a tube without the fold.
        let normal = normal.normalize_or(outwards);
        let normal = if normal.dot(outwards) > 0.0 {
            normal
        } else {
            outwards
        };
        (center.position + around.position, normal)
    }

    pub(crate) fn side(&self, side: usize, path: Path, t: f32) -> Jet {
        let (from, to) = SIDES[side];
        let (a, b) = (&self.corners[from], &self.corners[to]);
        let (kind, reversed) = self.sides[side];
        if reversed {
            let jet = edge(kind, b, a, path, 1.0 - t);
            Jet {
                derivative: -jet.derivative,
                ..jet
            }
        } else {
            edge(kind, a, b, path, t)
        }
    }

    /// At each x a cubic from the trunk's side to the inset's: [`loft_controls`] between points of the
    /// two sides, with its derivatives.
    fn loft(&self, path: Path, x: f32, y: f32) -> (Vec3, Vec3) {
        let [a, b, c, _] = &self.corners;
        let (near, far) = (self.side(0, path, x), self.side(2, path, x));
        let way = far.position - near.position;
        let way_x = far.derivative - near.derivative;
        let mixed = mix(a.cubic_normal(), b.cubic_normal(), x);
        let mixed_x = b.cubic_normal() - a.cubic_normal();
        let normal = over_length(mixed, mixed_x, mixed, mixed_x);
        let rise = way.dot(normal.position);
        let rise_x = way_x.dot(normal.position) + way.dot(normal.derivative);
        let over = way - normal.position * rise;
        let over_x = way_x - normal.derivative * rise - normal.position * rise_x;
        let (share, share_x) = first_leg(a, c, over, over_x);
        let (leave, leave_x) = (over * share, over_x * share + over * share_x);
        let third = way.length() / 3.0;
        let arrive = c.tangent * c.collar.min(third);
        let third_x = way.dot(way_x) / (9.0 * third).max(f32::MIN_POSITIVE);
        let arrive_x = if third < c.collar {
            c.tangent * third_x
        } else {
            Vec3::ZERO
        };
        let across = cubic(
            [
                near.position,
                near.position + leave,
                far.position - arrive,
                far.position,
            ],
            y,
        );
        let by_x = cubic(
            [
                near.derivative,
                near.derivative + leave_x,
                far.derivative - arrive_x,
                far.derivative,
            ],
            y,
        );
        let normal = by_x.position.cross(across.derivative);
        (across.position, normal.normalize_or(self.mean_normal()))
    }

    fn mean_normal(&self) -> Vec3 {
        let sum: Vec3 = self.corners.iter().map(|k| k.normal).sum();
        sum.normalize_or(Vec3::Y)
    }

    /// Bilinearly blended Coons patch. Its normal is that of the sides, the nearer one more: that of the surface
    /// jumps at the sides, which shows as lines where a ring pulls a soma out.
    fn coons(&self, x: f32, y: f32) -> (Vec3, Vec3) {
        let [near, right, far, left] = [
            self.side(0, Path::Hermite, x),
            self.side(1, Path::Hermite, y),
            self.side(2, Path::Hermite, x),
            self.side(3, Path::Hermite, y),
        ];
        let [a, b, c, d] = self.corners.map(|k| k.position);
        let position = mix(near.position, far.position, y) + mix(left.position, right.position, x)
            - mix(mix(a, b, x), mix(d, c, x), y);
        let [along_near, along_right, along_far, along_left] = [
            self.side_normal(0, &near, x),
            self.side_normal(1, &right, y),
            self.side_normal(2, &far, x),
            self.side_normal(3, &left, y),
        ];
        let normal = mix(along_near, along_far, y) * (x * (1.0 - x))
            + mix(along_left, along_right, x) * (y * (1.0 - y));
        (position, normal.normalize_or(self.mean_normal()))
    }

    fn side_normal(&self, side: usize, jet: &Jet, t: f32) -> Vec3 {
        let (from, to) = SIDES[side];
        edge_normal(&self.corners[from], &self.corners[to], jet.derivative, t)
    }

    /// The end of a tube: a disk, or the half sphere over it, whose polar angle grows with the
    /// distance from the disk's center.
    fn cap(&self, caps: Caps, x: f32, y: f32) -> (Vec3, Vec3) {
        let (flat, _) = self.coons(x, y);
        let [a, b, _, d] = &self.corners;
        let tangent = a.tangent;
        let outwards = (b.offset - a.offset).cross(d.offset - a.offset);
        let axis = if outwards.dot(tangent) < 0.0 {
            -tangent
        } else {
            tangent
        };
        if caps == Caps::Flat {
            return (flat, axis);
        }
        let radius = a.offset.length();
        let across = flat - a.center;
        let share = (across.length() / radius.max(f32::MIN_POSITIVE)).min(1.0);
        let angle = share * std::f32::consts::FRAC_PI_2;
        let stretch = if share > 1e-4 {
            angle.sin() / share
        } else {
            std::f32::consts::FRAC_PI_2
        };
        let dome = across * stretch + axis * (radius * angle.cos());
        (a.center + dome, dome.normalize_or(axis))
    }
}
