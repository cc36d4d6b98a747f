//! The parts of a skeleton around some forks, as trees of their own.

use crate::skeleton::{NONE, Root, Skeleton, SkeletonNode};

/// Nodes that are kept up and down the tree from a fork. Zones, joints and the patches that are judged
/// reach over a few of them.
const STEPS: u32 = 12;

/// Part of a skeleton.
pub(crate) struct Neighborhood {
    pub(crate) skeleton: Skeleton,
    /// By node: that of the whole skeleton.
    pub(crate) nodes: Vec<u32>,
}

impl Neighborhood {
    /// What lies within [`STEPS`] nodes of a fork.
    pub(crate) fn new(whole: &Skeleton, forks: &[u32]) -> Self {
        let keep = kept(whole, forks);
        let mut new_index = vec![NONE; keep.len()];
        let (mut nodes, mut old) = (Vec::new(), Vec::new());
        for (index, _) in keep.iter().enumerate().filter(|(_, keep)| **keep) {
            let node = whole.node(index as u32);
            new_index[index] = old.len() as u32;
            old.push(index as u32);
            let parent = match node.parent {
                NONE => NONE,
                parent => new_index[parent as usize],
            };
            nodes.push(SkeletonNode {
                parent,
                root: Root::Free,
                ..*node
            });
        }
        Self {
            skeleton: Skeleton::from_nodes(nodes),
            nodes: old,
        }
    }
}

fn kept(whole: &Skeleton, forks: &[u32]) -> Vec<bool> {
    let children = whole.children();
    let mut keep = vec![false; whole.nodes().len()];
    // Steps that are left from each node downwards.
    let mut left = vec![0; keep.len()];
    for &fork in forks {
        left[fork as usize] = STEPS;
        let mut here = fork;
        let mut steps = 0;
        // A tree must not begin with a fork that is none at the beginning of the whole.
        while here != NONE && (steps <= STEPS || children.of(here).len() > 1) {
            // From here on another fork has kept all that this one needs.
            if steps > STEPS && keep[here as usize] {
                break;
            }
            keep[here as usize] = true;
            here = whole.node(here).parent;
            steps += 1;
        }
        if here != NONE {
            keep[here as usize] = true;
        }
    }
    // Parents come first.
    for (index, node) in whole.nodes().iter().enumerate() {
        if node.parent != NONE && left[node.parent as usize] > 0 {
            keep[index] = true;
            left[index] = left[index].max(left[node.parent as usize] - 1);
        }
    }
    keep
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use neurotess_mesh::{SectionNumber, SwcType};

    use super::*;
    use crate::skeleton::Marks;

    /// A path of 100 nodes with a twig of 20 at node 50.
    fn tree() -> Skeleton {
        let node = |parent: u32, sample: i64| SkeletonNode {
            center: DVec3::X * sample as f64,
            radius: 1.0,
            parent,
            root: Root::Free,
            sample,
            kind: SwcType(3),
            section: SectionNumber(1),
            marks: Marks::default(),
        };
        let mut nodes: Vec<SkeletonNode> = (0..100_u32)
            .map(|i| node(i.checked_sub(1).unwrap_or(NONE), i.into()))
            .collect();
        nodes.extend((0..20_u32).map(|i| node(if i == 0 { 50 } else { 99 + i }, (100 + i).into())));
        Skeleton::from_nodes(nodes)
    }

    #[test]
    fn a_fork_keeps_what_is_near_it() {
        let near = Neighborhood::new(&tree(), &[50]);
        let steps = STEPS as usize;
        // Up, with one more as the root, the fork, and down both ways.
        assert_eq!(near.nodes.len(), (steps + 1) + 1 + 2 * steps);
        let roots = near.skeleton.nodes().iter().filter(|n| n.parent == NONE);
        assert_eq!(roots.count(), 1);
        let fork = near
            .nodes
            .iter()
            .position(|&n| n == 50)
            .expect("it is kept");
        assert_eq!(near.skeleton.children().of(fork as u32).len(), 2);
    }

    #[test]
    fn forks_keep_together_what_each_keeps_alone() {
        let mut nodes: Vec<SkeletonNode> = tree().nodes().to_vec();
        // Twigs at every node of a stretch, and some more beyond.
        for fork in (20..60).chain([75, 76, 90]) {
            nodes.push(SkeletonNode {
                parent: fork,
                ..nodes[fork as usize]
            });
        }
        let whole = Skeleton::from_nodes(nodes);
        let forks: Vec<u32> = (0..100)
            .filter(|&node| whole.children().of(node).len() > 1)
            .collect();
        assert_eq!(forks.len(), 43);
        let alone = forks.iter().map(|&fork| kept(&whole, &[fork]));
        let either = |a: Vec<bool>, b: Vec<bool>| a.iter().zip(b).map(|(a, b)| *a || b).collect();
        let expected: Vec<bool> = alone.reduce(either).expect("there are forks");
        assert_eq!(kept(&whole, &forks), expected);
    }

    #[test]
    fn links_are_those_of_the_whole() {
        let whole = tree();
        let near = Neighborhood::new(&whole, &[50]);
        for (index, node) in near.skeleton.nodes().iter().enumerate() {
            if node.parent != NONE {
                let parent = near.nodes[node.parent as usize];
                assert_eq!(whole.node(near.nodes[index]).parent, parent);
            }
        }
    }
}
