//! Pieces that are not connected, each connected to the nearest sample of another one.
//!
//! **Theory.** Borůvka's minimum spanning tree (1926): every piece without a soma finds its nearest sample of
//! another piece, all of them are connected, and again until no piece finds one within the distance. Two pieces
//! with a soma each are never connected, not by way of a third either, since only pieces without one look.
//! A piece that is connected to another is hung up by the sample at which it is: the piece with the soma stays
//! as it is; without a soma the one with the most samples does.
//!
//! **Practice.** A tree of boxes answers which sample of another piece is nearest and passes over boxes that
//! hold one piece only. Pieces at least halve with each round: n log² n.

mod nearest;

use std::collections::VecDeque;

use super::EditError;
use super::nodes::{Edits, Nodes};
use super::root::hang_up;
use crate::{Morphology, Node, SomaKind};
use nearest::{Ball, Nearest};

pub(super) fn join(
    morphology: &Morphology,
    nodes: &Nodes,
    distance: f64,
) -> Result<Edits, EditError> {
    if distance.is_nan() || distance <= 0.0 {
        return Err(EditError::Number {
            what: "the distance",
            value: distance,
            must: "above 0",
        });
    }
    let (tree, count) = nodes.trees();
    let mut pieces = Pieces::new(&tree, count, nodes.somata);
    let balls = balls(morphology, nodes);
    let first_of_soma: Vec<usize> = balls[..morphology.somata.len()]
        .iter()
        .map(|ball| ball.node)
        .collect();
    let mut nearest = Nearest::new(balls);
    let mut links = Vec::new();
    while pieces.count > 1 {
        let found = pieces.round(&mut nearest, nodes, &tree, distance);
        let found = found
            .into_iter()
            .map(|(a, b)| (a, attachment(morphology, nodes, &first_of_soma, a, b)));
        let found: Vec<(usize, usize)> = found.collect();
        if found.is_empty() {
            break;
        }
        links.extend(found);
    }
    let mut edited = nodes.nodes.clone();
    let left = pieces.alone();
    hang_on_one_another(&mut edited, &tree, pieces, &links);
    Ok(Edits {
        left,
        ..Edits::in_place(edited)
    })
}

/// A sphere for each neurite's sample, of no size, and one for each soma, by one of its samples.
fn balls(morphology: &Morphology, nodes: &Nodes) -> Vec<Ball> {
    let mut first = 0;
    let mut balls = Vec::with_capacity(nodes.nodes.len());
    for soma in &morphology.somata {
        balls.push(Ball {
            center: morphology.origin + soma.center.as_dvec3(),
            radius: f64::from(soma.radius).max(0.0),
            node: first,
        });
        first += soma.samples.len();
    }
    balls.extend((nodes.somata..nodes.nodes.len()).map(|node| Ball {
        center: nodes.nodes[node].position,
        radius: 0.0,
        node,
    }));
    balls
}

/// Which trees are connected by now.
struct Pieces {
    /// Of each tree another one of its piece, or itself.
    of: Vec<u32>,
    /// Whether the piece of a tree that stands for its piece has a soma.
    has_soma: Vec<bool>,
    /// Whether the tree itself has one.
    with_soma: Vec<bool>,
    /// Number of nodes of each tree.
    sizes: Vec<usize>,
    count: usize,
}

impl Pieces {
    fn new(tree: &[u32], count: usize, somata: usize) -> Self {
        let mut pieces = Self {
            of: (0..count as u32).collect(),
            has_soma: vec![false; count],
            with_soma: vec![false; count],
            sizes: vec![0; count],
            count,
        };
        for (node, &tree) in tree.iter().enumerate() {
            pieces.sizes[tree as usize] += 1;
            pieces.with_soma[tree as usize] |= node < somata;
        }
        pieces.has_soma.clone_from(&pieces.with_soma);
        pieces
    }

    /// The piece of a tree.
    fn find(&mut self, tree: u32) -> u32 {
        let mut at = tree;
        while self.of[at as usize] != at {
            let above = self.of[self.of[at as usize] as usize];
            self.of[at as usize] = above;
            at = above;
        }
        at
    }

