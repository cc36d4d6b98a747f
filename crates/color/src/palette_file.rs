//! Palettes in files: a named palette with colors of one's own. People write them by hand, in TOML:
//!
//! ```toml
//! base = "okabe-ito"
//! background = "white"
//!
//! [types]
//! axon = "#1f77b4"
//! custom_7 = "#ff8800"
//!
//! [categories]
//! L5_TTPC1 = "#2ca02c"
//! "neuron 7" = "#d62728"
//! ```
//!
//! Everything may be left out.

use std::fmt::Write as _;

use neurotess_picture::color::{Palette, Rgb};
use serde::{Deserialize, Deserializer};
use std::collections::BTreeMap;
use thiserror::Error;

use crate::own_colors::{ColorText, OwnColors, Tables, TypeText};

/// What a palette's file says.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PaletteFile {
    /// The palette of all that has no color of its own; none: the default one.
    pub base: Option<Palette>,
    /// Colors of one's own.
    pub own_colors: OwnColors,
    /// The background that they are meant for.
    pub background: Option<Rgb>,
}

/// Why a palette's file cannot be read. Displays without the file's name, which windows show beside it.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{}{why}", .line.map_or(String::new(), |line| format!("line {line}: ")))]
pub struct PaletteError {
    line: Option<usize>,
    why: String,
}

impl PaletteError {
    /// `FILE:LINE: what: what to do`
    pub fn of(&self, file: &str) -> String {
        let line = self.line.map_or(String::new(), |line| format!("{line}:"));
        format!("{file}:{line} {}", self.why)
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    #[serde(default)]
    base: Option<Base>,
    #[serde(default)]
    background: Option<ColorText>,
    #[serde(default)]
    types: BTreeMap<TypeText, ColorText>,
    #[serde(default)]
    categories: BTreeMap<String, ColorText>,
}

struct Base(Palette);

impl<'de> Deserialize<'de> for Base {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = String::deserialize(deserializer)?;
        let palette = name
            .parse()
            .map_err(|needed| format!("'{name}' is no palette: {needed}"));
        palette.map(Self).map_err(serde::de::Error::custom)
    }
}

impl PaletteFile {
    /// Reads a file's content.
    ///
    /// # Errors
    /// It is no palette: with the line, and what is needed.
    pub fn parse(content: &[u8]) -> Result<Self, PaletteError> {
        let text = std::str::from_utf8(content).map_err(|_| PaletteError {
            line: None,
            why: "is no text: a palette has lines as axon = \"#1f77b4\"".into(),
        })?;
        let written: Written = toml::from_str(text).map_err(|e| PaletteError {
            line: e.span().map(|s| text[..s.start].matches('\n').count() + 1),
            why: format!("{}: correct it", e.message().trim_end()),
        })?;
        let tables = Tables {
            types: written.types,
            categories: written.categories,
        };
        Ok(Self {
            base: written.base.map(|base| base.0),
            own_colors: tables.into(),
            background: written.background.map(|color| color.0),
        })
    }

    /// The content of its file.
    pub fn text(&self) -> String {
        let mut text = "# A palette of neurotess: `neurotess render --palette FILE`.\n".to_owned();
        let base = self.base.unwrap_or_default().name();
        // Writing into a String does not fail.
        let _ = writeln!(text, "base = \"{base}\"");
        if let Some([r, g, b]) = self.background {
            let _ = writeln!(text, "background = \"#{r:02x}{g:02x}{b:02x}\"");
        }
        let tables = toml::to_string(&Tables::from(self.own_colors.clone()));
        let tables = tables.expect("tables of texts are TOML");
        if !tables.is_empty() {
            let _ = write!(text, "\n{tables}");
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_palette_is_written_and_read() {
        let mut own_colors = OwnColors::default();
        own_colors
            .types
            .extend([(2, [31, 119, 180]), (7, [255, 136, 0])]);
        for name in ["L5_TTPC1", "neuron 7", "with \"quotes\" and µ", "5", ""] {
            own_colors.categories.insert(name.into(), [1, 2, 3]);
        }
        for file in [
            PaletteFile::default(),
            PaletteFile {
                base: Some(Palette::OkabeIto),
                own_colors,
                background: Some([255; 3]),
            },
        ] {
            let text = file.text();
            let read = PaletteFile::parse(text.as_bytes()).expect("read");
            let base = Some(file.base.unwrap_or_default());
            assert_eq!(read, PaletteFile { base, ..file }, "{text}");
        }
    }

    #[test]
    fn one_color_is_enough_and_dendrites_are_two_types() {
        let of = |text: &str| {
            PaletteFile::parse(text.as_bytes())
                .expect("read")
                .own_colors
                .types
        };
        let types = of("[types]\ndendrite = '#f00'\napical = 'black'\n");
        assert_eq!(types, [(3, [255, 0, 0]), (4, [0; 3])].into());
        assert_eq!(of("types.dendrite = '#f00'\ntypes.'4' = 'black'"), types);
        assert!(of("").is_empty());
    }

    #[test]
    fn faults_have_a_line_and_a_remedy() {
        for (text, line, says) in [
            ("base = 'mine'", 1, "use neurom, neuromorpho or okabe-ito"),
            (
                "\n[types]\naxon = 'reddish'",
                3,
                "'reddish' is no color: white, black",
            ),
            ("[types]\nL5_TTPC1 = '#fff'", 2, "belong to [categories]"),
            ("[typs]\naxon = '#fff'", 1, "unknown field"),
            ("[categories]\na = 3", 2, "expected a string"),
            ("[types]\naxon = #fff", 2, "correct it"),
        ] {
            let fault = PaletteFile::parse(text.as_bytes()).expect_err(text);
            let told = fault.of("my.toml");
            assert!(told.starts_with(&format!("my.toml:{line}: ")), "{told}");
            assert!(told.contains(says), "{told}");
        }
        let fault = PaletteFile::parse(&[0xff, 0xfe]).expect_err("no text");
        assert!(
            fault.of("a.png").starts_with("a.png: is no text"),
            "{fault}"
        );
    }
}
