//! What goes into a coloring and what comes out of it.

use neurotess_mesh::CoarseMesh;
use neurotess_morphology::{Morphology, NeuriteKind};
use neurotess_render::color::{ColorTable, Palette, Rgb};
use neurotess_render::overlay::Legend;

/// A cell to color.
#[derive(Clone, Copy, Debug)]
pub struct Cell<'c> {
    /// Name for the legend.
    pub name: &'c str,
    /// The tracing.
    pub morphology: &'c Morphology,
    /// Its coarse mesh.
    pub mesh: &'c CoarseMesh,
}

/// Colors of all cells.
#[derive(Clone, Debug)]
pub struct Coloring {
    /// For each cell a key per tracing point.
    pub color_keys: Vec<Vec<u32>>,
    /// The color that each key stands for.
    pub table: ColorTable,
    /// What the colors tell, for people.
    pub legend: Legend,
}

/// The colors to choose from.
#[derive(Clone, Debug)]
pub struct ColorScheme {
    /// Of types, and of categories without an order.
    pub palette: Palette,
    /// Behind everything: black is not drawn on black.
    pub background: Option<Rgb>,
    /// Of numbers.
    pub scale: Vec<Rgb>,
    /// Numbers at both ends of the scale; none: those that fit.
    pub range: Option<[f32; 2]>,
}

/// Color of what has no value: a gray that no scale has.
pub const NOTHING: Rgb = [160; 3];

impl ColorScheme {
    /// Color keys on the scale, from one number to another; the first category is for what has none.
    pub fn scaled(
        &self,
        color_keys: Vec<Vec<u32>>,
        title: &str,
        unit: &str,
        range: [f32; 2],
    ) -> Coloring {
        Coloring {
            color_keys,
            legend: Legend::bar(title, unit, self.scale.clone(), range, false),
            table: ColorTable {
                scale: self.scale.clone(),
                categories: vec![NOTHING],
                ..ColorTable::default()
            },
        }
    }

    pub(crate) fn of_type(&self, kind: i32) -> Rgb {
        match NeuriteKind(kind) {
            NeuriteKind::SOMA => self.palette.of_soma(self.background),
            _ => self.palette.of_type(kind),
        }
    }
}
