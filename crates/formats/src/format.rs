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
    /// NeuroML 2 and 1, `.nml`; written as 2.
    NeuroMl,
    /// SNT of Fiji, `.traces`; read only.
    Traces,
    /// webKnossos and KNOSSOS, `.nml`, told from NeuroML by the content; read only.
    Knossos,
    /// Neurolucida XML, `.xml`; read only.
    NeurolucidaXml,
    /// Neurons of MouseLight in JSON; read only.
    MouseLight,
    /// Skeletons of CATMAID in JSON; read only.
    Catmaid,
}

/// Extensions of files that are looked for in folders, in lower case. Files in XML and JSON are of many kinds, and are
/// read where they are named.
pub const EXTENSIONS: [&str; 8] = [
    "swc", "eswc", "asc", "h5", "hdf5", "nml", "neuroml", "traces",
];

impl Format {
    /// All formats.
    pub const ALL: [Self; 9] = [
        Self::Swc,
        Self::Asc,
        Self::H5,
        Self::NeuroMl,
        Self::Traces,
        Self::Knossos,
        Self::NeurolucidaXml,
        Self::MouseLight,
        Self::Catmaid,
    ];

    /// Those that can be written.
    pub const WRITTEN: [Self; 4] = [Self::Swc, Self::Asc, Self::H5, Self::NeuroMl];

    /// Short name, as reports have it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Swc => "swc",
            Self::Asc => "asc",
            Self::H5 => "h5",
            Self::NeuroMl => "neuroml",
            Self::Traces => "traces",
            Self::Knossos => "knossos",
            Self::NeurolucidaXml => "neurolucida_xml",
            Self::MouseLight => "mouselight",
            Self::Catmaid => "catmaid",
        }
    }

    /// Its extensions in lower case, the usual one first.
    pub fn extensions(self) -> &'static [&'static str] {
        match self {
            Self::Swc => &["swc", "eswc"],
            Self::Asc => &["asc"],
            Self::H5 => &["h5", "hdf5"],
            Self::NeuroMl => &["nml", "neuroml", "xml"],
            Self::Traces => &["traces", "xml"],
            Self::Knossos => &["nml", "xml"],
            Self::NeurolucidaXml => &["xml"],
            Self::MouseLight | Self::Catmaid => &["json"],
        }
    }

    /// The feature that it is built in with; SWC always is.
    fn feature(self) -> &'static str {
        match self {
            Self::Swc => "",
            Self::Asc => "asc",
            Self::H5 => "h5",
            Self::NeuroMl => "neuroml",
            Self::Traces | Self::Knossos | Self::NeurolucidaXml => "xml",
            Self::MouseLight | Self::Catmaid => "json",
        }
    }

    /// Whether this build reads it, and writes it if it is written at all.
    pub fn is_built_in(self) -> bool {
        let features = [
            ("", true),
            ("asc", cfg!(feature = "asc")),
            ("h5", cfg!(feature = "h5")),
            ("neuroml", cfg!(feature = "neuroml")),
            ("xml", cfg!(feature = "xml")),
            ("json", cfg!(feature = "json")),
        ];
        features.contains(&(self.feature(), true))
    }

    /// The fault of a file of this format where it is not built in.
    #[cfg_attr(
        all(
            feature = "asc",
            feature = "h5",
            feature = "neuroml",
            feature = "xml",
            feature = "json"
        ),
        expect(dead_code, reason = "every format is built in")
    )]
    pub(crate) fn missing(self) -> Fault {
        let feature = self.feature();
        Fault::NotBuiltIn { feature }
    }

    /// Whether the content tells which of several formats with its extensions a file has.
    pub(crate) fn is_told_by_content(self) -> bool {
        !matches!(self, Self::Swc | Self::Asc | Self::H5)
    }

    /// The format of an extension, in any case; the most common one where several have it.
    pub fn of_extension(extension: &str) -> Option<Self> {
        let extension = extension.to_ascii_lowercase();
        let place = |format: &Self| format.extensions().iter().position(|e| *e == extension);
        let with = Self::ALL
            .into_iter()
            .filter(|format| place(format).is_some());
        with.min_by_key(|format| match extension.as_str() {
            "xml" => usize::from(*format != Self::NeurolucidaXml),
            _ => place(format).unwrap_or(0),
        })
    }
}

/// Whether a file's name ends as those of morphologies do that are looked for in folders, packed by gzip or not.
pub fn has_known_name(path: &Path) -> bool {
    let extension = unpacked_name(path).extension().unwrap_or_default();
    let extension = extension.to_string_lossy().to_ascii_lowercase();
    EXTENSIONS.contains(&&*extension)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_extension_has_its_format() {
        for extension in EXTENSIONS {
            assert!(Format::of_extension(extension).is_some(), "{extension}");
        }
        for (extension, format) in [
            ("ASC", Some(Format::Asc)),
            ("nml", Some(Format::NeuroMl)),
            ("traces", Some(Format::Traces)),
            ("xml", Some(Format::NeurolucidaXml)),
            ("json", Some(Format::MouseLight)),
            ("obj", None),
        ] {
            assert_eq!(Format::of_extension(extension), format, "{extension}");
        }
        assert!(has_known_name(Path::new("a/cell.swc.gz")));
        assert!(has_known_name(Path::new("a/cell.TRACES")));
        assert!(!has_known_name(Path::new("a/cell.gz")));
        assert!(!has_known_name(Path::new("a/config.json")));
    }
}
