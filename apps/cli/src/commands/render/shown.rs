//! The cells of a picture, and how they are refined.

use itertools::Itertools;
use neurotess::picture::{AdaptiveSettings, Instance, Placement, Template, TemplateId};
use neurotess::refine::LodCriterion;

use super::args::{LodMode, RenderArgs};
use super::cells::MeshedCell;
use super::coloring::PictureColors;
use crate::report::usage;

/// The cells of a picture.
#[derive(Clone, Copy)]
pub(crate) struct Shown<'a> {
    pub(crate) args: &'a RenderArgs,
    pub(crate) cells: &'a [&'a MeshedCell],
    pub(crate) placements: &'a [(usize, Placement)],
    pub(crate) colored: &'a PictureColors,
}

impl<'a> Shown<'a> {
    /// Coarse meshes with the keys of their colors.
    pub(super) fn templates(&self) -> Vec<Template<'a>> {
        let keyed = self.cells.iter().zip_eq(&self.colored.coloring.color_keys);
        keyed
            .map(|(cell, color_keys)| Template {
                mesh: &cell.mesh,
                color_keys,
                values: &[],
            })
            .collect()
    }

    pub(super) fn instances(&self, id: impl Fn(usize) -> TemplateId) -> Vec<Instance> {
        let placements = self.placements.iter();
        placements
            .map(|&(cell, placement)| Instance {
                placement,
                ..Instance::new(id(cell))
            })
            .collect()
    }

    /// Coarse patches of all instances.
    pub(super) fn patches(&self) -> u64 {
        let placements = self.placements.iter();
        let patches = placements.map(|&(cell, _)| self.cells[cell].mesh.patches.len() as u64);
        patches.sum()
    }

    /// How it is refined as it is drawn.
    pub(super) fn settings(&self) -> anyhow::Result<AdaptiveSettings> {
        let args = self.args;
        let lod = match mode(args)? {
            LodMode::Homogeneous => LodCriterion::Homogeneous(args.level.unwrap_or(DEFAULT_LEVEL)),
            LodMode::Static => LodCriterion::PixelError(0.5),
            LodMode::Adaptive | LodMode::Prerefined | LodMode::Exploration => {
                LodCriterion::PixelError(args.error() as f32)
            }
        };
        Ok(AdaptiveSettings {
            lod,
            wireframe: args.wireframe,
            ..AdaptiveSettings::default()
        })
    }
}

/// Level if none is given.
const DEFAULT_LEVEL: u32 = 4;

/// The mode that follows from the options.
///
/// # Errors
/// Wrong usage: a level where levels follow from the error.
pub(super) fn mode(args: &RenderArgs) -> anyhow::Result<LodMode> {
    let exploring = args.lod == Some(LodMode::Exploration);
    if args.budget.is_some() && !exploring {
        return usage("--budget is for --lod exploration");
    }
    if exploring && args.pixels.is_some() {
        return usage("--lod exploration is within half a pixel: leave out --pixels");
    }
    match (args.lod, args.level) {
        (Some(LodMode::Adaptive), Some(_)) => usage(
            "--lod adaptive chooses levels by --pixels: leave out --level, or use --lod homogeneous",
        ),
        (Some(LodMode::Exploration | LodMode::Static), Some(_)) => {
            usage("this --lod has no levels: leave out --level, or use --lod homogeneous")
        }
        (Some(LodMode::Static), None) if args.pixels.is_some() => {
            usage("--lod static is within half a pixel: leave out --pixels, or use --lod adaptive")
        }
        (Some(mode), _) => Ok(mode),
        (None, Some(_)) => Ok(LodMode::Homogeneous),
        (None, None) => Ok(LodMode::Adaptive),
    }
}
