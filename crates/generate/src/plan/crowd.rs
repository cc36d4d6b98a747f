//! Crowded forks, whose branches are too close for one joint, split over several forks that short
//! segments join.
//!
//! Up to [`MOST_PAIRED`] neighbors the nearest pair moves to a new fork, again and again. Beyond, the
//! children are halved by direction, so that thousands of them take n log n steps.

use std::collections::{BTreeSet, HashMap};

use glam::DVec3;

use crate::plan::joint::plane;
use crate::tracing::{Children, NONE, Root, Skeleton, SkeletonNode};
use crate::warning::Warnings;

/// Least angle about the joint's normal between two of four or more neighbors (radians).
const LEAST_ANGLE: f64 = 0.35;
/// More neighbors than this are split over several joints.
const MOST_NEIGHBORS: usize = 6;
/// More neighbors than this are halved: pairing takes the cube of them.
const MOST_PAIRED: usize = 24;

/// Splits forks of four and more neighbors until their branches are far enough apart for a joint. Each split takes
/// neighbors from a fork and makes one of three, which is never split, so that this ends.
pub(crate) fn split_crowded_forks(skeleton: &mut Skeleton, warnings: &mut Warnings) {
    let children = skeleton.children();
    let branches = |fork: &u32| children.of(*fork).len() > 2;
    let mut pending: BTreeSet<u32> = (0..skeleton.nodes().len() as u32)
        .filter(branches)
        .collect();
    let mut tree = Tree::new(skeleton);
    while !pending.is_empty() {
        let mut touched = BTreeSet::new();
        for fork in std::mem::take(&mut pending) {
            if tree.split(fork, &mut touched) {
                warnings.add(
                    "fork_split",
                    Some(tree.nodes[fork as usize].sample),
                    "fork with branches too close to tell apart: split in two by a short segment",
                );
            }
        }
        pending = touched;
    }
    let changed = !tree.changed.is_empty();
    *skeleton = Skeleton::from_nodes(tree.nodes);
    if changed {
        skeleton.reorder();
    }
}

/// Nodes with the lists of their children, which change together and here alone.
struct Tree {
    nodes: Vec<SkeletonNode>,
    /// Children of the nodes as they were, but for those in `changed`.
    before: Children,
    changed: HashMap<u32, Vec<u32>>,
}

impl Tree {
    fn new(skeleton: &mut Skeleton) -> Self {
        let (nodes, before) = skeleton.take_apart();
        Self {
            nodes,
            before,
            changed: HashMap::new(),
        }
    }

    fn children(&self, node: u32) -> &[u32] {
        match self.changed.get(&node) {
            Some(children) => children,
            None => self.before.of(node),
        }
    }

    fn children_mut(&mut self, node: u32) -> &mut Vec<u32> {
        let before = &self.before;
        let children = self.changed.entry(node);
        children.or_insert_with(|| before.of(node).to_vec())
    }

    /// Splits a fork once if it is crowded; the forks that see another neighbor now go to `touched`.
    fn split(&mut self, fork: u32, touched: &mut BTreeSet<u32>) -> bool {
        let parent = Some(self.nodes[fork as usize].parent).filter(|&p| p != NONE);
        let children = self.children(fork).iter().copied();
        let around: Vec<u32> = parent.into_iter().chain(children).collect();
        if around.len() < 4 {
            return false;
        }
        let directions: Vec<DVec3> = around.iter().map(|&n| self.direction(fork, n)).collect();
        if around.len() > MOST_PAIRED {
            self.halve_all(fork, touched);
        } else if around.len() > MOST_NEIGHBORS || plane(&directions).1 < LEAST_ANGLE {
            let pair = nearest_pair(&directions).map(|slot| around[slot]);
            let new = self.branch_off(fork, &pair, &pair.map(|n| self.direction(fork, n)));
            touched.extend([fork, new].into_iter().chain(pair));
        } else {
            return false;
        }
        true
    }

    fn direction(&self, from: u32, to: u32) -> DVec3 {
        let way = self.nodes[to as usize].center - self.nodes[from as usize].center;
        way.try_normalize().unwrap_or(DVec3::Y)
    }

