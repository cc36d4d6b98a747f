//! `--size` of pictures.

use std::str::FromStr;

use neurotess::picture::LARGEST;

/// `--size`
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Size(pub(crate) [u32; 2]);

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let sides = text.split_once(['x', 'X', '×']);
        let sides = sides.and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
        match sides {
            Some(size) if size.iter().all(|n| (1..=LARGEST).contains(n)) => Ok(Self(size)),
            _ => Err(format!(
                "width x height is needed, 1 to {LARGEST}, as in 1280x960"
            )),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_read() {
        assert_eq!("640x480".parse(), Ok(Size([640, 480])));
        for wrong in ["640", "0x1", "1x99999", "x", "1x1x1"] {
            assert!(wrong.parse::<Size>().is_err(), "{wrong}");
        }
    }
}