    /// Connects each piece without a soma to the nearest other one. Returns pairs of nodes.
    fn round(
        &mut self,
        nearest: &mut Nearest,
        nodes: &Nodes,
        tree: &[u32],
        distance: f64,
    ) -> Vec<(usize, usize)> {
        let piece: Vec<u32> = tree.iter().map(|&tree| self.find(tree)).collect();
        nearest.label(&piece);
        // The nearest pair of each piece so far: its distance, and a node in it and in another one.
        let mut best: Vec<(f64, Option<(usize, usize)>)> = vec![(distance, None); self.of.len()];
        for (node, &own) in piece.iter().enumerate().skip(nodes.somata) {
            if self.has_soma[own as usize] {
                continue;
            }
            let so_far = &mut best[own as usize];
            let center = nodes.nodes[node].position;
            if let Some((found, way)) =
                nearest.of_another(center, own, so_far.0, so_far.1.is_none())
            {
                *so_far = (way, Some((node, found)));
            }
        }
        let mut links = Vec::new();
        for (node, other) in best.into_iter().filter_map(|(_, pair)| pair) {
            let (a, b) = (self.find(piece[node]), self.find(piece[other]));
            // Two pieces may have found one another.
            if a != b {
                self.connect(a, b);
                links.push((node, other));
            }
        }
        links
    }

    fn connect(&mut self, a: u32, b: u32) {
        self.of[a as usize] = b;
        self.has_soma[b as usize] |= self.has_soma[a as usize];
        self.count -= 1;
    }

    /// Of each piece the tree that stays as it is: the one with the soma, else the first of the largest.
    fn main_trees(&mut self) -> Vec<u32> {
        let trees = 0..self.of.len() as u32;
        let mut main: Vec<Option<u32>> = vec![None; self.of.len()];
        for tree in trees {
            let piece = self.find(tree) as usize;
            let size = |tree: u32| (self.with_soma[tree as usize], self.sizes[tree as usize]);
            if main[piece].is_none_or(|other| size(tree) > size(other)) {
                main[piece] = Some(tree);
            }
        }
        main.into_iter().flatten().collect()
    }

    /// Pieces without a soma beside others.
    fn alone(&self) -> usize {
        let roots = (0..self.of.len()).filter(|&i| self.of[i] as usize == i);
        let without = roots.filter(|&i| !self.has_soma[i]).count();
        if self.count == without {
            without.saturating_sub(1)
        } else {
            without
        }
    }
}

/// Of a soma, the sample that is nearest to a node, or of one of three points the first of these, as its convention
/// has it; any other node itself.
fn attachment(
    morphology: &Morphology,
    nodes: &Nodes,
    first_of_soma: &[usize],
    node: usize,
    other: usize,
) -> usize {
    if other >= nodes.somata {
        return other;
    }
    let soma = first_of_soma.partition_point(|&first| first <= other) - 1;
    let samples = other..other + morphology.somata[soma].samples.len();
    if morphology.somata[soma].kind == SomaKind::ThreePoint {
        let root = |&i: &usize| nodes.nodes[i].parent.is_none();
        return samples.into_iter().find(root).unwrap_or(other);
    }
    let way = |i: usize| nodes.nodes[i].position.distance(nodes.nodes[node].position);
    samples
        .min_by(|&a, &b| way(a).total_cmp(&way(b)))
        .unwrap_or(other)
}

/// Hangs the trees of each piece on one another, from its main tree on.
fn hang_on_one_another(
    edited: &mut [Node],
    tree: &[u32],
    mut pieces: Pieces,
    links: &[(usize, usize)],
) {
    let mut of_tree: Vec<Vec<(usize, usize)>> = vec![Vec::new(); pieces.of.len()];
    for &(a, b) in links {
        of_tree[tree[a] as usize].push((a, b));
        of_tree[tree[b] as usize].push((b, a));
    }
    let mut waiting: VecDeque<u32> = pieces.main_trees().into();
    let mut done = vec![false; of_tree.len()];
    while let Some(here) = waiting.pop_front() {
        done[here as usize] = true;
        for &(own, other) in &of_tree[here as usize] {
            let there = tree[other];
            if !done[there as usize] {
                hang_up(edited, other);
                edited[other].parent = Some(own as u32);
                waiting.push_back(there);
            }
        }
    }
}
