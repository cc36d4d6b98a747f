//! Values of options: colors, positions, lengths, light.

use std::str::FromStr;

use glam::{DVec3, Vec3};
use neurotess::picture::Light;
use neurotess::picture::color::Rgb;

/// Three numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Triple(pub(crate) DVec3);

impl FromStr for Triple {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Result<Vec<f64>, _> = text.split(',').map(|n| n.trim().parse()).collect();
        match numbers.as_deref() {
            Ok(&[x, y, z]) => Ok(Self(DVec3::new(x, y, z))),
            _ => Err("three numbers X,Y,Z are needed, as in 0,20,80".into()),
        }
    }
}

/// A color.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct RgbArg(pub(crate) Rgb);

impl FromStr for RgbArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        neurotess::coloring::rgb(text).map(Self)
    }
}

/// A length, or one that fits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Fit {
    /// A length that fits.
    Auto,
    /// A length (µm).
    Length(f64),
}

impl FromStr for Fit {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.parse() {
            Ok(length) if length >= 0.0 && f64::is_finite(length) => Ok(Self::Length(length)),
            _ if text == "fit" => Ok(Self::Auto),
            _ => Err("a length in µm is needed, or none".into()),
        }
    }
}

/// `--light`
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LightArg(pub(crate) Light);

impl FromStr for LightArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let light = match text {
            "soft" => Light::Soft,
            "flat" => Light::Flat,
            other => {
                let direction = other.parse::<Triple>().map(|triple| triple.0.as_vec3());
                let direction = direction.ok().filter(|d| d.is_finite() && *d != Vec3::ZERO);
                Light::From(direction.ok_or("use soft, flat or a direction X,Y,Z, as in -1,1,1")?)
            }
        };
        Ok(Self(light))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colors_and_positions_are_read() {
        assert_eq!("#102030".parse(), Ok(RgbArg([16, 32, 48])));
        assert!("reddish".parse::<RgbArg>().is_err());
        assert_eq!("1,-2,3e1".parse(), Ok(Triple(DVec3::new(1.0, -2.0, 30.0))));
        assert!("1,2".parse::<Triple>().is_err());
        assert!("0,0,0".parse::<LightArg>().is_err());
    }
}
