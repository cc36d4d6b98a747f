//! `--types`

use std::str::FromStr;

use neurotess::morphology::NeuriteKind;

/// The types that one word of `--types` keeps.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Types(pub(crate) Vec<NeuriteKind>);

impl FromStr for Types {
    type Err = String;

    fn from_str(word: &str) -> Result<Self, String> {
        let kinds = match word.to_ascii_lowercase().as_str() {
            "axon" => vec![NeuriteKind::AXON],
            "basal" | "basal_dendrite" => vec![NeuriteKind::BASAL_DENDRITE],
            "apical" | "apical_dendrite" => vec![NeuriteKind::APICAL_DENDRITE],
            "dendrite" => vec![NeuriteKind::BASAL_DENDRITE, NeuriteKind::APICAL_DENDRITE],
            "undefined" => vec![NeuriteKind::UNDEFINED],
            other => {
                let number = other.strip_prefix("custom_").unwrap_or(other).parse();
                let unknown = "use axon, basal, apical, dendrite, undefined, custom_N or a number";
                vec![NeuriteKind(number.map_err(|_| unknown.to_owned())?)]
            }
        };
        Ok(Self(kinds))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn types_have_names_and_numbers() {
        let of = |word: &str| word.parse::<Types>().map(|t| t.0);
        assert_eq!(of("Axon"), Ok(vec![NeuriteKind(2)]));
        assert_eq!(of("custom_9"), Ok(vec![NeuriteKind(9)]));
        assert_eq!(of("4"), of("apical"));
        assert_eq!(of("dendrite").map(|k| k.len()), Ok(2));
        assert!(of("branch").is_err());
    }
}
