//! Where trees begin: another root, or a part of the tree alone.

use super::EditError;
use super::nodes::{Edits, Nodes};
use crate::Node;

pub(super) fn reroot(nodes: &Nodes, sample: i64) -> Result<Edits, EditError> {
    let root = nodes.find(sample)?;
    let (tree, _) = nodes.trees();
    if tree[..nodes.somata].contains(&tree[root]) {
        return Err(EditError::RootIsSoma { sample });
    }
    let mut edited = nodes.nodes.clone();
    hang_up(&mut edited, root);
    Ok(Edits::in_place(edited))
}

/// Makes a node the root of its tree, by turning round the links on its way up.
pub(super) fn hang_up(nodes: &mut [Node], root: usize) {
    let mut child = root as u32;
    let mut above = nodes[root].parent.take();
    while let Some(at) = above {
        above = nodes[at as usize].parent.replace(child);
        child = at;
    }
}

pub(super) fn subtree(nodes: &Nodes, sample: i64) -> Result<Edits, EditError> {
    let top = nodes.find(sample)?;
    let kept = below(nodes, top);
    Ok(Edits {
        largest_move: Some(0.0),
        ..Edits::in_place(nodes.remaining(&kept))
    })
}

/// Which nodes hang on one, itself among them.
pub(super) fn below(nodes: &Nodes, top: usize) -> Vec<bool> {
    #[derive(Clone, Copy, PartialEq)]
    enum Known {
        Not,
        Below,
        Beside,
    }
    let mut known = vec![Known::Not; nodes.nodes.len()];
    known[top] = Known::Below;
    let mut way = Vec::new();
    for node in 0..known.len() {
        let mut at = Some(node);
        let found = loop {
            match at.map(|i| (i, known[i])) {
                None => break Known::Beside,
                Some((i, Known::Not)) => {
                    way.push(i);
                    at = nodes.nodes[i].parent.map(|p| p as usize);
                }
                Some((_, answer)) => break answer,
            }
        };
        for step in way.drain(..) {
            known[step] = found;
        }
    }
    known.into_iter().map(|k| k == Known::Below).collect()
}
