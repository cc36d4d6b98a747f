//! Morphology files and the morphology model, there and back.
//!
//! [`read`] finds the format, reads the whole file and gives a [`Read`]: the **morphology**, the
//! name of the **format** and the **warnings**, one per kind of oddity. What cannot be read is a
//! [`ReadError`] that names file, line, what is wrong and what to do. [`write()`] writes.
//!
//! ```
//! use neurotess_formats::{ReadOptions, swc};
//!
//! let file = b"1 1 0 0 0 5 -1\n2 2 0 6 0 1 1\n3 2 0 9 0 1 2\n";
//! let read = swc::read_bytes(file, "axon.swc", &ReadOptions::default())?;
//! assert_eq!(read.morphology.points.len(), 2);
//! assert!(read.warnings.is_empty());
//!
//! let mut written = Vec::new();
//! swc::write(&read.morphology, &mut written).expect("memory takes it");
//! assert_eq!(written, file);
//! # Ok::<(), neurotess_formats::ReadError>(())
//! ```
//!
//! # Features
//! SWC is always there. `asc`, `h5`, `neuroml`, `xml` (SNT, KNOSSOS, Neurolucida XML) and `json` (MouseLight, CATMAID,
//! neuroglancer's skeletons) add the other formats, all of them by default. A file of a format that is not built in is an error that names the
//! feature.
#![forbid(unsafe_code)]

#[cfg(feature = "asc")]
pub mod asc;
pub mod budget;
#[cfg(feature = "h5")]
pub mod capacity;
mod error;
mod foreign;
#[cfg(any(feature = "xml", feature = "json"))]
mod forest;
mod format;
#[cfg(feature = "h5")]
pub mod h5;
#[cfg(feature = "h5")]
mod hdf5;
#[cfg(feature = "h5")]
pub mod indices;
#[cfg(feature = "json")]
pub mod json;
#[cfg(feature = "xml")]
pub mod knossos;
#[cfg(feature = "h5")]
pub mod layout_5;
mod losses;
#[cfg(any(feature = "neuroml", feature = "xml"))]
mod named;
#[cfg(feature = "xml")]
pub mod neurolucida_xml;
#[cfg(feature = "neuroml")]
pub mod neuroml;
mod number;
#[cfg(any(feature = "asc", feature = "h5"))]
mod outlines;
mod packed;
#[cfg(feature = "json")]
pub mod precomputed;
mod recognize;
mod regular;
#[cfg(any(
    feature = "asc",
    feature = "h5",
    feature = "neuroml",
    feature = "xml",
    feature = "json"
))]
mod sample;
pub mod swc;
mod text;
#[cfg(any(feature = "asc", feature = "h5", feature = "xml"))]
mod traced;
#[cfg(feature = "xml")]
pub mod traces;
mod unit;
mod warning;
mod write;
#[cfg(any(feature = "neuroml", feature = "xml"))]
mod xml;

use std::borrow::Cow;
use std::path::Path;

use neurotess_morphology::Morphology;

pub use error::{Fault, ReadError};
pub use format::{EXTENSIONS, Format, has_known_name};
pub use packed::{unpacked, unpacked_name};
pub use recognize::is_json_tracing;
pub use regular::{read_regular, regular};
use text::Located;
pub use warning::Warning;
use warning::Warnings;
pub use write::{write, write_numbered};

/// How to read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ReadOptions {
    /// Take every warning as an error.
    pub strict: bool,
    /// Take radii in SWC that are no finite numbers as 0, with a warning, instead of refusing the file: for
    /// whoever mends radii afterwards.
    pub zero_for_bad_radii: bool,
    /// Warn of SWC that NEURON 9 refuses or reads as something else (`neuron_misreads`).
    pub for_neuron: bool,
    /// The caller knows the unit of SWC and takes lengths to micrometers: one that the header names is told, not applied.
    pub unit_given: bool,
}

/// What a file gave.
#[derive(Clone, Debug, PartialEq)]
pub struct Read {
    /// The cell, named after the file.
    pub morphology: Morphology,
    /// Short name of the format: [`Format::name`].
    pub format: &'static str,
    /// What was odd, in the order of the lines.
    pub warnings: Vec<Warning>,
}

/// Reads a morphology; the format is told by the name's extension, else by the content. Of a file that
/// holds many, `FILE#NAME` is one: the path in an H5 file, the number or name of a neuron in JSON. Of neuroglancer's
/// precomputed skeletons `FOLDER/ID` is one, in a file of its own or in shards. Files packed by
/// gzip, as `cell.swc.gz`, are unpacked.
///
/// # Errors
/// [`ReadError`] with file and line.
pub fn read(path: impl AsRef<Path>, options: &ReadOptions) -> Result<Read, ReadError> {
    let path = path.as_ref();
    #[cfg(feature = "json")]
    if let Some(read) = precomputed::read(path, options) {
        return read;
    }
    let name = path.display().to_string();
    let (file, member) = member(path);
    let extension = unpacked_name(file).extension().unwrap_or_default();
    let extension = extension.to_string_lossy();
    // Of a container of thousands only the one is read; other files of many are read whole.
    #[cfg(feature = "h5")]
    let is_container = !packed::is_packed(file) && !extension.eq_ignore_ascii_case("json");
    #[cfg(feature = "h5")]
    if let Some(member) = member.filter(|_| is_container) {
        return h5::read_member_of(file, &name, member, options);
    }
    let bytes = match read_regular(file) {
        Ok(bytes) => bytes,
        Err(e) => return Err(ReadError::of_file(&name, Fault::Io(e))),
    };
    match member {
        Some(member) => read_member(bytes, &name, member, options),
        None => read_bytes(bytes, &name, Format::of_extension(&extension), options),
    }
}

