//! What colors tell in a page: schemes that one switches between, palettes, color maps.

use neurotess_color::{ColorBy, ColorTarget, Coloring, OwnColors};
use neurotess_morphology::NeuriteKind;
use neurotess_picture::color::{CATEGORY_BIT, ColorMap, Palette, Rgb};
use serde::Serialize;

use crate::arrays::{ArrayRef, Arrays};

/// A scheme that a page offers: its coloring by the library.
#[derive(Clone, Copy, Debug)]
pub struct PageScheme<'s> {
    /// What colors tell.
    pub by: ColorBy,
    /// Color keys by cell of the page, the table and the legend.
    pub coloring: &'s Coloring,
}

impl PageScheme<'_> {
    /// What colors tell, and the entries of the legend; none of a scale.
    pub(crate) fn entries(&self) -> (ColorBy, Vec<String>) {
        let is_scale = self.coloring.legend.range().is_some();
        let things = self.coloring.things.iter().filter(|_| !is_scale);
        (self.by, things.map(|t| t.target.to_string()).collect())
    }
}

/// A scheme as the page's host reads it.
#[derive(Debug, Serialize)]
pub(crate) struct SchemeData {
    id: &'static str,
    label: &'static str,
    /// Of numbers: the title of the scale.
    title: String,
    /// Of numbers: those at the ends of the scale, and whether the upper end stands for what lies above.
    range: Option<([f32; 2], bool)>,
    /// Of numbers that cells have anyway: `radius` or `distance`.
    attribute: Option<&'static str>,
    things: Vec<Thing>,
    /// By cell, if there is no attribute: a category with [`CATEGORY`], or a share of the scale.
    keys: Vec<ArrayRef>,
}

/// Something with a color of its own.
#[derive(Debug, Serialize)]
struct Thing {
    name: String,
    /// SWC type, whose color the palette has.
    #[serde(skip_serializing_if = "Option::is_none")]
    kind: Option<i32>,
    /// A color that was chosen.
    #[serde(skip_serializing_if = "Option::is_none")]
    own: Option<Rgb>,
}

/// Set in the key of a category; shares of the scale are below.
const CATEGORY: u16 = 1 << 15;

impl SchemeData {
    pub(crate) fn new(scheme: &PageScheme<'_>, own: &OwnColors, arrays: &mut Arrays) -> Self {
        let PageScheme { by, coloring } = *scheme;
        let (id, label, attribute) = match by {
            ColorBy::Type => ("type", "type", None),
            ColorBy::Neurite => ("neurite", "neurite", None),
            ColorBy::Section => ("section", "section", None),
            ColorBy::BranchOrder => ("order", "branch order", None),
            ColorBy::Radius => ("radius", "radius", Some("radius")),
            ColorBy::PathDistance => ("distance", "path distance", Some("distance")),
            ColorBy::Neuron => ("neuron", "neuron", None),
        };
        let things = coloring.things.iter().map(|thing| Thing {
            name: thing.target.to_string(),
            kind: match thing.target {
                ColorTarget::Type(kind) => Some(kind),
                ColorTarget::Category(_) => None,
            },
            own: own.get(&thing.target),
        });
        let keys = coloring.color_keys.iter().filter(|_| attribute.is_none());
        let keys = keys.map(|keys| {
            let small: Vec<u16> = keys.iter().map(|&key| small_key(key)).collect();
            arrays.u16s(&small)
        });
        Self {
            id,
            label,
            title: coloring.legend.title().to_owned(),
            range: coloring.legend.range(),
            attribute,
            things: things.collect(),
            keys: keys.collect(),
        }
    }
}

/// A color key in 16 bits.
pub(crate) fn small_key(key: u32) -> u16 {
    let number = key & !CATEGORY_BIT;
    match key & CATEGORY_BIT {
        0 => (number >> 16) as u16,
        _ => CATEGORY | number.min(u32::from(CATEGORY) - 1) as u16,
    }
}

/// The colors of a palette; lists of them are text, as [`hex`] writes it.
#[derive(Debug, Serialize)]
pub(crate) struct PaletteData {
    name: &'static str,
    /// Of SWC types from 0 on, the last eight for all others in turn.
    types: String,
    soma_on_dark: Rgb,
    distinct: String,
}

/// Number of types with colors of their own.
const TYPES: i32 = 5 + 8;

/// All palettes.
pub(crate) fn palettes() -> Vec<PaletteData> {
    let data = |palette: Palette| PaletteData {
        name: palette.name(),
        types: (0..TYPES)
            .map(|kind| match NeuriteKind(kind) {
                NeuriteKind::SOMA => palette.of_soma(None),
                _ => palette.of_type(kind),
            })
            .map(hex)
            .collect(),
        soma_on_dark: palette.of_soma(Some([0; 3])),
        distinct: (0..palette.distinct_count())
            .map(|k| hex(palette.distinct(k)))
            .collect(),
    };
    Palette::ALL.map(data).into()
}

/// A color as six letters: a third of what it takes as numbers. Read by `Scene` in scene.js.
fn hex([red, green, blue]: Rgb) -> String {
    format!("{red:02x}{green:02x}{blue:02x}")
}

/// A color map, between whose colors others are mixed.
#[derive(Debug, Serialize)]
pub(crate) struct ColorMapData {
    name: &'static str,
    colors: String,
}

/// All color maps, every eighth color.
pub(crate) fn color_maps() -> Vec<ColorMapData> {
    let data = |map: ColorMap| ColorMapData {
        name: map.name(),
        colors: {
            let scale = map.scale();
            let last = scale.len() - 1;
            (0..=32).map(|k| hex(scale[k * last / 32])).collect()
        },
    };
    ColorMap::ALL.map(data).into()
}
