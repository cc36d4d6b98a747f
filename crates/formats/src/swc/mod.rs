//! SWC: one sample a line, `number type x y z radius parent`.
//!
//! The INCF's specification of SWC (version 1.0) asks for parents before children, one soma and
//! types 0 to 7 or custom ones; files in the wild do not always keep to it, and this reader takes
//! what has one meaning and tells what it took. Column 6 is a **radius**. What other readers make
//! of the same files, and where this one differs, is in `docs/other-programs.md`.
//!
//! ```text
//! bytes ──rows──▶ records: nodes, parents by number, lines
//!       ──ids───▶ nodes, parents by index
//!       ──units, conventions──▶ what programs mean that write SWC in ways of their own
//!       ──Morphology::from_nodes──▶ morphology + notes
//! ```
//!
//! **Taken in silence**: any white space, CRLF or CR alone, a byte-order mark, Latin-1 in comments,
//! comments anywhere (those above the first row are kept as the header; the others, like the
//! footer with synapses, are not), `+1`, `.5`, `1e3`, gaps between numbers, any type.
//! **Taken with a warning**: see the codes in [`crate::Warning`]; **refused**: [`crate::Fault`].

mod conventions;
mod ids;
mod neuron;
mod number;
mod rows;
mod units;
mod write;

use std::path::Path;

use neurotess_morphology::{BuildError, Morphology};

use crate::packed::unpacked_name;
use crate::text::{Located, refuse_foreign};
use crate::warning::Warnings;
use crate::{Fault, Format, Read, ReadError, ReadOptions, read_text};
use rows::{Reading, Records};
pub use write::{SampleNumbers, write, write_numbered};

/// Reads a file that is in memory. `name` is what errors call it; the morphology gets its stem.
///
/// Linear in the bytes, but n log n where the numbers of n samples are sparse; needs about 90 bytes
/// a sample above the file and the morphology.
///
/// # Errors
/// [`ReadError`] with `name` and line.
pub fn read_bytes(bytes: &[u8], name: &str, options: &ReadOptions) -> Result<Read, ReadError> {
    let extension = unpacked_name(Path::new(name)).extension();
    let extended = extension.is_some_and(|e| e.eq_ignore_ascii_case("eswc"));
    let reading = Reading {
        extended,
        zero_for_bad_radii: options.zero_for_bad_radii,
        for_neuron: options.for_neuron,
        unit_given: options.unit_given,
    };
    read_text(Format::Swc, name, options, |name, warnings| {
        interpret(bytes, name, reading, warnings)
    })
}

/// Whether the first line that is no comment is a sample.
pub(crate) fn looks_like(bytes: &[u8]) -> bool {
    refuse_foreign(bytes).is_ok() && rows::first_is_sample(bytes)
}

fn interpret(
    bytes: &[u8],
    name: &str,
    reading: Reading,
    warnings: &mut Warnings,
) -> Located<Morphology> {
    refuse_foreign(bytes)?;
    let mut records = rows::records(bytes, reading, warnings)?;
    if records.nodes.is_empty() {
        return Err((1, Fault::NoSample));
    }
    ids::resolve(&mut records, warnings)?;
    if reading.for_neuron {
        neuron::misreadings(&records, warnings);
    }
    units::apply(&mut records, reading.unit_given, warnings);
    conventions::fork_and_end_types(&mut records, warnings);
    let Records {
        nodes,
        lines,
        header,
        ..
    } = &mut records;
    let line = |node: u32| u64::from(lines[node as usize]);
    let built =
        Morphology::from_nodes(name, std::mem::take(header), nodes).map_err(|e| match e {
            BuildError::Cycle { node } => (
                line(node),
                Fault::Cycle {
                    id: nodes[node as usize].id,
                },
            ),
            BuildError::OutOfRange { node } => (
                line(node),
                Fault::OutOfRange {
                    column: "a number",
                    text: "too large".into(),
                },
            ),
            BuildError::UnknownParent { .. } | BuildError::TooMany { .. } => (1, Fault::TooMany),
        })?;
    warnings.add_notes(built.notes, line);
    Ok(built.morphology)
}
