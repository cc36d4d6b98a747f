//! Where the corners of a mesh are stored: whole numbers on the grid of a level.
//!
//! A level's nodes are boxes of `chunk_shape · 2^level`, and a corner in one is stored as 0 to 65,535 of it along each axis.
//! The far side of a node is the near side of the next, so **corners have one number along an axis for the whole
//! level**: [`STEPS`] for each node, and what is left is the number within.

use glam::DVec3;

/// Bits of a stored coordinate.
pub(crate) const BITS: u32 = 16;

/// Steps along a node.
pub(crate) const STEPS: i64 = (1 << BITS) - 1;

/// The stored coordinate where neuroglancer halves a node. Not the geometric middle, which is half a step before.
pub(crate) const HALF: i64 = 1 << (BITS - 1);

/// Longest step (nm) of the finest level; a cell that would need longer ones gets several nodes along that axis. Half of
/// it, by which a corner may be off, is a tenth of the radius of a thin axon.
const LONGEST_STEP: f64 = 21.4;

/// Steps that the box of a cell keeps free at the far side, so that coarse levels of a cell in one node end before its
/// middle, also where they round up.
const FREE: i64 = 2;

/// A box around a cell, divided into nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Near corner (nm).
    pub origin: [f32; 3],
    /// Sides (nm) of a node of the finest level.
    pub chunk: [f32; 3],
    /// Nodes of the finest level along each axis.
    pub nodes: [u32; 3],
}

impl Grid {
    /// The grid for what is in a box (nm).
    pub fn around(min: DVec3, max: DVec3) -> Self {
        // Near corners must not be cut off by rounding.
        let origin = min.to_array().map(|near| {
            let rounded = near as f32;
            if f64::from(rounded) > near {
                rounded.next_down()
            } else {
                rounded
            }
        });
        let far = max.to_array();
        let (mut chunk, mut nodes) = ([0.0; 3], [1; 3]);
        for axis in 0..3 {
            // A flat cell has a side, too; and a nanometer is more than rounding to 32 bits takes away.
            let side = (far[axis] - f64::from(origin[axis])).max(1.0);
            let usable = (STEPS - FREE) as f64;
            nodes[axis] = (side / (LONGEST_STEP * usable)).ceil() as u32;
            let of_node = side / f64::from(nodes[axis]) * STEPS as f64 / usable;
            chunk[axis] = (of_node as f32).next_up();
        }
        Self {
            origin,
            chunk,
            nodes,
        }
    }

    /// Nodes of a level along an axis.
    pub fn nodes_of(&self, level: u32, axis: usize) -> u32 {
        self.nodes[axis].div_ceil(1 << level)
    }

    /// The stored place of a point (nm) in a level, counted through all of its nodes.
    pub fn stored(&self, level: u32, point: DVec3) -> [i64; 3] {
        let steps = STEPS as f64;
        let share = (point - self.near()) / self.node(level) * steps;
        let most = |axis| i64::from(self.nodes_of(level, axis)) * STEPS;
        let share = share.round().to_array();
        std::array::from_fn(|axis| (share[axis] as i64).clamp(0, most(axis)))
    }

    /// The point (nm) that readers make of a stored place in a node.
    pub fn point(&self, level: u32, node: [u32; 3], stored: [i64; 3]) -> DVec3 {
        let within = DVec3::from_array(stored.map(|s| s as f64 / STEPS as f64));
        let node = DVec3::from_array(node.map(f64::from));
        self.near() + self.node(level) * (node + within)
    }

    fn near(&self) -> DVec3 {
        DVec3::from_array(self.origin.map(f64::from))
    }

    /// Sides (nm) of a node.
    fn node(&self, level: u32) -> DVec3 {
        DVec3::from_array(self.chunk.map(f64::from)) * f64::from(1 << level)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MM: f64 = 1e6;

    #[test]
    fn a_usual_cell_is_in_one_node_before_its_middle() {
        let grid = Grid::around(
            DVec3::new(-1.0, 3.7e7, 0.1),
            DVec3::new(1.4 * MM, 3.7e7 + 3.3, 0.1),
        );
        assert_eq!(grid.nodes, [1; 3]);
        for level in 0..6 {
            let far = grid.stored(level, DVec3::new(1.4 * MM, 3.7e7 + 3.3, 0.1));
            let most = if level == 0 { STEPS } else { HALF };
            assert!(far.iter().all(|&s| s < most && s >= 0), "{level}: {far:?}");
        }
    }

    #[test]
    fn what_is_read_is_within_half_a_step() {
        let (min, max) = (DVec3::splat(-3.3 * MM), DVec3::new(2.2, 1.9, 0.4) * MM);
        let grid = Grid::around(min, max);
        assert_eq!(grid.nodes, [4, 4, 3]);
        for n in 0..500 {
            let share = DVec3::new(0.002, 0.0013, 0.0017) * f64::from(n);
            let point = min.lerp(max, 0.5) + (max - min) * (share - share.floor() - 0.5);
            for level in 0..4 {
                let stored = grid.stored(level, point);
                let node = stored.map(|s| (s / STEPS) as u32);
                let within = std::array::from_fn(|axis| stored[axis] % STEPS);
                let half = 0.5 * grid.node(level) / STEPS as f64;
                let off = (grid.point(level, node, within) - point).abs();
                assert!(off.cmple(half * (1.0 + 1e-9)).all(), "{level} {point}");
            }
        }
    }

    /// As readers evaluate it: far side of a node, near side of the next.
    #[test]
    fn nodes_that_meet_have_the_same_plane_to_the_bit() {
        let grid = Grid::around(DVec3::splat(-7.7 * MM), DVec3::splat(5.1 * MM));
        for level in 0..3 {
            for node in 0..grid.nodes_of(level, 0) - 1 {
                let far = grid.point(level, [node; 3], [STEPS; 3]);
                let near = grid.point(level, [node + 1; 3], [0; 3]);
                assert_eq!(far.to_array(), near.to_array());
            }
        }
    }
}
