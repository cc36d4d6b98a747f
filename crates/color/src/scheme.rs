//! The inputs and the result of a coloring.

use neurotess_mesh::CoarseMesh;
use neurotess_morphology::{Morphology, NeuriteKind};
use neurotess_picture::color::{CATEGORY_BIT, ColorTable, Palette, Rgb};
use neurotess_picture::overlay::Legend;

use crate::own_colors::{ColorTarget, ColoredThing, OwnColors};

/// A cell to color.
#[derive(Clone, Copy, Debug)]
pub struct Cell<'c> {
    /// Name for the legend.
    pub name: &'c str,
    /// The tracing.
    pub morphology: &'c Morphology,
    /// Its coarse mesh.
    pub mesh: &'c CoarseMesh,
    /// Factor on the traced radii with which the mesh was made: 1 unless for figures.
    pub radius_factor: f64,
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
    /// What has a color that can be chosen, in the order of the legend, also where that names none
    /// because there are too many.
    pub things: Vec<ColoredThing>,
}

impl Coloring {
    /// Number of categories that the cells have, also beyond the end of the table, where all have its last
    /// color.
    pub fn categories(&self) -> usize {
        let keys = self.color_keys.iter().flatten();
        let categories = keys.filter(|&key| key & CATEGORY_BIT != 0);
        let used = categories.map(|key| (key & !CATEGORY_BIT) as usize + 1);
        self.table.categories.len().max(used.max().unwrap_or(0))
    }
}

/// The colors that a coloring uses.
#[derive(Clone, Debug)]
pub struct ColorScheme {
    /// Colors of types and other categories.
    pub palette: Palette,
    /// Colors that are not the palette's.
    pub own_colors: OwnColors,
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
            things: Vec::new(),
            table: ColorTable {
                scale: self.scale.clone(),
                categories: vec![NOTHING],
                ..ColorTable::default()
            },
        }
    }

    pub(crate) fn of_type(&self, kind: i32) -> Rgb {
        if let Some(&own) = self.own_colors.types.get(&kind) {
            return own;
        }
        match NeuriteKind(kind) {
            NeuriteKind::SOMA => self.palette.of_soma(self.background),
            _ => self.palette.of_type(kind),
        }
    }

    /// A type with its color.
    pub(crate) fn thing_of_type(&self, kind: i32) -> ColoredThing {
        ColoredThing {
            target: ColorTarget::Type(kind),
            color: self.of_type(kind),
        }
    }

    /// Different colors for things with these names, as far as the palette has them.
    pub(crate) fn distinct(&self, names: &[String]) -> Vec<ColoredThing> {
        let thing = |(index, name): (usize, &String)| {
            let target = ColorTarget::Category(name.clone());
            let own = self.own_colors.get(&target);
            ColoredThing {
                color: own.unwrap_or_else(|| self.palette.distinct(index)),
                target,
            }
        };
        names.iter().enumerate().map(thing).collect()
    }

    /// What the legend lists of things that have [`ColorScheme::distinct`] colors, and its title.
    /// If colors repeat, only those that were chosen mean something.
    pub(crate) fn listed(
        &self,
        things: &[ColoredThing],
        title: &str,
        plural: &str,
    ) -> (String, Vec<(Rgb, String)>) {
        let is_own = |thing: &&ColoredThing| self.own_colors.get(&thing.target).is_some();
        let entry = |thing: &ColoredThing| (thing.color, thing.target.to_string());
        let repeat = things.len() > self.palette.distinct_count();
        if repeat && !things.iter().all(|thing| is_own(&thing)) {
            let title = format!("{} {plural}, colors repeat", things.len());
            return (title, things.iter().filter(is_own).map(entry).collect());
        }
        (title.to_owned(), things.iter().map(entry).collect())
    }
}
