//! Text by lines and words.

use super::{FilePosition, ReadError, malformed, shown};

/// Lines of a file with their numbers.
pub(super) struct Lines<'a> {
    bytes: &'a [u8],
    /// Where the next line begins.
    pub(super) at: usize,
    /// Number of the last line given out.
    number: usize,
}

impl<'a> Lines<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self {
            bytes,
            at: 0,
            number: 0,
        }
    }

    /// The place of the last line given out.
    pub(super) fn place(&self) -> FilePosition {
        FilePosition::Line(self.number)
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = &'a [u8];

    /// The next line, without its end.
    fn next(&mut self) -> Option<&'a [u8]> {
        let rest = self.bytes.get(self.at..).filter(|rest| !rest.is_empty())?;
        let length = rest
            .iter()
            .position(|&byte| byte == b'\n')
            .unwrap_or(rest.len());
        self.at += length + 1;
        self.number += 1;
        Some(
            rest[..length]
                .strip_suffix(b"\r")
                .unwrap_or(&rest[..length]),
        )
    }
}

/// The next line with something on it, without a comment that `#` begins.
pub(super) fn data_line<'a>(
    lines: &mut Lines<'a>,
    what: &'static str,
) -> Result<&'a [u8], ReadError> {
    for line in lines.by_ref() {
        let line = line.split(|&byte| byte == b'#').next().unwrap_or_default();
        if words(line).next().is_some() {
            return Ok(line);
        }
    }
    Err(ReadError::Truncated {
        at: lines.place(),
        what,
    })
}

/// Words of a line.
pub(super) fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> + Clone {
    line.split(u8::is_ascii_whitespace)
        .filter(|word| !word.is_empty())
}

/// A number of a text.
pub(super) fn number(word: Option<&[u8]>, at: FilePosition) -> Result<f64, ReadError> {
    let word = word.ok_or_else(|| malformed(at, "the line ends", "one more number"))?;
    fast_float2::parse(word).map_err(|_| malformed(at, shown(word), "a number"))
}

/// A whole number of a text.
pub(super) fn whole<T: std::str::FromStr>(
    word: Option<&[u8]>,
    at: FilePosition,
) -> Result<T, ReadError> {
    let word = word.ok_or_else(|| malformed(at, "the line ends", "one more whole number"))?;
    let parsed = std::str::from_utf8(word)
        .ok()
        .and_then(|word| word.parse().ok());
    parsed.ok_or_else(|| malformed(at, shown(word), "a whole number that fits"))
}

/// An index, from any number.
pub(super) fn index(number: f64, at: FilePosition) -> Result<u32, ReadError> {
    let index = number as u32;
    if f64::from(index) == number && index < u32::MAX {
        return Ok(index);
    }
    Err(malformed(
        at,
        format!("index {number}"),
        "a whole number from 0 to 4294967294",
    ))
}
