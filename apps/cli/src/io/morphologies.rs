//! Morphologies from files or standard input, and into files.

use std::io::BufWriter;
use std::path::Path;

use neurotess::formats::swc::SampleNumbers;
use neurotess::formats::{self, Format, ReadOptions};
use neurotess::morphology::Morphology;
use serde::Serialize;

use super::output::{self, OutputError, is_standard};
use super::standard_input::standard_input;
use crate::report::{Failure, place};

/// A warning of the reader.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct ReaderWarning {
    line: Option<u64>,
    code: &'static str,
    message: String,
    count: u64,
}

impl ReaderWarning {
    pub(crate) fn code(&self) -> &'static str {
        self.code
    }

    pub(crate) fn message(&self) -> &str {
        &self.message
    }

    /// Whether the unit is likely not the micrometer.
    pub(crate) fn is_of_unit(&self) -> bool {
        OF_UNIT.contains(&self.code)
    }

    /// As text: `FILE:LINE: message (code)`.
    pub(crate) fn in_file(&self, file: &str) -> String {
        let place = place(file, self.line);
        format!("{place} {} ({})", self.message, self.code)
    }
}

/// Codes of a cell whose unit is likely not the micrometer.
pub(crate) const OF_UNIT: [&str; 2] = ["too_large", "too_small"];

impl From<formats::Warning> for ReaderWarning {
    fn from(warning: formats::Warning) -> Self {
        let formats::Warning {
            line,
            code,
            mut message,
            count,
        } = warning;
        if let Some(place) = OF_UNIT.iter().position(|&of_unit| of_unit == code) {
            let options = ["--units nm or voxel=X,Y,Z", "--scale 1000"][place];
            message.push_str(&format!(
                ": neurotess convert {options} makes micrometers of it"
            ));
        }
        Self {
            line,
            code,
            message,
            count,
        }
    }
}

/// Extensions of morphologies that are looked for in folders.
pub(crate) const MORPHOLOGIES: [&str; 16] = [
    "swc",
    "eswc",
    "asc",
    "h5",
    "hdf5",
    "nml",
    "neuroml",
    "traces",
    "swc.gz",
    "eswc.gz",
    "asc.gz",
    "h5.gz",
    "hdf5.gz",
    "nml.gz",
    "neuroml.gz",
    "traces.gz",
];

/// Reads the morphology of an input.
pub(crate) fn read_morphology(
    path: &Path,
    format: Option<Format>,
    options: &ReadOptions,
) -> Result<formats::Read, Failure> {
    let read = match is_standard(path) {
        true => {
            let no_text = |head: &[u8]| head.contains(&0) && !head.starts_with(b"\x89HDF");
            formats::read_bytes(standard_input(no_text)?, "-", format, options)
        }
        false => formats::read(path, options),
    };
    read.map_err(|e| Failure(e.to_string()))
}

/// An error if an input cannot be read at all, before anything is reported of its output.
pub(crate) fn readable(path: &Path) -> Result<(), Failure> {
    if is_standard(path) {
        return Ok(());
    }
    formats::regular(formats::member(path).0).map_err(|e| {
        let file = path.display();
        Failure(format!(
            "{file}: cannot be read ({e}): check the path and its permissions"
        ))
    })
}

/// Writes a morphology to a file, whole or not at all. Returns what the format cannot represent. `numbers`: of the samples
/// in SWC.
pub(crate) fn write_morphology(
    morphology: &Morphology,
    format: Format,
    numbers: SampleNumbers,
    out: &Path,
    force: bool,
) -> Result<Vec<formats::Warning>, OutputError> {
    let mut output = output::begin(out, force)?;
    let writer = BufWriter::new(output.file());
    let lost = formats::write_numbered(morphology, format, numbers, writer)
        .map_err(|e| OutputError::broken(out, e))?;
    output.finish()?;
    Ok(lost)
}

/// Formats that are written, by their extensions.
pub(crate) fn written() -> [&'static str; Format::WRITTEN.len()] {
    Format::WRITTEN.map(|format| format.extensions()[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_format_is_looked_for_packed_or_not() {
        let packed = formats::EXTENSIONS.map(|extension| format!("{extension}.gz"));
        let all: Vec<&str> = formats::EXTENSIONS
            .into_iter()
            .chain(packed.iter().map(String::as_str))
            .collect();
        assert_eq!(all, MORPHOLOGIES);
    }
}
