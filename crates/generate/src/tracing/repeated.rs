//! Branches that were traced more than once in the same place.
//!
//! Some files hold a branch two or three times, each copy hanging on the same fork. Their tubes would lie within one another.
//! So siblings in the same place become one, and then their children. Neurites that only begin in the same place are no
//! copies: their next points have to be so, too.

use std::collections::HashMap;

use super::skeleton::{NONE, Root, Skeleton, SkeletonNode};
use crate::warning::Warnings;

/// Leaves out all but one of the copies of a branch.
pub(crate) fn leave_out(skeleton: &mut Skeleton, warnings: &mut Warnings) {
    // What hangs on different copies is alike only once these are one.
    let mut is_again = false;
    loop {
        let copies = leave_out_once(skeleton);
        if copies.is_empty() {
            break;
        }
        for sample in copies.into_iter().filter(|_| !is_again) {
            warnings.add(
                "branch_repeated",
                Some(sample),
                "branch was traced before in the same place: one of them is meshed",
            );
        }
        is_again = true;
    }
}

/// Type and place, to the bit.
fn place(node: &SkeletonNode) -> (i32, [u64; 3]) {
    (node.kind.0, node.center.to_array().map(f64::to_bits))
}

/// The first samples of the copies.
fn leave_out_once(skeleton: &mut Skeleton) -> Vec<i64> {
    let children = skeleton.children();
    let node = |index: u32| skeleton.node(index);
    let child_at = |of: u32, at: &SkeletonNode| {
        let mut of = children.of(of).iter().copied();
        of.find(|&child| place(node(child)) == place(at))
    };
    // Copies, each with what it is a copy of.
    let mut copies: Vec<(u32, u32)> = Vec::new();
    let mut roots = HashMap::new();
    for (index, root) in (0..).zip(skeleton.nodes()) {
        if root.parent == NONE {
            let soma = match root.root {
                Root::Soma(soma) | Root::Insertion(soma) => Some(soma),
                Root::Free => None,
            };
            let first = *roots.entry((soma, place(root))).or_insert(index);
            let mut next = children.of(index).iter();
            let mut is_copy = || next.any(|&next| child_at(first, node(next)).is_some());
            if first != index && (children.of(index).is_empty() || is_copy()) {
                copies.push((first, index));
            }
        }
        let siblings = children.of(index);
        if siblings.len() > 1 {
            let mut at = HashMap::with_capacity(siblings.len());
            for &sibling in siblings {
                let first = *at.entry(place(node(sibling))).or_insert(sibling);
                if first != sibling {
                    copies.push((first, sibling));
                }
            }
        }
    }
    if copies.is_empty() {
        return Vec::new();
    }
    let samples = copies.iter().map(|&(_, copy)| node(copy).sample).collect();
    let mut is: Vec<u32> = (0..skeleton.nodes().len() as u32).collect();
    while let Some((first, copy)) = copies.pop() {
        if is[copy as usize] != copy || is[first as usize] != first {
            continue;
        }
        is[copy as usize] = first;
        let alike = |&next: &u32| Some((child_at(first, node(next))?, next));
        copies.extend(children.of(copy).iter().filter_map(alike));
    }
    let keep: Vec<bool> = (0..).zip(&is).map(|(index, &is)| index == is).collect();
    for node in skeleton
        .links()
        .iter_mut()
        .filter(|node| node.parent != NONE)
    {
        node.parent = is[node.parent as usize];
    }
    skeleton.cut(&keep);
    skeleton.reorder();
    samples
}
