//! The body of outlines in several planes: the loft through all of them, with round caps.
//!
//! Each outline is a height along the common normal, a centroid, and distances from it at equal angles. Between two,
//! all three are linear in the height. Beyond the first and last the outline shrinks as a half-ellipse does, as high as half
//! the distance to the next outline, or as its own radius of equal area if that is less.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use super::outline::{Moments, farthest};

/// Angles at which an outline's distances are known.
const ANGLES: usize = 64;
/// Outlines of a stack, at most: of more, every other is left out, and so on.
const MAX_OUTLINES: usize = 128;
/// Outlines nearer than this share of the stack's height are in one plane; the larger is kept.
const ONE_PLANE: f64 = 1e-3;
/// Steps along a ray from outside until it is within.
const STEPS: u32 = 48;
/// Halvings that follow.
const HALVINGS: u32 = 24;

/// Outlines, the lowest first.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Stack {
    axes: [DVec3; 3],
    layers: Vec<Layer>,
    /// Height of the caps below and above.
    caps: [f64; 2],
    /// A distance from the center beyond all of it.
    beyond: f64,
}

#[derive(Clone, Debug, PartialEq)]
struct Layer {
    height: f64,
    middle: DVec2,
    distances: [f64; ANGLES],
    /// Radius of equal area.
    radius: f64,
}

impl Stack {
    /// The body of outlines and its center; none if fewer than two of them go around something in planes apart.
    pub(super) fn new(outlines: &[Vec<DVec3>]) -> Option<(DVec3, Self)> {
        let normal = common_normal(outlines)?;
        let (e1, e2) = normal.any_orthonormal_pair();
        let stride = outlines.len().div_ceil(MAX_OUTLINES).max(1);
        let layer = |outline: &Vec<DVec3>| Layer::new(outline, [e1, e2, normal]);
        let mut layers: Vec<Layer> = outlines.iter().step_by(stride).filter_map(layer).collect();
        layers.sort_by(|a, b| a.height.total_cmp(&b.height));
        let height = layers.last()?.height - layers.first()?.height;
        layers.dedup_by(|upper, lower| {
            let same = upper.height - lower.height <= ONE_PLANE * height;
            if same && upper.radius > lower.radius {
                std::mem::swap(upper, lower);
            }
            same
        });
        let [first, .., last] = &layers[..] else {
            return None;
        };
        let gap = |a: usize, b: usize| 0.5 * (layers[b].height - layers[a].height);
        let caps = [
            gap(0, 1).min(first.radius),
            gap(layers.len() - 2, layers.len() - 1).min(last.radius),
        ];
        let mut stack = Self {
            axes: [e1, e2, normal],
            caps,
            beyond: 0.0,
            layers,
        };
        let center = stack.center();
        for layer in &mut stack.layers {
            layer.height -= center.z;
            layer.middle -= center.truncate();
        }
        let reach = |layer: &Layer| {
            let widest = layer.distances.iter().copied().fold(0.0, f64::max);
            layer.middle.length() + widest + layer.height.abs()
        };
        let reaches = stack.layers.iter().map(reach);
        stack.beyond = reaches.fold(0.0, f64::max) + stack.caps[0] + stack.caps[1];
        Some((e1 * center.x + e2 * center.y + normal * center.z, stack))
    }

    /// The centroid of the stack, moved into the middle of the outlines at its height.
    fn center(&self) -> DVec3 {
        let (mut sum, mut all) = (0.0, 0.0);
        for pair in self.layers.windows(2) {
            let thickness = pair[1].height - pair[0].height;
            let [a, b] = [&pair[0], &pair[1]].map(|layer| layer.radius);
            let volume = thickness * (a * a + a * b + b * b);
            let shift = (a * a + 2.0 * a * b + 3.0 * b * b) / (4.0 * (a * a + a * b + b * b));
            sum += volume * (pair[0].height + shift * thickness);
            all += volume;
        }
        let height = sum / all;
        let (below, share) = self.between(height);
        let [a, b] = [below, below + 1].map(|layer| self.layers[layer].middle);
        a.lerp(b, share).extend(height)
    }

