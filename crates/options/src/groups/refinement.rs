//! How finely surfaces are drawn.

use neurotess_picture::MAX_BUDGET;
use neurotess_refine::LodCriterion;
use serde::{Deserialize, Serialize};

use crate::OptionError;
use crate::words::{Lod, Positive, Within};

/// Level if none is given.
const USUAL_LEVEL: u32 = 4;

/// How finely surfaces are drawn.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[cfg_attr(feature = "clap", command(next_help_heading = "Refinement"))]
#[serde(default, deny_unknown_fields)]
pub struct RefinementOptions {
    /// How vertices are made [default: adaptive; homogeneous where --level is given]
    #[cfg_attr(feature = "clap", arg(long, value_enum, value_name = "MODE"))]
    pub lod: Option<Lod>,
    /// Subdivisions per coarse edge everywhere, 1 to 64, instead of --pixels
    #[cfg_attr(
        feature = "clap",
        arg(
            long,
            value_name = "N",
            conflicts_with = "pixels",
            allow_negative_numbers = true
        )
    )]
    pub level: Option<Within<1, 64>>,
    /// Farthest that the surface may be from the level-64 one (pixels) [default: 0.25, with
    /// --wireframe 1]
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "P", allow_negative_numbers = true)
    )]
    pub pixels: Option<Positive>,
    /// Most triangles of --lod exploration, for those that show most [default: 100000]
    #[cfg_attr(feature = "clap", arg(long, value_name = "N"))]
    pub budget: Option<Within<0, MAX_BUDGET>>,
}

impl RefinementOptions {
    /// The mode that follows from the options.
    ///
    /// # Errors
    /// A level where levels follow from the error.
    pub fn mode(&self) -> Result<Lod, OptionError> {
        let refused = |why: &str| Err(OptionError::together(why));
        let exploring = self.lod == Some(Lod::Exploration);
        if self.budget.is_some() && !exploring {
            return refused("--budget is for --lod exploration");
        }
        if exploring && self.pixels.is_some() {
            return refused("--lod exploration is within half a pixel: leave out --pixels");
        }
        if self.level.is_some() && self.pixels.is_some() {
            return refused("--level cannot be used with --pixels: leave out one of them");
        }
        match (self.lod, self.level) {
            (Some(Lod::Adaptive), Some(_)) => refused(
                "--lod adaptive chooses levels by --pixels: leave out --level, or use --lod homogeneous",
            ),
            (Some(Lod::Exploration | Lod::Static), Some(_)) => {
                refused("this --lod has no levels: leave out --level, or use --lod homogeneous")
            }
            (Some(Lod::Static), None) if self.pixels.is_some() => refused(
                "--lod static is within half a pixel: leave out --pixels, or use --lod adaptive",
            ),
            (Some(mode), _) => Ok(mode),
            (None, Some(_)) => Ok(Lod::Homogeneous),
            (None, None) => Ok(Lod::Adaptive),
        }
    }

    /// How it is refined as it is drawn. `wireframe`: as for [`error`](Self::error).
    ///
    /// # Errors
    /// As [`mode`](Self::mode).
    pub fn criterion(&self, wireframe: bool) -> Result<LodCriterion, OptionError> {
        Ok(match self.mode()? {
            Lod::Homogeneous => {
                LodCriterion::Homogeneous(self.level.map_or(USUAL_LEVEL, |level| level.0))
            }
            Lod::Static => LodCriterion::PixelError(0.5),
            Lod::Adaptive | Lod::Prerefined | Lod::Exploration => {
                LodCriterion::PixelError(self.error(wireframe) as f32)
            }
        })
    }

    /// Greatest error (pixels): one that cannot be seen; with a wireframe a larger one, so that its
    /// lines do not run together.
    pub fn error(&self, wireframe: bool) -> f64 {
        let usual = if wireframe { 1.0 } else { 0.25 };
        self.pixels.map_or(usual, |pixels| pixels.0)
    }
}
