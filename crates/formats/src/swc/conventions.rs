//! Habits of programs that write SWC, put into what the format says: types that are none, one soma written for each of
//! its neurites, neurites that begin in a soma and hang on nothing.

use glam::DVec3;
use neurotess_morphology::{NeuriteKind, Node};

use super::rows::Records;
use crate::warning::Warnings;

/// The types of forks and of ends, as the first programs for SWC wrote them and navis still does.
const FORK: NeuriteKind = NeuriteKind(5);
const END: NeuriteKind = NeuriteKind(6);

/// Two somata whose centers are nearer than this share of the larger radius are one: no two cells share so much.
const ONE_SOMA: f64 = 0.5;
/// Somata that others are compared with: a file with more has others than neurons.
const MOST_SOMATA: usize = 64;

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

/// A soma that is written once for each of its neurites is one soma.
pub(super) fn coincident_somata(records: &mut Records, warnings: &mut Warnings) {
    let nodes = &records.nodes;
    let is_root_soma = |node: &Node| node.kind == NeuriteKind::SOMA && node.parent.is_none();
    if nodes.iter().filter(|node| is_root_soma(node)).count() < 2 {
        return;
    }
    // By node: the one that it is a copy of.
    let mut same: Vec<Option<u32>> = vec![None; nodes.len()];
    let mut somata: Vec<u32> = Vec::new();
    for (index, node) in (0_u32..).zip(nodes).filter(|(_, node)| is_root_soma(node)) {
        let is_same = |&&other: &&u32| {
            let other = &nodes[other as usize];
            let reach = ONE_SOMA * node.radius.max(other.radius);
            node.position == other.position || node.position.distance(other.position) < reach
        };
        match somata.iter().find(is_same) {
            Some(&other) => same[index as usize] = Some(other),
            None if somata.len() < MOST_SOMATA => somata.push(index),
            None => {}
        }
    }
    // Samples of a copy that lie where the first soma has one, as of three points.
    for index in 0..nodes.len() {
        let node = &nodes[index];
        let Some(parent) = node.parent else { continue };
        let (Some(first), NeuriteKind::SOMA) = (same[parent as usize], node.kind) else {
            continue;
        };
        let of_first = |(_, other): &(u32, &Node)| {
            other.kind == NeuriteKind::SOMA
                && (other.parent == Some(first))
                && other.position == node.position
        };
        same[index] = (0..).zip(nodes).find(of_first).map(|(other, _)| other);
    }
    let copies = same.iter().filter(|same| same.is_some()).count();
    if copies == 0 {
        return;
    }
    let first = same.iter().position(Option::is_some).unwrap_or_default();
    let message = "somata in the same place: taken as one";
    warnings.add_many(
        u64::from(records.lines[first]),
        "coincident_somata",
        message,
        copies as u64,
    );
    leave_out(records, &same);
}

/// Leaves out nodes that stand for others, whose children move there.
fn leave_out(records: &mut Records, same: &[Option<u32>]) {
    let mut new_index = Vec::with_capacity(same.len());
    let mut next = 0;
    for same in same {
        new_index.push(next);
        next += u32::from(same.is_none());
    }
    let now = |index: u32| match same[index as usize] {
        Some(other) => new_index[other as usize],
        None => new_index[index as usize],
    };
    for node in &mut records.nodes {
        node.parent = node.parent.map(now);
    }
    let mut kept = same.iter().map(Option::is_none);
    records.nodes.retain(|_| kept.next().unwrap_or(true));
    let mut kept = same.iter().map(Option::is_none);
    records.lines.retain(|_| kept.next().unwrap_or(true));
}

/// Neurites that begin within a soma and hang on nothing hang on it.
pub(super) fn roots_in_somata(records: &mut Records, warnings: &mut Warnings) {
    let nodes = &records.nodes;
    let is_soma = |node: &Node| node.kind == NeuriteKind::SOMA;
    let somata: Vec<(u32, DVec3, f64)> = (0_u32..)
        .zip(nodes)
        .filter(|(_, node)| is_soma(node) && node.radius > 0.0)
        .map(|(index, node)| (index, node.position, node.radius))
        .take(MOST_SOMATA)
        .collect();
    if somata.is_empty() {
        return;
    }
    let mut moved = Vec::new();
    for (index, node) in (0_u32..).zip(nodes) {
        if node.parent.is_some() || is_soma(node) {
            continue;
        }
        let holds =
            |&&(_, center, radius): &&(u32, DVec3, f64)| node.position.distance(center) <= radius;
        if let Some(&(soma, ..)) = somata.iter().find(holds) {
            moved.push((index, soma));
        }
    }
    for (index, soma) in moved {
        records.nodes[index as usize].parent = Some(soma);
        let message =
            "neurites that begin within the soma and hang on nothing: taken as the soma's";
        let line = u64::from(records.lines[index as usize]);
        warnings.add(line, "root_in_soma", message);
    }
}
