//! Where neurites leave their soma.

use std::fmt;
use std::str::FromStr;

use crate::given::by_text;

/// The position of a neurite's first ring: NEURITE=POSITION.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ring {
    /// Number of the neurite, from 0.
    pub neurite: u32,
    /// From 0, the soma's sphere, over 1, the first traced point outside it, to 2.
    pub position: f64,
}

impl FromStr for Ring {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text.split_once('=');
        let numbers = parts.and_then(|(n, p)| Some((n.parse::<u32>().ok()?, p.parse().ok()?)));
        match numbers {
            Some((neurite, position)) if neurite > 0 && (0.0..=2.0).contains(&position) => {
                Ok(Self {
                    neurite: neurite - 1,
                    position,
                })
            }
            _ => {
                Err("a neurite from 1 on and a position from 0 to 2 are needed, as in 2=0.5".into())
            }
        }
    }
}

impl fmt::Display for Ring {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.neurite + 1, self.position)
    }
}

by_text!(Ring);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rings_have_a_neurite_and_a_position() {
        let ring = |text: &str| text.parse::<Ring>().map(|r| (r.neurite, r.position));
        assert_eq!(ring("1=0"), Ok((0, 0.0)));
        assert_eq!(ring("12=1.75"), Ok((11, 1.75)));
        for wrong in [
            "0=1", "1=2.1", "1=-0.1", "1", "=1", "a=1", "1=NaN", "1=0.5=2",
        ] {
            assert!(ring(wrong).is_err(), "{wrong}");
        }
    }
}
