//! How a picture looks.

use neurotess_picture::{Look, Occlusion};
use serde::{Deserialize, Serialize};

use crate::words::{Fit, LightFrom, NotNegative, Size, Within};

/// How a picture looks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[cfg_attr(feature = "clap", command(next_help_heading = "Picture"))]
#[serde(default, deny_unknown_fields)]
pub struct LookOptions {
    /// Width and height (pixels), up to 32768
    #[cfg_attr(feature = "clap", arg(long, default_value_t, value_name = "WxH"))]
    pub size: Size,
    /// Samples of a pixel, 1 to 64: smoother edges; 1, 4, 16, 36 and 64 are there
    #[cfg_attr(
        feature = "clap",
        arg(
            long,
            default_value = "16",
            value_name = "N",
            allow_negative_numbers = true
        )
    )]
    pub samples: Within<1, 64>,
    /// Leave the background out
    #[cfg_attr(feature = "clap", arg(long, conflicts_with = "background"))]
    pub transparent: bool,
    /// Leave out the end of the color map that is as light or as dark as the background. Without it
    /// that end has edges
    #[cfg_attr(feature = "clap", arg(long, help_heading = "Colors"))]
    pub trim_colormap: bool,
    /// Draw no legend
    #[cfg_attr(feature = "clap", arg(long, help_heading = "Colors"))]
    pub no_legend: bool,
    /// Draw a scale bar, of this length (µm) or one that fits
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "UM", num_args = 0..=1, default_missing_value = "fit")
    )]
    pub scale_bar: Option<Fit>,
    /// Show the directions of x, y and z in a corner
    #[cfg_attr(feature = "clap", arg(long))]
    pub axes: bool,
    /// Draw neurites at least this wide, so that thin ones can be seen; the legend says so. In pixels of
    /// pictures whose shorter side has up to 960; proportionally more in larger ones. 0: as wide as they are
    /// [default: 1.5, of more than 50 neurons 0]
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "PX", allow_negative_numbers = true)
    )]
    pub least_width: Option<NotNegative>,
    /// Show the triangles by thin lines
    #[cfg_attr(feature = "clap", arg(long, help_heading = "Look"))]
    pub wireframe: bool,
    /// soft, flat (bare colors), or where the light comes from: right, up, towards you
    #[cfg_attr(
        feature = "clap",
        arg(
            long,
            default_value = "soft",
            value_name = "LIGHT",
            allow_hyphen_values = true,
            help_heading = "Look"
        )
    )]
    pub light: LightFrom,
    /// Radius (µm) within which corners darken one another; 0: not at all [default: what fits]
    #[cfg_attr(
        feature = "clap",
        arg(
            long,
            value_name = "UM",
            num_args = 0..=1,
            default_missing_value = "fit",
            help_heading = "Look"
        )
    )]
    pub ao: Option<Fit>,
}

impl Default for LookOptions {
    fn default() -> Self {
        Self {
            size: Size::default(),
            samples: Within(16),
            transparent: false,
            trim_colormap: false,
            no_legend: false,
            scale_bar: None,
            axes: false,
            least_width: None,
            wireframe: false,
            light: LightFrom::default(),
            ao: None,
        }
    }
}

impl LookOptions {
    /// Least width (pixels of this picture) of neurites, of which there are so many; 0: as wide as they are.
    pub fn width(&self, neurons: usize) -> f32 {
        let width = self.least_width.map(|width| width.0 as f32);
        let width = width.unwrap_or_else(|| Look::usual_least_width(neurons));
        Look::width_at(width, self.size.0)
    }

    /// How corners darken one another.
    pub fn occlusion(&self) -> Occlusion {
        match self.ao {
            None | Some(Fit::Auto) => Occlusion::Fit,
            Some(Fit::Length(0.0)) => Occlusion::Off,
            Some(Fit::Length(radius)) => Occlusion::Within(radius as f32),
        }
    }
}
