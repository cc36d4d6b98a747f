//! Nested dissection: an order of elimination that leaves most of a factor zero.
//!
//! **Theory.** A layer of nodes that parts all others in two, eliminated after them, keeps the two from
//! filling one another; and so on within each (George, Nested dissection of a regular finite element
//! mesh, SIAM J. Numer. Anal. 10(2), 1973). The nodes are points in space: a layer is what touches the
//! other side of a plane. Of 13 planes through the median the one is taken that parts best.

use glam::DVec3;

use super::{Clique, NO_NODE};

/// Nodes that are not parted further.
const MIN_PARTED: usize = 24;

/// Which nodes share an equation.
pub(crate) struct Neighbors {
    start: Vec<usize>,
    list: Vec<u32>,
}

impl Neighbors {
    /// Of so many nodes, those that are in a clique together.
    pub(crate) fn new(nodes: usize, cliques: &[Clique]) -> Self {
        let pairs = |clique: &Clique| {
            let nodes = clique.map(|node| (node != NO_NODE).then_some(node));
            let pairs = nodes.map(|a| nodes.map(|b| a.zip(b).filter(|(a, b)| a != b)));
            pairs.into_iter().flatten().flatten()
        };
        let mut start = vec![0_usize; nodes + 1];
        for (a, _) in cliques.iter().flat_map(pairs) {
            start[a as usize + 1] += 1;
        }
        for node in 1..start.len() {
            start[node] += start[node - 1];
        }
        let mut next = start.clone();
        let mut all = vec![0_u32; start[nodes]];
        for (a, b) in cliques.iter().flat_map(pairs) {
            all[next[a as usize]] = b;
            next[a as usize] += 1;
        }
        let mut list = Vec::with_capacity(start[nodes] / 3);
        for node in 0..nodes {
            let own = &mut all[start[node]..next[node]];
            own.sort_unstable();
            start[node] = list.len();
            let repeats = |at: usize| at > 0 && own[at] == own[at - 1];
            list.extend((0..own.len()).filter(|&at| !repeats(at)).map(|at| own[at]));
        }
        start[nodes] = list.len();
        Self { start, list }
    }

    pub(crate) fn of(&self, node: u32) -> &[u32] {
        &self.list[self.start[node as usize]..self.start[node as usize + 1]]
    }
}

/// Nodes that are eliminated together.
pub(crate) struct Group {
    pub(crate) nodes: Vec<u32>,
    /// Numbers of the groups that these nodes part, at most two.
    pub(crate) parts: Vec<usize>,
}

/// All nodes in groups, each after its parts.
pub(crate) fn dissect(points: &[DVec3], neighbors: &Neighbors) -> Vec<Group> {
    let mut dissection = Dissection {
        points,
        neighbors,
        side: vec![Side::Outside; points.len()],
        groups: Vec::new(),
    };
    dissection.add((0..points.len() as u32).collect());
    dissection.groups
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Side {
    Outside,
    Below,
    Above,
}

struct Dissection<'a> {
    points: &'a [DVec3],
    neighbors: &'a Neighbors,
    side: Vec<Side>,
    groups: Vec<Group>,
}

impl Dissection<'_> {
    /// Adds groups of these nodes; the number of the last one.
    fn add(&mut self, nodes: Vec<u32>) -> usize {
        let cut = match nodes.len() {
            0..=MIN_PARTED => None,
            _ => self.best_cut(&nodes),
        };
        let group = match cut {
            None => Group {
                nodes,
                parts: Vec::new(),
            },
            Some([below, layer, above]) => Group {
                parts: vec![self.add(below), self.add(above)],
                nodes: layer,
            },
        };
        self.groups.push(group);
        self.groups.len() - 1
    }

    /// Nodes below, within and above the layer that is small and leaves halves of about the same size.
    fn best_cut(&mut self, nodes: &[u32]) -> Option<[Vec<u32>; 3]> {
        let mut best = (f64::INFINITY, None);
        for normal in normals() {
            let heights: Vec<f64> = nodes
                .iter()
                .map(|&n| self.points[n as usize].dot(normal))
                .collect();
            let mut sorted = heights.clone();
            let (_, &mut median, _) =
                sorted.select_nth_unstable_by(nodes.len() / 2, f64::total_cmp);
            // Nodes of one layer of the sphere are at one height but for rounding.
            for (&node, height) in nodes.iter().zip(heights) {
                self.side[node as usize] = match height < median - 1e-9 {
                    true => Side::Below,
                    false => Side::Above,
                };
            }
            for layer_side in [Side::Below, Side::Above] {
                let cut = self.cut(nodes, layer_side);
                let [below, layer, above] = cut.each_ref().map(|part| part.len() as f64);
                let cost = layer / below.min(above);
                if cost < best.0 {
                    best = (cost, Some(cut));
                }
            }
        }
        for &node in nodes {
            self.side[node as usize] = Side::Outside;
        }
        best.1
    }

    /// The layer: nodes of one side that touch the other.
    fn cut(&self, nodes: &[u32], layer_side: Side) -> [Vec<u32>; 3] {
        let mut parts = [const { Vec::new() }; 3];
        for &node in nodes {
            let side = self.side[node as usize];
            let touches = |&other: &u32| {
                let other = self.side[other as usize];
                other != Side::Outside && other != side
            };
            let part = match side {
                _ if side == layer_side && self.neighbors.of(node).iter().any(touches) => 1,
                Side::Below => 0,
                Side::Above | Side::Outside => 2,
            };
            parts[part].push(node);
        }
        parts
    }
}

/// Axes and diagonals of a cube.
fn normals() -> impl Iterator<Item = DVec3> {
    let all = (0..27).map(|i| {
        DVec3::new(
            f64::from(i / 9 - 1),
            f64::from(i / 3 % 3 - 1),
            f64::from(i % 3 - 1),
        )
    });
    all.skip(14)
}
