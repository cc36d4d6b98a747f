//! What a neurite is: the SWC type codes and their names.

use serde::Serialize;

/// Kind of a neurite's section: an SWC type code, kept as the file gave it.
///
/// Codes: 0 undefined, 1 soma (inside a tree, where a file puts it there), 2 axon, 3 basal
/// dendrite, 4 apical dendrite, 5 and above custom.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(transparent)]
pub struct NeuriteKind(pub i32);

impl NeuriteKind {
    /// Type 0: not given.
    pub const UNDEFINED: Self = Self(0);
    /// Type 1: soma.
    pub const SOMA: Self = Self(1);
    /// Type 2: axon.
    pub const AXON: Self = Self(2);
    /// Type 3: basal dendrite, or any dendrite of a cell without an apical one.
    pub const BASAL_DENDRITE: Self = Self(3);
    /// Type 4: apical dendrite.
    pub const APICAL_DENDRITE: Self = Self(4);

    /// Name of the kind as the command line prints and takes it.
    ///
    /// ```
    /// use neurotess_morphology::NeuriteKind;
    /// assert_eq!(NeuriteKind(3).name(), "basal_dendrite");
    /// assert_eq!(NeuriteKind(9).name(), "custom_9");
    /// ```
    pub fn name(self) -> String {
        match self.0 {
            0 => "undefined".into(),
            1 => "soma".into(),
            2 => "axon".into(),
            3 => "basal_dendrite".into(),
            4 => "apical_dendrite".into(),
            code => format!("custom_{code}"),
        }
    }
}