    /// Halves a fork, and the forks that come of it, until each is small enough to be paired. All at once:
    /// a branch that is paired with this fork searches the list of its children.
    fn halve_all(&mut self, fork: u32, touched: &mut BTreeSet<u32>) {
        let mut large = vec![fork];
        while let Some(fork) = large.pop() {
            let parent = Some(self.nodes[fork as usize].parent).filter(|&p| p != NONE);
            let children = self.children(fork).to_vec();
            // Without a parent one child stays: a fork of two branches would be a path.
            let moved = &children[usize::from(parent.is_none())..];
            for new in self.halve(fork, moved) {
                match self.children(new).len() < MOST_PAIRED {
                    true => touched.extend(self.children(new).iter().copied().chain([new])),
                    false => large.push(new),
                }
            }
            touched.insert(fork);
        }
    }

    /// Moves children to two new forks, by the axis along which their directions differ most.
    fn halve(&mut self, fork: u32, children: &[u32]) -> [u32; 2] {
        let directions: Vec<DVec3> = children.iter().map(|&n| self.direction(fork, n)).collect();
        let axis = widest_axis(&directions);
        let mut slots: Vec<usize> = (0..children.len()).collect();
        let middle = slots.len() / 2;
        slots.select_nth_unstable_by(middle, |&a, &b| {
            let along = directions[a][axis].total_cmp(&directions[b][axis]);
            along.then(a.cmp(&b))
        });
        let (low, high) = slots.split_at_mut(middle);
        [low, high].map(|half| {
            half.sort_unstable(); // children keep their order
            let nodes: Vec<u32> = half.iter().map(|&slot| children[slot]).collect();
            let directions: Vec<DVec3> = half.iter().map(|&slot| directions[slot]).collect();
            self.branch_off(fork, &nodes, &directions)
        })
    }

    /// Moves neighbors of a fork, its parent perhaps the first of them, to a new fork a little way
    /// towards them.
    fn branch_off(&mut self, fork: u32, neighbors: &[u32], directions: &[DVec3]) -> u32 {
        let at = self.nodes[fork as usize];
        let distance = |&n: &u32| self.nodes[n as usize].center.distance(at.center);
        let shortest = neighbors.iter().map(distance).fold(f64::INFINITY, f64::min);
        let mean = directions.iter().sum::<DVec3>().try_normalize();
        let towards = mean.unwrap_or(directions[0]);
        let new = self.nodes.len() as u32;
        let between = neighbors[0] == at.parent;
        self.nodes.push(SkeletonNode {
            center: at.center + towards * (1.2 * at.radius).min(0.4 * shortest),
            parent: if between { at.parent } else { fork },
            root: Root::Free,
            ..at
        });
        let moved = if between { &neighbors[1..] } else { neighbors };
        for &node in moved {
            self.nodes[node as usize].parent = new;
        }
        let moved_set: BTreeSet<u32> = moved.iter().copied().collect();
        let left = self.children_mut(fork);
        left.retain(|child| !moved_set.contains(child));
        if between {
            // The new fork lies between the parent and the old one.
            self.nodes[fork as usize].parent = new;
            let siblings = self.children_mut(at.parent);
            siblings.retain(|&child| child != fork);
            siblings.push(new);
            let children = std::iter::once(fork).chain(moved.iter().copied());
            self.changed.insert(new, children.collect());
        } else {
            left.push(new);
            self.changed.insert(new, moved.to_vec());
        }
        new
    }
}

/// The pair of directions that enclose the least angle.
fn nearest_pair(directions: &[DVec3]) -> [usize; 2] {
    let (mut pair, mut nearest) = ([0, 1], f64::NEG_INFINITY);
    for a in 0..directions.len() {
        for b in a + 1..directions.len() {
            let near = directions[a].dot(directions[b]);
            if near > nearest {
                (pair, nearest) = ([a, b], near);
            }
        }
    }
    pair
}

/// The axis along which directions differ most.
fn widest_axis(directions: &[DVec3]) -> usize {
    let low = directions.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = directions
        .iter()
        .copied()
        .fold(DVec3::NEG_INFINITY, DVec3::max);
    let extent = high - low;
    let axes = [0, 1, 2].into_iter();
    axes.max_by(|&a, &b| extent[a].total_cmp(&extent[b]))
        .expect("there are three axes")
}
