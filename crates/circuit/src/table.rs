//! Tables in files: CSV, or TSV for files of that name. Lines that begin with # are comments.

use std::path::Path;

use crate::{CircuitError, Fault};

/// Whether a file is named like a table.
pub(crate) fn is_named_so(path: &Path) -> bool {
    delimiter(path).is_some()
}

fn delimiter(path: &Path) -> Option<u8> {
    let extension = path.extension()?.to_string_lossy().to_ascii_lowercase();
    match &*extension {
        "csv" => Some(b','),
        "tsv" => Some(b'\t'),
        _ => None,
    }
}

/// Reads the content of a table.
pub(crate) fn reader<'b>(path: &Path, bytes: &'b [u8]) -> csv::Reader<&'b [u8]> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    csv::ReaderBuilder::new()
        .delimiter(delimiter(path).unwrap_or(b','))
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(bytes)
}

/// What the library says of a row.
pub(crate) fn broken(file: &str, error: &csv::Error) -> CircuitError {
    let line = error.position().map_or(1, csv::Position::line);
    let fault = match error.kind() {
        csv::ErrorKind::UnequalLengths {
            expected_len, len, ..
        } => Fault::Fields {
            found: *len as usize,
            expected: *expected_len as usize,
        },
        _ => Fault::Scene {
            reason: error.to_string(),
        },
    };
    CircuitError::at_line(file, line, "", fault)
}
