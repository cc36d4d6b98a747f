//! `--palette` and `--set-color`: named palettes, palettes in files, single colors.

use std::ffi::OsStr;
use std::path::Path;

use clap::builder::{PossibleValue, TypedValueParser};
use clap::{Arg, Command};
use neurotess::coloring::PaletteFile;
use neurotess::formats::read_regular;
use neurotess::picture::color::{Palette, Rgb};

use super::values::RgbArg;

/// `--palette`: a name, or the content of a file. It is read with the options, so that a fault is
/// found before any cell is read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct PaletteArg(pub(super) PaletteFile);

impl PaletteArg {
    fn parse(text: &str) -> Result<Self, String> {
        palette(text).map(Self)
    }
}

/// A palette by its name, or of a file.
///
/// # Errors
/// There is no such name, or the file is none: what is needed.
pub fn palette(text: &str) -> Result<PaletteFile, String> {
    if let Ok(palette) = text.parse::<Palette>() {
        return Ok(PaletteFile {
            base: Some(palette),
            ..PaletteFile::default()
        });
    }
    let path = Path::new(text);
    if path.extension().is_none() && !path.exists() {
        let names = Palette::ALL.map(Palette::name).join(", ");
        return Err(format!("use {names} or a palette's file, as in mine.toml"));
    }
    let content = read_regular(path).map_err(|e| format!("{text}: cannot be read: {e}"))?;
    PaletteFile::parse(&content).map_err(|e| e.of(text))
}

/// Reads [`PaletteArg`]s; shells complete the names.
#[derive(Clone, Debug)]
pub(crate) struct PaletteParser;

impl TypedValueParser for PaletteParser {
    type Value = PaletteArg;

    fn parse_ref(
        &self,
        command: &Command,
        arg: Option<&Arg>,
        value: &OsStr,
    ) -> Result<PaletteArg, clap::Error> {
        let parse: fn(&str) -> Result<PaletteArg, String> = PaletteArg::parse;
        parse.parse_ref(command, arg, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        let names = Palette::ALL.map(Palette::name).into_iter();
        Some(Box::new(names.map(PossibleValue::new)))
    }
}

/// `--set-color`: NAME=COLOR
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct SetColor {
    pub(super) name: String,
    pub(super) color: Rgb,
}

impl std::str::FromStr for SetColor {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        // Names may have an =, colors have none.
        let (name, color) = text
            .rsplit_once('=')
            .ok_or("NAME=COLOR is needed, as in axon=#ff8800")?;
        Ok(Self {
            name: name.trim().to_owned(),
            color: color.parse::<RgbArg>()?.0,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn palettes_have_names_or_files() {
        let palette = |text| PaletteArg::parse(text).map(|palette| palette.0.base);
        assert_eq!(palette("okabe-ito"), Ok(Some(Palette::OkabeIto)));
        let told = palette("mine").expect_err("no file");
        assert!(told.contains("neurom, neuromorpho, okabe-ito or"), "{told}");
        let told = palette("no/such.toml").expect_err("no file");
        assert!(told.starts_with("no/such.toml: cannot be read"), "{told}");
    }

    #[test]
    fn names_may_have_any_sign() {
        let set = |text: &str| text.parse::<SetColor>().map(|set| (set.name, set.color));
        assert_eq!(set("a=b = #010203"), Ok(("a=b".into(), [1, 2, 3])));
        assert!(set("axon").is_err() && set("axon=reddish").is_err());
    }
}
