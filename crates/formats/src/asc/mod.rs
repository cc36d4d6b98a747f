//! Neurolucida ASC: nested brackets of outlines and branches.
//!
//! The format has no public specification; `parse.rs` has the grammar of what is in use. The fourth
//! number of a point is a **diameter**. Outlines named or typed `CellBody` are the soma, several of
//! them its slices. Children hang on the last point of their parent; how a copy of it at their start
//! is taken stands in `docs/conventions.md`, as do markers and other contours, which are left out with
//! a count. Spines are places beside the tree: [`Morphology::spines`].

mod lexer;
mod parse;
mod write;

use neurotess_morphology::Morphology;

use crate::text::{BOM, Located, refuse_other_text};
use crate::warning::Warnings;
use crate::{Format, Read, ReadError, ReadOptions, read_text};
pub use write::write;

/// Reads a file that is in memory. `name` is what errors call it; the morphology gets its stem.
///
/// Linear in the bytes and without recursion. Points are numbered from 1 on, the soma's first.
///
/// # Errors
/// [`ReadError`] with `name` and line.
pub fn read_bytes(bytes: &[u8], name: &str, options: &ReadOptions) -> Result<Read, ReadError> {
    read_text(Format::Asc, name, options, |name, warnings| {
        interpret(bytes, name, warnings)
    })
}

fn interpret(bytes: &[u8], name: &str, warnings: &mut Warnings) -> Located<Morphology> {
    refuse_other_text(bytes)?;
    let text = bytes.strip_prefix(BOM).unwrap_or(bytes);
    let mut tracing = parse::parse(text, warnings)?;
    tracing.header = header(text);
    tracing.build(name, warnings)
}

/// Comment lines above everything else, without the comment sign.
fn header(text: &[u8]) -> Vec<String> {
    let lines = text.split(|&b| b == b'\n').map(<[u8]>::trim_ascii);
    lines
        .take_while(|line| line.is_empty() || line.starts_with(b";"))
        .filter(|line| !line.is_empty())
        .map(|line| String::from_utf8_lossy(line[1..].trim_ascii()).into_owned())
        .collect()
}
