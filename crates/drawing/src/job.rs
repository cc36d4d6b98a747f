//! The scene, cameras and overlay of a drawing, while what draws is made.

#[cfg(feature = "gpu")]
use neurotess_picture::BoundingSphere;
use neurotess_picture::{Camera, Placement};

use crate::colors::PictureColors;
use crate::meshed::MeshedCell;
use crate::options::DrawOptions;
use crate::shown::Shown;

/// The scene and cameras of a drawing.
pub(crate) struct Job<'a> {
    pub(crate) asked: &'a DrawOptions,
    pub(crate) cells: &'a [&'a MeshedCell],
    pub(crate) placements: &'a [(usize, Placement)],
    pub(crate) colored: &'a PictureColors,
    pub(crate) cameras: &'a [Camera],
    /// What cameras fit.
    #[cfg(feature = "gpu")]
    pub(crate) spheres: &'a [BoundingSphere],
}

impl<'a> Job<'a> {
    /// The cells that are drawn.
    pub(crate) fn shown(&self) -> Shown<'a> {
        Shown {
            asked: self.asked,
            cells: self.cells,
            placements: self.placements,
            colored: self.colored,
        }
    }
}
