//! Parents and children: order, cycles, and hanging a tree up by another node.

use super::BuildError;

/// "No node" in arrays of indices.
pub(super) const NONE: u32 = u32::MAX;

/// Children of every node as linked lists in ascending order: eight bytes a node.
pub(super) struct Links {
    first_child: Vec<u32>,
    next_sibling: Vec<u32>,
}

impl Links {
    pub(super) fn of(parents: &[u32]) -> Self {
        let mut first_child = vec![NONE; parents.len()];
        let mut next_sibling = vec![NONE; parents.len()];
        for i in (0..parents.len()).rev() {
            let parent = parents[i];
            if parent != NONE {
                next_sibling[i] = first_child[parent as usize];
                first_child[parent as usize] = i as u32;
            }
        }
        Self {
            first_child,
            next_sibling,
        }
    }

    pub(super) fn children(&self, node: u32) -> impl Iterator<Item = u32> + '_ {
        let listed = |i: u32| (i != NONE).then_some(i);
        let first = listed(self.first_child[node as usize]);
        std::iter::successors(first, move |&i| listed(self.next_sibling[i as usize]))
    }

    pub(super) fn only_child(&self, node: u32) -> Option<u32> {
        let first = self.first_child[node as usize];
        (first != NONE && self.next_sibling[first as usize] == NONE).then_some(first)
    }
}

/// An order with parents before children; `None` if the given one is such.
///
/// # Errors
/// [`BuildError::Cycle`] if there is no such order.
pub(super) fn parents_first(
    parents: &[u32],
    links: &Links,
) -> Result<Option<Vec<u32>>, BuildError> {
    let in_order = |(i, &p): (usize, &u32)| p == NONE || (p as usize) < i;
    if parents.iter().enumerate().all(in_order) {
        return Ok(None);
    }
    let roots = (0_u32..).zip(parents).filter(|&(_, &p)| p == NONE);
    let mut order: Vec<u32> = roots.map(|(i, _)| i).collect();
    let mut next = 0;
    while let Some(&node) = order.get(next) {
        order.extend(links.children(node));
        next += 1;
    }
    if order.len() < parents.len() {
        return Err(BuildError::Cycle {
            node: first_in_cycle(parents, &order),
        });
    }
    Ok(Some(order))
}

/// Smallest index in a cycle, given all nodes that hang on a root.
fn first_in_cycle(parents: &[u32], rooted: &[u32]) -> u32 {
    let mut seen = vec![false; parents.len()];
    for &i in rooted {
        seen[i as usize] = true;
    }
    let mut at = seen.iter().position(|seen| !seen).unwrap_or(0);
    while !seen[at] {
        seen[at] = true;
        at = parents[at] as usize; // never NONE: what has a root was seen before
    }
    let mut least = at;
    let mut other = parents[at] as usize;
    while other != at {
        least = least.min(other);
        other = parents[other] as usize;
    }
    least as u32
}

/// Makes each of the nodes the root of its tree, turning round the links on its way up.
/// Tells whether any link was turned.
pub(super) fn hang_up_by(parents: &mut [u32], new_roots: &[u32]) -> bool {
    let mut turned = false;
    for &root in new_roots {
        let mut child = root;
        let mut at = std::mem::replace(&mut parents[root as usize], NONE);
        while at != NONE {
            let above = std::mem::replace(&mut parents[at as usize], child);
            child = at;
            at = above;
            turned = true;
        }
    }
    turned
}
