//! What colors tell, and which they are.

use std::collections::BTreeMap;
use std::path::PathBuf;

use neurotess_color::OwnColors;
use neurotess_morphology::NeuriteKind;
use neurotess_picture::color::{ColorMap, Palette, Rgb};
use serde::{Deserialize, Serialize};

use crate::words::{Color, ColorWhat, PaletteName, SetColor};

/// What colors tell, and which they are.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[cfg_attr(feature = "clap", command(next_help_heading = "Colors"))]
#[serde(default, deny_unknown_fields)]
pub struct ColorOptions {
    /// What colors tell [default: type; what a scene says; value, if there is a --report]
    #[cfg_attr(feature = "clap", arg(long, value_enum, value_name = "WHAT"))]
    pub color_by: Option<ColorWhat>,
    /// Cells of a circuit by an attribute, like layer, mtype, population or group
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "NAME", conflicts_with_all = ["color_by", "report"])
    )]
    pub color_by_attribute: Option<String>,
    /// Values of a simulation: a SONATA report, or a file of spikes
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE"))]
    pub report: Option<PathBuf>,
    /// Numbers at both ends of the color map [default: the least and the greatest of all pictures]
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "LOW,HIGH", value_parser = ends, allow_hyphen_values = true)
    )]
    #[serde(with = "range")]
    pub range: Option<[f32; 2]>,
    /// Colors of types and of things told apart: a name, or a file with colors of your own
    #[cfg_attr(
        feature = "clap",
        arg(
            long,
            default_value = "neurom",
            value_name = "NAME|FILE",
            value_parser = parsers::PaletteParser
        )
    )]
    pub palette: PaletteName,
    /// Color of a type (axon, basal, custom_7, …) or of anything else in the legend, before that of the
    /// palette, as in axon=#ff8800; repeatable
    #[cfg_attr(feature = "clap", arg(long, value_name = "NAME=COLOR"))]
    pub set_color: Vec<SetColor>,
    /// Colors of numbers
    #[cfg_attr(
        feature = "clap",
        arg(long, default_value = "viridis", value_name = "NAME", value_parser = parsers::color_maps())
    )]
    #[serde(with = "color_map")]
    pub colormap: ColorMap,
    /// Color behind everything: a name (white, black, gray), RRGGBB or RGB [default: that of the
    /// palette's file, or white; of pages light or dark, as the reader's system is]
    #[cfg_attr(feature = "clap", arg(long, value_name = "COLOR"))]
    pub background: Option<Color>,
}

impl ColorOptions {
    /// The palette of all that has no color of its own.
    pub fn base_palette(&self) -> Palette {
        self.palette.colors.base.unwrap_or_default()
    }

    /// Colors of one's own: those of the file, and over them those of the options.
    pub fn own_colors(&self) -> OwnColors {
        let mut own = self.palette.colors.own_colors.clone();
        for set in &self.set_color {
            own.set_named(&set.name, set.color.0);
        }
        own
    }

    /// The background: that of the options, or that of the palette's file.
    pub fn behind(&self) -> Option<Rgb> {
        let option = self.background.map(|color| color.0);
        option.or(self.palette.colors.background)
    }

    /// The same without the palette's file: its colors are those of options.
    #[must_use]
    pub fn without_file(&self) -> Self {
        let own = self.own_colors();
        let types = own.types.iter();
        let types = types.map(|(&kind, &color)| (NeuriteKind(kind).name().to_owned(), color));
        let named: BTreeMap<String, Rgb> = types.chain(own.categories.clone()).collect();
        let set = |(name, color)| SetColor {
            name,
            color: Color(color),
        };
        Self {
            palette: PaletteName::of(self.base_palette()),
            set_color: named.into_iter().map(set).collect(),
            background: self.behind().map(Color),
            ..self.clone()
        }
    }

    /// Whether cells are colored by numbers.
    pub fn is_number(&self) -> bool {
        let number = self.color_by.is_some_and(ColorWhat::is_number);
        number || self.report.is_some() || self.color_by_attribute.is_some()
    }
}

/// What is needed for a range.
const ENDS: &str = "two numbers are needed, the lower first, as in -80,30";

/// The numbers at both ends of a scale.
///
/// # Errors
/// They are not two, or not in order.
fn ends(text: &str) -> Result<[f32; 2], String> {
    let ends: Option<Vec<f32>> = text.split(',').map(|n| n.trim().parse().ok()).collect();
    match ends.as_deref() {
        Some(&[low, high]) if low.is_finite() && high.is_finite() && low < high => Ok([low, high]),
        _ => Err(ENDS.into()),
    }
}

/// A range in files.
mod range {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub(super) fn serialize<S: Serializer>(
        range: &Option<[f32; 2]>,
        to: S,
    ) -> Result<S::Ok, S::Error> {
        range.serialize(to)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(
        from: D,
    ) -> Result<Option<[f32; 2]>, D::Error> {
        match serde_json::Value::deserialize(from)? {
            serde_json::Value::Null => Ok(None),
            given => {
                let ends = super::ends(&crate::text_of(&given));
                ends.map(Some).map_err(serde::de::Error::custom)
            }
        }
    }
}

/// A color map in files.
mod color_map {
    use neurotess_picture::color::ColorMap;
    use serde::{Deserialize, Deserializer, Serializer};

    pub(super) fn serialize<S: Serializer>(map: &ColorMap, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_str(map.name())
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<ColorMap, D::Error> {
        let given = serde_json::Value::deserialize(from)?;
        let map = crate::text_of(&given).parse();
        map.map_err(|_| {
            serde::de::Error::custom(crate::alike::one_of(&ColorMap::ALL.map(ColorMap::name)))
        })
    }
}

/// Names that shells complete.
#[cfg(feature = "clap")]
mod parsers {
    use std::ffi::OsStr;

    use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
    use clap::{Arg, Command};
    use neurotess_picture::color::{ColorMap, Palette};

    use crate::words::PaletteName;

    /// Color maps by name.
    pub(super) fn color_maps() -> impl TypedValueParser<Value = ColorMap> {
        let names = ColorMap::ALL.map(ColorMap::name);
        PossibleValuesParser::new(names).try_map(|name| name.parse::<ColorMap>())
    }

    /// Reads palettes by name or file.
    #[derive(Clone, Debug)]
    pub(super) struct PaletteParser;

    impl TypedValueParser for PaletteParser {
        type Value = PaletteName;

        fn parse_ref(
            &self,
            command: &Command,
            arg: Option<&Arg>,
            value: &OsStr,
        ) -> Result<PaletteName, clap::Error> {
            let parse: fn(&str) -> Result<PaletteName, String> = str::parse;
            parse.parse_ref(command, arg, value)
        }

        fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
            let names = Palette::ALL.map(Palette::name).into_iter();
            Some(Box::new(names.map(PossibleValue::new)))
        }
    }
}
