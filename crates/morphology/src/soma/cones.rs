//! The union of the round cones of a chain of samples.
//!
//! A **round cone** is the convex hull of two balls. A ray from the center leaves it at the last of its crossings with the
//! two balls and with the cone that touches both, where the ray's foot lies between them.

use glam::DVec3;

use super::directions::Directions;
use crate::SomaSample;

/// The round cones of linked samples.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Cones(Vec<Cone>);

#[derive(Clone, Copy, Debug, PartialEq)]
struct Cone {
    from: DVec3,
    to: DVec3,
    radii: [f64; 2],
}

/// Places along the chain that the center is looked for among, at most.
const MAX_CENTERS: usize = 32;
/// Cones of a soma, at most: longer chains leave out samples.
const MAX_CONES: usize = 512;
/// Directions along an edge of a cube by which centers are compared.
const COMPARED: u32 = 6;
/// A gap along a ray up to this share of the distance is none.
const NO_GAP: f64 = 0.05;
/// Share of directions with a gap up to which cylinders are a star: a dent is no branch. By eye.
const FEW: f64 = 0.03;

impl Cones {
    /// The cones of samples, and the place within that they are seen from best; none of samples without extent.
    pub(super) fn new(samples: &[SomaSample]) -> Option<(DVec3, Self)> {
        let ball = |sample: &SomaSample| {
            (
                sample.position.as_dvec3(),
                f64::from(sample.radius).max(0.0),
            )
        };
        let cone = |sample: &SomaSample| {
            let ((from, first), (to, last)) =
                (ball(&samples[sample.parent? as usize]), ball(sample));
            Some(Cone {
                from,
                to,
                radii: [first, last],
            })
        };
        let mut cones: Vec<Cone> = samples.iter().filter_map(cone).collect();
        let stride = cones.len().div_ceil(MAX_CONES).max(1);
        cones = cones.into_iter().step_by(stride).collect();
        let cones = Self(cones);
        let center = cones.center()?;
        Some((center, cones))
    }

    /// The middle if all is seen from there, else the place on the chain that sees most.
    fn center(&self) -> Option<DVec3> {
        let weighed = |cone: &Cone| {
            let [a, b] = cone.radii;
            let length = cone.from.distance(cone.to);
            let volume = length * (a * a + a * b + b * b) / 3.0 + a.max(b).powi(3) * 1e-3;
            let shift = match a * a + a * b + b * b {
                0.0 => 0.5,
                all => (a * a + 2.0 * a * b + 3.0 * b * b) / (4.0 * all),
            };
            (cone.from.lerp(cone.to, shift), volume)
        };
        let (mut sum, mut all) = (DVec3::ZERO, 0.0);
        for (place, volume) in self.0.iter().map(weighed) {
            sum += place * volume;
            all += volume;
        }
        let middle = sum / all;
        if !(all > 0.0 && middle.is_finite()) {
            return None;
        }
        let directions = Directions::new(COMPARED);
        if self.holds(middle) && self.gaps(middle, &directions) == 0.0 {
            return Some(middle);
        }
        let stride = (2 * self.0.len()).div_ceil(MAX_CENTERS).max(1);
        let places = self
            .0
            .iter()
            .flat_map(|cone| [cone.to, cone.from.midpoint(cone.to)]);
        let places = places.step_by(stride).filter(|&place| self.holds(place));
        let seen = places.map(|place| (self.gaps(place, &directions), place));
        // Of those that see the same, the nearest to the middle.
        let best = seen.min_by(|(a, p), (b, q)| {
            let far = |place: &DVec3| place.distance_squared(middle);
            a.total_cmp(b).then(far(p).total_cmp(&far(q)))
        });
        best.map(|(_, place)| place)
    }

    fn holds(&self, place: DVec3) -> bool {
        self.0.iter().any(|cone| {
            let along = cone.to - cone.from;
            let t = (place - cone.from).dot(along) / along.length_squared();
            let t = if t.is_finite() {
                t.clamp(0.0, 1.0)
            } else {
                0.0
            };
            let radius = cone.radii[0] + t * (cone.radii[1] - cone.radii[0]);
            place.distance(cone.from.lerp(cone.to, t)) < radius
        })
    }

