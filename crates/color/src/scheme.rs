//! The inputs and the result of a coloring.

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
    /// By cell: a key for each tracing point.
    pub color_keys: Vec<Vec<u32>>,
    /// The color that each key stands for.
    pub table: ColorTable,
    /// The legend.
    pub legend: Legend,
}

/// The colors that a coloring uses.
#[derive(Clone, Debug)]
pub struct ColorScheme {
    /// Colors of types and other categories.
    pub palette: Palette,
    /// The background, so that somata are not drawn black on black.
    pub background: Option<Rgb>,
    /// Colors of numbers.
    pub scale: Vec<Rgb>,
    /// Numbers at both ends of the scale; none: they follow from the data.
    pub range: Option<[f32; 2]>,
}

/// Color of points without a value: a gray that is in no color map.
pub const NOTHING: Rgb = [160; 3];

impl ColorScheme {
    /// A coloring by these keys, with a legend of this range; points of the first category have no
    /// value.
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
