//! How the sphere turns: its insertion quads onto their neurites, and the rest with them.

use glam::{DMat3, DVec3};

use super::insertion_quads::{Insertion, InsertionQuads};
use super::sphere::Sphere;
use super::warp::{self, Warp};

/// Rotation and warp together.
pub(super) struct Flow {
    rotation: DMat3,
    warp: Option<Warp>,
    /// Unit directions of each ring's corners from the soma's center.
    pub(super) rings: Vec<[DVec3; 4]>,
}

/// Steps of the flow: more changes the result by less than a hundredth of a quad.
const FLOW_STEPS: usize = 6;

impl Flow {
    pub(super) fn new(
        sphere: &Sphere,
        insertion_quads: &InsertionQuads,
        insertions: &[Insertion],
    ) -> Self {
        let (mut from, mut to, mut rings) = (Vec::new(), Vec::new(), Vec::new());
        for (&quad, insertion) in insertion_quads.quads.iter().zip(insertions) {
            let corners = sphere.quads[quad].map(|v| sphere.nodes[v as usize]);
            let corners = warp::rotate(insertion_quads.rotation, corners);
            let goals = warp::ring_directions(insertion.direction, insertion.angle(), corners);
            from.extend(corners);
            to.extend(match insertion.inset {
                true => warp::ring_directions(insertion.direction, insertion.quad_angle(), corners),
                false => goals,
            });
            rings.push(goals);
        }
        let width = 2.5 * (4.0 * std::f64::consts::PI / sphere.quads.len() as f64).sqrt();
        let warp = Warp::new(&from, &to, width, FLOW_STEPS);
        Self {
            rotation: insertion_quads.rotation,
            warp,
            rings,
        }
    }

    /// Where a point of the unit sphere goes.
    pub(super) fn apply(&self, point: DVec3) -> DVec3 {
        let point = self.rotation * point;
        match (&self.warp, point.try_normalize()) {
            (Some(warp), Some(direction)) => warp.apply(direction) * point.length(),
            _ => point,
        }
    }
}
