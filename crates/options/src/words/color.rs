//! Colors, and colors of things.

use std::fmt;
use std::str::FromStr;

use neurotess_picture::color::Rgb;

use crate::given::by_text;

/// A color: a name (white, black, gray), RRGGBB or RGB.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Color(pub Rgb);

impl FromStr for Color {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        neurotess_color::rgb(text).map(Self)
    }
}

impl fmt::Display for Color {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [red, green, blue] = self.0;
        write!(f, "#{red:02x}{green:02x}{blue:02x}")
    }
}

/// The color of a type or of anything else in a legend: NAME=COLOR.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SetColor {
    /// What has the color.
    pub name: String,
    /// The color.
    pub color: Color,
}

impl FromStr for SetColor {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        // Names may have an =, colors have none.
        let (name, color) = text
            .rsplit_once('=')
            .ok_or("NAME=COLOR is needed, as in axon=#ff8800")?;
        Ok(Self {
            name: name.trim().to_owned(),
            color: color.parse()?,
        })
    }
}

impl fmt::Display for SetColor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.name, self.color)
    }
}

by_text!(Color, SetColor);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colors_are_read_and_written() {
        let color: Color = "#102030".parse().expect("a color");
        assert_eq!(
            (color.0, color.to_string()),
            ([16, 32, 48], "#102030".into())
        );
        assert!("reddish".parse::<Color>().is_err());
    }

    #[test]
    fn names_may_have_any_sign() {
        let set = |text: &str| text.parse::<SetColor>().map(|set| (set.name, set.color.0));
        assert_eq!(set("a=b = #010203"), Ok(("a=b".into(), [1, 2, 3])));
        assert!(set("axon").is_err() && set("axon=reddish").is_err());
    }
}
