//! The union of the frusta of linked samples.
//!
//! A **frustum** has a flat face at each of its samples, so that a straight chain has exactly the volume that its samples
//! say. Around bends its faces gape: there a ball touches the sides. Free ends are **half-depth**: the last third of a
//! radius is cut off, and a half ellipsoid of the same volume stands for it, half as deep as it is wide. A flat face
//! would have an edge that no coarse surface follows.

use std::f64::consts::PI;

use glam::DVec3;

use super::directions::Directions;
use crate::SomaSample;

/// The frusta of linked samples, what fills their bends and what closes their ends.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Cones(Vec<Solid>);

/// A convex body.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Solid {
    Frustum(Frustum),
    Ball {
        center: DVec3,
        radius: f64,
    },
    /// The half of an ellipsoid beyond its greatest disk.
    Cap {
        center: DVec3,
        axis: DVec3,
        radius: f64,
        depth: f64,
    },
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Frustum {
    from: DVec3,
    to: DVec3,
    radii: [f64; 2],
}

/// Whether free ends are half-depth or flat, as where branches go on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ends {
    HalfDepth,
    Flat,
}

/// What is cut off a free end, in its radii: a half ellipsoid of the same volume is half as deep as it is wide.
const CUT: f64 = 1.0 / 3.0;
/// Cosine of the angle up to which faces that meet do not gape.
const STRAIGHT: f64 = 0.9999;
/// Places along the chain that the center is looked for among, at most.
const MAX_CENTERS: usize = 32;
/// Frusta of a soma, at most: longer chains leave out samples.
const MAX_CONES: usize = 512;
/// Directions along an edge of a cube by which centers are compared.
const COMPARED: u32 = 6;
/// A gap along a ray up to this share of the distance is none.
const NO_GAP: f64 = 0.05;
/// Share of directions with a gap up to which cylinders are a star: a dent is no branch. By eye.
const FEW: f64 = 0.03;

impl Cones {
    /// The frusta of samples, and the place within that they are seen from best; none of samples without extent.
    pub(super) fn new(samples: &[SomaSample], ends: Ends) -> Option<(DVec3, Self)> {
        let stride = samples.len().div_ceil(MAX_CONES).max(1);
        let linked = (0..samples.len()).step_by(stride);
        let linked = linked.filter_map(|child| Some([samples[child].parent? as usize, child]));
        let links: Vec<[usize; 2]> = linked.collect();
        let frustum = |link: &[usize; 2]| {
            let [from, to] = link.map(|end| samples[end].position.as_dvec3());
            let radii = link.map(|end| f64::from(samples[end].radius).max(0.0));
            Frustum { from, to, radii }
        };
        let frusta = links.iter().map(frustum).collect();
        let chain = Chain::new(samples.len(), links, frusta);
        let mut solids = chain.balls();
        match ends {
            Ends::HalfDepth => solids.extend(chain.with_caps()),
            Ends::Flat => solids.extend(chain.frusta.into_iter().map(Solid::Frustum)),
        }
        let cones = Self(solids);
        Some((cones.center()?, cones))
    }

    fn frusta(&self) -> impl Iterator<Item = &Frustum> {
        self.0.iter().filter_map(|solid| match solid {
            Solid::Frustum(frustum) => Some(frustum),
            Solid::Ball { .. } | Solid::Cap { .. } => None,
        })
    }

    /// Whether frusta meet at an angle anywhere.
    pub(super) fn has_joints(&self) -> bool {
        self.0
            .iter()
            .any(|solid| matches!(solid, Solid::Ball { .. }))
    }

