//! What parts of neurons are by the names that people give them.

use neurotess_morphology::NeuriteKind;

/// What a name says.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Part {
    Apical,
    Basal,
    Axon,
    Soma,
    /// Of whatever sort.
    Dendrite,
}

impl Part {
    /// Names in use: `apical_dends`, `basal0`, `Dend_3`, `axonal`, `Cell Body`. One of two kinds, as `soma_dends`, or of
    /// what is not there, as `no_axon`, says nothing.
    pub(crate) fn of_name(name: &str) -> Option<Self> {
        let name = name.to_ascii_lowercase();
        let mut words = name.split(|c: char| !c.is_ascii_alphabetic());
        let denies = |word| matches!(word, "no" | "non" | "not" | "but" | "without" | "except");
        if words.any(denies) || name.contains("perisoma") {
            return None;
        }
        let says = |word: &str| name.contains(word);
        let (apical, basal) = (says("apic"), says("basal"));
        let dendrite = apical || basal || says("dend");
        let letters: String = name.chars().filter(char::is_ascii_alphabetic).collect();
        let soma = says("soma") || letters.contains("cellbody");
        Some(match (soma, says("axon"), dendrite) {
            (true, false, false) => Self::Soma,
            (false, true, false) => Self::Axon,
            (false, false, true) if apical && !basal => Self::Apical,
            (false, false, true) if basal && !apical => Self::Basal,
            (false, false, true) => Self::Dendrite,
            _ => return None,
        })
    }

    pub(crate) fn kind(self) -> NeuriteKind {
        match self {
            Self::Apical => NeuriteKind::APICAL_DENDRITE,
            Self::Basal | Self::Dendrite => NeuriteKind::BASAL_DENDRITE,
            Self::Axon => NeuriteKind::AXON,
            Self::Soma => NeuriteKind::SOMA,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_one_kind_say_it() {
        for (name, part) in [
            ("soma_group", Some(Part::Soma)),
            ("Cell Body", Some(Part::Soma)),
            ("axon 12", Some(Part::Axon)),
            ("apical_dends", Some(Part::Apical)),
            ("basal0", Some(Part::Basal)),
            ("Dend_3", Some(Part::Dendrite)),
            ("basal_and_apical", Some(Part::Dendrite)),
            ("soma_dends", None),
            ("somatodendritic", None),
            ("all_but_axon", None),
            ("perisomatic", None),
            ("all", None),
        ] {
            assert_eq!(Part::of_name(name), part, "{name}");
        }
    }
}
