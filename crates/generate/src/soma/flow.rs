//! How the sphere turns: its insertion quads onto their neurites, and the rest with them.

use glam::{DMat3, DVec3};

use super::insertion_quads::{Insertion, InsertionQuads};
use super::sphere::Sphere;
use super::warp::{self, Warp};
use crate::tracing::SomaSphere;

/// A linear map of directions that makes them denser where the traced surface is far from the center.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stretch {
    map: DMat3,
    back: DMat3,
}

impl Stretch {
    /// That of a soma.
    pub(super) fn of(soma: &SomaSphere) -> Self {
        let map = soma.shape().stretch();
        let back = map.inverse();
        match back.is_finite() {
            true => Self { map, back },
            false => Self {
                map: DMat3::IDENTITY,
                back: DMat3::IDENTITY,
            },
        }
    }

    fn apply(&self, direction: DVec3) -> DVec3 {
        (self.map * direction).try_normalize().unwrap_or(direction)
    }

    /// The direction that is mapped to this one.
    pub(super) fn undo(&self, direction: DVec3) -> DVec3 {
        (self.back * direction).try_normalize().unwrap_or(direction)
    }
}

/// Rotation, warp and stretch together.
pub(super) struct Flow {
    rotation: DMat3,
    warp: Option<Warp>,
    stretch: Stretch,
    /// Each ring's corners, relative to the soma's center.
    pub(super) rings: Vec<[DVec3; 4]>,
}

/// Steps of the flow: more changes the result by less than a hundredth of a quad.
const FLOW_STEPS: usize = 6;

impl Flow {
    pub(super) fn new(
        sphere: &Sphere,
        insertion_quads: &InsertionQuads,
        insertions: &[Insertion],
        stretch: &Stretch,
    ) -> Self {
        let (mut from, mut to, mut rings) = (Vec::new(), Vec::new(), Vec::new());
        for (&quad, insertion) in insertion_quads.quads.iter().zip(insertions) {
            let corners = sphere.quads[quad].map(|v| sphere.nodes[v as usize]);
            let corners = warp::rotate(insertion_quads.rotation, corners);
            from.extend(corners);
            let corners = corners.map(|corner| stretch.apply(corner));
            let (center, radius) = (insertion.center(), insertion.radius);
            let ring = warp::across(insertion.axis, corners).map(|out| center + out * radius);
            let quad = match insertion.inset {
                true => warp::ring_directions(insertion.foot, insertion.quad_angle(), corners),
                false => ring.map(DVec3::normalize_or_zero),
            };
            to.extend(quad.map(|goal| stretch.undo(goal)));
            rings.push(ring);
        }
        let width = 2.0 * (4.0 * std::f64::consts::PI / sphere.quads.len() as f64).sqrt();
        let warp = Warp::new(&from, &to, width, FLOW_STEPS);
        Self {
            rotation: insertion_quads.rotation,
            warp,
            stretch: *stretch,
            rings,
        }
    }

    /// Where a point of the unit sphere goes.
    pub(super) fn apply(&self, point: DVec3) -> DVec3 {
        let point = self.rotation * point;
        let Some(direction) = point.try_normalize() else {
            return point;
        };
        let warped = match &self.warp {
            Some(warp) => warp.apply(direction),
            None => direction,
        };
        self.stretch.apply(warped) * point.length()
    }
}
