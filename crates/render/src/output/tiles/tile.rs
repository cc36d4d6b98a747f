//! A tile: what is drawn, what is kept of it, and how it is finished.

use neurotess_picture::Frame;
use neurotess_picture::color::Rgb;

/// What is drawn at once, and what is kept of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct KeptTile {
    /// What is drawn.
    pub(crate) frame: Frame,
    /// The upper left sub-pixel of what is kept.
    pub(crate) inset: [u32; 2],
    /// Width and height (pixels) of what is kept.
    pub(crate) kept: [u32; 2],
}

impl KeptTile {
    /// The frame of what is kept. `scale`: sub-pixels per pixel along a side.
    pub(super) fn without_margin(&self, scale: u32) -> Frame {
        let mut kept = self.frame;
        kept.tile.x += self.inset[0] as i32;
        kept.tile.y += self.inset[1] as i32;
        kept.tile.width = self.kept[0] * scale;
        kept.tile.height = self.kept[1] * scale;
        kept
    }
}

/// How a tile is finished.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Finishing {
    /// Sub-pixels per pixel along a side.
    pub(crate) scale: u32,
    /// Radius (µm) of ambient occlusion, and the most sub-pixels that it may reach.
    pub(crate) occlusion: Option<(f32, f32)>,
    /// Color behind everything; none: transparent.
    pub(crate) background: Option<Rgb>,
}

impl Finishing {
    /// Bytes of a pixel where nothing is.
    pub(crate) fn empty_pixel(&self) -> [u8; 4] {
        self.background.map_or([0; 4], |[r, g, b]| [r, g, b, 255])
    }
}
