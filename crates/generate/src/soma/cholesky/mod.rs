//! Cholesky factorization of a sparse symmetric positive definite matrix with three equations a node.
//!
//! **Theory.** Nodes are eliminated in the order of a nested dissection ([`dissection`]). Each of its
//! groups is a dense **front**: the equations of its nodes, and those of later nodes that these touch
//! (Duff & Reid, The multifrontal solution of indefinite sparse symmetric linear equations, ACM TOMS
//! 9(3), 1983; Davis, Direct Methods for Sparse Linear Systems, 2006, chapters 4 and 6). A front sums
//! the matrix's elements and what its parts left, is factored as far as its own nodes go ([`dense`]),
//! and leaves the rest to the front that follows.
//!
//! **Practice.** Made once per matrix; the time is that of a few large products of matrices. Solving
//! passes the fronts forwards and backwards, for several right sides at once.
//!
//! Why not a library: faer, which is as fast, takes a fifth of the time that all of this program takes
//! to compile. rsparse compiles at once but factors row by row (Davis's up-looking method): two to four
//! times slower on cubes, 27 times on the octahedron of level 4.

mod dense;
mod dissection;

use glam::{DMat3, DVec3};

pub(crate) use dense::Columns;
use dissection::{Group, Neighbors};

/// A block of the matrix; its transpose, at (column, row), goes without saying. Blocks at the same row
/// and column add up.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Block {
    pub(crate) row: u32,
    pub(crate) column: u32,
    pub(crate) value: DMat3,
}

/// The factor L, in fronts.
pub(crate) struct Cholesky {
    /// Position of each node in the order of elimination.
    position: Vec<u32>,
    fronts: Vec<Front>,
}

/// Equations that are eliminated together.
struct Front {
    /// Positions of its own nodes: so many from the first on.
    first: usize,
    own: usize,
    /// Positions of later nodes that they touch, in order.
    later: Vec<u32>,
    columns: Columns,
}

impl Cholesky {
    /// Factors the matrix of nodes at the given points; `None` if it is not positive definite.
    pub(crate) fn new(points: &[DVec3], blocks: &[Block]) -> Option<Self> {
        let pairs = blocks.iter().map(|block| (block.row, block.column));
        let neighbors = Neighbors::new(points.len(), pairs);
        let groups = dissection::dissect(points, &neighbors);
        let mut position = vec![0; points.len()];
        let order = groups.iter().flat_map(|group| &group.nodes);
        for (index, &node) in order.enumerate() {
            position[node as usize] = index as u32;
        }
        let by_front = blocks_by_front(&groups, &position, blocks);
        let mut fronts: Vec<Front> = Vec::with_capacity(groups.len());
        // What the groups leave to those that follow, by group.
        let mut left: Vec<Vec<f64>> = vec![Vec::new(); groups.len()];
        let mut slots = vec![0; points.len()];
        let mut first = 0;
        for (group, blocks) in groups.iter().zip(by_front) {
            let parts = group.parts.iter().map(|&part| &fronts[part]);
            let later = later_nodes(group, first, &neighbors, &position, parts);
            let mut front = Assembly::new(first, group.nodes.len(), later, &mut slots);
            for block in &blocks {
                front.add_block(block, &position);
            }
            for &part in &group.parts {
                front.add_part(&fronts[part], &std::mem::take(&mut left[part]));
            }
            let (front, rest) = front.factor()?;
            left[fronts.len()] = rest;
            fronts.push(front);
            first += group.nodes.len();
        }
        Some(Self { position, fronts })
    }

    /// Solves for W right sides at once, in place: three rows a node.
    pub(crate) fn solve<const W: usize>(&self, x: &mut [[f64; W]]) {
        let mut ordered = vec![[0.0; W]; x.len()];
        let rows = self.position.iter().enumerate();
        for (node, &position) in rows.clone() {
            copy_node(&mut ordered, position as usize, x, node);
        }
        let mut local = Vec::new();
        for front in &self.fronts {
            front.forward(&mut ordered, &mut local);
        }
        for front in self.fronts.iter().rev() {
            front.backward(&mut ordered, &mut local);
        }
        for (node, &position) in rows {
            copy_node(x, node, &ordered, position as usize);
        }
    }
}

fn copy_node<const W: usize>(to: &mut [[f64; W]], at: usize, from: &[[f64; W]], node: usize) {
    to[3 * at..][..3].copy_from_slice(&from[3 * node..][..3]);
}

/// Each block belongs to the front that eliminates the earlier one of its nodes.
fn blocks_by_front(groups: &[Group], position: &[u32], blocks: &[Block]) -> Vec<Vec<Block>> {
    let mut front_of = vec![0; position.len()];
    for (front, group) in groups.iter().enumerate() {
        for &node in &group.nodes {
            front_of[node as usize] = front;
        }
    }
    let mut by_front = vec![Vec::new(); groups.len()];
    for block in blocks {
        let (row, column) = (block.row as usize, block.column as usize);
        let earlier = if position[row] < position[column] {
            row
        } else {
            column
        };
        by_front[front_of[earlier]].push(*block);
    }
    by_front
}

