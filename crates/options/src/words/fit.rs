//! Lengths that may fit by themselves.

use std::fmt;
use std::str::FromStr;

/// A length, or one that fits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fit {
    /// A length that fits.
    Auto,
    /// A length (µm).
    Length(f64),
}

impl FromStr for Fit {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.trim().parse() {
            Ok(length) if length >= 0.0 && f64::is_finite(length) => Ok(Self::Length(length)),
            _ if text == "fit" => Ok(Self::Auto),
            _ => Err("a length in µm is needed, or none".into()),
        }
    }
}

impl fmt::Display for Fit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Auto => f.write_str("fit"),
            Self::Length(length) => length.fmt(f),
        }
    }
}

impl serde::Serialize for Fit {
    fn serialize<S: serde::Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.collect_str(self)
    }
}

impl<'de> serde::Deserialize<'de> for Fit {
    /// `true` is a length that fits.
    fn deserialize<D: serde::Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        match serde_json::Value::deserialize(from)? {
            serde_json::Value::Bool(true) => Ok(Self::Auto),
            other => crate::text_of(&other)
                .parse()
                .map_err(serde::de::Error::custom),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_fit_or_are_given() {
        let read = |json: &str| serde_json::from_str::<Fit>(json).ok();
        assert_eq!(read("true"), Some(Fit::Auto));
        assert_eq!(read("\"fit\""), Some(Fit::Auto));
        assert_eq!(read("12.5"), Some(Fit::Length(12.5)));
        assert!(read("-1").is_none() && read("\"far\"").is_none());
    }
}
