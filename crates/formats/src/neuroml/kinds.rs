//! What segments are, by the groups that they are in or by their names.

use std::collections::{HashMap, HashSet};

use neurotess_morphology::NeuriteKind;

use super::records::{Group, Records};

/// How much a word tells: the greater counts where groups overlap.
type Word = (u8, NeuriteKind);

/// Kind of each segment, in order.
pub(super) fn kinds(records: &Records) -> Vec<NeuriteKind> {
    let groups: HashMap<&str, &Group> = records.groups.iter().map(|g| (&*g.id, g)).collect();
    let mut of_segment: HashMap<i64, Word> = HashMap::new();
    for group in &records.groups {
        let Some(word) = of_term(&group.term).or_else(|| of_name(&group.id)) else {
            continue;
        };
        for id in members(group, &groups) {
            let known = of_segment.entry(id).or_insert(word);
            if word.0 > known.0 {
                *known = word;
            }
        }
    }
    let kind = |segment: &super::records::Segment| {
        let by_group = of_segment.get(&segment.id).copied();
        let word = by_group.or_else(|| of_name(&segment.name));
        word.map_or(NeuriteKind::UNDEFINED, |(_, kind)| kind)
    };
    records.segments.iter().map(kind).collect()
}

/// Segments of a group and of all that it includes; circles end.
fn members(group: &Group, groups: &HashMap<&str, &Group>) -> Vec<i64> {
    let mut members = Vec::new();
    let mut seen = HashSet::from([&*group.id]);
    let mut open = vec![group];
    while let Some(group) = open.pop() {
        members.extend(&group.members);
        for name in &group.includes {
            if let Some(&included) = groups.get(&**name)
                && seen.insert(name)
            {
                open.push(included);
            }
        }
    }
    members
}

/// Terms of the Gene Ontology and of NeuroLex, as `segmentGroup` has them.
fn of_term(term: &str) -> Option<Word> {
    Some(match term {
        "GO:0097440" | "sao1186862860" => (3, NeuriteKind::APICAL_DENDRITE),
        "GO:0097441" | "sao1079900774" => (3, NeuriteKind::BASAL_DENDRITE),
        "GO:0030424" | "sao1770195789" => (2, NeuriteKind::AXON),
        "GO:0043025" | "sao1044911821" => (2, NeuriteKind::SOMA),
        "GO:0030425" | "sao1211023249" => (1, NeuriteKind::BASAL_DENDRITE),
        _ => return None,
    })
}

/// Names in use: `soma_group`, `axon_group`, `apical_dends`, `dendrite_group`, `basal0`, `Dend_3`.
fn of_name(name: &str) -> Option<Word> {
    let name = name.to_ascii_lowercase();
    let says = |word: &str| name.contains(word);
    Some(match () {
        () if says("apic") => (3, NeuriteKind::APICAL_DENDRITE),
        () if says("basal") => (3, NeuriteKind::BASAL_DENDRITE),
        () if says("axon") => (2, NeuriteKind::AXON),
        () if says("soma") => (2, NeuriteKind::SOMA),
        () if says("dend") => (1, NeuriteKind::BASAL_DENDRITE),
        () => return None,
    })
}
