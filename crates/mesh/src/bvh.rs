//! A tree of boxes over boxes, to find those that overlap.
//!
//! **Theory.** Boxes are sorted along a Morton curve (T. Karras, Maximizing Parallelism in the
//! Construction of BVHs, 2012); a complete tree of four children a node stands on them. Four boxes
//! side by side are compared with another one by six instructions (I. Wald, C. Benthin, S. Boulos,
//! Getting Rid of Packets, 2008). The children of node n of one level are 4 n to 4 n + 3 of the
//! level below, so the tree needs no pointers.
//!
//! **Practice.** Meshes of neurons have faces of like size along thin tubes, which a curve sorts
//! well: building the tree and testing all pairs of a million triangles takes about 0.3 s on
//! two cores (`examples/measure_speed.rs` measures it on a torus). All pairs are found block by block: the tree is searched once for
//! 64 boxes that are neighbors along the curve, and they share what is found.

use glam::{Vec3, Vec4};
use rayon::prelude::*;

/// A box along the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounds {
    pub(crate) low: Vec3,
    pub(crate) high: Vec3,
}

impl Bounds {
    const EMPTY: Self = Self {
        low: Vec3::INFINITY,
        high: Vec3::NEG_INFINITY,
    };

    /// Bounds of a triangle.
    pub(crate) fn of([a, b, c]: [Vec3; 3]) -> Self {
        Self {
            low: a.min(b).min(c),
            high: a.max(b).max(c),
        }
    }

    fn union(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }
}

/// Four boxes, by axis; fewer are filled up with empty ones, which overlap nothing.
#[derive(Clone, Copy, Debug)]
struct Four {
    low: [Vec4; 3],
    high: [Vec4; 3],
}

impl Four {
    fn new(boxes: &[Bounds]) -> Self {
        let at = |n: usize| boxes.get(n).copied().unwrap_or(Bounds::EMPTY);
        let of = [at(0), at(1), at(2), at(3)];
        let row = |value: fn(&Bounds) -> Vec3, axis| Vec4::from(of.map(|b| value(&b)[axis]));
        Self {
            low: [0, 1, 2].map(|axis| row(|b| b.low, axis)),
            high: [0, 1, 2].map(|axis| row(|b| b.high, axis)),
        }
    }

    /// One of the four.
    fn get(&self, n: usize) -> Bounds {
        Bounds {
            low: Vec3::from(self.low.map(|row| row[n])),
            high: Vec3::from(self.high.map(|row| row[n])),
        }
    }

    /// Bounds of all.
    fn bounds(&self) -> Bounds {
        Bounds {
            low: Vec3::from(self.low.map(Vec4::min_element)),
            high: Vec3::from(self.high.map(Vec4::max_element)),
        }
    }

    /// A bit for each of the four that overlaps a box.
    fn overlaps(&self, query: &Bounds) -> u32 {
        let axis = |n: usize| {
            self.low[n].cmple(Vec4::splat(query.high[n]))
                & self.high[n].cmpge(Vec4::splat(query.low[n]))
        };
        (axis(0) & axis(1) & axis(2)).bitmask()
    }
}

/// The tree.
pub(crate) struct Bvh {
    /// Numbers of the boxes in the order of the leaves.
    order: Vec<u32>,
    /// Nodes by level: first the leaves, of four boxes each, at last the root alone.
    levels: Vec<Vec<Four>>,
}

/// Levels between a leaf and the node that is a block.
const BLOCK: usize = 2;

/// Leaves of a group; by eye.
const GROUP: usize = 4;

impl Bvh {
    /// A tree over boxes, none of which may be empty or not a number.
    pub(crate) fn new(boxes: &[Bounds]) -> Self {
        let all = boxes
            .par_iter()
            .copied()
            .reduce(|| Bounds::EMPTY, Bounds::union);
        let scale = (all.high - all.low).max(Vec3::splat(f32::MIN_POSITIVE));
        let mut keys: Vec<(u64, u32)> = boxes
            .par_iter()
            .enumerate()
            .map(|(n, bounds)| {
                let middle = bounds.low * 0.5 + bounds.high * 0.5;
                (morton((middle - all.low) / scale), n as u32)
            })
            .collect();
        keys.par_sort_unstable();
        let order: Vec<u32> = keys.into_iter().map(|(_, n)| n).collect();
        let boxes: Vec<Bounds> = order.par_iter().map(|&n| boxes[n as usize]).collect();
        let mut levels: Vec<Vec<Four>> = vec![boxes.par_chunks(4).map(Four::new).collect()];
        while let Some(below) = levels.last()
            && below.len() > 1
        {
            let boxes: Vec<Bounds> = below.par_iter().map(Four::bounds).collect();
            levels.push(boxes.par_chunks(4).map(Four::new).collect());
        }
        Self { order, levels }
    }

    /// Number of blocks; see [`Bvh::overlaps_of_block`].
    pub(crate) fn block_count(&self) -> usize {
        self.levels[0].len().div_ceil(1 << (2 * BLOCK))
    }

