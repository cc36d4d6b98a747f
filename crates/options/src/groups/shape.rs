//! What of cells is shown, and how their meshes are made.

use std::collections::BTreeMap;

use neurotess_generate::GenerateOptions;
use neurotess_morphology::NeuriteKind;
use serde::{Deserialize, Serialize};

use crate::words::{Positive, RadiusFactor, Ring, Soma, Types};

/// What is done about radii that are missing or too thin.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default)]
pub struct MissingRadii {
    /// Radius (µm) of points that have none: zero, negative [default: that of their neighbors along the path, else
    /// the cell's median, else 0.5]
    #[cfg_attr(
        feature = "clap",
        arg(
            long,
            value_name = "UM",
            allow_negative_numbers = true,
            help_heading = "Surface"
        )
    )]
    pub radius: Option<Positive>,
    /// Least radius (µm) of neurites: thinner points become as thick
    #[cfg_attr(
        feature = "clap",
        arg(
            long,
            value_name = "UM",
            allow_negative_numbers = true,
            help_heading = "Surface"
        )
    )]
    pub min_radius: Option<Positive>,
}

/// Where neurites leave their soma.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default)]
pub struct Rings {
    /// Put the first ring of a neurite somewhere between the soma's sphere (0), the first traced
    /// point outside it (1) and as far beyond along the path (2); several times for several
    /// neurites, which are counted from 1 in the order of the file, as in the window
    #[cfg_attr(
        feature = "clap",
        arg(long = "ring", value_name = "NEURITE=POSITION", help_heading = "Soma")
    )]
    pub ring: Vec<Ring>,
}

impl Rings {
    /// The positions by neurite, from 0. If there are several for a neurite, the last one.
    pub fn positions(&self) -> BTreeMap<u32, f64> {
        self.ring.iter().map(|r| (r.neurite, r.position)).collect()
    }
}

/// What of cells is shown, and how their meshes are made.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[cfg_attr(feature = "clap", command(next_help_heading = "Cells"))]
#[serde(default)]
pub struct ShapeOptions {
    /// Draw neurites with their radii times this factor, so that thin ones can be seen in a figure; the
    /// legend says so
    #[cfg_attr(
        feature = "clap",
        arg(
            long,
            value_name = "FACTOR",
            allow_negative_numbers = true,
            help_heading = "Picture"
        )
    )]
    pub radius_factor: Option<RadiusFactor>,
    #[cfg_attr(feature = "clap", command(flatten))]
    #[serde(flatten)]
    #[expect(missing_docs, reason = "the group says it")]
    pub radii: MissingRadii,
    /// How the soma is made
    #[cfg_attr(
        feature = "clap",
        arg(
            long,
            value_enum,
            default_value_t,
            value_name = "METHOD",
            help_heading = "Soma"
        )
    )]
    pub soma: Soma,
    #[cfg_attr(feature = "clap", command(flatten))]
    #[serde(flatten)]
    #[expect(missing_docs, reason = "the group says it")]
    pub rings: Rings,
    /// Keep only these: axon, basal, apical, dendrite (both), undefined, custom_N, SWC numbers
    #[cfg_attr(
        feature = "clap",
        arg(long, value_delimiter = ',', value_name = "TYPE,…")
    )]
    pub types: Vec<Types>,
}

impl ShapeOptions {
    /// Factor on the radii of neurites.
    pub fn factor(&self) -> f64 {
        self.radius_factor.map_or(1.0, |factor| factor.0)
    }

    /// The types that are kept; none for all.
    pub fn kinds(&self) -> Option<Vec<NeuriteKind>> {
        let kinds = self.types.iter().flat_map(|types| types.kinds().to_vec());
        (!self.types.is_empty()).then(|| kinds.collect())
    }

    /// How coarse meshes are made.
    pub fn generate(&self) -> GenerateOptions {
        GenerateOptions {
            soma: self.soma.into(),
            rings: self.rings.positions(),
            radius_factor: self.factor(),
            unknown_radius: self.radii.radius.map(|radius| radius.0),
            least_radius: self.radii.min_radius.map_or(0.0, |radius| radius.0),
            kinds: self.kinds(),
            ..GenerateOptions::default()
        }
    }
}
