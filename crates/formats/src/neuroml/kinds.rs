//! What segments are, by the groups that they are in or by their names.
//!
//! Groups overlap: `all` has everything, a group for each channel has what the channel is in. So those that are
//! named exactly as the conventions of NeuroML say (`soma_group`, `axon_group`, `dendrite_group`) come first; of all
//! others the one with the fewest segments says most. A group named for two kinds (`soma_dends`) says nothing. Which
//! dendrite a segment is of may be told by other groups than that it is one.

use neurotess_morphology::NeuriteKind;

use super::members::Members;
use super::records::{Records, Segment};
use crate::named::Part;

/// What a group says of its segments. The least counts.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Word {
    /// How many segments the group has.
    size: usize,
    part: Part,
}

/// The best words on a segment so far.
#[derive(Clone, Copy, Default)]
struct Words {
    /// Of groups that are named as the conventions say.
    exact: Option<Word>,
    /// Of groups with a term of an ontology.
    term: Option<Word>,
    /// Of groups with a name that tells something.
    name: Option<Word>,
    /// Of whatever groups say which dendrite it is.
    dendrite: Option<Word>,
    /// Of groups of every segment, which tell none of them: less than names of segments.
    all: Option<Word>,
}

/// Kind of each segment, in order. `parents`: index of each one's parent.
pub(super) fn kinds(records: &Records, parents: &[Option<usize>]) -> Vec<NeuriteKind> {
    let mut members = Members::of(records, parents);
    let mut words = vec![Words::default(); records.segments.len()];
    for (i, group) in records.groups.iter().enumerate() {
        let exact = of_exact_name(&group.id);
        let term = of_term(&group.term);
        let Some(part) = exact.or(term).or_else(|| Part::of_name(&group.id)) else {
            continue;
        };
        let segments = members.all(i);
        let size = segments.len();
        let word = Word { size, part };
        for segment in segments {
            let known = &mut words[segment];
            put(
                match (exact, term) {
                    (Some(_), _) => &mut known.exact,
                    _ if size > 1 && size == records.segments.len() => &mut known.all,
                    (None, Some(_)) => &mut known.term,
                    (None, None) => &mut known.name,
                },
                word,
            );
            if matches!(part, Part::Apical | Part::Basal) {
                put(&mut known.dendrite, word);
            }
        }
    }
    let kind = |(i, segment): (usize, &Segment)| {
        let by_group = words[i].part();
        let named = by_group.or_else(|| Part::of_name(&segment.name));
        let part = named.or(words[i].all.map(|word| word.part));
        part.map_or(NeuriteKind::UNDEFINED, Part::kind)
    };
    records.segments.iter().enumerate().map(kind).collect()
}

fn put(place: &mut Option<Word>, word: Word) {
    if place.is_none_or(|known| word < known) {
        *place = Some(word);
    }
}

impl Words {
    fn part(&self) -> Option<Part> {
        let least = |a: Option<Word>, b: Option<Word>| a.into_iter().chain(b).min();
        // A smaller group with a term corrects one with the right name, such as a `dendrite_group` of all segments; a
        // mere name does not.
        let sure = least(self.exact, self.term);
        let word = match sure {
            Some(_) if sure == self.exact => sure,
            _ => least(sure, self.name),
        };
        match word?.part {
            Part::Dendrite => Some(self.dendrite.map_or(Part::Dendrite, |word| word.part)),
            part => Some(part),
        }
    }
}

/// Names that the conventions of NeuroML give.
fn of_exact_name(name: &str) -> Option<Part> {
    Some(match name {
        "soma_group" => Part::Soma,
        "axon_group" => Part::Axon,
        "dendrite_group" => Part::Dendrite,
        _ => return None,
    })
}

/// Terms of the Gene Ontology and of NeuroLex, as `segmentGroup` has them.
fn of_term(term: &str) -> Option<Part> {
    Some(match term.trim() {
        "GO:0097440" | "sao1186862860" => Part::Apical,
        "GO:0097441" | "sao1079900774" => Part::Basal,
        "GO:0030424" | "sao1770195789" => Part::Axon,
        "GO:0043025" | "sao1044911821" => Part::Soma,
        "GO:0030425" | "sao1211023249" => Part::Dendrite,
        _ => return None,
    })
}
