//! Which samples a translucent surface covers. Twin of sheets.wgsl, whose head says how it works.

use neurotess_picture::meshes::SHEET_DEPTH;

use crate::masks::bayer;
use crate::projection::Projection;

/// What decides which samples a mesh covers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sheet {
    pub(crate) number: u32,
    pub(crate) opacity: f32,
    pub(crate) edges: bool,
    pub(crate) projection: Projection,
}

impl Sheet {
    pub(crate) fn is_translucent(&self) -> bool {
        self.edges || self.opacity < 1.0
    }

    /// Coverage of a fragment. `line`: how strongly lines of a half width (sub-pixels) along the edges cover it.
    pub(crate) fn coverage(&self, line: impl Fn(f32) -> f32) -> f32 {
        match self.edges {
            true => self.opacity * line(self.projection.half_line()),
            false => self.opacity,
        }
    }

    /// The samples of a sub-pixel that are covered.
    pub(crate) fn mask(
        &self,
        coverage: f32,
        samples: u32,
        pixel: [i32; 2],
        nearness: f32,
        is_front: bool,
    ) -> u32 {
        if coverage >= 1.0 {
            return (1 << samples) - 1;
        }
        let turned = pixel.map(|n| (n + 4096) as u32);
        let block = turned.map(|n| n >> 1);
        let [x, y] = turned.map(|n| n & 1);
        let sheet = scrambled(2 * self.number + u32::from(is_front));
        let of_block = scrambled(sheet).wrapping_add(block[1]);
        let of_block = scrambled(scrambled(of_block).wrapping_add(block[0]));
        let begin = (of_block >> 8) as f32 / 16_777_216.0;
        let depth = self.projection.depth(nearness);
        let layer = ((self.steps_of_depth(depth) + begin).floor() as i32).wrapping_add(1 << 20);
        let layer = layer as u32;
        let seed = scrambled(of_block.wrapping_add(layer));
        let kind = match is_front {
            true => layer % 3,
            false => 3 + layer % 2,
        };
        let kind = (2 * self.number + kind) % 5;
        // Below a sixteenth, neighboring blocks differ.
        let [bx, by] = block.map(|n| n & 3);
        let fine = bayer([bx, by]) + 0.25 * bayer([bx >> 1, by >> 1]) - 0.125;
        let fine = fine - fine.floor();
        let first = 4 * (x + 2 * y);
        (0..samples).fold(0, |mask, k| {
            let place = place_of(first + k, kind, seed) as f32;
            mask | u32::from(place + fine < 16.0 * coverage) << k
        })
    }

    /// Steps of depth, of which each holds what counts as one layer.
    fn steps_of_depth(&self, depth: f32) -> f32 {
        let Projection {
            slope, flat, near, ..
        } = self.projection;
        match flat > 0.0 {
            true => depth / (SHEET_DEPTH * flat),
            false => libm::logf(depth.max(near)) / (SHEET_DEPTH * slope),
        }
    }
}

/// O'Neill, PCG: a family of simple fast space-efficient statistically good algorithms for random number generation, 2014.
fn scrambled(value: u32) -> u32 {
    let state = value.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

/// A product in the field of four elements.
fn product(a: u32, b: u32) -> u32 {
    let tables = [0, 0xe4, 0x78, 0x9c];
    (tables[a as usize & 3] >> (2 * b)) & 3
}

/// Place of a sample, from 0 to 15, in an order of this kind.
fn place_of(index: u32, kind: u32, seed: u32) -> u32 {
    let (row, column) = (index >> 2, index & 3);
    // Lines in the plane over that field: of each kind four, which are parallel.
    let (group, other) = match kind == 4 {
        true => (column, row),
        false => (row ^ product(kind & 3, column), column),
    };
    // Which group is first, and which sample in each, is random.
    let first = product(1 + (seed >> 2) % 3, group) ^ (seed & 3);
    let bits = seed >> (16 + 4 * first);
    let second = product(1 + ((seed >> 8) + first) % 3, other) ^ (bits & 3);
    4 * first + second
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_order_has_every_place_once() {
        for kind in 0..5 {
            for seed in (0..2000_u32).map(scrambled) {
                let mut places: Vec<u32> = (0..16).map(|k| place_of(k, kind, seed)).collect();
                places.sort_unstable();
                assert!(places.into_iter().eq(0..16), "{kind} {seed}");
            }
        }
    }
}
