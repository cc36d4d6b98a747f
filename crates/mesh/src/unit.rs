//! The unit of lengths in a file: micrometers as in tracings, or meters as simulators in SI units want
//! them.

use std::fmt;

use glam::{DAffine3, DVec3};

/// A unit of length.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Unit {
    /// That of tracings.
    #[default]
    Micrometer,
    /// That of SI.
    Meter,
}

impl Unit {
    /// How many of it a micrometer is.
    pub fn per_micrometer(self) -> f64 {
        match self {
            Self::Micrometer => 1.0,
            Self::Meter => 1e-6,
        }
    }

    /// The scaling from coordinates in µm.
    pub fn unit_from_um(self) -> DAffine3 {
        DAffine3::from_scale(DVec3::splat(self.per_micrometer()))
    }
}

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Micrometer => "micrometer",
            Self::Meter => "meter",
        })
    }
}