/// Reads one morphology of a file that holds many.
#[cfg_attr(
    not(any(feature = "h5", feature = "json")),
    expect(unused_variables, reason = "no format of this build holds many")
)]
fn read_member(
    bytes: Vec<u8>,
    name: &str,
    member: &str,
    options: &ReadOptions,
) -> Result<Read, ReadError> {
    let bytes = unpacked(bytes).map_err(|fault| ReadError::of_file(name, fault))?;
    match recognize::format(&bytes, None).unwrap_or(Format::H5) {
        #[cfg(feature = "json")]
        Format::MouseLight => json::mouselight::read_member(&bytes, name, member, options),
        #[cfg(feature = "json")]
        Format::Catmaid => json::catmaid::read_member(&bytes, name, member, options),
        #[cfg(feature = "h5")]
        _ => h5::read_member(bytes, name, member, options),
        #[cfg(not(feature = "h5"))]
        _ => Err(ReadError::of_file(name, Format::H5.missing())),
    }
}

/// Reads a morphology that is in memory, packed by gzip or not. `name` is what errors call it; `format`: where
/// it is known, else the content tells.
///
/// # Errors
/// [`ReadError`] with `name` and line.
pub fn read_bytes(
    bytes: Vec<u8>,
    name: &str,
    format: Option<Format>,
    options: &ReadOptions,
) -> Result<Read, ReadError> {
    let bytes = match unpacked(bytes) {
        Ok(bytes) => bytes,
        Err(fault) => return Err(ReadError::of_file(name, fault)),
    };
    let format = recognize::format(&bytes, format);
    match format.map_err(|fault| ReadError::of_file(name, fault))? {
        Format::Swc => swc::read_bytes(&bytes, name, options),
        #[cfg(feature = "asc")]
        Format::Asc => asc::read_bytes(&bytes, name, options),
        #[cfg(feature = "h5")]
        Format::H5 => h5::read_bytes(bytes, name, options),
        #[cfg(feature = "neuroml")]
        Format::NeuroMl => neuroml::read_bytes(&bytes, name, options),
        #[cfg(feature = "xml")]
        Format::Traces => traces::read_bytes(&bytes, name, options),
        #[cfg(feature = "xml")]
        Format::Knossos => knossos::read_bytes(&bytes, name, options),
        #[cfg(feature = "xml")]
        Format::NeurolucidaXml => neurolucida_xml::read_bytes(&bytes, name, options),
        #[cfg(feature = "json")]
        Format::MouseLight => json::mouselight::read_bytes(&bytes, name, options),
        #[cfg(feature = "json")]
        Format::Catmaid => json::catmaid::read_bytes(&bytes, name, options),
        #[cfg(not(all(
            feature = "asc",
            feature = "h5",
            feature = "neuroml",
            feature = "xml",
            feature = "json"
        )))]
        other => Err(ReadError::of_file(name, other.missing())),
    }
}

/// A soma's surface: vertices (µm, the coordinates of the file), and triangles.
pub type SomaMesh = (Vec<glam::DVec3>, Vec<[u32; 3]>);

/// The mesh of the soma that an H5 file has beside a cell, as morph-spines writes it.
///
/// # Errors
/// There is none, or it is broken; this build reads no H5.
pub fn soma_mesh(path: impl AsRef<Path>) -> Result<SomaMesh, ReadError> {
    #[cfg(feature = "h5")]
    return h5::soma_mesh(path);
    #[cfg(not(feature = "h5"))]
    {
        let error = std::io::Error::other(Format::H5.missing());
        Err(ReadError::of_file(
            &path.as_ref().display().to_string(),
            Fault::Io(error),
        ))
    }
}

/// The file, and the morphology within it that a path names as in `merged.h5#cells/a`.
pub fn member(path: &Path) -> (&Path, Option<&str>) {
    let whole = (path, None);
    let Some(text) = path.to_str().filter(|text| text.contains('#')) else {
        return whole;
    };
    if path.exists() {
        return whole;
    }
    // Folders and names may have a # of their own: the first that ends the path of a file counts.
    let mut parts = text.match_indices('#');
    let parts = parts.find_map(|(at, _)| {
        let (file, member) = (Path::new(&text[..at]), &text[at + 1..]);
        (!member.is_empty() && file.is_file()).then_some((file, Some(member)))
    });
    parts.unwrap_or(whole)
}

/// The file on the disk that holds the morphology that a path names: that of a [`member`], or of a skeleton of neuroglancer.
pub fn file_of(path: &Path) -> Cow<'_, Path> {
    #[cfg(feature = "json")]
    if let Some(file) = precomputed::file_of(path) {
        return Cow::Owned(file);
    }
    Cow::Borrowed(member(path).0)
}

/// Reads a format that has lines: `interpret` gets the cell's name and collects warnings.
fn read_text(
    format: Format,
    name: &str,
    options: &ReadOptions,
    interpret: impl FnOnce(&str, &mut Warnings) -> Located<Morphology>,
) -> Result<Read, ReadError> {
    let mut warnings = Warnings::default();
    let stem = text::stem(name, format.extensions());
    let morphology =
        interpret(stem, &mut warnings).map_err(|located| ReadError::at(name, located))?;
    Ok(Read {
        morphology,
        format: format.name(),
        warnings: warnings.finish(name, options)?,
    })
}
