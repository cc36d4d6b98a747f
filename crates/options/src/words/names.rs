//! Choices by name.

use neurotess_circuit::SynapseSide;
use neurotess_color::ColorBy;
use neurotess_generate::SomaMethod;
use neurotess_picture::{MarkerShape, Side};
use serde::{Deserialize, Serialize};

/// What colors tell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[serde(rename_all = "kebab-case")]
pub enum ColorWhat {
    /// SWC type
    Type,
    /// Every neurite its own
    Neurite,
    /// Neighboring sections differ
    Section,
    /// Number of forks from the neurite's start
    #[cfg_attr(feature = "clap", value(alias = "branch-order"))]
    Order,
    /// Radius (µm)
    Radius,
    /// Distance along the neurite from its start (µm)
    #[cfg_attr(feature = "clap", value(alias = "path-distance"))]
    Depth,
    /// Every input its own, and every cell of a circuit
    Neuron,
    /// Values of a --report
    Value,
}

impl ColorWhat {
    /// What colors of tracings tell; none for values.
    pub fn by(self) -> Option<ColorBy> {
        Some(match self {
            Self::Value => return None,
            Self::Type => ColorBy::Type,
            Self::Neurite => ColorBy::Neurite,
            Self::Section => ColorBy::Section,
            Self::Order => ColorBy::BranchOrder,
            Self::Radius => ColorBy::Radius,
            Self::Depth => ColorBy::PathDistance,
            Self::Neuron => ColorBy::Neuron,
        })
    }

    /// Whether it is a number.
    pub fn is_number(self) -> bool {
        matches!(self, Self::Order | Self::Radius | Self::Depth)
    }
}

/// How vertices are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[serde(rename_all = "kebab-case")]
pub enum Lod {
    /// As it is drawn, as fine as --pixels asks for
    Adaptive,
    /// As it is drawn, at --level everywhere
    Homogeneous,
    /// Refined beforehand, whole in the adapter's memory
    Prerefined,
    /// As the viewer draws while the camera moves: any scene within --budget triangles
    Exploration,
    /// As the viewer draws at rest: adaptive, within half a pixel
    Static,
}

/// From where one looks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[serde(rename_all = "kebab-case")]
pub enum ViewSide {
    /// Along −z, y upwards
    #[default]
    Front,
    /// Along +z
    Back,
    /// Along +x
    Left,
    /// Along −x
    Right,
    /// Along −y
    Top,
    /// Along +y
    Bottom,
    /// From the right, above and before
    Iso,
}

impl From<ViewSide> for Side {
    fn from(side: ViewSide) -> Self {
        match side {
            ViewSide::Front => Self::Front,
            ViewSide::Back => Self::Back,
            ViewSide::Left => Self::Left,
            ViewSide::Right => Self::Right,
            ViewSide::Top => Self::Top,
            ViewSide::Bottom => Self::Bottom,
            ViewSide::Iso => Self::Iso,
        }
    }
}

impl From<Side> for ViewSide {
    fn from(side: Side) -> Self {
        match side {
            Side::Front => Self::Front,
            Side::Back => Self::Back,
            Side::Left => Self::Left,
            Side::Right => Self::Right,
            Side::Top => Self::Top,
            Side::Bottom => Self::Bottom,
            Side::Iso => Self::Iso,
        }
    }
}

/// How the soma is made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[serde(rename_all = "kebab-case")]
pub enum Soma {
    /// What was traced, drawn out towards the neurites by linear elasticity
    #[default]
    Fem,
    /// A sphere
    Sphere,
    /// LiveMesh's radius function
    Profile,
    /// None: every neurite is closed by itself
    None,
}

impl From<Soma> for SomaMethod {
    fn from(soma: Soma) -> Self {
        match soma {
            Soma::Fem => Self::Fem,
            Soma::Sphere => Self::Sphere,
            Soma::Profile => Self::Profile,
            Soma::None => Self::None,
        }
    }
}

/// Side of a synapse.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[serde(rename_all = "kebab-case")]
pub enum SideOfSynapse {
    /// Inputs: on their targets
    #[default]
    Afferent,
    /// Outputs: on their sources
    Efferent,
}

impl From<SideOfSynapse> for SynapseSide {
    fn from(side: SideOfSynapse) -> Self {
        match side {
            SideOfSynapse::Afferent => Self::Afferent,
            SideOfSynapse::Efferent => Self::Efferent,
        }
    }
}

/// Shape of a synapse or point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[serde(rename_all = "kebab-case")]
pub enum DrawnAs {
    /// Dots of three pixels
    Point,
    /// Spheres
    Sphere,
    /// Spheres on flat discs
    Contact,
}

impl From<DrawnAs> for MarkerShape {
    fn from(shape: DrawnAs) -> Self {
        match shape {
            DrawnAs::Point => Self::Point,
            DrawnAs::Sphere => Self::Sphere,
            DrawnAs::Contact => Self::Contact,
        }
    }
}
