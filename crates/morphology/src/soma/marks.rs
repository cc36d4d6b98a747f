//! Samples of a soma that have no radius of their own: places on its outline or surface, as NeuroMorphoVis writes them
//! beside the sample of the soma's middle. They are no balls.

use glam::DVec3;

use super::CONTOUR_BULGE;
use crate::SomaSample;

/// Least number of samples that share a radius which says nothing, and that go around anything.
pub(crate) const FEWEST_MARKS: usize = 4;
/// A shared radius is none of their own where it is below this share of the samples' distance from the middle. By eye: what
/// exporters write is 1 µm or nothing, and somata have 3 µm and more.
pub(crate) const THIN: f64 = 0.35;
/// Farthest from the middle in mean distances, and nearest: 1 ± this. A branch that was traced leads outwards.
const UNEVEN: f64 = 0.6;
/// Samples with the radius of the middle are on its ball where they are so near to it, in radii.
const ON_BALL: f64 = 0.25;
/// Length of the mean direction from the middle beyond which samples are to one side of it.
const ONE_SIDED: f64 = 0.5;
/// Widest gap between the directions of an outline's neighbors, radians.
const WIDEST_GAP: f64 = 2.1;
/// Samples that a plane is looked for among, at most.
const MAX_COMPARED: usize = 48;

/// What samples without a radius of their own tell of their soma.
pub(super) enum Marks {
    /// Its outline.
    Outline(Vec<DVec3>),
    /// The sphere of places all around.
    Surface(DVec3, f64),
    /// Nothing: the sample that has a radius is the soma.
    LeftOut(usize),
}

impl Marks {
    /// What the samples tell beside the thickest of them, if nothing but that has a radius of its own.
    pub(super) fn of(samples: &[SomaSample], positions: &[DVec3]) -> Option<Self> {
        let middle = (0..samples.len()).max_by(|&a, &b| {
            samples[a]
                .radius
                .total_cmp(&samples[b].radius)
                .then(b.cmp(&a))
        })?;
        let own = f64::from(samples[middle].radius);
        let marks: Vec<usize> = (0..samples.len()).filter(|&i| i != middle).collect();
        let first = f64::from(samples[*marks.first()?].radius).max(0.0);
        let same = |i: &usize| f64::from(samples[*i].radius).max(0.0) == first;
        if own <= 0.0 || !marks.iter().all(same) {
            return None;
        }
        let center = positions[middle];
        let offsets: Vec<DVec3> = marks.iter().map(|&i| positions[i] - center).collect();
        let count = offsets.len() as f64;
        let distance = offsets.iter().map(|off| off.length()).sum::<f64>() / count;
        let all_within = |low: f64, high: f64| {
            let mut lengths = offsets.iter().map(|off| off.length());
            lengths.all(|length| (low..=high).contains(&length))
        };
        let is_star = || {
            marks
                .iter()
                .all(|&i| samples[i].parent == Some(middle as u32))
        };
        let is_none = match first {
            0.0 => true,
            _ if marks.len() < FEWEST_MARKS => false,
            _ if first == own => {
                is_star() && all_within((1.0 - ON_BALL) * own, (1.0 + ON_BALL) * own)
            }
            _ => {
                first < THIN * distance
                    && all_within((1.0 - UNEVEN) * distance, (1.0 + UNEVEN) * distance)
            }
        };
        if !is_none {
            return None;
        }
        if marks.len() < FEWEST_MARKS || distance <= 0.0 {
            return Some(Self::LeftOut(middle));
        }
        if let Some(order) = around(&offsets, distance) {
            return Some(Self::Outline(
                order.into_iter().map(|i| center + offsets[i]).collect(),
            ));
        }
        let directions = offsets.iter().map(|off| off.normalize_or_zero());
        let mean = directions.sum::<DVec3>() / count;
        match mean.length() < ONE_SIDED
            && normal(&offsets).is_some_and(|n| !is_flat(&offsets, n, distance))
        {
            true => Some(Self::Surface(center, distance)),
            false => Some(Self::LeftOut(middle)),
        }
    }
}

/// Samples in a plane that go around the middle, in the order in which they do.
fn around(offsets: &[DVec3], distance: f64) -> Option<Vec<usize>> {
    let normal = normal(offsets)?;
    if !is_flat(offsets, normal, distance) {
        return None;
    }
    let (x, y) = normal.any_orthonormal_pair();
    let angle = |i: usize| offsets[i].dot(y).atan2(offsets[i].dot(x));
    let mut order: Vec<usize> = (0..offsets.len()).collect();
    order.sort_by(|&a, &b| angle(a).total_cmp(&angle(b)));
    let next = order.iter().cycle().skip(1);
    let gaps = order.iter().zip(next).map(|(&a, &b)| {
        let gap = angle(b) - angle(a);
        if gap < 0.0 {
            gap + std::f64::consts::TAU
        } else {
            gap
        }
    });
    (gaps.fold(0.0, f64::max) < WIDEST_GAP).then_some(order)
}

fn is_flat(offsets: &[DVec3], normal: DVec3, distance: f64) -> bool {
    let off = offsets.iter().map(|off| off.dot(normal).abs());
    off.fold(0.0, f64::max) < CONTOUR_BULGE * distance
}

/// Normal of the plane through the middle and the two samples that span the largest triangle with it.
fn normal(offsets: &[DVec3]) -> Option<DVec3> {
    let stride = offsets.len().div_ceil(MAX_COMPARED).max(1);
    let some = || offsets.iter().step_by(stride);
    let pairs = some().flat_map(|a| some().map(move |b| a.cross(*b)));
    let largest = pairs.max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()))?;
    largest.try_normalize()
}
