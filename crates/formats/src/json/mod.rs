//! Tracings in JSON: MouseLight's neurons and CATMAID's skeletons.
//!
//! Each has its reader; here is what they share: the text of a part of a file, with its line.

pub mod catmaid;
pub mod mouselight;

use neurotess_morphology::Morphology;
use serde::Deserialize;
use serde_json::value::RawValue;

use crate::Fault;
use crate::text::{BOM, Located, refuse_other_text};
use crate::warning::Warnings;

/// A file's text, and how far its lines are counted.
struct Source<'a> {
    text: &'a str,
    at: usize,
    line: u64,
}

impl<'a> Source<'a> {
    fn new(bytes: &'a [u8]) -> Located<Self> {
        refuse_other_text(bytes)?;
        let bytes = bytes.strip_prefix(BOM).unwrap_or(bytes);
        let text = std::str::from_utf8(bytes).map_err(|e| {
            let before = &bytes[..e.valid_up_to()];
            let line = 1 + memchr::memchr_iter(b'\n', before).count() as u64;
            let reason = "it is not UTF-8".to_owned();
            (line, Fault::Json { reason })
        })?;
        let (at, line) = (0, 1);
        Ok(Self { text, at, line })
    }

    /// The line of a part of the text; linear in all where parts come in order.
    fn line(&mut self, part: &RawValue) -> u64 {
        let start = part.get().as_ptr() as usize;
        let at = start.saturating_sub(self.text.as_ptr() as usize);
        let at = at.min(self.text.len());
        if at < self.at {
            (self.at, self.line) = (0, 1);
        }
        let passed = &self.text.as_bytes()[self.at..at];
        self.line += memchr::memchr_iter(b'\n', passed).count() as u64;
        self.at = at;
        self.line
    }

    /// The whole text as a value.
    fn whole<T: Deserialize<'a>>(&self) -> Located<T> {
        serde_json::from_str(self.text).map_err(|e| fault(1, &e))
    }

    /// A part of the text as a value.
    fn value<T: Deserialize<'a>>(&mut self, part: &'a RawValue) -> Located<T> {
        serde_json::from_str(part.get()).map_err(|e| fault(self.line(part), &e))
    }
}

/// The fault of a value that begins in a line.
fn fault(start: u64, error: &serde_json::Error) -> (u64, Fault) {
    let line = start + (error.line() as u64).saturating_sub(1);
    let said = error.to_string();
    // The library's own line counts from where the part begins.
    let reason = said.split(" at line ").next().unwrap_or(&said).to_owned();
    (line, Fault::Json { reason })
}

/// Tells of cells that are not read.
fn warn_of_others(line: u64, count: usize, warnings: &mut Warnings) {
    warnings.add_many(
        line,
        "other_cells_left_out",
        "another cell in the file: only the first is read; FILE#NAME is one of them",
        count as u64,
    );
}

/// The fault of a name that no cell of the file has. `known`: that of another.
fn no_member(member: &str, count: usize, known: Option<String>) -> Fault {
    Fault::NoMember {
        member: member.to_owned(),
        count,
        first: known.unwrap_or_default(),
    }
}

/// A coordinate or radius that a model can hold.
fn in_range(line: u64, column: &'static str, number: f64) -> Located<f64> {
    if number.abs() <= Morphology::MAX_COORDINATE {
        return Ok(number);
    }
    let text = number.to_string();
    Err((line, Fault::OutOfRange { column, text }))
}
