//! The offset that keeps far-away coordinates precise in `f32`.
//!
//! `f32` resolves 0.0005 µm at 4096 µm and 0.004 µm at 52,000 µm (a connectome in voxels). Beyond
//! 4096 all positions are therefore stored relative to whole micrometers near the main soma's
//! first sample.
//!
//! Writing and reading back must find the same origin, although the decimals are then a little
//! different. So every decision is made on numbers as `f32` has them: the limit, and the anchor's
//! offset, which is in [-0.5, 0.5) after rounding.

use glam::{DVec3, Vec3};

use super::Node;
use crate::Morphology;

/// Greatest coordinate (µm) that is stored as it is.
const LIMIT: f32 = Morphology::FARTHEST_UNSHIFTED;

/// Where positions are counted from.
pub(super) struct Frame {
    pub(super) origin: DVec3,
    /// Something lies beyond the limit by less than the shifted grid can tell.
    at_limit: bool,
}

impl Frame {
    pub(super) fn choose(nodes: &[Node], anchor: Option<DVec3>) -> Self {
        let zero = Self {
            origin: DVec3::ZERO,
            at_limit: false,
        };
        let far = |frame: &Self, node: &Node| {
            let stored = frame.origin + frame.relative(node.position).as_dvec3();
            stored.as_vec3().abs().max_element() > LIMIT
        };
        let Some(anchor) = anchor else { return zero };
        if !nodes
            .iter()
            .any(|node| node.position.as_vec3().abs().max_element() > LIMIT)
        {
            return zero;
        }
        let origin = DVec3::from_array(anchor.to_array().map(whole));
        let shifted = Self {
            origin,
            at_limit: false,
        };
        if nodes.iter().any(|node| far(&shifted, node)) {
            shifted
        } else {
            Self {
                at_limit: true,
                ..zero
            }
        }
    }

    /// Position relative to the origin.
    ///
    /// Coordinates that are a rounding error beyond the limit become the limit where the shifted
    /// grid is as coarse as that error: then the origin stays zero when the cell is read again.
    pub(super) fn place(&self, position: DVec3) -> Vec3 {
        let relative = self.relative(position);
        if self.at_limit {
            relative.clamp(Vec3::splat(-LIMIT), Vec3::splat(LIMIT))
        } else {
            relative
        }
    }

    fn relative(&self, position: DVec3) -> Vec3 {
        let [x, y, z] = std::array::from_fn(|axis| offset(position[axis], self.origin[axis]));
        Vec3::new(x, y, z)
    }
}

/// The difference as `f32`, no more than what is read back: rounding at 1e37 µm may go beyond.
fn offset(position: f64, origin: f64) -> f32 {
    let mut offset = (position - origin) as f32;
    while (origin + f64::from(offset)).abs() > Morphology::MAX_COORDINATE && origin != 0.0 {
        offset = if offset > 0.0 {
            offset.next_down()
        } else {
            offset.next_up()
        };
    }
    offset
}

/// The nearest whole number, so that the `f32` of the rest is less than a half.
fn whole(x: f64) -> f64 {
    let nearest = (x + 0.5).floor();
    if (x - nearest) as f32 >= 0.5 {
        nearest + 1.0
    } else {
        nearest
    }
}
