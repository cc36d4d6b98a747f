//! As much XML as VTK's files use: tags with attributes.
//!
//! Why not quick-xml, which reads NeuroML? Bytes that are no XML may follow a tag in VTK's files, and are
//! found by their offset from it.

use super::{FilePosition, ReadError, malformed};

/// A tag.
pub(super) struct Tag<'a> {
    /// Its name, with a `/` in front if it closes.
    pub(super) name: &'a str,
    attributes: &'a str,
    /// Offset of the byte after it.
    pub(super) end: usize,
}

impl<'a> Tag<'a> {
    /// The next tag at or after an offset; comments and declarations are skipped.
    pub(super) fn next(bytes: &'a [u8], mut from: usize) -> Result<Option<Self>, ReadError> {
        loop {
            let Some(start) = find(bytes, from, b"<") else {
                return Ok(None);
            };
            let cut = ReadError::Truncated {
                at: FilePosition::Byte(start),
                what: "a tag",
            };
            if bytes[start..].starts_with(b"<!--") {
                from = find(bytes, start + 4, b"-->").ok_or(cut)? + 3;
                continue;
            }
            let end = tag_end(bytes, start).ok_or(cut)?;
            let inside = &bytes[start + 1..end];
            from = end + 1;
            if inside.starts_with(b"?") || inside.starts_with(b"!") {
                continue;
            }
            let Ok(inside) = std::str::from_utf8(inside) else {
                return Err(malformed(
                    FilePosition::Byte(start),
                    "a tag",
                    "text in UTF-8",
                ));
            };
            let inside = inside.strip_suffix('/').unwrap_or(inside);
            let (name, attributes) = inside
                .split_once(|c: char| c.is_ascii_whitespace())
                .unwrap_or((inside, ""));
            return Ok(Some(Self {
                name,
                attributes,
                end: from,
            }));
        }
    }

    /// The value of an attribute.
    pub(super) fn get(&self, name: &str) -> Option<&'a str> {
        let mut rest = self.attributes;
        loop {
            let (key, after) = rest.split_once('=')?;
            let after = after.trim_start();
            let quote = after.chars().next().filter(|c| matches!(c, '"' | '\''))?;
            let (value, left) = after[1..].split_once(quote)?;
            if key.trim() == name {
                return Some(value);
            }
            rest = left;
        }
    }
}

/// Where the tag that begins here ends: the `>` that no quotation marks surround.
fn tag_end(bytes: &[u8], start: usize) -> Option<usize> {
    let mut quote = None;
    let place = bytes[start..].iter().position(|&byte| match quote {
        None if byte == b'>' => true,
        None => {
            quote = Some(byte).filter(|b| matches!(b, b'"' | b'\''));
            false
        }
        Some(open) => {
            if byte == open {
                quote = None;
            }
            false
        }
    });
    place.map(|place| start + place)
}

/// Where a pattern stands at or after an offset.
pub(super) fn find(bytes: &[u8], from: usize, pattern: &[u8]) -> Option<usize> {
    let rest = bytes.get(from..)?;
    let found = rest
        .windows(pattern.len())
        .position(|window| window == pattern)?;
    Some(from + found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tag_does_not_end_within_quotation_marks() {
        let text = b"<DataArray Name='a > b' type=\"Float32\">1 2";
        let tag = Tag::next(text, 0).expect("valid").expect("a tag");
        assert_eq!(tag.get("Name"), Some("a > b"));
        assert_eq!(tag.get("type"), Some("Float32"));
        assert_eq!(&text[tag.end..], b"1 2");
    }

    #[test]
    fn a_tag_that_is_cut_off_is_an_error() {
        assert!(Tag::next(b"<DataArray Name='a > b", 0).is_err());
    }
}
