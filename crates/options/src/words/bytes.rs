//! Sizes of memory.

use std::fmt;
use std::str::FromStr;

use bytesize::ByteSize;

use crate::given::by_text;

/// A size of memory, as in 512MiB, 2GB or 1000000 (bytes).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bytes(pub u64);

impl FromStr for Bytes {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.parse::<ByteSize>() {
            Ok(size) if size.as_u64() > 0 => Ok(Self(size.as_u64())),
            _ => Err("a size above 0 is needed, like 512MiB, 2GB or 1000000 (bytes)".into()),
        }
    }
}

impl fmt::Display for Bytes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

by_text!(Bytes);
