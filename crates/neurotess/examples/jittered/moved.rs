//! Cells whose points are moved at random; a test merges some of them, too.

use neurotess::morphology::Morphology;

/// By which share of their radii points of a copy move: from 0.1 for the first to 3 for the last.
pub(crate) fn share(copy: u32, copies: u32) -> f32 {
    0.1 + 2.9 * copy as f32 / copies.saturating_sub(1).max(1) as f32
}

/// A cell whose points have moved by up to a share of their radii.
pub(crate) fn moved(morphology: &Morphology, share: f32, copy: u32) -> Morphology {
    let mut cell = morphology.clone();
    let mut state = u64::from(copy) + 1;
    let mut random = || {
        // Steele et al., Fast splittable pseudorandom number generators, 2014: SplitMix64.
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = state;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((bits ^ (bits >> 31)) >> 40) as f32 / (1_u32 << 23) as f32 - 1.0
    };
    for point in &mut cell.points {
        for coordinate in 0..3 {
            point.position[coordinate] += share * point.radius * random();
        }
    }
    cell
}
