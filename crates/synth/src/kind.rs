//! The kinds of neuron and their names.

use std::fmt;
use std::str::FromStr;

use thiserror::Error;

/// A kind of neuron.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// Of the cortex: apical dendrite with obliques and a tuft, basal dendrites, axon downwards.
    Pyramidal,
    /// Of the cerebellum: a dense flat fan.
    Purkinje,
    /// Of the cerebellum: a few short dendrites, an axon that splits like a T.
    Granule,
    /// An interneuron with a dense axon around it.
    Basket,
    /// Of the spinal cord: a large soma and long thick dendrites.
    Motor,
    /// A small interneuron, much the same to all sides.
    Star,
}

impl Kind {
    /// All kinds.
    pub const ALL: [Self; 6] = [
        Self::Pyramidal,
        Self::Purkinje,
        Self::Granule,
        Self::Basket,
        Self::Motor,
        Self::Star,
    ];

    /// The name as the command line takes it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Pyramidal => "pyramidal",
            Self::Purkinje => "purkinje",
            Self::Granule => "granule",
            Self::Basket => "basket",
            Self::Motor => "motor",
            Self::Star => "star",
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Kind {
    type Err = UnknownKind;

    fn from_str(name: &str) -> Result<Self, UnknownKind> {
        let found = Self::ALL.into_iter().find(|kind| kind.name() == name);
        found.ok_or_else(|| UnknownKind(name.to_owned()))
    }
}

/// A name that is none of the kinds'.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("no kind of neuron is called {0:?}: take {list}", list = Kind::ALL.map(Kind::name).join(", "))]
pub struct UnknownKind(pub String);
