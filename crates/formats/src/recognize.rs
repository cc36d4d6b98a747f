//! The format of a file by what it begins like.

use crate::format::Format;
use crate::text::{BOM, begin, refuse_other_text};
use crate::{Fault, foreign, swc};

/// The format of a file, by its content where several formats share its name. `named`: by its name, if that tells.
pub(crate) fn format(bytes: &[u8], named: Option<Format>) -> Result<Format, Fault> {
    match named {
        Some(named) if !named.is_told_by_content() => return Ok(named),
        _ if bytes.is_empty() => return Err(Fault::Empty),
        _ => {}
    }
    if let Some(format) = of_content(bytes) {
        return Ok(format);
    }
    if let Some(foreign) = foreign::of_content(bytes) {
        return Err(foreign);
    }
    match (named, root(bytes)) {
        (_, Some(root)) if root.eq_ignore_ascii_case("html") => Err(Fault::Html),
        (_, Some(root)) if !root.is_empty() => Err(Fault::OtherXml { root: root.into() }),
        (Some(Format::MouseLight), _) => Err(Fault::OtherJson),
        // The reader says what is wrong with it.
        (Some(named), _) => Ok(named),
        (None, _) => Err(Fault::UnknownFormat),
    }
}

/// The format that the content begins like.
fn of_content(bytes: &[u8]) -> Option<Format> {
    if bytes.starts_with(HDF5) {
        return Some(Format::H5);
    }
    if let Some(root) = root(bytes) {
        return Some(match root {
            "neuroml" | "morphml" => Format::NeuroMl,
            "tracings" => Format::Traces,
            "things" => Format::Knossos,
            "mbf" => Format::NeurolucidaXml,
            _ => return None,
        });
    }
    match () {
        () if begins_with_bracket(bytes) => Some(Format::Asc),
        () if swc::looks_like(bytes) => Some(Format::Swc),
        () => json(bytes),
    }
}

/// The name of the outermost element without its prefix, if the content is XML.
fn root(bytes: &[u8]) -> Option<&str> {
    let mut rest = begin(bytes);
    while rest.starts_with(b"<") {
        let end = match rest {
            [b'<', b'?', ..] => after(rest, b"?>")?,
            [b'<', b'!', b'-', b'-', ..] => after(rest, b"-->")?,
            // A document type may have declarations of its own in brackets.
            [b'<', b'!', ..] => {
                let close = memchr::memchr2(b'>', b'[', rest)?;
                match rest[close] {
                    b'[' => {
                        after(rest, b"]").and_then(|at| Some(at + after(&rest[at..], b">")?))?
                    }
                    _ => close + 1,
                }
            }
            _ => {
                let name = &rest[1..];
                let ends = |&b: &u8| b.is_ascii_whitespace() || b == b'>' || b == b'/';
                let name = &name[..name.iter().position(ends).unwrap_or(name.len())];
                let name = std::str::from_utf8(name).ok()?;
                return Some(name.rsplit(':').next().unwrap_or(name));
            }
        };
        rest = rest[end..].trim_ascii_start();
    }
    None
}

/// Where what follows a sign begins.
fn after(text: &[u8], sign: &[u8]) -> Option<usize> {
    memchr::memmem::find(text, sign).map(|at| at + sign.len())
}

/// Which JSON of tracings it is, by its first brackets and keys.
fn json(bytes: &[u8]) -> Option<Format> {
    let text = begin(bytes);
    let has = |key: &str| memchr::memmem::find(text, key.as_bytes()).is_some();
    match text.first()? {
        b'[' => match text[1..].trim_ascii_start().first()? {
            b'[' => Some(Format::Catmaid),
            b'{' if has("\"sampleNumber\"") => Some(Format::MouseLight),
            _ => None,
        },
        b'{' if has("\"sampleNumber\"") => Some(Format::MouseLight),
        b'{' if has("\"skeletons\"") => Some(Format::Catmaid),
        _ => None,
    }
}

/// Whether the beginning of a file is that of a tracing in JSON: a neuron of MouseLight, or a skeleton of CATMAID.
pub fn is_json_tracing(beginning: &[u8]) -> bool {
    json(beginning).is_some()
}

/// First bytes of every HDF5 file without a user block.
const HDF5: &[u8] = b"\x89HDF\r\n\x1a\n";

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_outermost_element_tells() {
        for (text, name) in [
            (
                "<?xml version=\"1.0\"?>\n<!-- a <b> --><neuroml id=\"a\">",
                Some("neuroml"),
            ),
            (
                "\u{feff}<!DOCTYPE tracings [\n<!ELEMENT p (q)>\n]>\n<tracings>",
                Some("tracings"),
            ),
            ("<!DOCTYPE html><html>", Some("html")),
            ("<nl:mbf/>", Some("mbf")),
            ("<!DOCTYPE a [", None),
            ("<?xml", None),
            ("1 1 0 0 0 1 -1", None),
        ] {
            assert_eq!(root(text.as_bytes()), name, "{text}");
        }
    }

    #[test]
    fn json_is_told_by_its_keys() {
        for (text, format) in [
            (
                "[[[1, null, 3, 0, 0, 0, -1, 5]], [], {}]",
                Some(Format::Catmaid),
            ),
            ("{\"skeletons\": {}}", Some(Format::Catmaid)),
            (
                "{\"neurons\": [{\"axon\": [{\"sampleNumber\": 1}]}]}",
                Some(Format::MouseLight),
            ),
            ("{\"version\": 2, \"networks\": {}}", None),
            ("[1, 2]", None),
            ("[", None),
        ] {
            assert_eq!(of_content(text.as_bytes()), format, "{text}");
        }
    }
}
