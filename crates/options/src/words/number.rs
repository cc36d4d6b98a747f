//! Numbers within bounds.

use std::fmt;
use std::str::FromStr;

use crate::given::by_text;

/// A number above 0.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Positive(pub f64);

/// A number of 0 or more.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct NotNegative(pub f64);

/// A factor on radii, 0.01 to 1000: far beyond these bounds there is nothing to recognize.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct RadiusFactor(pub f64);

/// A whole number from `LEAST` to `MOST`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Within<const LEAST: u32, const MOST: u32>(pub u32);

fn number(text: &str, holds: impl Fn(f64) -> bool, needed: &str) -> Result<f64, String> {
    match text.trim().parse() {
        Ok(number) if f64::is_finite(number) && holds(number) => Ok(number),
        _ => Err(needed.to_owned()),
    }
}

impl FromStr for Positive {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        number(text, |n| n > 0.0, "a number above 0 is needed").map(Self)
    }
}

impl FromStr for NotNegative {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        number(text, |n| n >= 0.0, "a number of 0 or more is needed").map(Self)
    }
}

impl FromStr for RadiusFactor {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let holds = |n| (0.01..=1000.0).contains(&n);
        number(text, holds, "a number from 0.01 to 1000 is needed").map(Self)
    }
}

impl<const LEAST: u32, const MOST: u32> FromStr for Within<LEAST, MOST> {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number: Option<i64> = text.trim().parse().ok();
        let number = number.and_then(|n| u32::try_from(n).ok());
        match number {
            Some(number) if (LEAST..=MOST).contains(&number) => Ok(Self(number)),
            _ => Err(format!("a whole number from {LEAST} to {MOST} is needed")),
        }
    }
}

impl fmt::Display for Positive {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl fmt::Display for NotNegative {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl fmt::Display for RadiusFactor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl<const LEAST: u32, const MOST: u32> fmt::Display for Within<LEAST, MOST> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

by_text!(Positive, NotNegative, RadiusFactor);

impl<'de, const LEAST: u32, const MOST: u32> serde::Deserialize<'de> for Within<LEAST, MOST> {
    fn deserialize<D: serde::Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let value = serde_json::Value::deserialize(from)?;
        let read = crate::text_of(&value).parse();
        read.map_err(serde::de::Error::custom)
    }
}

impl<const LEAST: u32, const MOST: u32> serde::Serialize for Within<LEAST, MOST> {
    fn serialize<S: serde::Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_u32(self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_bounds() {
        assert_eq!("0.5".parse(), Ok(Positive(0.5)));
        assert!("0".parse::<Positive>().is_err() && "inf".parse::<Positive>().is_err());
        assert_eq!("0".parse(), Ok(NotNegative(0.0)));
        assert!("-1".parse::<NotNegative>().is_err() && "nan".parse::<NotNegative>().is_err());
        assert!("0.001".parse::<RadiusFactor>().is_err());
        assert_eq!("64".parse(), Ok(Within::<1, 64>(64)));
        for wrong in ["0", "65", "-1", "1.5", "x", ""] {
            let error = wrong.parse::<Within<1, 64>>().expect_err(wrong);
            assert_eq!(error, "a whole number from 1 to 64 is needed");
        }
    }
}
