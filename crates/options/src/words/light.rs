//! Where light comes from.

use std::fmt;
use std::str::FromStr;

use glam::Vec3;
use neurotess_picture::Light;

use super::Point;
use crate::given::by_text;

/// soft, flat (bare colors), or where the light comes from: right, up, towards who looks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LightFrom(pub Light);

impl FromStr for LightFrom {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let light = match text {
            "soft" => Light::Soft,
            "flat" => Light::Flat,
            other => {
                let direction = other.parse::<Point>().map(|point| point.0.as_vec3());
                let direction = direction.ok().filter(|d| d.is_finite() && *d != Vec3::ZERO);
                Light::From(direction.ok_or("use soft, flat or a direction X,Y,Z, as in -1,1,1")?)
            }
        };
        Ok(Self(light))
    }
}

impl fmt::Display for LightFrom {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Light::Soft => f.write_str("soft"),
            Light::Flat => f.write_str("flat"),
            Light::From(Vec3 { x, y, z }) => write!(f, "{x},{y},{z}"),
        }
    }
}

by_text!(LightFrom);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_has_a_name_or_a_direction() {
        for text in ["soft", "flat", "-1,1,0.5"] {
            let light: LightFrom = text.parse().expect(text);
            assert_eq!(light.to_string(), text);
        }
        assert!("0,0,0".parse::<LightFrom>().is_err() && "dim".parse::<LightFrom>().is_err());
    }
}
