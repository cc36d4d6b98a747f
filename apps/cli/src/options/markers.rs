//! Synapses and points beside the cells of a picture.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use neurotess::circuit::SynapseSide;
use neurotess::picture::MarkerShape;

use crate::report::usage;

/// Which synapses and points.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Synapses and points")]
pub(crate) struct MarkerArgs {
    /// Show synapses of the cells of a circuit: all, or those of these populations of edges
    #[arg(long, value_name = "EDGES,…", value_delimiter = ',', num_args = 0..=1,
          default_missing_value = "all", require_equals = true)]
    pub(crate) synapses: Option<Vec<String>>,
    /// Where synapses are shown: on the cells that they are inputs of, or outputs
    #[arg(long, value_enum, default_value_t = SideArg::Afferent, value_name = "SIDE",
          requires = "synapses")]
    pub(crate) synapse_side: SideArg,
    /// Show the points of a table: CSV or TSV with columns x, y and z (µm)
    #[arg(long, value_name = "FILE", conflicts_with = "synapses")]
    pub(crate) points: Option<PathBuf>,
    /// Color synapses or points by a number that each has, such as delay or conductance, or a column of the table
    #[arg(long, value_name = "NAME")]
    pub(crate) marker_color_by: Option<String>,
    /// What synapses and points are drawn as: contact discs lie on the membrane, of synapses only [default: sphere]
    #[arg(long, value_enum, value_name = "SHAPE")]
    pub(crate) marker_shape: Option<ShapeArg>,
    /// Diameter (µm) of synapses and points; discs are twice as wide [default: 1]
    #[arg(long, value_name = "UM", value_parser = super::numbers::positive,
          allow_negative_numbers = true)]
    pub(crate) marker_size: Option<f64>,
}

/// Side of a synapse.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum SideArg {
    /// Inputs: on their targets
    #[default]
    Afferent,
    /// Outputs: on their sources
    Efferent,
}

/// Shape of a synapse or point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ShapeArg {
    /// Dots of three pixels
    Point,
    /// Spheres
    Sphere,
    /// Spheres on flat discs
    Contact,
}

impl From<ShapeArg> for MarkerShape {
    fn from(shape: ShapeArg) -> Self {
        match shape {
            ShapeArg::Point => Self::Point,
            ShapeArg::Sphere => Self::Sphere,
            ShapeArg::Contact => Self::Contact,
        }
    }
}

impl From<SideArg> for SynapseSide {
    fn from(side: SideArg) -> Self {
        match side {
            SideArg::Afferent => Self::Afferent,
            SideArg::Efferent => Self::Efferent,
        }
    }
}

impl MarkerArgs {
    /// Whether anything is shown.
    pub(crate) fn any(&self) -> bool {
        self.synapses.is_some() || self.points.is_some()
    }

    /// Refuses options that nothing has.
    ///
    /// # Errors
    /// Wrong usage.
    pub(crate) fn check(&self) -> anyhow::Result<()> {
        let options = [
            self.marker_color_by.is_some(),
            self.marker_size.is_some(),
            self.marker_shape.is_some(),
        ];
        if !self.any() && options.contains(&true) {
            return usage(
                "--marker-color-by, --marker-size and --marker-shape are for --synapses or --points",
            );
        }
        if self.points.is_some() && self.shape() == MarkerShape::Contact {
            return usage(
                "--marker-shape contact is for --synapses: points of a table lie on no membrane",
            );
        }
        Ok(())
    }

    /// What they are drawn as.
    pub(crate) fn shape(&self) -> MarkerShape {
        self.marker_shape.map_or(MarkerShape::default(), Into::into)
    }

    /// Populations of edges; empty for all.
    pub(crate) fn populations(&self) -> Vec<String> {
        let named = self.synapses.iter().flatten();
        named.filter(|name| *name != "all").cloned().collect()
    }
}
