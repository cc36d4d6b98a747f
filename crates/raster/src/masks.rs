//! Which samples of a sub-pixel something covers in part. Twin of `bayer` and `mask_of` in shade.wgsl.

/// Four thresholds in the order of Bayer, for a block of two by two.
pub(crate) fn bayer([x, y]: [u32; 2]) -> f32 {
    let (x, y) = (x & 1, y & 1);
    (((x ^ y) * 2 + y) as f32 + 0.5) / 4.0
}

/// Mask of so many samples for a coverage, dithered over neighboring sub-pixels.
pub(crate) fn mask_of(coverage: f32, samples: u32, [x, y]: [i32; 2]) -> u32 {
    let all = (1 << samples) - 1;
    if coverage >= 1.0 {
        return all;
    }
    let (x, y) = ((x + 4096) as u32, (y + 4096) as u32);
    let count = (coverage.clamp(0.0, 1.0) * samples as f32 + bayer([x, y])) as u32;
    let turn = (x + 2 * y) % samples;
    let bits = ((1_u32 << count) - 1) << turn;
    (bits | (bits >> samples)) & all
}
