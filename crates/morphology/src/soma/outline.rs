//! The body of one outline: circular cross-sections along its long axis.
//!
//! Only a silhouette was traced. Along the long axis (the principal one of the outlined area) the outline has a middle and
//! a half-width; the body there is a circle of that half-width about that middle, as NEURON reads outlines. So its
//! silhouette is the outline, and its depth the local half-width.
//!
//! ```text
//!        width ▲      ,---.              Between two corners of the outline, middle and half-width are
//!              │   ,-'  ↕  `-.           linear: a **slab**, an oblique cone. A ray leaves the body at the
//!              │  (----m·h----) ──▶      last root of a quadratic in one of them, or through a flat end.
//!              │   `-.     ,-'   long axis
//!                     `---'
//! ```
//!
//! An outline that the width meets more than twice has the outermost two edges for a slab.
//!
//! This body has the outline's bumps all around. So it is made smooth ([`smooth`](super::smooth)), and set right by the
//! outline itself: wholly in its plane, off the plane by a share that falls as cos⁴ of the elevation.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::smooth::Smooth;

/// Corners of an outline that are kept: the time of a ray is linear in them.
const MAX_CORNERS: usize = 96;
/// Farthest from the centroid that the center is, in radii of equal area, so that all of an outline is seen: from near a
/// tip all may be seen, but not well.
const ASIDE: f64 = 0.5;
/// Angles at which an outline is compared with the body.
const ANGLES: usize = 120;
/// Weights of neighboring angles that round the corners of an outline: 6° to both sides.
const ROUNDED: [f64; 5] = [1.0, 2.0, 3.0, 2.0, 1.0];
/// Least share of the body's distance that an outline's has.
const LEAST: f64 = 0.05;
/// Least share of the radius of equal area that the center keeps from the edges of an outline, if it can.
const CLEARANCE: f64 = 0.2;

/// An outline as seen from the center within it: long axis first.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Outline {
    axes: [DVec3; 3],
    body: Smooth,
    /// By how much the logarithm of the outline's distance is off the body's in its plane.
    off: InPlane,
}

/// A function of the angle in the plane, smooth and known at equal angles once the outline is stretched to a round one.
#[derive(Clone, Debug, PartialEq)]
struct InPlane {
    stretch: f64,
    values: [f64; ANGLES],
}

/// The body with its bumps.
struct Slabs(Vec<Slab>);

/// A stretch of the long axis with linear middle and half-width.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Slab {
    from: f64,
    to: f64,
    middle: [f64; 2],
    half: [f64; 2],
}

impl Outline {
    /// The body of a nearly flat outline and its center; none if it encloses nothing.
    pub(super) fn new(outline: &[DVec3]) -> Option<(DVec3, Self)> {
        let stride = outline.len().div_ceil(MAX_CORNERS).max(1);
        let outline: Vec<DVec3> = outline.iter().step_by(stride).copied().collect();
        let (origin, normal) = plane(&outline)?;
        let (e1, e2) = normal.any_orthonormal_pair();
        let flat = |axes: [DVec3; 2], origin: DVec3| -> Vec<DVec2> {
            let place =
                |&p: &DVec3| DVec2::new((p - origin).dot(axes[0]), (p - origin).dot(axes[1]));
            outline.iter().map(place).collect()
        };
        let corners = flat([e1, e2], origin);
        let moments = Moments::of(&corners)?;
        let turn = 0.5 * f64::atan2(2.0 * moments.xy, moments.xx - moments.yy);
        let long = e1 * turn.cos() + e2 * turn.sin();
        let wide = normal.cross(long);
        let about = origin + e1 * moments.centroid.x + e2 * moments.centroid.y;
        let corners = flat([long, wide], about);
        let middle = center(&corners, (moments.area / std::f64::consts::PI).sqrt());
        let corners: Vec<DVec2> = corners.into_iter().map(|corner| corner - middle).collect();
        let slabs = Slabs(slabs(&corners));
        let center = about + long * middle.x + wide * middle.y;
        let body = Smooth::fit(|ray| slabs.leave(ray))?;
        Some((
            center,
            Self {
                axes: [long, wide, normal],
                off: InPlane::new((moments.xx / moments.yy).sqrt(), |ray| {
                    let traced = farthest(&corners, ray);
                    let smooth = body.logarithm(ray.extend(0.0));
                    traced
                        .max((LEAST * smooth.exp()).max(f64::MIN_POSITIVE))
                        .ln()
                        - smooth
                }),
                body,
            },
        ))
    }

