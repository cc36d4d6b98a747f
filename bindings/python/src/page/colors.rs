//! What a page begins with, from the keywords of Python.

use neurotess::coloring::{ColorBy, OwnColors, rgb};
use neurotess::render::color::{ColorMap, Palette, Rgb};
use neurotess_cli::embed;
use pyo3::prelude::*;

/// What a page may be colored by, under the names that the command line has.
const COLOR_BY: [(&str, ColorBy); 7] = [
    ("type", ColorBy::Type),
    ("neurite", ColorBy::Neurite),
    ("section", ColorBy::Section),
    ("order", ColorBy::BranchOrder),
    ("radius", ColorBy::Radius),
    ("depth", ColorBy::PathDistance),
    ("neuron", ColorBy::Neuron),
];

/// The name of what colors tell.
pub(super) fn name_of(by: ColorBy) -> &'static str {
    let named = COLOR_BY.iter().find(|&&(_, other)| other == by);
    named.map_or("", |&(name, _)| name)
}

/// The keywords of a page, as Python has them. What is none has its default.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(super) struct Keywords {
    pub(super) title: Option<String>,
    color_by: Option<String>,
    palette: Option<String>,
    set_color: Vec<(String, String)>,
    colormap: Option<String>,
    pub(super) range: Option<[f32; 2]>,
    background: Option<String>,
    pub(super) least_width: Option<f32>,
    /// Options of a report, synapses and points, as the command line has them.
    pub(super) content: Vec<String>,
}

/// What a page begins with.
pub(super) struct Colors {
    pub(super) first: Option<ColorBy>,
    pub(super) palette: Palette,
    pub(super) own_colors: OwnColors,
    pub(super) color_map: ColorMap,
    pub(super) background: Option<Rgb>,
}

impl Colors {
    /// # Errors
    /// A word that is none, in the words that errors of options are read from.
    pub(super) fn of(keywords: &Keywords) -> Result<Self, String> {
        let wrong = |option: &str, value: &str, needed: &str| {
            format!("invalid value '{value}' for '{option}': {needed}")
        };
        let palette = keywords
            .palette
            .as_deref()
            .map(|text| embed::palette(text).map_err(|needed| wrong("palette", text, &needed)));
        let palette = palette.transpose()?.unwrap_or_default();
        let mut own_colors = palette.own_colors;
        for (name, color) in &keywords.set_color {
            let color = rgb(color);
            let color = color.map_err(|needed| wrong("palette", name, &needed))?;
            own_colors.set_named(name, color);
        }
        let map = keywords.colormap.as_deref().map(|name| {
            let maps = ColorMap::ALL.map(ColorMap::name);
            name.parse::<ColorMap>()
                .map_err(|_| unknown("colormap", name, &maps))
        });
        let background = keywords
            .background
            .as_deref()
            .map(|color| rgb(color).map_err(|needed| wrong("background", color, &needed)));
        Ok(Self {
            first: first(keywords.color_by.as_deref())?,
            palette: palette.base.unwrap_or_default(),
            own_colors,
            color_map: map.transpose()?.unwrap_or_default(),
            background: background.transpose()?,
        })
    }
}

/// What a page begins with; none: with values, or by type.
fn first(word: Option<&str>) -> Result<Option<ColorBy>, String> {
    let Some(word) = word.filter(|&word| word != "value") else {
        return Ok(None);
    };
    let found = COLOR_BY.iter().find(|(name, _)| *name == word);
    let mut words: Vec<&str> = COLOR_BY.iter().map(|&(name, _)| name).collect();
    words.push("value");
    found
        .map(|&(_, by)| Some(by))
        .ok_or_else(|| unknown("color_by", word, &words))
}

fn unknown(option: &str, given: &str, words: &[&str]) -> String {
    let words = words.join(", ");
    format!("invalid value '{given}' for '{option}' [possible values: {words}]")
}