    /// Distance at which a ray leaves the union for the last time.
    pub(super) fn distance(&self, center: DVec3, direction: DVec3) -> f64 {
        let ends = self.0.iter();
        let ends = ends.filter_map(|cone| cone.crossed(center, direction));
        ends.map(|[_, last]| last).fold(0.0, f64::max)
    }

    /// Whether nearly all of it is seen from the center.
    pub(super) fn is_star(&self, center: DVec3, directions: &Directions) -> bool {
        self.gaps(center, directions) <= FEW
    }

    /// Share of directions in which something is hidden.
    fn gaps(&self, center: DVec3, directions: &Directions) -> f64 {
        let has_gap = |direction: &&DVec3| {
            let crossed = self.0.iter();
            let crossed = crossed.filter_map(|cone| cone.crossed(center, **direction));
            let mut spans: Vec<[f64; 2]> = crossed.filter(|&[_, last]| last > 0.0).collect();
            spans.sort_by(|a, b| a[0].total_cmp(&b[0]));
            let last = spans.iter().map(|span| span[1]).fold(0.0, f64::max);
            let mut reached = 0.0;
            spans.iter().any(|&[first, end]| {
                let gap = first - reached > NO_GAP * last;
                reached = f64::max(reached, end);
                gap
            })
        };
        let hidden = directions.units.iter().filter(has_gap).count();
        hidden as f64 / directions.units.len() as f64
    }
}

impl Cone {
    /// Where a line enters and leaves it, as ways from `center`.
    fn crossed(&self, center: DVec3, direction: DVec3) -> Option<[f64; 2]> {
        let [ra, rb] = self.radii;
        let mut span: Option<[f64; 2]> = None;
        let mut add = |t: f64| {
            span = Some(span.map_or([t; 2], |[first, last]| [first.min(t), last.max(t)]));
        };
        for (ball, radius) in [(self.from, ra), (self.to, rb)] {
            let off = center - ball;
            let roots = roots(
                1.0,
                off.dot(direction),
                off.length_squared() - radius * radius,
            );
            roots.into_iter().flatten().for_each(&mut add);
        }
        let along = self.to - self.from;
        let length = along.length();
        let sine = (ra - rb) / length;
        if sine.is_nan() || sine.abs() >= 1.0 {
            return span; // one ball holds the other
        }
        let (axis, cosine) = (along / length, (1.0 - sine * sine).sqrt());
        // With s along the axis and ρ off it, the cone is ρ cos = ra − s sin.
        let off = center - self.from;
        let (s0, s1) = (off.dot(axis), direction.dot(axis));
        let (a, b, c) = (
            cosine * cosine * (1.0 - s1 * s1) - sine * sine * s1 * s1,
            cosine * cosine * (off.dot(direction) - s0 * s1) + sine * s1 * (ra - s0 * sine),
            cosine * cosine * (off.length_squared() - s0 * s0) - (ra - s0 * sine).powi(2),
        );
        for t in roots(a, b, c).into_iter().flatten() {
            let s = s0 + t * s1;
            let from_axis = (ra - s * sine) / cosine;
            let foot = s - from_axis * sine / cosine;
            if from_axis >= 0.0 && (0.0..=length).contains(&foot) {
                add(t);
            }
        }
        span
    }
}

/// The roots of a t² + 2 b t + c.
fn roots(a: f64, b: f64, c: f64) -> [Option<f64>; 2] {
    if a.abs() < 1e-12 {
        let root = (b != 0.0).then(|| -c / (2.0 * b));
        return [root, None];
    }
    let inner = b * b - a * c;
    if inner < 0.0 {
        return [None; 2];
    }
    let root = inner.sqrt();
    [Some((-b - root) / a), Some((-b + root) / a)]
}
