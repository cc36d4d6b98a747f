//! Words for values of options.

use neurotess_generate::{SomaKeep, SomaMethod, SphereKind};
use neurotess_morphology::NeuriteKind;
use neurotess_refine::{Caps, Path};

use crate::{Crossings, Radii};

/// A choice among few, each with a word.
pub(crate) trait Word: Copy + PartialEq + Sized + 'static {
    /// All of them.
    const ALL: &'static [(&'static str, Self)];

    /// Its word.
    fn word(self) -> &'static str {
        let mut all = Self::ALL.iter();
        all.find(|(_, value)| *value == self)
            .map_or("", |(word, _)| word)
    }

    /// The choice with this word.
    fn of_word(word: &str) -> Option<Self> {
        let mut all = Self::ALL.iter();
        all.find(|(of, _)| *of == word).map(|&(_, value)| value)
    }

    /// All words, as a sentence lists them.
    fn words() -> String {
        let words: Vec<&str> = Self::ALL.iter().map(|(word, _)| *word).collect();
        words.join(", ")
    }
}

impl Word for Path {
    const ALL: &'static [(&'static str, Self)] =
        &[("hermite", Self::Hermite), ("linear", Self::Linear)];
}

impl Word for Caps {
    const ALL: &'static [(&'static str, Self)] = &[("round", Self::Round), ("flat", Self::Flat)];
}

impl Word for Crossings {
    const ALL: &'static [(&'static str, Self)] = &[
        ("keep", Self::Keep),
        ("merge", Self::Merge),
        ("separate", Self::Separate),
    ];
}

impl Word for Radii {
    const ALL: &'static [(&'static str, Self)] = &[
        ("traced", Self::Traced),
        ("equal-area", Self::EqualArea),
        ("equal-perimeter", Self::EqualPerimeter),
    ];
}

impl Word for SomaMethod {
    const ALL: &'static [(&'static str, Self)] = &[
        ("fem", Self::Fem),
        ("sphere", Self::Sphere),
        ("profile", Self::Profile),
        ("none", Self::None),
    ];
}

impl Word for SomaKeep {
    const ALL: &'static [(&'static str, Self)] = &[
        ("volume", Self::Volume),
        ("area", Self::Area),
        ("scale", Self::Scale),
    ];
}

impl Word for SphereKind {
    const ALL: &'static [(&'static str, Self)] =
        &[("octahedron", Self::Octahedron), ("cube", Self::Cube)];
}

/// What positions of first rings are to be.
pub(crate) const RINGS: &str =
    "a neurite from 1 on and a position from 0 to 2 are needed, as in 2=0.5";
/// What smoothing is to be.
pub(crate) const SMOOTH: &str = "a length of 0 or more (µm) or auto is needed";
/// What [`neurite_kinds`] takes.
pub const KINDS: &str = "axon, basal, apical, dendrite, undefined, custom_N or a number";

/// The types of neurites that a word or a number of SWC names: `axon`, `dendrite` (basal and apical ones), `custom_9`,
/// `2`.
pub fn neurite_kinds(word: &str) -> Option<Vec<NeuriteKind>> {
    Some(match word.to_ascii_lowercase().as_str() {
        "axon" => vec![NeuriteKind::AXON],
        "basal" | "basal_dendrite" => vec![NeuriteKind::BASAL_DENDRITE],
        "apical" | "apical_dendrite" => vec![NeuriteKind::APICAL_DENDRITE],
        "dendrite" => vec![NeuriteKind::BASAL_DENDRITE, NeuriteKind::APICAL_DENDRITE],
        "undefined" => vec![NeuriteKind::UNDEFINED],
        other => {
            let number = other.strip_prefix("custom_").unwrap_or(other);
            vec![NeuriteKind(number.parse().ok()?)]
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn types_have_names_and_numbers() {
        assert_eq!(neurite_kinds("Axon"), Some(vec![NeuriteKind(2)]));
        assert_eq!(neurite_kinds("custom_9"), Some(vec![NeuriteKind(9)]));
        assert_eq!(neurite_kinds("4"), neurite_kinds("apical"));
        assert_eq!(neurite_kinds("dendrite").map(|kinds| kinds.len()), Some(2));
        assert_eq!(neurite_kinds("branch"), None);
    }

    #[test]
    fn words_lead_there_and_back() {
        assert_eq!(SomaMethod::of_word("none"), Some(SomaMethod::None));
        assert_eq!(Radii::EqualArea.word(), "equal-area");
        assert_eq!(Crossings::words(), "keep, merge, separate");
    }
}
