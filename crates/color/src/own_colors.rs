//! Colors of one's own for types and categories, over those of a named palette; and their text.

use std::collections::BTreeMap;
use std::fmt;
use std::str::FromStr;

use neurotess_morphology::NeuriteKind;
use neurotess_picture::color::Rgb;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A thing that has a color.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ColorTarget {
    /// A type of SWC.
    Type(i32),
    /// What a legend names: a layer, a population, a neuron, a neurite.
    Category(String),
}

/// As legends call it.
impl fmt::Display for ColorTarget {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Type(kind) => f.write_str(&NeuriteKind(*kind).name().replace('_', " ")),
            Self::Category(name) => f.write_str(name),
        }
    }
}

/// A thing in a picture whose color can be chosen, and the color that it has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ColoredThing {
    /// The thing.
    pub target: ColorTarget,
    /// Its color.
    pub color: Rgb,
}

/// Colors of one's own. What has none keeps that of the palette. A category's color holds wherever
/// its name appears, whatever neurons are colored by.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "Tables", into = "Tables")]
pub struct OwnColors {
    /// By type of SWC.
    pub types: BTreeMap<i32, Rgb>,
    /// By name.
    pub categories: BTreeMap<String, Rgb>,
}

impl OwnColors {
    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.types.is_empty() && self.categories.is_empty()
    }

    /// The own color of a thing.
    pub fn get(&self, target: &ColorTarget) -> Option<Rgb> {
        match target {
            ColorTarget::Type(kind) => self.types.get(kind).copied(),
            ColorTarget::Category(name) => self.categories.get(name).copied(),
        }
    }

    /// Gives a thing a color.
    pub fn set(&mut self, target: ColorTarget, color: Rgb) {
        match target {
            ColorTarget::Type(kind) => self.types.insert(kind, color),
            ColorTarget::Category(name) => self.categories.insert(name, color),
        };
    }

    /// Gives a thing the palette's color.
    pub fn reset(&mut self, target: &ColorTarget) {
        match target {
            ColorTarget::Type(kind) => self.types.remove(kind),
            ColorTarget::Category(name) => self.categories.remove(name),
        };
    }

    /// Gives all that a name may mean a color: types if it is one's name, and the category. "5" is a
    /// type of SWC and may be a layer, too; what neurons are colored by decides which shows.
    pub fn set_named(&mut self, name: &str, color: Rgb) {
        for kind in kinds(name).unwrap_or_default() {
            self.set(ColorTarget::Type(kind), color);
        }
        self.set(ColorTarget::Category(name.to_owned()), color);
    }

    /// Takes the colors of others before its own.
    pub fn extend(&mut self, others: &Self) {
        self.types.extend(&others.types);
        let categories = others.categories.iter();
        self.categories
            .extend(categories.map(|(name, &color)| (name.clone(), color)));
    }
}

/// The types of SWC that a name or number means; none if it is no type's. Legends write spaces, files
/// underscores.
pub fn kinds(name: &str) -> Option<Vec<i32>> {
    let name = name.trim().to_ascii_lowercase().replace(' ', "_");
    let kinds = match name.as_str() {
        "soma" => vec![NeuriteKind::SOMA],
        "axon" => vec![NeuriteKind::AXON],
        "basal" | "basal_dendrite" => vec![NeuriteKind::BASAL_DENDRITE],
        "apical" | "apical_dendrite" => vec![NeuriteKind::APICAL_DENDRITE],
        "dendrite" => vec![NeuriteKind::BASAL_DENDRITE, NeuriteKind::APICAL_DENDRITE],
        "undefined" => vec![NeuriteKind::UNDEFINED],
        other => {
            let number = other.strip_prefix("custom_").unwrap_or(other);
            vec![NeuriteKind(number.parse().ok()?)]
        }
    };
    Some(kinds.into_iter().map(|kind| kind.0).collect())
}

/// A color: `white`, `black`, `gray`, RRGGBB or RGB, with or without a #.
///
/// # Errors
/// It is none: with what is needed.
pub fn rgb(text: &str) -> Result<Rgb, String> {
    Ok(match text.trim().to_ascii_lowercase().as_str() {
        "white" => [255; 3],
        "black" => [0; 3],
        "gray" | "grey" => [128; 3],
        other => {
            let digits = other.strip_prefix('#').unwrap_or(other);
            let hexadecimal = digits.bytes().all(|byte| byte.is_ascii_hexdigit());
            let digits: String = match digits.len() {
                6 if hexadecimal => digits.into(),
                // #fff is #ffffff.
                3 if hexadecimal => digits.chars().flat_map(|digit| [digit, digit]).collect(),
                _ => String::new(),
            };
            let [_, r, g, b] = u32::from_str_radix(&digits, 16)
                .map_err(|_| "white, black, gray, RRGGBB or RGB is needed, as in 102030")?
                .to_be_bytes();
            [r, g, b]
        }
    })
}

