//! The cells of a picture, and how they are refined.

use itertools::Itertools;
use neurotess_picture::{AdaptiveSettings, Instance, Placement, Template, TemplateId};

use crate::colors::PictureColors;
use crate::error::DrawError;
use crate::meshed::MeshedCell;
use crate::options::DrawOptions;

/// The cells of a picture.
#[derive(Clone, Copy)]
pub(crate) struct Shown<'a> {
    pub(crate) asked: &'a DrawOptions,
    pub(crate) cells: &'a [&'a MeshedCell],
    pub(crate) placements: &'a [(usize, Placement)],
    pub(crate) colored: &'a PictureColors,
}

impl<'a> Shown<'a> {
    /// Coarse meshes with the keys of their colors.
    pub(crate) fn templates(&self) -> Vec<Template<'a>> {
        let keyed = self.cells.iter().zip_eq(&self.colored.coloring.color_keys);
        keyed
            .map(|(cell, color_keys)| Template {
                mesh: &cell.mesh,
                color_keys,
                values: &[],
            })
            .collect()
    }

    pub(crate) fn instances(&self, id: impl Fn(usize) -> TemplateId) -> Vec<Instance> {
        let placements = self.placements.iter();
        placements
            .map(|&(cell, placement)| Instance {
                placement,
                ..Instance::new(id(cell))
            })
            .collect()
    }

    /// Coarse patches of all instances.
    pub(crate) fn patches(&self) -> u64 {
        let placements = self.placements.iter();
        let patches = placements.map(|&(cell, _)| self.cells[cell].mesh.patches.len() as u64);
        patches.sum()
    }

    /// How it is refined as it is drawn.
    pub(crate) fn settings(&self) -> Result<AdaptiveSettings, DrawError> {
        let picture = &self.asked.picture;
        let wireframe = picture.look.wireframe;
        Ok(AdaptiveSettings {
            lod: picture.refinement.criterion(wireframe)?,
            wireframe,
            ..AdaptiveSettings::default()
        })
    }
}
