//! Habits of programs that write SWC, put into what the format says: types that are none.

use neurotess_morphology::{NeuriteKind, Node};

use super::rows::Records;
use crate::warning::Warnings;

/// The types of forks and of ends, as the first programs for SWC wrote them and navis still does.
const FORK: NeuriteKind = NeuriteKind(5);
const END: NeuriteKind = NeuriteKind(6);

/// Type 5 at forks alone and 6 at ends alone says nothing of what a neurite is: the parent's type does.
pub(super) fn fork_and_end_types(records: &mut Records, warnings: &mut Warnings) {
    let nodes = &records.nodes;
    if !nodes.iter().any(|node| [FORK, END].contains(&node.kind)) {
        return;
    }
    let mut children = vec![0_u32; nodes.len()];
    for parent in nodes.iter().filter_map(|node| node.parent) {
        children[parent as usize] = children[parent as usize].saturating_add(1);
    }
    let fits = |(node, &children): (&Node, &u32)| match node.kind {
        FORK => children >= 2,
        END => children == 0,
        _ => true,
    };
    if !nodes.iter().zip(&children).all(fits) {
        return;
    }
    let is_none = |kind: NeuriteKind| kind == FORK || kind == END;
    let mut count = 0;
    let mut first = u64::MAX;
    // The nearest ancestor with a type; a walk ends at one that has got its own.
    for index in 0..records.nodes.len() {
        if !is_none(records.nodes[index].kind) {
            continue;
        }
        let mut walked = vec![index];
        let mut kind = NeuriteKind::UNDEFINED;
        let mut at = records.nodes[index].parent;
        while let Some(parent) = at.map(|parent| parent as usize) {
            let node = &records.nodes[parent];
            if !is_none(node.kind) {
                // A fork on the soma is a neurite's.
                kind = match node.kind {
                    NeuriteKind::SOMA => NeuriteKind::UNDEFINED,
                    kind => kind,
                };
                break;
            }
            walked.push(parent);
            at = node.parent;
            if walked.len() > records.nodes.len() {
                // A cycle, which is told of later.
                break;
            }
        }
        for place in walked {
            records.nodes[place].kind = kind;
            first = first.min(u64::from(records.lines[place]));
            count += 1;
        }
    }
    let message = "types 5 at forks and 6 at ends alone: taken as the types of their parents";
    warnings.add_many(first, "fork_and_end_types", message, count);
}