    /// The middle if all is seen from there, else the place on the chain that sees most.
    fn center(&self) -> Option<DVec3> {
        let (mut sum, mut all) = (DVec3::ZERO, 0.0);
        for (place, volume) in self.frusta().map(Frustum::middle_and_weight) {
            sum += place * volume;
            all += volume;
        }
        let middle = sum / all;
        if !(all > 0.0 && middle.is_finite()) {
            return None;
        }
        let directions = Directions::new(COMPARED);
        if self.holds(middle) && self.gaps(middle, &directions, 0) == 0 {
            return Some(middle);
        }
        let count = self.frusta().count();
        let stride = (2 * count).div_ceil(MAX_CENTERS).max(1);
        let places = self
            .frusta()
            .flat_map(|frustum| [frustum.to, frustum.from.midpoint(frustum.to)]);
        let places = places.step_by(stride).filter(|&place| self.holds(place));
        // Of those that see the same, the nearest to the middle.
        let mut best: Option<(usize, f64, DVec3)> = None;
        for place in places {
            let (most, nearest) = best.map_or((usize::MAX, f64::MAX), |(gaps, far, _)| (gaps, far));
            let gaps = self.gaps(place, &directions, most);
            let far = place.distance_squared(middle);
            if gaps < most || (gaps == most && far < nearest) {
                best = Some((gaps, far, place));
            }
        }
        best.map(|(_, _, place)| place)
    }

    fn holds(&self, place: DVec3) -> bool {
        self.frusta().any(|frustum| {
            let along = frustum.to - frustum.from;
            let t = (place - frustum.from).dot(along) / along.length_squared();
            let t = if t.is_finite() {
                t.clamp(0.0, 1.0)
            } else {
                0.0
            };
            let radius = frustum.radii[0] + t * (frustum.radii[1] - frustum.radii[0]);
            place.distance(frustum.from.lerp(frustum.to, t)) < radius
        })
    }

    /// Distance at which a ray leaves the union for the last time.
    pub(super) fn distance(&self, center: DVec3, direction: DVec3) -> f64 {
        let ends = self.0.iter();
        let ends = ends.filter_map(|solid| solid.crossed(center, direction));
        ends.map(|[_, last]| last).fold(0.0, f64::max)
    }

    /// Whether nearly all of it is seen from the center.
    pub(super) fn is_star(&self, center: DVec3, directions: &Directions) -> bool {
        let few = (FEW * directions.units.len() as f64) as usize;
        self.gaps(center, directions, few) <= few
    }

    /// Number of directions in which something is hidden; where there are more than `most`, one more than that.
    fn gaps(&self, center: DVec3, directions: &Directions, most: usize) -> usize {
        let has_gap = |direction: &&DVec3| {
            let crossed = self.0.iter();
            let crossed = crossed.filter_map(|solid| solid.crossed(center, **direction));
            let mut spans: Vec<[f64; 2]> = crossed.filter(|&[_, last]| last > 0.0).collect();
            let last = spans.iter().map(|span| span[1]).fold(0.0, f64::max);
            // Where faces gape at a bend nothing is hidden.
            let at_faces = self.frusta().flat_map(|frustum| {
                let [a, b] = frustum.radii;
                [(frustum.from, a), (frustum.to, b)]
            });
            spans.extend(at_faces.filter_map(|(place, radius)| {
                let ball = Solid::Ball {
                    center: place,
                    radius,
                };
                ball.crossed(center, **direction)
            }));
            spans.retain(|span| span[0] < last && span[1] > 0.0);
            spans.sort_by(|a, b| a[0].total_cmp(&b[0]));
            let mut reached = 0.0;
            spans.iter().any(|&[first, end]| {
                let gap = first - reached > NO_GAP * last;
                reached = f64::max(reached, end);
                gap
            })
        };
        let hidden = directions.units.iter().filter(has_gap);
        hidden.take(most.saturating_add(1)).count()
    }
}

/// Frusta, and the samples that they link.
struct Chain {
    links: Vec<[usize; 2]>,
    frusta: Vec<Frustum>,
    /// The links at each sample.
    at: Vec<Vec<usize>>,
}

