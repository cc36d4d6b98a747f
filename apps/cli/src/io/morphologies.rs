//! What is said of morphologies that are read, and morphologies into files.

use std::io::BufWriter;
use std::path::Path;

use neurotess::formats::swc::SampleNumbers;
use neurotess::formats::{self, Format};
use neurotess::morphology::Morphology;
use neurotess::options::OF_UNIT;
use serde::Serialize;

use super::output::{self, OutputError};
use crate::report::place;

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
