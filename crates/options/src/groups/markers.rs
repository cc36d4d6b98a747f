//! Synapses and points beside the cells of a picture.

use std::path::PathBuf;

use neurotess_picture::MarkerShape;
use serde::{Deserialize, Serialize};

use crate::OptionError;
use crate::words::{DrawnAs, Positive, SideOfSynapse};

/// Which synapses and points.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[cfg_attr(feature = "clap", command(next_help_heading = "Synapses and points"))]
#[serde(default, deny_unknown_fields)]
pub struct MarkerOptions {
    /// Show synapses of the cells of a circuit: all, or those of these populations of edges
    #[cfg_attr(
        feature = "clap",
        arg(
            long,
            value_name = "EDGES,…",
            value_delimiter = ',',
            num_args = 0..=1,
            default_missing_value = "all",
            require_equals = true
        )
    )]
    #[serde(deserialize_with = "edges")]
    pub synapses: Option<Vec<String>>,
    /// Where synapses are shown: on the cells that they are inputs of, or outputs
    #[cfg_attr(
        feature = "clap",
        arg(long, value_enum, default_value_t, value_name = "SIDE")
    )]
    pub synapse_side: SideOfSynapse,
    /// Show the points of a table: CSV or TSV with columns x, y and z (µm)
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "FILE", conflicts_with = "synapses")
    )]
    pub points: Option<PathBuf>,
    /// Color synapses or points by a number that each has, such as delay or conductance, or a column of the table
    #[cfg_attr(feature = "clap", arg(long, value_name = "NAME"))]
    pub marker_color_by: Option<String>,
    /// What synapses and points are drawn as: contact discs lie on the membrane, of synapses only [default: sphere]
    #[cfg_attr(feature = "clap", arg(long, value_enum, value_name = "SHAPE"))]
    pub marker_shape: Option<DrawnAs>,
    /// Diameter (µm) of synapses and points; discs are twice as wide [default: 1]
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "UM", allow_negative_numbers = true)
    )]
    pub marker_size: Option<Positive>,
}

/// Populations of edges: a list, names with commas between, or `true` for all.
fn edges<'de, D: serde::Deserializer<'de>>(from: D) -> Result<Option<Vec<String>>, D::Error> {
    Ok(match serde_json::Value::deserialize(from)? {
        serde_json::Value::Null | serde_json::Value::Bool(false) => None,
        serde_json::Value::Bool(true) => Some(vec!["all".into()]),
        other => {
            let names = crate::text_of(&other);
            Some(names.split(',').map(str::to_owned).collect())
        }
    })
}

impl MarkerOptions {
    /// Whether anything is shown.
    pub fn any(&self) -> bool {
        self.synapses.is_some() || self.points.is_some()
    }

    /// Refuses options that nothing has.
    ///
    /// # Errors
    /// Options that do not go together.
    pub fn check(&self) -> Result<(), OptionError> {
        if self.synapses.is_none() && self.synapse_side != SideOfSynapse::default() {
            return Err(OptionError::together(
                "--synapse-side is for --synapses: name them, too",
            ));
        }
        if self.synapses.is_some() && self.points.is_some() {
            return Err(OptionError::together(
                "--points cannot be used with --synapses: leave out one of them",
            ));
        }
        let options = [
            self.marker_color_by.is_some(),
            self.marker_size.is_some(),
            self.marker_shape.is_some(),
        ];
        if !self.any() && options.contains(&true) {
            return Err(OptionError::together(
                "--marker-color-by, --marker-size and --marker-shape are for --synapses or --points",
            ));
        }
        if self.points.is_some() && self.shape() == MarkerShape::Contact {
            return Err(OptionError::together(
                "--marker-shape contact is for --synapses: points of a table lie on no membrane",
            ));
        }
        Ok(())
    }

    /// What they are drawn as.
    pub fn shape(&self) -> MarkerShape {
        self.marker_shape.map_or(MarkerShape::default(), Into::into)
    }

    /// Populations of edges; empty for all.
    pub fn populations(&self) -> Vec<String> {
        let named = self.synapses.iter().flatten();
        named.filter(|name| *name != "all").cloned().collect()
    }
}