impl Chain {
    fn new(samples: usize, links: Vec<[usize; 2]>, frusta: Vec<Frustum>) -> Self {
        let mut at = vec![Vec::new(); samples];
        for (link, ends) in links.iter().enumerate() {
            ends.iter().for_each(|&end| at[end].push(link));
        }
        Self { links, frusta, at }
    }

    /// Balls where frusta meet at an angle. They touch the steepest side, so that they hardly bulge out of others.
    fn balls(&self) -> Vec<Solid> {
        let way = |link: usize| (self.frusta[link].to - self.frusta[link].from).normalize_or_zero();
        let is_straight = |at: &[usize]| match *at {
            [a, b] => way(a).dot(way(b)).abs() > STRAIGHT,
            _ => at.len() < 2,
        };
        let met = self
            .at
            .iter()
            .enumerate()
            .filter(|(_, at)| !is_straight(at));
        let ball = |(sample, at): (usize, &Vec<usize>)| {
            let cosines = at.iter().map(|&link| self.frusta[link].cosine());
            let end = usize::from(self.links[at[0]][1] == sample);
            let frustum = &self.frusta[at[0]];
            Solid::Ball {
                center: [frustum.from, frustum.to][end],
                radius: frustum.radii[end] * cosines.fold(1.0, f64::min),
            }
        };
        met.map(ball).collect()
    }

    /// The frusta with their free ends cut short, and what closes them. No end loses more than half of the way to the next
    /// fork or end.
    fn with_caps(&self) -> Vec<Solid> {
        let mut kept = vec![[0.0, 1.0]; self.links.len()];
        let mut caps = Vec::new();
        let ends = self.at.iter().enumerate().filter(|(_, at)| at.len() == 1);
        for run in ends.map(|(end, at)| self.run(end, at[0])) {
            let length: f64 = run
                .iter()
                .map(|&(link, _)| self.frusta[link].length())
                .sum();
            let (first, side) = run[0];
            let mut left = (CUT * self.frusta[first].radii[side]).min(0.5 * length);
            let mut volume = 0.0;
            for (link, side) in run {
                let frustum = &self.frusta[link];
                let share = left / frustum.length();
                if share >= 1.0 {
                    volume += frustum.volume();
                    left -= frustum.length();
                    kept[link] = [0.0; 2];
                    continue;
                }
                let place = [share, 1.0 - share][side];
                volume += [frustum.part([0.0, place]), frustum.part([place, 1.0])][side].volume();
                kept[link][side] = place;
                let radius = frustum.part([place; 2]).radii[0];
                let way = frustum.to - frustum.from;
                caps.push(Solid::Cap {
                    center: frustum.from + way * place,
                    axis: way.normalize_or_zero() * [-1.0, 1.0][side],
                    radius,
                    depth: 1.5 * volume / (PI * radius * radius),
                });
                break;
            }
        }
        caps.retain(|cap| matches!(cap, Solid::Cap { depth, .. } if depth.is_finite()));
        let kept = self.frusta.iter().zip(kept);
        let kept = kept.filter(|(_, [from, to])| from < to);
        caps.extend(kept.map(|(frustum, part)| Solid::Frustum(frustum.part(part))));
        caps
    }

    /// The links from a free end to the next fork or end, each with the side that is nearer to the free end.
    fn run(&self, end: usize, first: usize) -> Vec<(usize, usize)> {
        let (mut here, mut link, mut run) = (end, first, Vec::new());
        loop {
            let side = usize::from(self.links[link][1] == here);
            run.push((link, side));
            here = self.links[link][1 - side];
            let &[a, b] = &self.at[here][..] else {
                return run;
            };
            link = if a == link { b } else { a };
        }
    }
}

impl Frustum {
    fn length(&self) -> f64 {
        self.from.distance(self.to)
    }

    fn volume(&self) -> f64 {
        let [a, b] = self.radii;
        PI * self.length() * (a * a + a * b + b * b) / 3.0
    }

