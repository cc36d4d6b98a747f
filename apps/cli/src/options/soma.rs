//! `--soma`

use clap::ValueEnum;
use neurotess::generate::SomaMethod;

/// `--soma`
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum SomaArg {
    /// What was traced, drawn out towards the neurites by linear elasticity
    Fem,
    /// A sphere
    Sphere,
    /// LiveMesh's radius function
    Profile,
    /// None: every neurite is closed by itself
    None,
}

impl SomaArg {
    /// The library's value.
    pub(crate) fn method(self) -> SomaMethod {
        match self {
            Self::Fem => SomaMethod::Fem,
            Self::Sphere => SomaMethod::Sphere,
            Self::Profile => SomaMethod::Profile,
            Self::None => SomaMethod::None,
        }
    }
}
