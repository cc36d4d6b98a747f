//! Which formats there are.

use std::io::{self, Write};

use neurotess_morphology::Morphology;

use crate::text::{BOM, refuse_other_text};
use crate::{Fault, Warning, swc};

/// A format of morphology files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// SWC, `.swc`.
    Swc,
    /// Neurolucida, `.asc`.
    Asc,
    /// Blue Brain's HDF5, `.h5`.
    H5,
    /// NeuroML 2, `.nml`; read only.
    NeuroMl,
}

/// Extensions of all formats that are read, in lower case.
pub const EXTENSIONS: [&str; 7] = ["swc", "eswc", "asc", "h5", "hdf5", "nml", "neuroml"];

impl Format {
    /// All formats.
    pub const ALL: [Self; 4] = [Self::Swc, Self::Asc, Self::H5, Self::NeuroMl];

    /// Those that can be written.
    pub const WRITTEN: [Self; 3] = [Self::Swc, Self::Asc, Self::H5];

    /// Short name, as reports have it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Swc => "swc",
            Self::Asc => "asc",
            Self::H5 => "h5",
            Self::NeuroMl => "neuroml",
        }
    }

    /// Its extensions in lower case, the usual one first.
    pub fn extensions(self) -> &'static [&'static str] {
        match self {
            Self::Swc => &["swc", "eswc"],
            Self::Asc => &["asc"],
            Self::H5 => &["h5", "hdf5"],
            Self::NeuroMl => &["nml", "neuroml"],
        }
    }

    /// Whether this build reads it, and writes it if it is written at all.
    pub fn is_built_in(self) -> bool {
        match self {
            Self::Swc => true,
            Self::Asc => cfg!(feature = "asc"),
            Self::H5 => cfg!(feature = "h5"),
            Self::NeuroMl => cfg!(feature = "neuroml"),
        }
    }

    /// The fault of a file of this format where it is not built in.
    #[cfg_attr(
        all(feature = "asc", feature = "h5", feature = "neuroml"),
        expect(dead_code, reason = "every format is built in")
    )]
    pub(crate) fn missing(self) -> Fault {
        Fault::NotBuiltIn {
            // Features are named as formats are.
            feature: self.name(),
        }
    }

    /// The format of an extension, in any case.
    pub fn of_extension(extension: &str) -> Option<Self> {
        let extension = extension.to_ascii_lowercase();
        let has = |format: &Self| format.extensions().contains(&&*extension);
        Self::ALL.into_iter().find(has)
    }

    /// The format that the content begins like.
    pub(crate) fn of_content(bytes: &[u8]) -> Option<Self> {
        match () {
            () if bytes.starts_with(HDF5) => Some(Self::H5),
            () if has_neuroml_element(bytes) => Some(Self::NeuroMl),
            () if begins_with_bracket(bytes) => Some(Self::Asc),
            () if swc::looks_like(bytes) => Some(Self::Swc),
            () => None,
        }
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

/// Writes a morphology, and tells what the format cannot say of it.
///
/// # Errors
/// Those of the writer; [`io::ErrorKind::Unsupported`] for a format that is only read, or that this build
/// has no feature for.
///
/// # Panics
/// If indices in the morphology point outside its arrays.
pub fn write(
    morphology: &Morphology,
    format: Format,
    writer: impl Write,
) -> io::Result<Vec<Warning>> {
    match format {
        Format::Swc => swc::write(morphology, writer).map(|()| Vec::new()),
        #[cfg(feature = "asc")]
        Format::Asc => crate::asc::write(morphology, writer),
        #[cfg(feature = "h5")]
        Format::H5 => crate::h5::write(morphology, writer),
        Format::NeuroMl => Err(io::ErrorKind::Unsupported.into()),
        #[cfg(not(all(feature = "asc", feature = "h5")))]
        other => Err(io::Error::new(io::ErrorKind::Unsupported, other.missing())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_extension_has_its_format() {
        let all: Vec<&str> = Format::ALL
            .iter()
            .flat_map(|f| f.extensions())
            .copied()
            .collect();
        assert_eq!(all, EXTENSIONS);
        assert_eq!(Format::of_extension("ASC"), Some(Format::Asc));
        assert_eq!(Format::of_extension("obj"), None);
    }
}
