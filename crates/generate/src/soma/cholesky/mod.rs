//! Cholesky factorization of a sparse symmetric positive definite matrix with three equations a node.
//!
//! **Theory.** Nodes are eliminated in the order of a nested dissection ([`dissection`]). Each of its
//! groups is a dense **front**: the equations of its nodes, and those of later nodes that these touch
//! (Duff & Reid, The multifrontal solution of indefinite sparse symmetric linear equations, ACM TOMS
//! 9(3), 1983; Davis, Direct Methods for Sparse Linear Systems, 2006, chapters 4 and 6). A front sums
//! the matrix's elements and what its parts left, is factored as far as its own nodes go ([`dense`]),
//! and leaves the rest to the front that follows.
//!
//! **Practice.** The order is made once for all matrices of a pattern, and a factor once per matrix; its time is
//! that of a few large products of matrices. Fronts that part from one another are factored side by side. Solving
//! passes the fronts forwards and backwards, for several right sides at once.
//!
//! Why not a library: faer, which is as fast, takes a fifth of the time that all of this program takes
//! to compile. rsparse compiles at once but factors row by row (Davis's up-looking method): two to four
//! times slower on cubes, 27 times on the octahedron of level 4.

mod dense;
mod dissection;

use std::sync::Arc;

use glam::{DMat3, DVec3};

pub(crate) use dense::Columns;
use dissection::{Group, Neighbors};

/// Nodes that share blocks of the matrix, each with itself and with each other: those of an element.
/// [`NO_NODE`] stands where there are fewer than four.
pub(crate) type Clique = [u32; 4];

/// The blocks of a clique: row by row of its nodes, symmetric. Those of [`NO_NODE`] are not used, and what
/// several cliques have at the same row and column adds up.
pub(crate) type Blocks = [[DMat3; 4]; 4];

/// Stands for no node in a [`Clique`].
pub(crate) const NO_NODE: u32 = u32::MAX;

/// In which order the nodes of matrices of the same pattern are eliminated.
pub(crate) struct Elimination<'c> {
    cliques: &'c [Clique],
    /// Position of each node in the order of elimination.
    position: Arc<[u32]>,
    groups: Vec<Group>,
    /// By group: the position of its first node.
    first: Vec<usize>,
    /// By group: positions of the nodes after it that its own nodes or its parts touch, in order.
    later: Vec<Arc<[u32]>>,
    /// By group: the cliques whose first node it eliminates. There all of their nodes are known.
    cliques_of: Vec<Vec<u32>>,
}

/// The factor L, in fronts.
pub(crate) struct Cholesky {
    /// Position of each node in the order of elimination.
    position: Arc<[u32]>,
    fronts: Vec<Front>,
}

/// Equations that are eliminated together.
struct Front {
    /// Positions of its own nodes: so many from the first on.
    first: usize,
    own: usize,
    /// Positions of later nodes that they touch, in order.
    later: Arc<[u32]>,
    columns: Columns,
}

impl<'c> Elimination<'c> {
    /// Of nodes at the given points that share blocks by clique.
    pub(crate) fn new(points: &[DVec3], cliques: &'c [Clique]) -> Self {
        let neighbors = Neighbors::new(points.len(), cliques);
        let groups = dissection::dissect(points, &neighbors);
        let mut position = vec![0; points.len()];
        let order = groups.iter().flat_map(|group| &group.nodes);
        for (index, &node) in order.enumerate() {
            position[node as usize] = index as u32;
        }
        let first = first_positions(&groups);
        Self {
            later: later_nodes(&groups, &first, &position, &neighbors),
            cliques_of: cliques_by_group(&groups, &position, cliques),
            position: position.into(),
            cliques,
            groups,
            first,
        }
    }

    /// Factors the sum of the blocks of all cliques; `None` if it is not positive definite. `blocks`: by number of
    /// the clique.
    pub(crate) fn factor(&self, blocks: &(impl Fn(usize) -> Blocks + Sync)) -> Option<Cholesky> {
        let Factored { fronts, .. } = self.factor_group(self.groups.len() - 1, blocks)?;
        Some(Cholesky {
            position: Arc::clone(&self.position),
            fronts,
        })
    }

    /// Factors a group after its parts, which do not know of each other.
    fn factor_group(
        &self,
        number: usize,
        blocks: &(impl Fn(usize) -> Blocks + Sync),
    ) -> Option<Factored> {
        let group = &self.groups[number];
        let parts = match group.parts[..] {
            [a, b] => {
                let factor = |part: usize| self.factor_group(part, blocks);
                let (a, b) = rayon::join(|| factor(a), || factor(b));
                vec![a?, b?]
            }
            _ => Vec::new(),
        };
        let later = Arc::clone(&self.later[number]);
        let mut sum = Sum::new(self.first[number], group.nodes.len(), later);
        for &clique in &self.cliques_of[number] {
            let nodes = self.cliques[clique as usize];
            sum.add_clique(
                nodes.map(|node| self.position.get(node as usize).copied()),
                &blocks(clique as usize),
            );
        }
        let mut fronts = Vec::new();
        for part in parts {
            if let Some(last) = part.fronts.last() {
                sum.add_part(last, &part.left);
            }
            fronts.extend(part.fronts);
        }
        let (front, left) = sum.factor()?;
        fronts.push(front);
        Some(Factored { fronts, left })
    }
}

