//! The inner quad of an inset: a ring of the branch's size, lifted off its trunk.

use std::f64::consts::FRAC_1_SQRT_2;

use glam::DVec3;

use super::cone::{RoundCone, distance, outwards};
use crate::soma::collar;

/// Steepest that a branch leaves its trunk, by the cosine of the angle to the trunk's normal: 60°.
pub(super) const MIN_STEEP: f64 = 0.5;
/// A corner lies at most this far from the others' mean along the branch, in radii of the branch. Without it 16 % more pairs
/// cross at forks of the tests that fork again at once.
const MAX_SHEAR: f64 = 2.2;
/// Least part of a vector across a direction that is more than rounding: the step of 32 bits, which tracings are kept in.
/// A guard.
const LEAST_ACROSS: f64 = 1e-7;
/// Places along a branch where it is looked whether its trunk comes near it again.
const TOP_STEPS: u32 = 8;

/// The ring that a branch begins with.
#[derive(Clone, Copy, Debug)]
pub(crate) struct InsetShape {
    pub(crate) center: DVec3,
    /// Counter-clockwise about the direction: behind, on the left and right, then ahead.
    pub(crate) corners: [DVec3; 4],
    /// Unit directions of the corners across the branch.
    pub(crate) radials: [DVec3; 4],
    pub(crate) direction: DVec3,
    /// Length (µm) over which the lofts run along the direction.
    pub(crate) collar: f64,
    /// How far (µm) the corners reach along the direction from the center.
    pub(crate) reach: f64,
}

/// What a ring is made of.
#[derive(Clone, Copy, Debug)]
pub(crate) struct InsetSite {
    /// Where the branch's axis leaves the trunk, and its unit direction there.
    pub(crate) exit: DVec3,
    pub(crate) direction: DVec3,
    pub(crate) radius: f64,
    /// Height of the corners over the trunk, in radii of the branch.
    pub(crate) lift: f64,
    /// Unit direction of the trunk's path.
    pub(crate) along: DVec3,
}

impl InsetSite {
    /// Places the ring over the trunk's cones: each corner on its line along the branch, where the
    /// distance from the trunk is `lift` radii.
    pub(crate) fn shape(&self, trunk: &[RoundCone]) -> InsetShape {
        let normal = outwards(trunk, self.exit, self.radius);
        let ahead = unit_across(self.along, self.direction)
            .unwrap_or_else(|| self.direction.any_orthonormal_vector());
        let left = ahead.cross(self.direction) * -1.0;
        let left = if left.dot(self.along.cross(normal)) < 0.0 {
            -left
        } else {
            left
        };
        let radials = [-ahead - left, -ahead + left, ahead + left, ahead - left]
            .map(|side| side * FRAC_1_SQRT_2);
        let height = self.lift * self.radius;
        let top = self.top(trunk, height);
        let heights = radials.map(|side| self.height(trunk, side * self.radius, height, top));
        let mean = heights.iter().sum::<f64>() / 4.0;
        let most = MAX_SHEAR * self.radius;
        let corners = [0, 1, 2, 3].map(|k| {
            let up = heights[k].clamp(mean - most, mean + most);
            self.exit + radials[k] * self.radius + self.direction * up
        });
        let center = corners.iter().sum::<DVec3>() / 4.0;
        let reaches = corners.map(|p| (p - center).dot(self.direction));
        let steep = self.direction.dot(normal).max(MIN_STEEP);
        InsetShape {
            center,
            corners,
            radials,
            direction: self.direction,
            collar: collar(height, self.radius) / steep,
            reach: reaches.into_iter().fold(0.0, f64::max),
        }
    }

    /// Way along the branch from the exit's plane to where it is well clear of the trunk, and not yet near another
    /// part of it that bends back over the branch.
    fn top(&self, trunk: &[RoundCone], height: f64) -> f64 {
        let most = 4.0 * self.radius + 2.0 * height;
        let (mut before, mut farthest, mut top) = (0.0, 0.0, most);
        for step in 1..=TOP_STEPS {
            let up = most * f64::from(step) / f64::from(TOP_STEPS);
            let away = distance(trunk, self.exit + self.direction * up);
            if away < before && away < self.radius + height {
                return top;
            }
            if away > farthest {
                (farthest, top) = (away, up);
            }
            before = away;
        }
        most
    }

    /// Way along the branch from the exit's plane to where a line beside the axis is this high over the
    /// trunk: from this far along the branch down, by sphere tracing, and once that is near by secants.
    fn height(&self, trunk: &[RoundCone], beside: DVec3, height: f64, top: f64) -> f64 {
        let mut up = top;
        // Of the last place: how far up it was, and how high.
        let mut last = (f64::INFINITY, f64::INFINITY);
        for _ in 0..80 {
            let above = distance(trunk, self.exit + beside + self.direction * up) - height;
            if above.abs() < 1e-6 * self.radius {
                break;
            }
            let slope = (last.1 - above) / (last.0 - up);
            last = (up, above);
            // The slope of a distance is at most 1.
            up -= match above.abs() < 0.5 * self.radius && slope > 0.1 {
                true => above / slope.min(1.0),
                false => above,
            };
            if up < -3.0 * self.radius {
                break;
            }
        }
        up
    }
}