    /// Calls `visit` with the numbers of two boxes that overlap, one of them in `block` and the
    /// other there or in a later block: over all blocks, each pair once.
    pub(crate) fn overlaps_of_block(&self, block: usize, mut visit: impl FnMut(u32, u32)) {
        let leaves = &self.levels[0];
        let first = block << (2 * BLOCK);
        let end = leaves.len().min(first + (1 << (2 * BLOCK)));
        let bounds = leaves[first..end]
            .iter()
            .map(Four::bounds)
            .fold(Bounds::EMPTY, Bounds::union);
        let mut near = Vec::new();
        self.search(&bounds, first, |other| {
            near.push(other);
            true
        });
        for leaf in first..end {
            let bounds = leaves[leaf].bounds();
            for &other in &near {
                // Leaves that are near come in order.
                if other < leaf || leaves[other].overlaps(&bounds) == 0 {
                    continue;
                }
                self.overlaps_of_leaves(leaf, other, &mut visit);
            }
        }
    }

    /// Number of groups; see [`Bvh::overlaps_of_group`].
    pub(crate) fn group_count(&self) -> usize {
        self.levels[0].len().div_ceil(GROUP)
    }

    /// For each of a few boxes that are neighbors, a group: calls `visit` with its number and those
    /// of the boxes that overlap `query` of it, until it returns false. Over all groups, each box
    /// has its turn once. The tree is searched once for all queries of a group, which should
    /// hardly be larger than the boxes.
    pub(crate) fn overlaps_of_group(
        &self,
        group: usize,
        query: impl Fn(u32) -> Bounds,
        mut visit: impl FnMut(u32, u32) -> bool,
    ) {
        let first = 4 * GROUP * group;
        let end = self.order.len().min(first + 4 * GROUP);
        let queries: Vec<(u32, Bounds)> = self.order[first..end]
            .iter()
            .map(|&n| (n, query(n)))
            .collect();
        let all = queries
            .iter()
            .fold(Bounds::EMPTY, |all, &(_, bounds)| all.union(bounds));
        let mut near = Vec::new();
        self.search(&all, 0, |leaf| {
            near.push(leaf);
            true
        });
        for (n, bounds) in queries {
            let mut leaves = near.iter();
            leaves.all(|&leaf| {
                bits(self.levels[0][leaf].overlaps(&bounds))
                    .all(|m| visit(n, self.order[4 * leaf + m]))
            });
        }
    }

    fn overlaps_of_leaves(&self, leaf: usize, other: usize, visit: &mut impl FnMut(u32, u32)) {
        let boxes = &self.levels[0][leaf];
        for n in 0..self.order.len().min(4 * leaf + 4) - 4 * leaf {
            let mut found = self.levels[0][other].overlaps(&boxes.get(n));
            if leaf == other {
                found &= 0b1110 << n;
            }
            for m in bits(found) {
                visit(self.order[4 * leaf + n], self.order[4 * other + m]);
            }
        }
    }

    /// Calls `visit` with the numbers of boxes that overlap `query`, until it returns false.
    pub(crate) fn overlaps_of(&self, query: &Bounds, mut visit: impl FnMut(u32) -> bool) {
        self.search(query, 0, |leaf| {
            bits(self.levels[0][leaf].overlaps(query)).all(|n| visit(self.order[4 * leaf + n]))
        });
    }

    /// Calls `visit` with the leaves from `first` on that may hold a box that overlaps `query`, in
    /// order, until it returns false.
    fn search(&self, query: &Bounds, first: usize, mut visit: impl FnMut(usize) -> bool) {
        if self.order.is_empty() {
            return;
        }
        // Of each level down to the leaves at most three nodes wait; there are at most 16 levels.
        let mut stack = [(0usize, 0usize); 64];
        stack[0] = (self.levels.len() - 1, 0);
        let mut top = 1;
        while top > 0 {
            top -= 1;
            let (level, node) = stack[top];
            if level == 0 {
                if !visit(node) {
                    return;
                }
                continue;
            }
            let found = self.levels[level][node].overlaps(query);
            for child in [3, 2, 1, 0].into_iter().filter(|n| found >> n & 1 == 1) {
                let child = 4 * node + child;
                // The leaves below it end here.
                if (child + 1) << (2 * (level - 1)) > first {
                    stack[top] = (level - 1, child);
                    top += 1;
                }
            }
        }
    }
}

/// The numbers of the bits that are set.
fn bits(mut set: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lowest = (set != 0).then(|| set.trailing_zeros() as usize);
        set &= set.wrapping_sub(1);
        lowest
    })
}

/// Morton code of a point in the unit cube, 21 bits an axis.
fn morton(point: Vec3) -> u64 {
    let [x, y, z] = (point * 2_097_151.0).to_array().map(|x| spread(x as u64));
    x | y << 1 | z << 2
}

/// Puts two zeros between the lowest 21 bits.
fn spread(bits: u64) -> u64 {
    let bits = bits & 0x1f_ffff;
    let bits = (bits | bits << 32) & 0x1f_0000_0000_ffff;
    let bits = (bits | bits << 16) & 0x1f_0000_ff00_00ff;
    let bits = (bits | bits << 8) & 0x100f_00f0_0f00_f00f;
    let bits = (bits | bits << 4) & 0x10c3_0c30_c30c_30c3;
    (bits | bits << 2) & 0x1249_2492_4924_9249
}