    /// Of the angle between its side and its axis.
    fn cosine(&self) -> f64 {
        let length = self.length();
        let slant = length.hypot(self.radii[1] - self.radii[0]);
        if slant > 0.0 { length / slant } else { 1.0 }
    }

    /// Between two shares of its length.
    fn part(&self, shares: [f64; 2]) -> Self {
        let [a, b] = self.radii;
        let [from, to] = shares.map(|share| self.from.lerp(self.to, share));
        let radii = shares.map(|share| a + share * (b - a));
        Self { from, to, radii }
    }

    /// Its center of gravity, and its volume; also of frusta without a length, a little.
    fn middle_and_weight(&self) -> (DVec3, f64) {
        let [a, b] = self.radii;
        let weight = self.volume() + a.max(b).powi(3) * 1e-3;
        let shift = match a * a + a * b + b * b {
            0.0 => 0.5,
            all => (a * a + 2.0 * a * b + 3.0 * b * b) / (4.0 * all),
        };
        (self.from.lerp(self.to, shift), weight)
    }

    /// Where a line enters and leaves it, as ways from `center`.
    fn crossed(&self, center: DVec3, direction: DVec3) -> Option<[f64; 2]> {
        let length = self.length();
        let axis = (self.to - self.from).try_normalize()?;
        let off = center - self.from;
        // With s along the axis and ρ off it, ρ = a + slope s on the side.
        let (s0, s1) = (off.dot(axis), direction.dot(axis));
        let slope = (self.radii[1] - self.radii[0]) / length;
        let wide = self.radii[0] + slope * s0;
        let (a, b, c) = (
            1.0 - s1 * s1 - slope * slope * s1 * s1,
            off.dot(direction) - s0 * s1 - wide * slope * s1,
            off.length_squared() - s0 * s0 - wide * wide,
        );
        let mut span: Option<[f64; 2]> = None;
        let mut add = |t: f64| {
            span = Some(span.map_or([t; 2], |[first, last]| [first.min(t), last.max(t)]));
        };
        for t in roots(a, b, c).into_iter().flatten() {
            let s = s0 + t * s1;
            if (0.0..=length).contains(&s) {
                add(t);
            }
        }
        for (s, radius) in [0.0, length].into_iter().zip(self.radii) {
            let t = (s - s0) / s1;
            if t.is_finite() && (off + direction * t - axis * s).length() <= radius {
                add(t);
            }
        }
        span
    }
}

impl Solid {
    /// Where a line enters and leaves it, as ways from `center`.
    fn crossed(&self, center: DVec3, direction: DVec3) -> Option<[f64; 2]> {
        match *self {
            Self::Frustum(frustum) => frustum.crossed(center, direction),
            Self::Ball {
                center: ball,
                radius,
            } => {
                let off = center - ball;
                let c = off.length_squared() - radius * radius;
                let [first, last] = roots(1.0, off.dot(direction), c);
                Some([first?, last?])
            }
            Self::Cap {
                center: base,
                axis,
                radius,
                depth,
            } => {
                // Where the ellipsoid is a unit ball; what lies on this side of the base is cut away.
                let to_ball = |place: DVec3| {
                    let along = place.dot(axis);
                    (place - axis * along) / radius + axis * (along / depth)
                };
                let (off, way) = (to_ball(center - base), to_ball(direction));
                let (c, squared) = (off.length_squared() - 1.0, way.length_squared());
                let [first, last] = roots(squared, off.dot(way), c);
                let (first, last) = (first?, last?);
                let [height, climb] = [off.dot(axis), way.dot(axis)];
                let at_base = -height / climb;
                let [low, high] = match climb {
                    climb if climb > 0.0 => [first.max(at_base), last],
                    climb if climb < 0.0 => [first, last.min(at_base)],
                    _ if height >= 0.0 => [first, last],
                    _ => return None,
                };
                (low <= high).then_some([low, high])
            }
        }
    }
}

/// The roots of a t² + 2 b t + c, the lesser one first where a > 0.
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