/// A color in a file: `"#1f77b4"`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ColorText(pub(crate) Rgb);

impl Serialize for ColorText {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let [r, g, b] = self.0;
        serializer.collect_str(&format_args!("#{r:02x}{g:02x}{b:02x}"))
    }
}

impl<'de> Deserialize<'de> for ColorText {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        let color = rgb(&text).map_err(|needed| format!("'{text}' is no color: {needed}"));
        color.map(Self).map_err(serde::de::Error::custom)
    }
}

/// The name of a type in a file: `axon`, `dendrite`, `custom_7`.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub(crate) struct TypeText(String);

impl FromStr for TypeText {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        match kinds(name) {
            Some(_) => Ok(Self(name.to_owned())),
            None => Err(format!(
                "'{name}' is no type: use soma, axon, basal, apical, dendrite, undefined, custom_N or a \
                 number; other names belong to [categories]"
            )),
        }
    }
}

impl<'de> Deserialize<'de> for TypeText {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = String::deserialize(deserializer)?;
        name.parse().map_err(serde::de::Error::custom)
    }
}

/// Own colors as they are stored in files.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Tables {
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub(crate) types: BTreeMap<TypeText, ColorText>,
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub(crate) categories: BTreeMap<String, ColorText>,
}

impl From<Tables> for OwnColors {
    fn from(tables: Tables) -> Self {
        let mut own = Self::default();
        for (name, color) in tables.types {
            let kinds = kinds(&name.0).unwrap_or_default();
            // What is said of dendrites holds for those that have no color of their own.
            for kind in kinds.iter().copied() {
                if kinds.len() == 1 {
                    own.types.insert(kind, color.0);
                } else {
                    own.types.entry(kind).or_insert(color.0);
                }
            }
        }
        let categories = tables.categories.into_iter();
        own.categories = categories.map(|(name, color)| (name, color.0)).collect();
        own
    }
}

impl From<OwnColors> for Tables {
    fn from(own: OwnColors) -> Self {
        let named = |(kind, color)| (TypeText(NeuriteKind(kind).name()), ColorText(color));
        let colored = |(name, color)| (name, ColorText(color));
        Self {
            types: own.types.into_iter().map(named).collect(),
            categories: own.categories.into_iter().map(colored).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_mean_types_as_in_files_and_legends() {
        assert_eq!(kinds("Basal dendrite"), Some(vec![3]));
        assert_eq!(kinds("dendrite"), Some(vec![3, 4]));
        assert_eq!(
            [kinds("custom_7"), kinds("7")],
            [Some(vec![7]), Some(vec![7])]
        );
        assert_eq!(kinds("L5_TTPC1"), None);
        for kind in [0, 1, 2, 3, 4, 5, 12, -3] {
            let name = ColorTarget::Type(kind).to_string();
            assert_eq!(kinds(&name), Some(vec![kind]), "{name}");
        }
    }

    #[test]
    fn a_number_may_be_a_type_and_a_category() {
        let mut own = OwnColors::default();
        own.set_named("5", [1, 2, 3]);
        own.set_named("L23_PC", [4, 5, 6]);
        let category = |name: &str| own.get(&ColorTarget::Category(name.into()));
        assert_eq!(own.get(&ColorTarget::Type(5)), Some([1, 2, 3]));
        assert_eq!(category("5"), Some([1, 2, 3]));
        assert_eq!(category("L23_PC"), Some([4, 5, 6]));
        assert_eq!(own.types.len(), 1);
        own.reset(&ColorTarget::Type(5));
        assert!(own.types.is_empty() && !own.is_empty());
    }

    #[test]
    fn colors_are_read() {
        assert_eq!(rgb("#102030"), Ok([16, 32, 48]));
        assert_eq!(rgb("fA0"), Ok([255, 170, 0]));
        assert_eq!(rgb("White"), Ok([255; 3]));
        for wrong in ["12345", "reddish", "#ééé", "+12345", "+12", "#ff", ""] {
            assert!(rgb(wrong).is_err(), "{wrong}");
        }
    }
}
