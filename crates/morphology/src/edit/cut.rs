//! Parts of a tracing that go: subtrees, types, twigs.
//!
//! Where a fork loses all children but one it is a fork no more, and the sections around it become one: that
//! comes from putting the nodes together again.

use super::nodes::{Edits, Nodes};
use super::root::below;
use super::{EditError, positive};
use crate::{Morphology, NeuriteKind};

pub(super) fn cut(
    morphology: &Morphology,
    nodes: &Nodes,
    samples: &[i64],
) -> Result<Edits, EditError> {
    let tops = nodes.find_all(samples)?;
    let mut kept = vec![true; nodes.nodes.len()];
    for &top in &tops {
        // One that hangs on another that was cut has gone with all below it.
        if kept[top] {
            let cut = below(nodes, top);
            kept.iter_mut()
                .zip(cut)
                .for_each(|(kept, cut)| *kept &= !cut);
        }
    }
    for top in tops {
        if let Some(first) = rest_of_soma(morphology, &kept, top) {
            return Err(EditError::PartOfSoma {
                sample: nodes.nodes[top].id,
                first,
            });
        }
    }
    Ok(remaining(nodes, &kept))
}

/// The number of the first sample of the soma that a sample is of, if some of that soma would stay. Half a soma
/// would be another one, with another center and radius.
fn rest_of_soma(morphology: &Morphology, kept: &[bool], sample: usize) -> Option<i64> {
    let mut first = 0;
    for soma in &morphology.somata {
        let of_soma = first..first + soma.samples.len();
        if of_soma.contains(&sample) {
            let root = soma.samples.iter().find(|sample| sample.parent.is_none());
            let stays = kept[of_soma].contains(&true);
            return root.filter(|_| stays).map(|root| root.id);
        }
        first = of_soma.end;
    }
    None
}

pub(super) fn drop_types(nodes: &Nodes, types: &[NeuriteKind]) -> Edits {
    let kept = nodes.nodes.iter().map(|node| !types.contains(&node.kind));
    remaining(nodes, &kept.collect::<Vec<bool>>())
}

pub(super) fn prune(nodes: &Nodes, length: f64) -> Result<Edits, EditError> {
    positive("the length of twigs", length)?;
    let mut children = vec![0_u32; nodes.nodes.len()];
    for parent in nodes.nodes.iter().filter_map(|node| node.parent) {
        children[parent as usize] += 1;
    }
    let mut kept = vec![true; nodes.nodes.len()];
    let mut twig = Vec::new();
    for end in (nodes.somata..nodes.nodes.len()).filter(|&i| children[i] == 0) {
        twig.clear();
        if twig_of(nodes, &children, end, &mut twig).is_some_and(|found| found < length) {
            twig.iter().for_each(|&node| kept[node] = false);
        }
    }
    Ok(remaining(nodes, &kept))
}

/// Collects the nodes of the twig that ends here, and gives its length (µm); none if nothing carries it.
fn twig_of(nodes: &Nodes, children: &[u32], end: usize, twig: &mut Vec<usize>) -> Option<f64> {
    let mut length = 0.0;
    let mut at = end;
    loop {
        twig.push(at);
        let parent = nodes.nodes[at].parent? as usize;
        if parent < nodes.somata {
            return Some(length);
        }
        let to = nodes.nodes[parent].position;
        length += nodes.nodes[at].position.distance(to);
        if children[parent] > 1 {
            return Some(length);
        }
        at = parent;
    }
}

fn remaining(nodes: &Nodes, kept: &[bool]) -> Edits {
    Edits {
        largest_move: Some(0.0),
        ..Edits::in_place(nodes.remaining(kept))
    }
}
