//! A job: the scene, cameras and files of a run.

use std::path::PathBuf;

use neurotess::picture::overlay::Overlay;
use neurotess::picture::{BoundingSphere, Camera, Placement};

use super::args::RenderArgs;
use super::cells::MeshedCell;
use super::coloring::PictureColors;
use super::shown::Shown;

/// The scene, cameras and files of a run.
pub(super) struct RenderJob<'a> {
    pub(super) args: &'a RenderArgs,
    pub(super) cells: &'a [&'a MeshedCell],
    pub(super) placements: &'a [(usize, Placement)],
    pub(super) colored: &'a PictureColors,
    pub(super) cameras: &'a [Camera],
    /// What cameras fit.
    #[cfg(feature = "gpu")]
    pub(super) spheres: &'a [BoundingSphere],
    /// What holds everything, for near planes.
    pub(super) around: &'a [BoundingSphere],
    pub(super) overlay: &'a Overlay,
    pub(super) files: &'a [PathBuf],
}

impl<'a> RenderJob<'a> {
    /// The cells that are drawn.
    pub(super) fn shown(&self) -> Shown<'a> {
        Shown {
            args: self.args,
            cells: self.cells,
            placements: self.placements,
            colored: self.colored,
        }
    }
}
