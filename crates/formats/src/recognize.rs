//! The format of a file by what it begins like.

use crate::format::Format;
use crate::swc;
use crate::text::{BOM, refuse_other_text};

/// The format that the content begins like.
pub(crate) fn of_content(bytes: &[u8]) -> Option<Format> {
    match () {
        () if bytes.starts_with(HDF5) => Some(Format::H5),
        () if has_neuroml_element(bytes) => Some(Format::NeuroMl),
        () if begins_with_bracket(bytes) => Some(Format::Asc),
        () if swc::looks_like(bytes) => Some(Format::Swc),
        () => None,
    }
}

/// First bytes of every HDF5 file without a user block.
const HDF5: &[u8] = b"\x89HDF\r\n\x1a\n";

/// Whether there is an element of NeuroML near the start.
fn has_neuroml_element(bytes: &[u8]) -> bool {
    let start = &bytes[..bytes.len().min(4096)];
    memchr::memmem::find(start, b"<neuroml").is_some()
}

/// Whether the first thing that is no comment is a bracket, as in Neurolucida's files.
fn begins_with_bracket(bytes: &[u8]) -> bool {
    if refuse_other_text(bytes).is_err() {
        return false;
    }
    let mut rest = bytes.strip_prefix(BOM).unwrap_or(bytes);
    while let Some((&byte, after)) = rest.split_first() {
        rest = match byte {
            b';' => &after[memchr::memchr2(b'\n', b'\r', after).unwrap_or(after.len())..],
            b',' | 0x0b => after,
            _ if byte.is_ascii_whitespace() => after,
            _ => return byte == b'(',
        };
    }
    false
}
