//! The grids that patches are drawn in: one index buffer for all of them, made once.
//!
//! A patch's grid has 1 to 64 columns and rows. It is drawn in the smallest **bucket** whose grid
//! holds it: each axis has one of the sizes in [`GRID_SIZE`], and columns beyond the patch's own
//! fall together with its last one, as triangles without area. So 12 × 12 buckets draw all 4,096
//! grids with exactly their own vertices, and no axis has more than half too many. Round patches
//! (caps, somata) have buckets of their own, in which diagonals run towards the corners. So have
//! **tubes**, lateral patches between two points with implicit rings: they are many, and a shader
//! of their own computes their vertices.
//!
//! Small grids fill a GPU's waves badly: an instance of a small bucket draws **several patches
//! together**, about 256 vertices.
//!
//! Patches at level 1, most of what is far away, are in no bucket: they are drawn as **flat** quads
//! with shared corners (coarse_point.wgsl), by an index buffer that the device writes.
//!
//! Why not one draw per grid: 4,096 draws, most of them empty. Why an index buffer: with it a
//! vertex is evaluated once per grid point, without it up to six times.

use bytemuck::{Pod, Zeroable};

/// Sizes of a grid's axis. Finer than powers of two: an axis then has at most half too many
/// columns.
pub(crate) const GRID_SIZE: [u32; 12] = [1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64];

/// Grids of tubes.
pub(crate) const TUBE_BUCKETS: usize = GRID_SIZE.len() * GRID_SIZE.len();
/// Grids of tubes, then those of other lateral patches, then those of round ones.
pub(crate) const BUCKETS: usize = 3 * TUBE_BUCKETS;

/// Indices of a flat patch: two triangles.
pub(crate) const FLAT_INDICES: u32 = 6;
/// The bits of a flat patch's index from this one on say which of its corners it is; only
/// wireframes need them.
pub(crate) const FLAT_CORNER_SHIFT: u32 = 28;

/// Small patches are drawn together until an instance of the draw has about this many vertices.
pub(crate) const VERTICES_TOGETHER: u32 = 256;

// A vertex index says, from its low bits upwards: column, row, patch in the instance, bucket.
pub(crate) const INDEX_PLACE_MASK: u32 = 0x7f;
pub(crate) const INDEX_ROW_SHIFT: u32 = 7;
pub(crate) const INDEX_PATCH_SHIFT: u32 = 14;
pub(crate) const INDEX_PATCH_MASK: u32 = 0xff;
pub(crate) const INDEX_BUCKET_SHIFT: u32 = 22;

/// A bucket on the device. Twin of the struct of the same name in scan.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub(crate) struct Bucket {
    /// First place in the list; the device fills it in.
    pub(crate) start: u32,
    /// Number of patches; the device fills it in.
    pub(crate) count: u32,
    /// Patches per instance of the draw.
    pub(crate) together: u32,
    /// Number of indices of one instance.
    pub(crate) indices: u32,
    /// Where they begin in the index buffer.
    pub(crate) first_index: u32,
}

/// All buckets with the indices that draw them.
pub(crate) fn buckets() -> (Vec<Bucket>, Vec<u32>) {
    let mut all = Vec::with_capacity(BUCKETS);
    let mut indices = Vec::new();
    for round in [false, false, true] {
        for ny in GRID_SIZE {
            for nx in GRID_SIZE {
                let first_index = indices.len() as u32;
                let together = (VERTICES_TOGETHER / ((nx + 1) * (ny + 1))).max(1);
                let bucket = (all.len() as u32) << INDEX_BUCKET_SHIFT;
                for patch in 0..together {
                    let patch = bucket | (patch << INDEX_PATCH_SHIFT);
                    push_grid(patch, nx, ny, round, &mut indices);
                }
                all.push(Bucket {
                    together,
                    indices: indices.len() as u32 - first_index,
                    first_index,
                    ..Bucket::default()
                });
            }
        }
    }
    (all, indices)
}

fn push_grid(patch: u32, nx: u32, ny: u32, round: bool, indices: &mut Vec<u32>) {
    let at = |i: u32, j: u32| patch | i | (j << INDEX_ROW_SHIFT);
    for j in 0..ny {
        for i in 0..nx {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            // Diagonals as in the exported surface: towards the corners of round patches, else
            // parallel.
            if round && (2 * i < nx) != (2 * j < ny) {
                indices.extend([a, b, d, b, c, d]);
            } else {
                indices.extend([a, b, c, a, c, d]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_index_names_its_bucket_and_a_place_in_its_grid() {
        let (all, indices) = buckets();
        assert_eq!(all.len(), BUCKETS);
        for (b, bucket) in all.iter().enumerate() {
            let nx = GRID_SIZE[b % GRID_SIZE.len()];
            let ny = GRID_SIZE[b / GRID_SIZE.len() % GRID_SIZE.len()];
            assert_eq!(bucket.indices, 6 * nx * ny * bucket.together);
            let first = bucket.first_index as usize;
            for index in &indices[first..first + bucket.indices as usize] {
                assert_eq!(index >> INDEX_BUCKET_SHIFT, b as u32);
                assert!(index & INDEX_PLACE_MASK <= nx);
                assert!((index >> INDEX_ROW_SHIFT) & INDEX_PLACE_MASK <= ny);
                assert!((index >> INDEX_PATCH_SHIFT) & INDEX_PATCH_MASK < bucket.together);
            }
        }
    }

    #[test]
    fn all_grids_together_cost_a_few_megabytes() {
        let (_, indices) = buckets();
        assert!(size_of_val(&*indices) < 5 << 20, "{}", indices.len());
    }
}
