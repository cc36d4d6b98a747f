//! The bands of a picture, and what all of them have in common.
//!
//! A **band** is as many rows of pixels as memory allows. What it is drawn of reaches beyond it as far as ambient
//! occlusion does, so that bands fit together.

use std::ops::Range;

use neurotess_picture::{LARGEST, PictureOptions, Viewpoint};

use crate::grid::{Grid, TILE};
use crate::light::Lights;
use crate::occlusion::BLUR;
use crate::projection::Projection;

/// Most sub-pixels of a band, with what is around it: samples of all of them would take 800 MB, of a cell's a tenth.
const MAX_BAND: u64 = 1 << 24;
/// Rows of pixels that are drawn at once.
pub(crate) struct Band {
    /// Rows of pixels.
    pub(crate) rows: Range<u32>,
    pub(crate) grid: Grid,
}

/// How a picture is divided and finished.
pub(crate) struct Setup {
    pub(crate) size: [u32; 2],
    /// Sub-pixels per pixel, along one side.
    pub(crate) scale: u32,
    pub(crate) many_samples: bool,
    /// Radius of occlusion: µm, and most sub-pixels.
    pub(crate) occlusion: Option<(f32, f32)>,
    pub(crate) projection: Projection,
    pub(crate) lights: Lights,
}

impl Setup {
    pub(crate) fn new(view: &Viewpoint, options: &PictureOptions) -> Self {
        let many_samples = options.samples_in_sub_pixel() > 1;
        let scale = options.sub_pixels(options.samples_in_sub_pixel());
        let size = options.size.map(|n| n.clamp(1, LARGEST));
        Self {
            size,
            scale,
            many_samples,
            occlusion: options.occlusion.reach(&view.camera, size[1] * scale),
            projection: Projection::new(view, options, scale),
            lights: Lights::new(&options.look),
        }
    }

    /// Sub-pixels around a band that what is in it depends on.
    fn margin(&self) -> i32 {
        self.occlusion.map_or(0, |(_, most)| most as i32 + BLUR + 2)
    }

    /// The bands from above.
    pub(crate) fn bands(&self) -> Vec<Band> {
        let margin = self.margin();
        let [width, height] = self.size;
        let scale = self.scale as i32;
        let across = u64::from(width * self.scale) + 2 * margin as u64;
        let rows = (MAX_BAND / across) as i64 - 2 * i64::from(margin);
        // At least a row of tiles, lest most of what is drawn is around.
        let step = (rows / i64::from(scale))
            .max(i64::from(TILE / scale))
            .max(1) as usize;
        (0..height)
            .step_by(step)
            .map(|top| {
                let rows = top..height.min(top + step as u32);
                let kept = [
                    0..width as i32 * scale,
                    rows.start as i32 * scale..rows.end as i32 * scale,
                ];
                let widened = |by: i32| kept.clone().map(|kept| kept.start - by..kept.end + by);
                let grid = Grid::new(widened(margin), widened(BLUR), self.many_samples);
                Band { rows, grid }
            })
            .collect()
    }
}

/// Number of bands of a picture.
pub fn bands(view: &Viewpoint, options: &PictureOptions) -> usize {
    Setup::new(view, options).bands().len()
}