    /// Unit normal of its plane.
    pub(super) fn normal(&self) -> DVec3 {
        self.axes[2]
    }

    /// Distance of the surface from the center.
    pub(super) fn distance(&self, direction: DVec3) -> f64 {
        let ray = DVec3::from_array(self.axes.map(|axis| direction.dot(axis)));
        let smooth = self.body.logarithm(ray);
        let Some(flat) = ray.truncate().try_normalize() else {
            return smooth.exp();
        };
        let in_plane = ray.truncate().length_squared().powi(2);
        (smooth + self.off.at(flat) * in_plane).exp()
    }
}

impl InPlane {
    fn new(stretch: f64, value: impl Fn(DVec2) -> f64) -> Self {
        let stretch = match stretch.is_finite() {
            true => stretch.clamp(1.0, 10.0),
            false => 1.0,
        };
        let traced: [f64; ANGLES] = std::array::from_fn(|i| {
            let (sin, cos) = (TAU * i as f64 / ANGLES as f64).sin_cos();
            value(DVec2::new(cos, sin / stretch).normalize_or(DVec2::X))
        });
        // Corners that were clicked are none of the membrane.
        let all: f64 = ROUNDED.iter().sum();
        let rounded = |i: usize| {
            let around = (0..).zip(ROUNDED);
            let first = i + ANGLES - ROUNDED.len() / 2;
            around
                .map(|(k, weight): (usize, f64)| weight * traced[(first + k) % ANGLES])
                .sum::<f64>()
                / all
        };
        Self {
            stretch,
            values: std::array::from_fn(rounded),
        }
    }

    /// Between the angles by a cubic through four of them.
    fn at(&self, ray: DVec2) -> f64 {
        let turns = f64::atan2(ray.y * self.stretch, ray.x).rem_euclid(TAU) / TAU * ANGLES as f64;
        let (index, t) = (turns as usize, turns.fract());
        let [a, b, c, d] = [ANGLES - 1, 0, 1, 2].map(|k| self.values[(index + k) % ANGLES]);
        let (slope, next) = (0.5 * (c - a), 0.5 * (d - b));
        let (t2, t3) = (t * t, t * t * t);
        (2.0 * t3 - 3.0 * t2 + 1.0) * b
            + (t3 - 2.0 * t2 + t) * slope
            + (3.0 * t2 - 2.0 * t3) * c
            + (t3 - t2) * next
    }
}

impl Slabs {
    /// Where a ray leaves the slabs for the last time.
    fn leave(&self, ray: DVec3) -> f64 {
        let lasts = self.0.iter().filter_map(|slab| slab.leave(ray));
        lasts.fold(0.0, f64::max)
    }
}

