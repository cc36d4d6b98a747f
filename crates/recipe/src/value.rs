//! Values of options as files and Python give them, before it is known what they are of.

use std::collections::BTreeMap;
use std::path::PathBuf;

use neurotess_generate::Smooth;
use neurotess_morphology::NeuriteKind;
use serde::{Deserialize, Serialize};

use crate::words::{KINDS, RINGS, SMOOTH, Word, neurite_kinds};
use crate::{MeshOption, OptionsError};

/// A value of any option.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
#[expect(missing_docs, reason = "the names say it")]
pub enum OptionValue {
    Switch(bool),
    Whole(i64),
    Number(f64),
    Text(String),
    List(Vec<Self>),
    Map(BTreeMap<String, Self>),
}

impl std::fmt::Display for OptionValue {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Switch(value) => value.fmt(f),
            Self::Whole(value) => value.fmt(f),
            Self::Number(value) => value.fmt(f),
            Self::Text(value) => f.write_str(value),
            Self::List(values) => {
                let values: Vec<String> = values.iter().map(ToString::to_string).collect();
                f.write_str(&values.join(","))
            }
            Self::Map(values) => {
                let pairs = values.iter().map(|(key, value)| format!("{key}={value}"));
                f.write_str(&pairs.collect::<Vec<_>>().join(","))
            }
        }
    }
}

/// A value, and what it is to be.
#[derive(Clone, Copy)]
pub(crate) struct Given<'v> {
    pub(crate) option: MeshOption,
    pub(crate) value: &'v OptionValue,
}

impl Given<'_> {
    fn refused(&self, needed: impl Into<String>) -> OptionsError {
        OptionsError::Value {
            option: self.option,
            value: self.value.to_string(),
            needed: needed.into(),
        }
    }

    pub(crate) fn switch(&self) -> Result<bool, OptionsError> {
        match self.value {
            OptionValue::Switch(value) => Ok(*value),
            _ => Err(self.refused("true or false is needed")),
        }
    }

    /// A whole number; `range` is what is said where it does not fit.
    pub(crate) fn whole(&self, range: &str) -> Result<u32, OptionsError> {
        let whole = match self.value {
            OptionValue::Whole(value) => Some(*value),
            OptionValue::Text(text) => text.parse().ok(),
            _ => None,
        };
        let whole = whole.ok_or_else(|| self.refused("a whole number is needed"))?;
        whole
            .try_into()
            .map_err(|_| self.refused(format!("{whole} is not in {range}")))
    }

    pub(crate) fn number(&self) -> Result<f64, OptionsError> {
        let number = match self.value {
            OptionValue::Whole(value) => Some(*value as f64),
            OptionValue::Number(value) => Some(*value),
            OptionValue::Text(text) => text.parse().ok(),
            _ => None,
        };
        number.ok_or_else(|| self.refused("a number is needed"))
    }

    pub(crate) fn path(&self) -> Result<PathBuf, OptionsError> {
        match self.value {
            OptionValue::Text(text) => Ok(text.into()),
            _ => Err(self.refused("the path of a mesh is needed")),
        }
    }

    /// A choice by its word.
    pub(crate) fn word<T: Word>(&self) -> Result<T, OptionsError> {
        let found = match self.value {
            OptionValue::Text(text) => T::of_word(text),
            _ => None,
        };
        found.ok_or_else(|| OptionsError::Word {
            option: self.option,
            value: self.value.to_string(),
            words: T::words(),
        })
    }

    /// A factor, 1 for true and none for false.
    pub(crate) fn factor(&self) -> Result<Option<f64>, OptionsError> {
        match self.value {
            OptionValue::Switch(value) => Ok(value.then_some(1.0)),
            _ => self.number().map(Some),
        }
    }

    pub(crate) fn smooth(&self) -> Result<Smooth, OptionsError> {
        match self.value {
            OptionValue::Text(text) if text == "auto" => Ok(Smooth::Auto),
            _ => {
                let length = self.number();
                let length = length.map_err(|_| self.refused(SMOOTH))?;
                // None and a length of 0 are the same.
                Ok(match length == 0.0 {
                    true => Smooth::None,
                    false => Smooth::Length(length),
                })
            }
        }
    }

    /// Positions of first rings by the number of the neurite, from 1.
    pub(crate) fn rings(&self) -> Result<BTreeMap<u32, f64>, OptionsError> {
        let OptionValue::Map(values) = self.value else {
            return Err(self.refused(RINGS));
        };
        let ring = |(key, value): (&String, &OptionValue)| {
            let neurite = key.parse().ok()?;
            let position = match value {
                OptionValue::Whole(value) => *value as f64,
                OptionValue::Number(value) => *value,
                _ => return None,
            };
            Some((neurite, position))
        };
        let rings: Option<_> = values.iter().map(ring).collect();
        rings.ok_or_else(|| self.refused(RINGS))
    }

    /// Types of neurites by names and numbers, several of them in a text.
    pub(crate) fn kinds(&self) -> Result<Vec<NeuriteKind>, OptionsError> {
        let words: Vec<String> = match self.value {
            OptionValue::List(values) => values.iter().map(ToString::to_string).collect(),
            OptionValue::Text(text) => text.split(',').map(str::to_owned).collect(),
            value => vec![value.to_string()],
        };
        let kinds: Option<Vec<_>> = words.iter().map(|word| neurite_kinds(word)).collect();
        let kinds = kinds.filter(|kinds| !kinds.is_empty());
        let kinds = kinds.ok_or_else(|| self.refused(format!("use {KINDS}")))?;
        Ok(kinds.concat())
    }
}
