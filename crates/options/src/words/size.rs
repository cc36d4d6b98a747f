//! Sizes of pictures.

use std::fmt;
use std::str::FromStr;

use neurotess_picture::{LARGEST, PictureOptions};

use crate::given::by_text;

/// Width and height (pixels), as in 1280x960.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size(pub [u32; 2]);

impl Default for Size {
    fn default() -> Self {
        Self(PictureOptions::default().size)
    }
}

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let sides = text.split_once(['x', 'X', '×', ',']);
        let sides = sides.and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
        match sides {
            Some(size) if size.iter().all(|n| (1..=LARGEST).contains(n)) => Ok(Self(size)),
            _ => Err(format!(
                "width x height is needed, 1 to {LARGEST}, as in 1280x960"
            )),
        }
    }
}

impl fmt::Display for Size {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [width, height] = self.0;
        write!(f, "{width}x{height}")
    }
}

by_text!(Size);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_read() {
        assert_eq!("640x480".parse(), Ok(Size([640, 480])));
        assert_eq!(
            serde_json::from_str("[640, 480]").ok(),
            Some(Size([640, 480]))
        );
        assert_eq!(Size([640, 480]).to_string(), "640x480");
        for wrong in ["640", "0x1", "1x99999", "x", "1x1x1"] {
            assert!(wrong.parse::<Size>().is_err(), "{wrong}");
        }
    }
}
