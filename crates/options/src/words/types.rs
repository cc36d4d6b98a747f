//! Types of neurites.

use std::fmt;
use std::str::FromStr;

use neurotess_morphology::NeuriteKind;
use neurotess_recipe::{KINDS, neurite_kinds};

use crate::given::by_text;

/// A word for types of neurites: axon, basal, apical, dendrite (both), undefined, custom_N, or a number of SWC; several
/// with commas between.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Types {
    word: String,
    kinds: Vec<NeuriteKind>,
}

impl Types {
    /// A word for these types.
    pub fn of_kinds(word: &str, kinds: Vec<NeuriteKind>) -> Self {
        Self {
            word: word.to_owned(),
            kinds,
        }
    }

    /// The types that it means.
    pub fn kinds(&self) -> &[NeuriteKind] {
        &self.kinds
    }
}

impl FromStr for Types {
    type Err = String;

    fn from_str(word: &str) -> Result<Self, String> {
        let kinds: Option<Vec<_>> = word.split(',').map(neurite_kinds).collect();
        let kinds = kinds.ok_or_else(|| format!("use {KINDS}"))?;
        Ok(Self {
            word: word.to_owned(),
            kinds: kinds.concat(),
        })
    }
}

impl fmt::Display for Types {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.word)
    }
}

by_text!(Types);