impl Cholesky {
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

fn cliques_by_group(groups: &[Group], position: &[u32], cliques: &[Clique]) -> Vec<Vec<u32>> {
    let mut group_of = vec![0; position.len()];
    for (number, group) in groups.iter().enumerate() {
        for &node in &group.nodes {
            group_of[position[node as usize] as usize] = number;
        }
    }
    let mut by_group = vec![Vec::new(); groups.len()];
    for (number, clique) in (0..).zip(cliques) {
        let nodes = clique.iter().filter(|&&node| node != NO_NODE);
        if let Some(first) = nodes.map(|&node| position[node as usize]).min() {
            by_group[group_of[first as usize]].push(number);
        }
    }
    by_group
}

fn first_positions(groups: &[Group]) -> Vec<usize> {
    let before = groups.iter().scan(0, |before, group| {
        let first = *before;
        *before += group.nodes.len();
        Some(first)
    });
    before.collect()
}

fn later_nodes(
    groups: &[Group],
    first: &[usize],
    position: &[u32],
    neighbors: &Neighbors,
) -> Vec<Arc<[u32]>> {
    let mut all: Vec<Arc<[u32]>> = Vec::with_capacity(groups.len());
    for (group, first) in groups.iter().zip(first) {
        let touched = group.nodes.iter().flat_map(|&node| neighbors.of(node));
        let touched = touched.map(|&node| position[node as usize]);
        let passed_on = group
            .parts
            .iter()
            .flat_map(|&part| all[part].iter().copied());
        let after = (first + group.nodes.len()) as u32;
        let mut later: Vec<u32> = touched.chain(passed_on).filter(|&p| p >= after).collect();
        later.sort_unstable();
        later.dedup();
        all.push(later.into());
    }
    all
}

/// The fronts of a group and of all its parts, its own last.
struct Factored {
    fronts: Vec<Front>,
    /// What they leave to the front that follows: the square of the last one's later nodes.
    left: Vec<f64>,
}

/// A front that is being summed.
struct Sum {
    front: Front,
    /// The square of the later nodes, column by column.
    rest: Vec<f64>,
}

impl Sum {
    fn new(first: usize, own: usize, later: Arc<[u32]>) -> Self {
        Self {
            rest: dense::zeros((3 * later.len()).pow(2)),
            front: Front {
                first,
                own,
                columns: Columns::new(3 * (own + later.len()), 3 * own),
                later,
            },
        }
    }

    /// The number in the front of the node at a position.
    fn slot(&self, position: u32) -> usize {
        let Front {
            first, own, later, ..
        } = &self.front;
        match (position as usize).checked_sub(*first) {
            Some(slot) if slot < *own => slot,
            _ => own + later.partition_point(|&node| node < position),
        }
    }

    /// Equations of a node from its own on, and how many equations of the front come before the first of
    /// them.
    fn column_mut(&mut self, slot: usize, axis: usize) -> (&mut [f64], usize) {
        let Front {
            own,
            later,
            columns,
            ..
        } = &mut self.front;
        match slot.checked_sub(*own) {
            None => (columns.column_mut(3 * slot + axis), 0),
            Some(slot) => {
                let rows = 3 * later.len();
                (&mut self.rest[(3 * slot + axis) * rows..][..rows], 3 * *own)
            }
        }
    }

    /// Adds the blocks of nodes at these positions.
    fn add_clique(&mut self, positions: [Option<u32>; 4], blocks: &Blocks) {
        let slots = positions.map(|position| position.map(|position| self.slot(position)));
        for (row, blocks) in slots.iter().zip(blocks) {
            for (column, block) in slots.iter().zip(blocks) {
                let (Some(row), Some(column)) = (*row, *column) else {
                    continue;
                };
                for axis in (0..3).filter(|_| row >= column) {
                    let (to, above) = self.column_mut(column, axis);
                    add(&mut to[3 * row - above..][..3], &block.col(axis).to_array());
                }
            }
        }
    }

    /// Adds what another front left: its later nodes are all in this one, in the same order.
    fn add_part(&mut self, part: &Front, left: &[f64]) {
        let size = 3 * part.later.len();
        let slots: Vec<usize> = part.later.iter().map(|&node| self.slot(node)).collect();
        for (number, &slot) in slots.iter().enumerate() {
            for axis in 0..3 {
                let from = &left[(3 * number + axis) * size..][..size];
                let (to, above) = self.column_mut(slot, axis);
                for (row, values) in slots.iter().zip(from.as_chunks::<3>().0).skip(number) {
                    add(&mut to[3 * row - above..][..3], values);
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
        for &node in self.later.iter() {
            local.extend_from_slice(&x[3 * node as usize..][..3]);
        }
        self.columns.backward(local);
        let own = 3 * self.own;
        x[3 * self.first..][..own].copy_from_slice(&local[..own]);
    }
}

#[cfg(test)]
mod tests;
