//! Which formats there are.

use std::path::Path;

use crate::Fault;
use crate::packed::unpacked_name;

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
}

/// Whether a file's name ends as those of morphologies do, packed by gzip or not.
pub fn has_known_name(path: &Path) -> bool {
    let extension = unpacked_name(path).extension().unwrap_or_default();
    Format::of_extension(&extension.to_string_lossy()).is_some()
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
        assert!(has_known_name(Path::new("a/cell.swc.gz")));
        assert!(!has_known_name(Path::new("a/cell.gz")));
    }
}
