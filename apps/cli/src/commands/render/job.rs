//! A job: the scene, cameras and files of a run.

use std::path::PathBuf;

use neurotess::render::overlay::Overlay;
use neurotess::render::{BoundingSphere, Camera, Placement};

use super::args::RenderArgs;
use super::cells::MeshedCell;
use super::coloring::PictureColors;

/// The scene, cameras and files of a run.
pub(super) struct RenderJob<'a> {
    pub(super) args: &'a RenderArgs,
    pub(super) cells: &'a [&'a MeshedCell],
    pub(super) placements: &'a [(usize, Placement)],
    pub(super) colored: &'a PictureColors,
    pub(super) cameras: &'a [Camera],
    /// What cameras fit.
    pub(super) spheres: &'a [BoundingSphere],
    /// What holds everything, for near planes.
    pub(super) around: &'a [BoundingSphere],
    pub(super) overlay: &'a Overlay,
    pub(super) files: &'a [PathBuf],
}
