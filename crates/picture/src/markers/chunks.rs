//! Markers in an order in which neighbors lie together, cut into **chunks** that are culled and drawn as
//! one.
//!
//! Chunks follow the Z-order curve (Morton, A computer oriented geodetic data base, 1966). Within a chunk
//! the order is shuffled, so that any number of its first markers is a fair sample: where there are more
//! than pixels can show, or than a frame may have, the last ones are left out.

use glam::{DVec3, UVec3, Vec3};

/// Markers of a chunk.
pub const CHUNK: usize = 2048;

/// Up to [`CHUNK`] markers that lie together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Chunk {
    /// Index of its first marker, in the order of [`ordered`].
    pub(super) first: u32,
    pub(super) count: u32,
    /// Bounding sphere of the markers' centers.
    pub(super) center: DVec3,
    pub(super) reach: f64,
}

/// The order that markers are stored in: indices into `positions`.
pub(super) fn ordered(positions: &[DVec3]) -> Vec<u32> {
    let low = positions.iter().copied().fold(DVec3::MAX, DVec3::min);
    let high = positions.iter().copied().fold(DVec3::MIN, DVec3::max);
    let cells = DVec3::splat(f64::from((1 << 21) - 1)) / (high - low).max(DVec3::splat(1e-9));
    let code = |&position: &DVec3| morton(((position - low) * cells).as_uvec3());
    let mut keyed: Vec<(u64, u32)> = positions.iter().map(code).zip(0..).collect();
    keyed.sort_unstable();
    let mut order: Vec<u32> = keyed.into_iter().map(|(_, index)| index).collect();
    for chunk in order.chunks_mut(CHUNK) {
        shuffle(chunk);
    }
    order
}

/// The chunks of markers in their order.
pub(super) fn chunks(positions: &[DVec3], order: &[u32]) -> Vec<Chunk> {
    let parts = order.chunks(CHUNK).zip((0_u32..).step_by(CHUNK));
    let chunk = |(part, first): (&[u32], u32)| {
        let within = || part.iter().map(|&index| positions[index as usize]);
        let low = within().fold(DVec3::MAX, DVec3::min);
        let high = within().fold(DVec3::MIN, DVec3::max);
        let center = low.midpoint(high);
        let reach = within().fold(0.0_f64, |most, p| most.max(p.distance_squared(center)));
        Chunk {
            first,
            count: part.len() as u32,
            center,
            reach: reach.sqrt(),
        }
    };
    parts.map(chunk).collect()
}

impl Chunk {
    /// Center relative to the eye.
    pub(super) fn relative(&self, eye: DVec3) -> Vec3 {
        (self.center - eye).as_vec3()
    }
}

/// Bits of three numbers of 21 bits in turn.
fn morton(cell: UVec3) -> u64 {
    let spread = |n: u32| {
        let mut x = u64::from(n) & 0x1f_ffff;
        x = (x | (x << 32)) & 0x001f_0000_0000_ffff;
        x = (x | (x << 16)) & 0x001f_0000_ff00_00ff;
        x = (x | (x << 8)) & 0x100f_00f0_0f00_f00f;
        x = (x | (x << 4)) & 0x10c3_0c30_c30c_30c3;
        (x | (x << 2)) & 0x1249_2492_4924_9249
    };
    spread(cell.x) | (spread(cell.y) << 1) | (spread(cell.z) << 2)
}

/// Fisher and Yates' shuffle, the same every time.
fn shuffle(indices: &mut [u32]) {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    for last in (1..indices.len()).rev() {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        indices.swap(last, ((state >> 33) as usize) % (last + 1));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_marker_is_in_one_chunk_and_within_its_sphere() {
        let positions: Vec<DVec3> = (0..5000)
            .map(|i| {
                let t = f64::from(i);
                DVec3::new((t * 0.37).sin(), (t * 0.73).cos(), t * 1e-3) * 400.0
            })
            .collect();
        let order = ordered(&positions);
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert!(sorted.iter().copied().eq(0..5000));
        let chunks = chunks(&positions, &order);
        assert_eq!(chunks.iter().map(|c| c.count).sum::<u32>(), 5000);
        for chunk in &chunks {
            let part = &order[chunk.first as usize..][..chunk.count as usize];
            for &index in part {
                let distance = positions[index as usize].distance(chunk.center);
                assert!(distance <= chunk.reach * (1.0 + 1e-12));
            }
        }
    }

    #[test]
    fn neighbors_on_the_curve_are_neighbors_in_space() {
        assert_eq!(morton(UVec3::new(1, 0, 0)), 1);
        assert_eq!(morton(UVec3::new(0, 1, 0)), 2);
        assert_eq!(morton(UVec3::new(0, 0, 1)), 4);
        assert_eq!(morton(UVec3::splat((1 << 21) - 1)), (1 << 63) - 1);
    }
}