/// Cosine of a turn (150°) beyond which a path turns back: both legs are one tube there, without a crease between them. With
/// creases up to 180° narrow bends are 4 % thinner inside.
pub(super) const TURNED_BACK: f64 = -0.866;
/// Length of the sum of two unit directions below which they are opposite, as at turns by 174°: the sum tells no direction.
/// A guard.
const OPPOSITE: f64 = 0.1;

/// Whether directions whose sum this is go straight back.
pub(super) fn is_straight_back(sum: DVec3) -> bool {
    sum.length() <= OPPOSITE
}

/// The part of a vector across a unit direction, as a unit vector. None if that is but rounding: then it would be any
/// vector, even along the direction.
pub(crate) fn unit_across(vector: DVec3, direction: DVec3) -> Option<DVec3> {
    let across = vector - direction * vector.dot(direction);
    let is_some = across.length_squared() > LEAST_ACROSS * LEAST_ACROSS * vector.length_squared();
    across.try_normalize().filter(|_| is_some)
}

/// A direction turned up to [`MIN_STEEP`] from the surface's normal.
pub(crate) fn not_too_steep(direction: DVec3, normal: DVec3) -> DVec3 {
    let up = direction.dot(normal);
    if up >= MIN_STEEP {
        return direction;
    }
    let flat = unit_across(direction, normal).unwrap_or_else(|| normal.any_orthonormal_vector());
    normal * MIN_STEEP + flat * (1.0 - MIN_STEEP * MIN_STEEP).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ring_stands_over_its_trunk() {
        let ends = [-20.0, 20.0].map(|x| DVec3::new(x, 0.0, 0.0));
        let trunk = [RoundCone::new(ends, [1.0; 2])];
        for slant in [0.0_f64, 0.5, -0.8] {
            let site = InsetSite {
                exit: DVec3::new(0.0, 1.0, 0.0),
                direction: DVec3::new(slant, 1.0, 0.0).normalize_or(DVec3::Y),
                radius: 0.4,
                lift: 0.4,
                along: DVec3::X,
            };
            let shape = site.shape(&trunk);
            for corner in shape.corners {
                assert!((distance(&trunk, corner) - 0.16).abs() < 1e-5);
            }
            // Counter-clockwise about the direction.
            let [a, b, _, d] = shape.corners;
            assert!((b - a).cross(d - a).dot(site.direction) > 0.0);
            // The first two corners are those behind.
            assert!((a.x + b.x) < (shape.corners[2].x + d.x));
        }
    }

    /// Fault C6, `f1_fork_folds_back.swc`: a branch that goes on along its trunk has a ring across it.
    #[test]
    fn ring_along_its_trunk_has_its_radius() {
        let ends = [-20.0, 20.0].map(|x| DVec3::new(x, 0.0, 0.0));
        let trunk = [RoundCone::new(ends, [0.165; 2])];
        for direction in [
            DVec3::NEG_X * (1.0 - f64::EPSILON),
            DVec3::new(1.0, 1e-16, 0.0),
        ] {
            let site = InsetSite {
                exit: DVec3::new(-0.165, 0.0, 0.0),
                direction,
                radius: 0.165,
                lift: 0.4,
                along: DVec3::X,
            };
            let shape = site.shape(&trunk);
            let [a, b, c, d] = shape.radials;
            assert!(a.dot(c) < -0.99 && b.dot(d) < -0.99 && a.dot(b).abs() < 0.01);
            assert!(
                shape
                    .radials
                    .iter()
                    .all(|side| side.dot(direction).abs() < 1e-6)
            );
        }
    }

    #[test]
    fn ring_stands_below_what_bends_back_over_it() {
        let along = [-20.0, 20.0].map(|x| DVec3::new(x, 0.0, 0.0));
        let over = [-20.0, 20.0].map(|z| DVec3::new(0.0, 3.2, z));
        let trunk = [
            RoundCone::new(along, [1.0; 2]),
            RoundCone::new(over, [0.8; 2]),
        ];
        let site = InsetSite {
            exit: DVec3::new(0.0, 1.0, 0.0),
            direction: DVec3::Y,
            radius: 0.4,
            lift: 0.4,
            along: DVec3::X,
        };
        for corner in site.shape(&trunk).corners {
            assert!(
                (distance(&trunk[..1], corner) - 0.16).abs() < 1e-5,
                "{corner}"
            );
        }
    }
}