/// Positions of the nodes after a group that its own nodes or its parts touch.
fn later_nodes<'a>(
    group: &Group,
    first: usize,
    neighbors: &Neighbors,
    position: &[u32],
    parts: impl Iterator<Item = &'a Front>,
) -> Vec<u32> {
    let touched = group.nodes.iter().flat_map(|&node| neighbors.of(node));
    let touched = touched.map(|&node| position[node as usize]);
    let passed_on = parts.flat_map(|part| part.later.iter().copied());
    let after = (first + group.nodes.len()) as u32;
    let mut later: Vec<u32> = touched.chain(passed_on).filter(|&p| p >= after).collect();
    later.sort_unstable();
    later.dedup();
    later
}

/// A front that is being summed.
struct Assembly<'a> {
    front: Front,
    /// The square of the later nodes, column by column.
    rest: Vec<f64>,
    /// By position of a node: its number in the front. Only those of its nodes are up to date.
    slots: &'a mut [usize],
}

impl<'a> Assembly<'a> {
    fn new(first: usize, own: usize, later: Vec<u32>, slots: &'a mut [usize]) -> Self {
        for (slot, position) in (first..first + own)
            .chain(later.iter().map(|&p| p as usize))
            .enumerate()
        {
            slots[position] = slot;
        }
        Self {
            rest: vec![0.0; (3 * later.len()).pow(2)],
            front: Front {
                first,
                own,
                columns: Columns::new(3 * (own + later.len()), 3 * own),
                later,
            },
            slots,
        }
    }

    fn add_block(&mut self, block: &Block, position: &[u32]) {
        let [row, column] =
            [block.row, block.column].map(|node| self.slots[position[node as usize] as usize]);
        let (row, column, value) = match row >= column {
            true => (row, column, block.value),
            false => (column, row, block.value.transpose()),
        };
        for axis in 0..3 {
            let values = &mut self.front.columns.column_mut(3 * column + axis)[3 * row..][..3];
            add(values, &value.col(axis).to_array());
        }
    }

    /// Adds what another front left: its later nodes are all in this one, in the same order.
    fn add_part(&mut self, part: &Front, left: &[f64]) {
        let size = 3 * part.later.len();
        let own = self.front.own;
        let later = self.front.later.len();
        for (number, &node) in part.later.iter().enumerate() {
            let slot = self.slots[node as usize];
            for axis in 0..3 {
                let from = &left[(3 * number + axis) * size..][..size];
                let (to, above) = match slot < own {
                    true => (self.front.columns.column_mut(3 * slot + axis), 0),
                    false => (
                        &mut self.rest[(3 * (slot - own) + axis) * 3 * later..][..3 * later],
                        own,
                    ),
                };
                for (row, values) in part.later.iter().zip(from.as_chunks::<3>().0).skip(number) {
                    add(
                        &mut to[3 * (self.slots[*row as usize] - above)..][..3],
                        values,
                    );
                }
            }
        }
    }

    /// The factored front, and what it leaves to the one that follows.
    fn factor(mut self) -> Option<(Front, Vec<f64>)> {
        let columns = self.front.columns.factor()?;
        columns.subtract_from(&mut self.rest);
        let front = Front {
            columns,
            ..self.front
        };
        Some((front, self.rest))
    }
}

fn add(to: &mut [f64], values: &[f64; 3]) {
    for (to, value) in to.iter_mut().zip(values) {
        *to += value;
    }
}

impl Front {
    fn forward<const W: usize>(&self, x: &mut [[f64; W]], local: &mut Vec<[f64; W]>) {
        let own = &mut x[3 * self.first..][..3 * self.own];
        // Right sides are zero but for a few rows, and stay so until a front touches one.
        if own.iter().flatten().all(|&value| value == 0.0) {
            return;
        }
        local.clear();
        local.extend_from_slice(own);
        local.resize(3 * (self.own + self.later.len()), [0.0; W]);
        self.columns.forward(local);
        let (solved, updates) = local.split_at(own.len());
        own.copy_from_slice(solved);
        for (&node, updates) in self.later.iter().zip(updates.as_chunks::<3>().0) {
            for (x, update) in x[3 * node as usize..].iter_mut().zip(updates) {
                for (x, update) in x.iter_mut().zip(update) {
                    *x += update;
                }
            }
        }
    }

    fn backward<const W: usize>(&self, x: &mut [[f64; W]], local: &mut Vec<[f64; W]>) {
        local.clear();
        local.extend_from_slice(&x[3 * self.first..][..3 * self.own]);
        for &node in &self.later {
            local.extend_from_slice(&x[3 * node as usize..][..3]);
        }
        self.columns.backward(local);
        let own = 3 * self.own;
        x[3 * self.first..][..own].copy_from_slice(&local[..own]);
    }
}

#[cfg(test)]
mod tests;
