//! Palettes by name or file.

use std::fmt;
use std::path::Path;
use std::str::FromStr;

use neurotess_color::PaletteFile;
use neurotess_formats::read_regular;
use neurotess_picture::color::Palette;

use crate::given::by_text;

/// A palette by its name, or the content of a file. It is read with the options, so that a fault is found before any cell
/// is read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PaletteName {
    text: String,
    /// What it says.
    pub colors: PaletteFile,
}

impl PaletteName {
    /// A palette that has a name.
    pub fn of(palette: Palette) -> Self {
        Self {
            text: palette.name().to_owned(),
            colors: named(palette),
        }
    }

    /// Whether it is of a file.
    pub fn is_file(&self) -> bool {
        self.text.parse::<Palette>().is_err()
    }
}

impl Default for PaletteName {
    fn default() -> Self {
        Self::of(Palette::default())
    }
}

fn named(palette: Palette) -> PaletteFile {
    PaletteFile {
        base: Some(palette),
        ..PaletteFile::default()
    }
}

impl FromStr for PaletteName {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let colors = palette(text)?;
        Ok(Self {
            text: text.to_owned(),
            colors,
        })
    }
}

impl fmt::Display for PaletteName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

by_text!(PaletteName);

/// A palette by its name, or of a file.
///
/// # Errors
/// There is no such name, or the file is none: what is needed.
pub fn palette(text: &str) -> Result<PaletteFile, String> {
    if let Ok(palette) = text.parse::<Palette>() {
        return Ok(named(palette));
    }
    let path = Path::new(text);
    if path.extension().is_none() && !path.exists() {
        let names = Palette::ALL.map(Palette::name).join(", ");
        return Err(format!("use {names} or a palette's file, as in mine.toml"));
    }
    let content = read_regular(path).map_err(|e| format!("{text}: cannot be read: {e}"))?;
    PaletteFile::parse(&content).map_err(|e| e.of(text))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn palettes_have_names_or_files() {
        let palette = |text: &str| text.parse::<PaletteName>().map(|name| name.colors.base);
        assert_eq!(palette("okabe-ito"), Ok(Some(Palette::OkabeIto)));
        let told = palette("mine").expect_err("no file");
        assert!(told.contains("neurom, neuromorpho, okabe-ito or"), "{told}");
        let told = palette("no/such.toml").expect_err("no file");
        assert!(told.starts_with("no/such.toml: cannot be read"), "{told}");
    }
}
