//! Which samples form somata.
//!
//! Samples of type 1 that are linked form a *piece*. One piece of a tree is its soma: the one with
//! the root, else the one with the thickest sample, then with the most samples, then the first.
//! The other pieces stay points of neurites. Among the somata of several trees the main one is
//! found by the same measures; a contour has radius 0 and goes by its number of samples.

use std::cmp::Reverse;

use super::notes::Notes;
use super::tree::NONE;
use super::{Node, Oddity, is_soma};

/// The somata, the main one first.
#[derive(Default)]
pub(super) struct Somata {
    /// Nodes of each soma in the order given.
    pub(super) members: Vec<Vec<u32>>,
    /// The member of each that is nearest to the root.
    pub(super) tops: Vec<u32>,
    /// Soma of each node, or [`NONE`]; empty if there is no soma at all.
    role: Vec<u32>,
    /// Index of each node in its `members`.
    sample: Vec<u32>,
}

/// Samples of type 1 that are linked to one another.
struct Piece {
    top: u32,
    thickest: f32,
    samples: u32,
}

impl Piece {
    /// Sorts the main soma first. `total_cmp` by way of the bits: radii are finite.
    fn rank(&self) -> (Reverse<u32>, Reverse<u32>) {
        (
            Reverse(self.thickest.max(0.0).to_bits()),
            Reverse(self.samples),
        )
    }
}

impl Somata {
    /// Soma of a node, or [`NONE`].
    pub(super) fn of(&self, node: u32) -> u32 {
        self.role.get(node as usize).copied().unwrap_or(NONE)
    }

    /// Which sample of its soma a node is.
    pub(super) fn sample(&self, node: u32) -> u32 {
        self.sample[node as usize]
    }

    /// Changes the soma of one of its samples.
    pub(super) fn set_soma(&mut self, node: u32, soma: u32) {
        self.role[node as usize] = soma;
    }

    /// Changes which sample of its soma a node stands for.
    pub(super) fn set_sample(&mut self, node: u32, sample: u32) {
        self.sample[node as usize] = sample;
    }

    /// Turns somata into points of neurites, except those whose members stay.
    pub(super) fn retain(&mut self, stays: impl Fn(&[u32]) -> bool) {
        let kept = |soma: usize| stays(&self.members[soma]);
        let kept: Vec<bool> = (0..self.members.len()).map(kept).collect();
        let mut count = 0;
        let number = |&kept: &bool| {
            count += u32::from(kept);
            if kept { count - 1 } else { NONE }
        };
        let number: Vec<u32> = kept.iter().map(number).collect();
        for (role, sample) in self.role.iter_mut().zip(&mut self.sample) {
            *role = number.get(*role as usize).copied().unwrap_or(NONE);
            if *role == NONE {
                *sample = NONE;
            }
        }
        let mut stays = kept.iter();
        self.members.retain(|_| *stays.next().unwrap_or(&true));
        let mut stays = kept.iter();
        self.tops.retain(|_| *stays.next().unwrap_or(&true));
    }

    /// `order` has parents before children; `None` if the nodes themselves do.
    pub(super) fn find(
        nodes: &[Node],
        parents: &[u32],
        order: Option<&[u32]>,
        notes: &mut Notes,
    ) -> Self {
        let (pieces, piece_of) = pieces(nodes, parents, order);
        if pieces.is_empty() {
            if !nodes.is_empty() {
                notes.add(Oddity::NoSoma, 0);
            }
            return Self::default();
        }
        let mut chosen = chosen(&pieces, parents, order);
        chosen.sort_by_key(|&k| pieces[k as usize].rank());

        let mut soma_of_piece = vec![NONE; pieces.len()];
        let mut somata = Self {
            role: piece_of,
            ..Self::default()
        };
        for (soma, &k) in (0_u32..).zip(&chosen) {
            soma_of_piece[k as usize] = soma;
            somata
                .members
                .push(Vec::with_capacity(pieces[k as usize].samples as usize));
            somata.tops.push(pieces[k as usize].top);
        }
        somata.gather(&soma_of_piece, notes);
        for &top in somata
            .tops
            .iter()
            .filter(|&&top| parents[top as usize] != NONE)
        {
            notes.add(Oddity::SomaNotRoot, top);
        }
        somata
    }

    /// Turns pieces into somata, node by node.
    fn gather(&mut self, soma_of_piece: &[u32], notes: &mut Notes) {
        self.sample = vec![NONE; self.role.len()];
        for i in 0..self.role.len() {
            let piece = self.role[i];
            if piece == NONE {
                continue;
            }
            let soma = soma_of_piece[piece as usize];
            self.role[i] = soma;
            if soma == NONE {
                notes.add(Oddity::SomaInsideNeurite, i as u32);
            } else {
                let members = &mut self.members[soma as usize];
                self.sample[i] = members.len() as u32;
                members.push(i as u32);
            }
        }
    }
}

/// The pieces in the order of their tops, and the piece of each node.
fn pieces(nodes: &[Node], parents: &[u32], order: Option<&[u32]>) -> (Vec<Piece>, Vec<u32>) {
    let typed = |i: u32| i != NONE && is_soma(&nodes[i as usize]);
    let mut pieces = Vec::new();
    let mut piece_of = Vec::new();
    for (i, &parent) in (0_u32..).zip(parents) {
        if typed(i) && !typed(parent) {
            if pieces.is_empty() {
                piece_of = vec![NONE; nodes.len()];
            }
            piece_of[i as usize] = pieces.len() as u32;
            pieces.push(Piece {
                top: i,
                thickest: f32::MIN,
                samples: 0,
            });
        }
    }
    if pieces.is_empty() {
        return (pieces, piece_of);
    }
    for step in 0..nodes.len() as u32 {
        let i = order.map_or(step, |order| order[step as usize]);
        if typed(i) {
            if typed(parents[i as usize]) {
                piece_of[i as usize] = piece_of[parents[i as usize] as usize];
            }
            let piece = &mut pieces[piece_of[i as usize] as usize];
            piece.samples += 1;
            piece.thickest = piece.thickest.max(nodes[i as usize].radius as f32);
        }
    }
    (pieces, piece_of)
}

/// One piece per tree, in the order of the pieces.
fn chosen(pieces: &[Piece], parents: &[u32], order: Option<&[u32]>) -> Vec<u32> {
    if let [piece] = pieces
        && parents[piece.top as usize] == NONE
    {
        return vec![0];
    }
    let root_of = roots(parents, order);
    let mut best = vec![NONE; parents.len()];
    for (k, piece) in (0_u32..).zip(pieces) {
        let root = root_of[piece.top as usize];
        let so_far = &mut best[root as usize];
        let better = match pieces.get(*so_far as usize) {
            None => true,
            Some(_) if piece.top == root => true,
            Some(other) => other.top != root && piece.rank() < other.rank(),
        };
        if better {
            *so_far = k;
        }
    }
    let mut chosen: Vec<u32> = best.into_iter().filter(|&k| k != NONE).collect();
    chosen.sort_unstable();
    chosen
}

/// Root of the tree of each node.
fn roots(parents: &[u32], order: Option<&[u32]>) -> Vec<u32> {
    let mut root_of = vec![NONE; parents.len()];
    for step in 0..parents.len() as u32 {
        let i = order.map_or(step, |order| order[step as usize]);
        let parent = parents[i as usize];
        root_of[i as usize] = if parent == NONE {
            i
        } else {
            root_of[parent as usize]
        };
    }
    root_of
}
