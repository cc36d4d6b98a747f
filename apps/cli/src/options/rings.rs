//! `--ring NEURITE=POSITION`: where neurites leave their soma.

use std::collections::BTreeMap;
use std::str::FromStr;

use clap::Args;

/// Options of first rings.
#[derive(Args, Clone, Debug, Default)]
pub(crate) struct RingArgs {
    /// Put the first ring of a neurite somewhere between the soma's sphere (0), the first traced
    /// point outside it (1) and as far beyond along the path (2); several times for several
    /// neurites, which are counted from 1 in the order of the file, as in the window
    #[arg(long = "ring", value_name = "NEURITE=POSITION", help_heading = "Soma")]
    rings: Vec<Ring>,
}

impl RingArgs {
    /// The positions for the library. If there are several for a neurite, the last one.
    pub(crate) fn positions(&self) -> BTreeMap<u32, f64> {
        self.rings.iter().map(|r| (r.neurite, r.position)).collect()
    }
}

/// A value of `--ring`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Ring {
    /// Number of the neurite, from 0.
    neurite: u32,
    position: f64,
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
