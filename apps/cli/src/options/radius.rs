//! Radii that a tracing lacks.

use clap::Args;

use super::numbers::positive;

/// What is done about radii that are missing or too thin.
#[derive(Args, Clone, Copy, Debug, Default)]
pub(crate) struct RadiusArgs {
    /// Radius (µm) of points that have none: zero, negative [default: that of their neighbors along the path, else
    /// the cell's median, else 0.5]
    #[arg(long, value_name = "UM", value_parser = positive, allow_negative_numbers = true,
          help_heading = "Surface")]
    pub(crate) radius: Option<f64>,
    /// Least radius (µm) of neurites: thinner points become as thick
    #[arg(long, value_name = "UM", value_parser = positive, allow_negative_numbers = true,
          help_heading = "Surface")]
    pub(crate) min_radius: Option<f64>,
}