impl Slab {
    fn leave(&self, ray: DVec3) -> Option<f64> {
        // Ways at which the ray is between the ends.
        let (first, last) = if ray.x.abs() < 1e-12 {
            if !(self.from..=self.to).contains(&0.0) {
                return None;
            }
            (0.0, f64::INFINITY)
        } else {
            let (a, b) = (self.from / ray.x, self.to / ray.x);
            (a.min(b).max(0.0), a.max(b))
        };
        if last < first {
            return None;
        }
        let length = self.to - self.from;
        let slope = |ends: [f64; 2]| (ends[1] - ends[0]) / length;
        let (m1, h1) = (slope(self.middle), slope(self.half));
        let (m0, h0) = (
            self.middle[0] - self.from * m1,
            self.half[0] - self.from * h1,
        );
        // Within: (w t − m)² + (z t)² − h² ≤ 0, with m = m0 + m1 x t and h = h0 + h1 x t.
        let (dw, dh) = (ray.y - m1 * ray.x, h1 * ray.x);
        let (a, b, c) = (
            dw * dw + ray.z * ray.z - dh * dh,
            -dw * m0 - h0 * dh,
            m0 * m0 - h0 * h0,
        );
        let within = |t: f64| (a * t + 2.0 * b) * t + c <= 1e-9 * (c.abs() + h0 * h0);
        if last.is_finite() && within(last) {
            return Some(last);
        }
        let inner = b * b - a * c;
        if inner < 0.0 {
            return None;
        }
        let root = inner.sqrt();
        let roots = match a.abs() < 1e-12 {
            true => [-c / (2.0 * b); 2],
            false => [(-b - root) / a, (-b + root) / a],
        };
        let slack = 1e-9 * last.min(1e9);
        let in_range = |t: &f64| *t >= first - slack && *t <= last + slack;
        roots.into_iter().filter(in_range).reduce(f64::max)
    }
}

/// Mean of the corners, and the unit normal of their vector area.
fn plane(outline: &[DVec3]) -> Option<(DVec3, DVec3)> {
    let middle = outline.iter().copied().sum::<DVec3>() / outline.len().max(1) as f64;
    let corners = outline.iter().zip(outline.iter().cycle().skip(1));
    let normal: DVec3 = corners.map(|(&a, &b)| (a - middle).cross(b - middle)).sum();
    Some((middle, normal.try_normalize()?))
}

/// Moments of the area within a polygon.
pub(super) struct Moments {
    pub(super) area: f64,
    pub(super) centroid: DVec2,
    /// Second moments about the centroid.
    xx: f64,
    xy: f64,
    yy: f64,
}

impl Moments {
    /// None of a polygon that encloses nothing.
    pub(super) fn of(corners: &[DVec2]) -> Option<Self> {
        let (mut area, mut first, mut second) = (0.0, DVec2::ZERO, [0.0; 3]);
        for (&a, &b) in edges(corners) {
            let cross = 0.5 * a.perp_dot(b);
            area += cross;
            first += (a + b) * (cross / 3.0);
            let of = |i: usize, j: usize| {
                let same = a[i] * a[j] + b[i] * b[j];
                cross / 12.0 * (2.0 * same + a[i] * b[j] + a[j] * b[i])
            };
            second[0] += of(0, 0);
            second[1] += of(0, 1);
            second[2] += of(1, 1);
        }
        let centroid = first / area;
        let [xx, xy, yy] = second.map(|moment| moment / area);
        centroid.is_finite().then_some(Self {
            area: area.abs(),
            centroid,
            xx: xx - centroid.x * centroid.x,
            xy: xy - centroid.x * centroid.y,
            yy: yy - centroid.y * centroid.y,
        })
    }
}

pub(super) fn edges(corners: &[DVec2]) -> impl Iterator<Item = (&DVec2, &DVec2)> {
    corners.iter().zip(corners.iter().cycle().skip(1))
}

/// Distance at which a ray from the origin leaves a polygon for the last time; 0 if it meets no edge.
pub(super) fn farthest(corners: &[DVec2], ray: DVec2) -> f64 {
    let crossed = edges(corners).filter_map(|(&a, &b)| {
        let (from, to) = (ray.perp_dot(a), ray.perp_dot(b));
        if (from > 0.0) == (to > 0.0) {
            return None;
        }
        Some(a.lerp(b, from / (from - to)).dot(ray))
    });
    crossed.fold(0.0, f64::max)
}

