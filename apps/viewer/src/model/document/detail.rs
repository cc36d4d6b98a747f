//! How finely surfaces are drawn.

use neurotess::refine::LodCriterion;
use serde::{Deserialize, Serialize};

/// How finely surfaces are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Detail {
    /// By what.
    pub criterion: LodKind,
    /// Error (pixels).
    pub error: f32,
    /// Length of an edge's piece (pixels).
    pub size: f32,
    /// Level.
    pub level: u32,
    /// Distance (µm) from which on the level is 1.
    pub far: f32,
    /// What is smaller (pixels) is left out.
    pub smallest: f32,
}

/// By what the level is chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum LodKind {
    /// Error in pixels.
    #[default]
    Error,
    /// Size in pixels.
    Size,
    /// The same everywhere.
    Homogeneous,
    /// By the distance from the eye.
    Distance,
}

impl Default for Detail {
    fn default() -> Self {
        Self {
            criterion: LodKind::Error,
            error: 0.5,
            size: 8.0,
            level: 4,
            far: 500.0,
            smallest: 0.0,
        }
    }
}

impl Detail {
    pub(crate) fn lod(&self) -> LodCriterion {
        match self.criterion {
            LodKind::Error => LodCriterion::PixelError(self.error.max(0.01)),
            LodKind::Size => LodCriterion::PixelSize(self.size.max(0.5)),
            LodKind::Homogeneous => LodCriterion::Homogeneous(self.level.clamp(1, 64)),
            LodKind::Distance => LodCriterion::Distance {
                level: self.level.clamp(1, 64),
                far: self.far.max(1e-3),
            },
        }
    }
}
