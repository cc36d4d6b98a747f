//! Which formats there are.

use std::io::{self, Write};

use neurotess_morphology::Morphology;

use crate::{Warning, asc, h5, neuroml, swc};

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
            Self::Swc => &swc::EXTENSIONS,
            Self::Asc => &asc::EXTENSIONS,
            Self::H5 => &h5::EXTENSIONS,
            Self::NeuroMl => &neuroml::EXTENSIONS,
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
            () if h5::looks_like(bytes) => Some(Self::H5),
            () if neuroml::looks_like(bytes) => Some(Self::NeuroMl),
            () if asc::looks_like(bytes) => Some(Self::Asc),
            () if swc::looks_like(bytes) => Some(Self::Swc),
            () => None,
        }
    }
}

/// Writes a morphology, and tells what the format cannot say of it.
///
/// # Errors
/// Those of the writer; [`io::ErrorKind::Unsupported`] for a format that is only read.
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
        Format::Asc => asc::write(morphology, writer),
        Format::H5 => h5::write(morphology, writer),
        Format::NeuroMl => Err(io::ErrorKind::Unsupported.into()),
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
