//! Which nodes a manifest lists, and in which order.
//!
//! Neuroglancer finds the children of a node by their order, and draws a level's node where the finer ones are not wanted.
//! A child that is listed without bytes hides its parent's part; one that is not listed leaves that on the screen; and one
//! whose parent is not listed never shows. So listed are:
//!
//! * nodes with triangles,
//! * nodes without, where the parent has triangles in their place,
//! * what is above a listed node.

use std::collections::BTreeSet;

use crate::cut::Part;

/// A node of a level by the order that files have: bits of x, y and z in turn, that of x the lowest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Node(u64);

impl Node {
    /// The node at a place.
    pub(crate) fn at(place: [u32; 3]) -> Self {
        let bit = |n: u32| {
            let of_axis = |axis: u32| u64::from(place[axis as usize] >> n & 1) << (3 * n + axis);
            of_axis(0) | of_axis(1) | of_axis(2)
        };
        Self((0..21).map(bit).fold(0, |all, bits| all | bits))
    }

    /// Its place.
    pub(crate) fn place(self) -> [u32; 3] {
        let of_axis = |axis: u32| {
            let bit = |n: u32| (self.0 >> (3 * n + axis) & 1) as u32;
            (0..21).map(|n| bit(n) << n).fold(0, |all, bits| all | bits)
        };
        [0, 1, 2].map(of_axis)
    }

    /// The child that a part of this level's node is.
    pub(crate) fn child(part: Part) -> Self {
        let along = |axis: usize| 2 * part.node[axis] + u32::from(part.upper[axis]);
        Self::at([0, 1, 2].map(along))
    }

    fn parent(self) -> Self {
        Self(self.0 >> 3)
    }
}

/// What a level has.
#[derive(Clone, Debug, Default)]
pub(crate) struct LevelNodes {
    /// Nodes with triangles.
    pub(crate) full: BTreeSet<Node>,
    /// Nodes of the next finer level in whose place this level has triangles.
    pub(crate) children: BTreeSet<Node>,
}

/// The nodes to list of each level, finest first, in the order of files.
pub(crate) fn listed(levels: &[LevelNodes]) -> Vec<BTreeSet<Node>> {
    let mut listed: Vec<BTreeSet<Node>> = levels.iter().map(|level| level.full.clone()).collect();
    for (finer, level) in levels.iter().skip(1).enumerate() {
        listed[finer].extend(&level.children);
    }
    for coarser in 1..listed.len() {
        let parents: Vec<Node> = listed[coarser - 1].iter().map(|n| n.parent()).collect();
        listed[coarser].extend(parents);
    }
    listed
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(places: &[[u32; 3]]) -> BTreeSet<Node> {
        places.iter().map(|&place| Node::at(place)).collect()
    }

    fn places(nodes: &BTreeSet<Node>) -> Vec<[u32; 3]> {
        nodes.iter().map(|node| node.place()).collect()
    }

    #[test]
    fn x_is_the_lowest_bit() {
        let all = [
            [1, 1, 0],
            [0, 0, 1],
            [2, 0, 0],
            [1, 0, 0],
            [0, 1, 0],
            [0, 0, 0],
        ];
        let ordered = [
            [0, 0, 0],
            [1, 0, 0],
            [0, 1, 0],
            [1, 1, 0],
            [0, 0, 1],
            [2, 0, 0],
        ];
        assert_eq!(places(&set(&all)), ordered);
        assert_eq!(Node::at([5, 6, 7]).parent(), Node::at([2, 3, 3]));
        let far = [1_000_000, 2, 2_000_000];
        assert_eq!(Node::at(far).place(), far);
    }

    #[test]
    fn a_cell_in_one_node_lists_no_empty_ones() {
        let one = LevelNodes {
            full: set(&[[0; 3]]),
            children: set(&[[0; 3]]),
        };
        let listed = listed(&[one.clone(), one.clone(), one]);
        assert!(listed.iter().all(|nodes| places(nodes) == [[0; 3]]));
    }

    #[test]
    fn empty_nodes_hide_their_parents_part_and_lead_to_children() {
        let finest = LevelNodes {
            full: set(&[[0, 0, 0], [3, 0, 0]]),
            children: set(&[]),
        };
        let coarsest = LevelNodes {
            full: set(&[[0, 0, 0]]),
            children: set(&[[0, 0, 0], [0, 1, 0]]),
        };
        let listed = listed(&[finest, coarsest]);
        // (0, 1, 0) has no triangles while its parent has some there; the parent of (3, 0, 0) has none at all.
        assert_eq!(places(&listed[0]), [[0, 0, 0], [0, 1, 0], [3, 0, 0]]);
        assert_eq!(places(&listed[1]), [[0, 0, 0], [1, 0, 0]]);
    }
}
