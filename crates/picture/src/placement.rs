//! Where an instance is.

use glam::{DMat3, DQuat, DVec3};

/// Where an instance is: `world = translation + scale · rotation · cell`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Unit quaternion.
    pub rotation: DQuat,
    /// Scale, the same in all directions; positive.
    pub scale: f64,
    /// Translation (µm).
    pub translation: DVec3,
}

impl Default for Placement {
    fn default() -> Self {
        Self {
            rotation: DQuat::IDENTITY,
            scale: 1.0,
            translation: DVec3::ZERO,
        }
    }
}

impl Placement {
    /// Rotation and scale as a matrix.
    pub fn linear(&self) -> DMat3 {
        DMat3::from_quat(self.rotation) * self.scale
    }

    /// A point of the cell in the world (µm).
    pub fn world_from_cell(&self, p: DVec3) -> DVec3 {
        self.translation + self.rotation * p * self.scale
    }

    /// A point of the world in the cell (µm).
    pub fn cell_from_world(&self, p: DVec3) -> DVec3 {
        self.rotation.inverse() * (p - self.translation) / self.scale
    }
}
