//! Boxes in a tree: which of them overlap another one.

use glam::DVec3;

/// Boxes of a leaf.
const LEAF: usize = 4;

/// Boxes by the halves that their middles are in, each half with its own box.
pub(super) struct Boxes {
    /// In the order of the tree: the box's number and corners.
    boxes: Vec<(u32, [DVec3; 2])>,
    /// Of the root, its first half with all of that one's, and so on.
    nodes: Vec<Node>,
}

struct Node {
    bounds: [DVec3; 2],
    /// Which of `boxes` are in it.
    first: usize,
    end: usize,
    /// Nodes up to the next one that is not within it.
    size: usize,
}

impl Boxes {
    pub(super) fn new(boxes: impl IntoIterator<Item = [DVec3; 2]>) -> Self {
        let mut tree = Self {
            boxes: (0..).zip(boxes).collect(),
            nodes: Vec::new(),
        };
        tree.add(0, tree.boxes.len());
        tree
    }

    fn add(&mut self, first: usize, end: usize) {
        let within = &mut self.boxes[first..end];
        let bounds = within.iter().fold(
            [DVec3::INFINITY, DVec3::NEG_INFINITY],
            |[low, high], (_, [from, to])| [low.min(*from), high.max(*to)],
        );
        let at = self.nodes.len();
        self.nodes.push(Node {
            bounds,
            first,
            end,
            size: 1,
        });
        if end - first > LEAF {
            let size = (bounds[1] - bounds[0]).to_array();
            let longest = (0..3).fold(0, |k, axis| if size[axis] > size[k] { axis } else { k });
            let middle = |(_, [from, to]): &(u32, [DVec3; 2])| (*from + *to).to_array()[longest];
            let half = within.len() / 2;
            within.select_nth_unstable_by(half, |a, b| {
                middle(a).total_cmp(&middle(b)).then(a.0.cmp(&b.0))
            });
            self.add(first, first + half);
            self.add(first + half, end);
            self.nodes[at].size = self.nodes.len() - at;
        }
    }

    /// Puts the numbers of those that overlap a box into `found`.
    pub(super) fn overlapping(&self, with: [DVec3; 2], found: &mut Vec<u32>) {
        let overlap =
            |[low, high]: [DVec3; 2]| low.cmple(with[1]).all() && high.cmpge(with[0]).all();
        found.clear();
        let mut at = 0;
        while let Some(node) = self.nodes.get(at) {
            if !overlap(node.bounds) {
                at += node.size;
                continue;
            }
            if node.size == 1 {
                let here = self.boxes[node.first..node.end].iter();
                found.extend(here.filter(|(_, b)| overlap(*b)).map(|(number, _)| number));
            }
            at += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn found_are_those_that_overlap() {
        let boxes: Vec<[DVec3; 2]> = (0..100)
            .map(|k| {
                let [u, v, w] = [0.618, 0.755, 0.569].map(|step| (f64::from(k) * step).fract());
                let low = DVec3::new(u, v, w);
                [low, low + 0.3 * DVec3::new(v, w, u)]
            })
            .collect();
        let tree = Boxes::new(boxes.iter().copied());
        let mut found = Vec::new();
        for with in &boxes {
            tree.overlapping(*with, &mut found);
            found.sort_unstable();
            let all = (0..100_u32).filter(|&k| {
                let [low, high] = boxes[k as usize];
                low.cmple(with[1]).all() && high.cmpge(with[0]).all()
            });
            assert_eq!(found, all.collect::<Vec<_>>());
        }
    }

    #[test]
    fn none_are_found_among_none() {
        let mut found = vec![1];
        Boxes::new([]).overlapping([DVec3::ZERO, DVec3::ONE], &mut found);
        assert!(found.is_empty());
    }
}
