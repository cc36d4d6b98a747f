//! The parts of a skeleton around some forks, as trees of their own.

use crate::tracing::{NONE, Root, Skeleton, SkeletonNode};

/// Nodes that are kept up and down the tree from a fork. Zones, joints and the patches that are judged
/// reach over a few of them.
const STEPS: u32 = 12;

/// Nodes from which on a part is large enough to be worth a thread.
const PART: usize = 250;

/// Part of a skeleton.
pub(crate) struct Neighborhood {
    pub(crate) skeleton: Skeleton,
    /// By node: that of the whole skeleton.
    pub(crate) nodes: Vec<u32>,
}

impl Neighborhood {
    /// What lies within [`STEPS`] nodes of forks, in parts of whole trees.
    pub(crate) fn parts(whole: &Skeleton, forks: &[u32]) -> Vec<Self> {
        let keep = kept(whole, forks);
        let part_of = parts_of_trees(whole, &keep);
        let count = part_of.iter().filter(|&&part| part != NONE).max();
        let count = count.map_or(0, |&last| last as usize + 1);
        let mut parts = vec![(Vec::new(), Vec::new()); count];
        let mut new_index = vec![NONE; keep.len()];
        for (index, &part) in part_of
            .iter()
            .enumerate()
            .filter(|(_, part)| **part != NONE)
        {
            let node = whole.node(index as u32);
            let (nodes, old) = &mut parts[part as usize];
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
        let parts = parts.into_iter().map(|(skeleton, nodes)| Self {
            skeleton: Skeleton::from_nodes(skeleton),
            nodes,
        });
        parts.collect()
    }
}

/// By node: the number of its part, [`NONE`] of nodes that are not kept. Trees in the order of their roots fill one
/// part after the other.
fn parts_of_trees(whole: &Skeleton, keep: &[bool]) -> Vec<u32> {
    // Tree of each node, and nodes of each tree.
    let mut of = vec![NONE; keep.len()];
    let mut sizes: Vec<usize> = Vec::new();
    for (index, _) in keep.iter().enumerate().filter(|(_, keep)| **keep) {
        let parent = whole.node(index as u32).parent;
        let above = of.get(parent as usize).copied().unwrap_or(NONE);
        of[index] = match above {
            NONE => sizes.len() as u32,
            tree => tree,
        };
        if above == NONE {
            sizes.push(0);
        }
        sizes[of[index] as usize] += 1;
    }
    let (mut part, mut filled) = (0, 0);
    let parts = sizes.into_iter().map(|size| {
        if filled >= PART {
            (part, filled) = (part + 1, 0);
        }
        filled += size;
        part
    });
    let parts: Vec<u32> = parts.collect();
    for tree in of.iter_mut().filter(|tree| **tree != NONE) {
        *tree = parts[*tree as usize];
    }
    of
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
        };
        let mut nodes: Vec<SkeletonNode> = (0..100_u32)
            .map(|i| node(i.checked_sub(1).unwrap_or(NONE), i.into()))
            .collect();
        nodes.extend((0..20_u32).map(|i| node(if i == 0 { 50 } else { 99 + i }, (100 + i).into())));
        Skeleton::from_nodes(nodes)
    }

    fn only_part(whole: &Skeleton, forks: &[u32]) -> Neighborhood {
        let mut parts = Neighborhood::parts(whole, forks);
        assert_eq!(parts.len(), 1);
        parts.remove(0)
    }

    #[test]
    fn parts_are_of_whole_trees() {
        // Twigs in turn at nodes of two paths that are as long as a part and a half.
        let length = 3 * PART as u32 / 2;
        let path = tree().nodes()[0];
        let node = |parent: u32| SkeletonNode { parent, ..path };
        let paths = [0, length].map(|first| (0..length).map(move |i| (first + i, i)));
        let paths = paths.into_iter().flatten();
        let mut nodes: Vec<SkeletonNode> = paths
            .map(|(index, i)| node(if i == 0 { NONE } else { index - 1 }))
            .collect();
        let forks: Vec<u32> = (5..length)
            .step_by(10)
            .flat_map(|i| [i, length + i])
            .collect();
        nodes.extend(forks.iter().map(|&fork| node(fork)));
        let whole = Skeleton::from_nodes(nodes);
        let parts = Neighborhood::parts(&whole, &forks);
        assert_eq!(parts.len(), 2);
        for part in &parts {
            let roots = part.skeleton.nodes().iter().filter(|n| n.parent == NONE);
            assert_eq!(roots.count(), 1);
        }
        let keep = kept(&whole, &forks);
        let mut nodes: Vec<u32> = parts.iter().flat_map(|part| part.nodes.clone()).collect();
        nodes.sort_unstable();
        let expected = (0..whole.nodes().len() as u32).filter(|&node| keep[node as usize]);
        assert!(nodes.into_iter().eq(expected));
    }

    #[test]
    fn a_fork_keeps_what_is_near_it() {
        let near = only_part(&tree(), &[50]);
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
        let near = only_part(&whole, &[50]);
        for (index, node) in near.skeleton.nodes().iter().enumerate() {
            if node.parent != NONE {
                let parent = near.nodes[node.parent as usize];
                assert_eq!(whole.node(near.nodes[index]).parent, parent);
            }
        }
    }
}
