//! `--types`

use std::str::FromStr;

use neurotess::morphology::NeuriteKind;
use neurotess::recipe::{KINDS, neurite_kinds};

/// The types that one word of `--types` keeps.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Types(pub(crate) Vec<NeuriteKind>);

impl FromStr for Types {
    type Err = String;

    fn from_str(word: &str) -> Result<Self, String> {
        let kinds = neurite_kinds(word).ok_or_else(|| format!("use {KINDS}"))?;
        Ok(Self(kinds))
    }
}