    /// The layer below a height within the stack, and the share of the way to the next.
    fn between(&self, height: f64) -> (usize, f64) {
        let above = self.layers.partition_point(|layer| layer.height < height);
        let below = above.saturating_sub(1).min(self.layers.len() - 2);
        let [a, b] = [below, below + 1].map(|layer| self.layers[layer].height);
        (below, ((height - a) / (b - a)).clamp(0.0, 1.0))
    }

    /// Distance of the surface from the center.
    pub(super) fn distance(&self, direction: DVec3) -> f64 {
        let ray = DVec3::from_array(self.axes.map(|axis| direction.dot(axis)));
        let step = self.beyond / f64::from(STEPS);
        let within = (0..STEPS).rev().map(|i| step * f64::from(i));
        let Some(mut inside) = within.clone().find(|&t| self.holds(ray * t)) else {
            return 0.0;
        };
        let mut outside = inside + step;
        for _ in 0..HALVINGS {
            let middle = 0.5 * (inside + outside);
            match self.holds(ray * middle) {
                true => inside = middle,
                false => outside = middle,
            }
        }
        inside
    }

    fn holds(&self, place: DVec3) -> bool {
        let (first, last) = (&self.layers[0], &self.layers[self.layers.len() - 1]);
        let (low, high) = (first.height - place.z, place.z - last.height);
        let (over, cap) = match low > high {
            true => (low, self.caps[0]),
            false => (high, self.caps[1]),
        };
        if over > cap {
            return false;
        }
        let rounded = (1.0 - (over.max(0.0) / cap.max(f64::MIN_POSITIVE)).powi(2))
            .max(0.0)
            .sqrt();
        let (below, share) = self.between(place.z);
        let [a, b] = [&self.layers[below], &self.layers[below + 1]];
        let off = place.truncate() - a.middle.lerp(b.middle, share);
        let turns = f64::atan2(off.y, off.x).rem_euclid(TAU) / TAU * ANGLES as f64;
        let (index, part) = (turns as usize % ANGLES, turns.fract());
        let at = |layer: &Layer| {
            let [here, next] = [index, (index + 1) % ANGLES].map(|i| layer.distances[i]);
            here + part * (next - here)
        };
        let edge = at(a) + share * (at(b) - at(a));
        off.length() <= edge * rounded
    }
}

impl Layer {
    fn new(outline: &[DVec3], axes: [DVec3; 3]) -> Option<Self> {
        let flat = |p: &DVec3| DVec2::new(p.dot(axes[0]), p.dot(axes[1]));
        let corners: Vec<DVec2> = outline.iter().map(flat).collect();
        // About a corner: far from the origin the moments of a small polygon cancel.
        let near = *corners.first()?;
        let corners: Vec<DVec2> = corners.into_iter().map(|corner| corner - near).collect();
        let moments = Moments::of(&corners)?;
        let about: Vec<DVec2> = corners
            .iter()
            .map(|&corner| corner - moments.centroid)
            .collect();
        let distance = |i: usize| {
            let (sin, cos) = (TAU * i as f64 / ANGLES as f64).sin_cos();
            farthest(&about, DVec2::new(cos, sin))
        };
        Some(Self {
            height: outline.iter().map(|p| p.dot(axes[2])).sum::<f64>() / outline.len() as f64,
            middle: near + moments.centroid,
            distances: std::array::from_fn(distance),
            radius: (moments.area / PI).sqrt(),
        })
    }
}

/// The unit sum of the outlines' vector areas, whichever way around each was traced.
fn common_normal(outlines: &[Vec<DVec3>]) -> Option<DVec3> {
    let area = |outline: &Vec<DVec3>| -> DVec3 {
        let first = outline.first().copied().unwrap_or_default();
        let corners = outline.iter().zip(outline.iter().skip(1));
        corners.map(|(&a, &b)| (a - first).cross(b - first)).sum()
    };
    let areas: Vec<DVec3> = outlines.iter().map(area).collect();
    let longest = areas
        .iter()
        .copied()
        .reduce(|a, b| if b.length() > a.length() { b } else { a })?;
    let turned = areas
        .iter()
        .map(|&area| if area.dot(longest) < 0.0 { -area } else { area });
    turned.sum::<DVec3>().try_normalize()
}
