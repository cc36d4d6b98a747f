//! How a picture is divided into tiles.
//!
//! Around what is kept of a tile, a margin as wide as ambient occlusion reaches is drawn too: at 16 samples and the
//! default size, 178 sub-pixels to each side. So tiles are as few and as square as memory allows: of all
//! divisions whose tiles are small enough, the one that draws the fewest sub-pixels.

use crate::gpu::device::Gpu;
use crate::output::options::{PictureOptions, Viewpoint, samples_in_sub_pixel};
use crate::output::tiles::Finishing;
use crate::shading::finish::BLUR;
use crate::shading::shade::GUARD;
use crate::view::camera::Camera;
use crate::view::frame::{Frame, Tile};

/// A picture's tiles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Tiling {
    /// Sub-pixels per pixel along a side.
    scale: u32,
    /// Samples of a sub-pixel.
    pub(crate) samples: u32,
    /// Sub-pixels around a tile.
    margin: u32,
    /// Pixels kept of a tile.
    pub(crate) step: [u32; 2],
    /// Radius of occlusion: µm, and most sub-pixels.
    occlusion: Option<(f32, f32)>,
}

impl Tiling {
    /// The tiles of a picture from a camera.
    pub(crate) fn new(options: &PictureOptions, gpu: &Gpu, camera: &Camera) -> Self {
        let scale = options.sub_pixels(gpu);
        let size = options.size.map(|n| n.max(1));
        let occlusion = options.occlusion.reach(camera, size[1] * scale);
        let margin = occlusion
            .map_or(0, |(_, most)| most as u32 + BLUR + 2)
            .next_multiple_of(scale);
        let most = Most {
            side: gpu.largest_texture() - 2 * GUARD as u32,
            square: options.tile,
        };
        Self {
            scale,
            samples: samples_in_sub_pixel(gpu, options.samples_taken()),
            margin,
            step: step(size, scale, margin, most),
            occlusion,
        }
    }

    /// How its tiles are finished.
    pub(crate) fn finishing(&self, options: &PictureOptions) -> Finishing {
        Finishing {
            scale: self.scale,
            margin: self.margin,
            occlusion: self.occlusion,
            background: options.background,
        }
    }

    /// The frame of the tile whose upper left pixel is at `[left, top]` of a picture of this size.
    pub(crate) fn frame(&self, view: &Viewpoint, size: [u32; 2], [left, top]: [u32; 2]) -> Frame {
        let Self {
            scale,
            margin,
            step,
            ..
        } = *self;
        let place = |n: u32| (n * scale) as i32 - margin as i32;
        Frame {
            camera: view.camera,
            near: view.near,
            size: size.map(|n| n * scale),
            tile: Tile {
                x: place(left),
                y: place(top),
                width: step[0] * scale + 2 * margin,
                height: step[1] * scale + 2 * margin,
            },
        }
    }
}

impl PictureOptions {
    /// Number of tiles of a picture.
    pub fn tiles(&self, gpu: &Gpu, camera: &Camera) -> usize {
        let step = Tiling::new(self, gpu, camera).step;
        let [across, down] = [0, 1].map(|k| self.size[k].max(1).div_ceil(step[k]));
        across as usize * down as usize
    }
}

/// How large tiles may be (sub-pixels, with their margins).
#[derive(Clone, Copy, Debug)]
struct Most {
    side: u32,
    /// Side of a square of the greatest area.
    square: u32,
}

/// Fewest pixels kept of a tile along a side, however small tiles should be.
const LEAST_STEP: u32 = 32;

/// Pixels kept of a tile, along both sides.
fn step(size: [u32; 2], scale: u32, margin: u32, most: Most) -> [u32; 2] {
    let least = LEAST_STEP * scale + 2 * margin;
    let area = u64::from(most.square.max(least)).pow(2);
    let drawn = |step: u32| u64::from(step * scale + 2 * margin);
    let widest = (most.side.max(least) - 2 * margin) / scale;
    let divided = |across: u32| {
        let width = size[0].div_ceil(across);
        if width > widest || width < LEAST_STEP.min(size[0]) {
            return None;
        }
        let highest = (area / drawn(width)).min(u64::from(most.side.max(least)));
        let highest = (highest as u32).checked_sub(2 * margin)? / scale;
        let highest = highest.min(size[1]);
        if highest < LEAST_STEP.min(size[1]) {
            return None;
        }
        let down = size[1].div_ceil(highest);
        let height = size[1].div_ceil(down);
        let pixels = u64::from(across) * u64::from(down) * drawn(width) * drawn(height);
        Some((pixels, [width, height]))
    };
    let all = (1..=size[0].div_ceil(LEAST_STEP)).filter_map(divided);
    let best = all.min_by_key(|&(pixels, _)| pixels);
    best.map_or(size.map(|n| n.min(LEAST_STEP)), |(_, step)| step)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROOMY: Most = Most {
        side: 16_000,
        square: 1536,
    };

    #[test]
    fn tiles_cover_a_picture_within_their_bounds() {
        for size in [
            [1, 1],
            [31, 2000],
            [300, 260],
            [1280, 960],
            [7919, 31],
            [32_768, 32_768],
        ] {
            for (scale, margin) in [(1, 0), (2, 54), (2, 178), (4, 366)] {
                for square in [97, 333, 1536] {
                    let most = Most { square, ..ROOMY };
                    let [width, height] = step(size, scale, margin, most);
                    assert!(width >= 1 && width <= size[0] && height >= 1 && height <= size[1]);
                    let drawn = |n: u32| u64::from(n * scale + 2 * margin);
                    let least = u64::from(LEAST_STEP * scale + 2 * margin);
                    let area = u64::from(square).max(least).pow(2);
                    assert!(
                        drawn(width) * drawn(height) <= area,
                        "{size:?} {scale} {margin}"
                    );
                    assert!(drawn(width.max(height)) <= u64::from(ROOMY.side).max(least));
                }
            }
        }
    }

    #[test]
    fn a_default_picture_draws_fewer_than_twice_its_sub_pixels() {
        let step = step([1280, 960], 2, 180, ROOMY);
        assert_eq!(step, [640, 480]);
        let drawn = 4 * (2 * step[0] + 360) * (2 * step[1] + 360);
        assert!(f64::from(drawn) < 2.0 * 2560.0 * 1920.0);
    }
}