/// Where an outline is seen from: its centroid (the origin) if all edges face it and none is near, else the centroid
/// of what all edges face if that is near, else the middle of the outline's width at its own centroid.
fn center(corners: &[DVec2], radius: f64) -> DVec2 {
    let turn = edges(corners)
        .map(|(&a, &b)| a.perp_dot(b))
        .sum::<f64>()
        .signum();
    let reach = corners.iter().map(|c| c.length()).fold(0.0, f64::max);
    let mut kernel: Vec<DVec2> = [[-1., -1.], [1., -1.], [1., 1.], [-1., 1.]]
        .map(|corner| DVec2::from_array(corner) * reach)
        .to_vec();
    let mut nearest = f64::INFINITY;
    for (&a, &b) in edges(corners) {
        let Some(along) = (b - a).try_normalize() else {
            continue;
        };
        let inwards = |p: DVec2| turn * along.perp_dot(p - a);
        nearest = nearest.min(inwards(DVec2::ZERO));
        let mut clipped = Vec::with_capacity(kernel.len() + 1);
        for (&p, &q) in edges(&kernel) {
            let (from, to) = (inwards(p), inwards(q));
            if from >= 0.0 {
                clipped.push(p);
            }
            if (from >= 0.0) != (to >= 0.0) {
                clipped.push(p.lerp(q, from / (from - to)));
            }
        }
        kernel = clipped;
        if kernel.is_empty() {
            break;
        }
    }
    if nearest >= CLEARANCE * radius {
        return DVec2::ZERO;
    }
    match Moments::of(&kernel) {
        Some(kernel)
            if kernel.area > 1e-3 * radius * radius
                && kernel.centroid.length() < ASIDE * radius =>
        {
            kernel.centroid
        }
        _ => {
            let (above, below) = (farthest(corners, DVec2::Y), farthest(corners, DVec2::NEG_Y));
            let crossed = edges(corners).filter(|(a, b)| (a.x > 0.0) != (b.x > 0.0));
            let places = crossed.map(|(a, b)| a.y + (b.y - a.y) * a.x / (a.x - b.x));
            let mut places: Vec<f64> = places.collect();
            places.sort_by(f64::total_cmp);
            // The widest stretch within.
            let spans = places.chunks_exact(2).map(|span| [span[0], span[1]]);
            let widest = spans.max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])));
            let [low, high] = widest.unwrap_or([-below, above]);
            DVec2::new(0.0, 0.5 * (low + high))
        }
    }
}

/// The slabs between the corners.
fn slabs(corners: &[DVec2]) -> Vec<Slab> {
    let mut places: Vec<f64> = corners.iter().map(|corner| corner.x).collect();
    places.sort_by(f64::total_cmp);
    let extent = places.last().unwrap_or(&0.0) - places.first().unwrap_or(&0.0);
    places.dedup_by(|a, b| (*a - *b).abs() < 1e-6 * extent);
    let slab = |ends: &[f64]| {
        let (from, to) = (ends[0], ends[1]);
        let middle = 0.5 * (from + to);
        let spanning = edges(corners).filter(|(a, b)| (a.x > middle) != (b.x > middle));
        let at = |(a, b): (&DVec2, &DVec2)| {
            [from, to, middle].map(|x| a.y + (b.y - a.y) * (x - a.x) / (b.x - a.x))
        };
        let mut heights: Vec<[f64; 3]> = spanning.map(at).collect();
        heights.sort_by(|a, b| a[2].total_cmp(&b[2]));
        let (low, high) = (heights.first()?, heights.last()?);
        let ends = |of: fn(f64, f64) -> f64| [of(low[0], high[0]), of(low[1], high[1])];
        Some(Slab {
            from,
            to,
            middle: ends(|low, high| 0.5 * (low + high)),
            half: ends(|low, high| 0.5 * (high - low).max(0.0)),
        })
    };
    places.windows(2).filter_map(slab).collect()
}
