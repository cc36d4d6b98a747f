//! How finely surfaces are drawn.

use neurotess::refine::LodCriterion;
use serde::{Deserialize, Serialize};

/// How finely surfaces are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Detail {
    /// What decides on levels.
    pub criterion: LodKind,
    /// Greatest error (pixels), for [`LodKind::Error`].
    pub error: f32,
    /// Greatest length of refined edges (pixels), for [`LodKind::Size`].
    pub size: f32,
    /// The level, for [`LodKind::Homogeneous`] and [`LodKind::Distance`].
    pub level: u32,
    /// Distance (µm) from which on the level is 1, for [`LodKind::Distance`].
    pub far: f32,
    /// Patches smaller than this (pixels) are left out.
    pub smallest: f32,
    /// How the picture at rest is drawn.
    pub at_rest: RestChoice,
}

/// How the picture at rest is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum RestChoice {
    /// With all detail, or within a budget where that would block the window.
    #[default]
    Automatic,
    /// With all detail, however long it takes.
    Full,
    /// Within a budget, as drafts are.
    Budget,
}

/// What decides on levels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum LodKind {
    /// The error in pixels.
    #[default]
    Error,
    /// The length of edges in pixels.
    Size,
    /// A single level everywhere.
    Homogeneous,
    /// The distance from the eye.
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
            at_rest: RestChoice::Automatic,
        }
    }
}

impl Detail {
    /// What is taste in it: not what leaves small parts out.
    pub(crate) fn taste(&self) -> Self {
        Self {
            smallest: Self::default().smallest,
            ..*self
        }
    }

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
