//! The placement of a neuron in a session's file.

use glam::{DQuat, DVec3};
use neurotess::render::Placement;
use serde::{Deserialize, Serialize};

/// Rotation, scale and position in a session's file.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct PlacementEntry {
    pub(crate) rotation: [f64; 4],
    pub(crate) scale: f64,
    pub(crate) translation: [f64; 3],
}

impl From<Placement> for PlacementEntry {
    fn from(p: Placement) -> Self {
        Self {
            rotation: p.rotation.to_array(),
            scale: p.scale,
            translation: p.translation.to_array(),
        }
    }
}

impl From<PlacementEntry> for Placement {
    fn from(p: PlacementEntry) -> Self {
        let rotation = DQuat::from_array(p.rotation);
        Self {
            // One that is a rotation already comes back to the last bit.
            rotation: if (rotation.length_squared() - 1.0).abs() < 1e-12 {
                rotation
            } else if rotation.is_finite() && rotation.length() > 1e-6 {
                rotation.normalize()
            } else {
                DQuat::IDENTITY
            },
            scale: if p.scale.is_finite() && p.scale > 0.0 {
                p.scale
            } else {
                1.0
            },
            translation: DVec3::from_array(
                p.translation.map(|c| if c.is_finite() { c } else { 0.0 }),
            ),
        }
    }
}
