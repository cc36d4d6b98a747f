//! Readers of surfaces, for judging any mesh.
//!
//! Whatever a file claims, memory grows with the bytes that are there: counts in headers are
//! believed only when the data follow. Polygons of more than four corners become fans of triangles;
//! attributes that our writers write are read back, and numbers of one's own where they are wanted.

mod arrays;
mod base64;
mod builder;
mod compressed;
mod glb;
mod lines;
mod msh;
mod msh2;
mod numbers;
mod obj;
mod off;
mod own;
mod ply;
mod regions;
mod stl;
mod tetgen;
mod vtu;
mod xml;

use std::fmt;
use std::io;
use std::path::Path;

use self::builder::Builder;
pub use self::own::OwnAttribute;
use crate::{Format, SurfaceMesh, UnknownFormat};

/// Where in a file something is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilePosition {
    /// A line, from 1 on.
    Line(usize),
    /// An offset in bytes.
    Byte(usize),
    /// No place in particular.
    File,
}

/// Why a surface could not be read.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// The file could not be opened or read.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// The extension names no format.
    #[error(transparent)]
    Format(#[from] UnknownFormat),
    /// The file breaks the rules of its format.
    #[error("{at}: {found}: expected {expected}")]
    Malformed {
        /// Where.
        at: FilePosition,
        /// What is there.
        found: String,
        /// What the format wants.
        expected: &'static str,
    },
    /// The file ends too early.
    #[error(
        "{at}: the file ends within {what}: it was cut off or its header is wrong, get it anew"
    )]
    Truncated {
        /// Where the data should be.
        at: FilePosition,
        /// What is missing.
        what: &'static str,
    },
    /// A face names a vertex that is not there.
    #[error(
        "{at}: a face names vertex {index} (counted from 0), but there are {vertices} vertices: \
         export the mesh anew"
    )]
    BadIndex {
        /// The face.
        at: FilePosition,
        /// The highest index.
        index: u32,
        /// How many vertices there are.
        vertices: usize,
    },
    /// The file is sound, perhaps, but holds something that we do not read.
    #[error("{at}: {what} is not supported: {remedy}")]
    Unsupported {
        /// Where.
        at: FilePosition,
        /// What is there.
        what: String,
        /// The way out.
        remedy: &'static str,
    },
}

impl ReadError {
    /// Where in the file, if that is known.
    pub fn place(&self) -> FilePosition {
        match self {
            Self::Io(_) | Self::Format(_) => FilePosition::File,
            Self::Malformed { at, .. }
            | Self::Truncated { at, .. }
            | Self::BadIndex { at, .. }
            | Self::Unsupported { at, .. } => *at,
        }
    }

    /// The message with the file in front: `FILE:LINE: what: what to do`.
    pub fn in_file(&self, file: &str) -> String {
        let text = self.to_string();
        match (self.place(), self) {
            (FilePosition::Line(line), _) => {
                let what = text.strip_prefix(&format!("line {line}: "));
                format!("{file}:{line}: {}", what.unwrap_or(&text))
            }
            (_, Self::Io(e)) => {
                format!("{file}: cannot be read ({e}): check the path and its permissions")
            }
            _ => format!("{file}: {}", text.strip_prefix("file: ").unwrap_or(&text)),
        }
    }
}

impl fmt::Display for FilePosition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(f, "line {line}"),
            Self::Byte(byte) => write!(f, "byte {byte}"),
            Self::File => f.write_str("file"),
        }
    }
}

/// Reads a mesh; the extension names the format (`gltf` too, if it embeds its data).
///
/// The origin is zero if all coordinates are numbers of 32 bits, else near the center of the
/// bounds.
pub fn read(path: &Path) -> Result<SurfaceMesh, ReadError> {
    read_as(path, Format::from_extension(path)?)
}

/// Reads a mesh of a known format, whatever its name; see [`read`].
pub fn read_as(path: &Path, format: Format) -> Result<SurfaceMesh, ReadError> {
    read_bytes(&bytes_of(path)?, format)
}

/// Reads a mesh with numbers of one's own for its vertices, which PLY, VTU and GLB have: of a known format, or of that
/// which the extension names. Else as [`read`].
pub fn read_with_attributes(
    path: &Path,
    format: Option<Format>,
) -> Result<(SurfaceMesh, Vec<OwnAttribute>), ReadError> {
    let format = format.map_or_else(|| Format::from_extension(path), Ok)?;
    read_bytes_with_attributes(&bytes_of(path)?, format)
}

fn bytes_of(path: &Path) -> Result<Vec<u8>, ReadError> {
    // A device has no end, and a pipe that nobody writes to keeps whoever opens it waiting.
    if !std::fs::metadata(path)?.is_file() {
        let what = "it is a folder, a device or a pipe, not a regular file";
        return Err(io::Error::other(what).into());
    }
    Ok(std::fs::read(path)?)
}

/// Reads a mesh from the bytes of a file; see [`read`].
pub fn read_bytes(bytes: &[u8], format: Format) -> Result<SurfaceMesh, ReadError> {
    let built = |read: fn(&[u8], &mut Builder) -> Result<(), ReadError>| {
        let mut mesh = Builder::new(bytes.len());
        read(bytes, &mut mesh)?;
        mesh.finish()
    };
    match format {
        Format::Ply => built(ply::read),
        Format::Obj => obj::read(bytes),
        Format::Stl => stl::read(bytes),
        Format::Glb => built(glb::read),
        Format::Off => off::read(bytes),
        Format::Vtu => built(vtu::read),
        // The file says which version it is of.
        Format::Msh | Format::Msh2 => msh::read(bytes),
        Format::Poly => tetgen::read_poly(bytes),
        Format::Smesh => tetgen::read_smesh(bytes),
    }
}

/// Reads a mesh with numbers of one's own from the bytes of a file; see [`read_with_attributes`].
pub fn read_bytes_with_attributes(
    bytes: &[u8],
    format: Format,
) -> Result<(SurfaceMesh, Vec<OwnAttribute>), ReadError> {
    let mut mesh = Builder::with_own(bytes.len());
    match format {
        Format::Ply => ply::read(bytes, &mut mesh)?,
        Format::Glb => glb::read(bytes, &mut mesh)?,
        Format::Vtu => vtu::read(bytes, &mut mesh)?,
        other => return Ok((read_bytes(bytes, other)?, Vec::new())),
    }
    mesh.finish_with_own()
}

/// A [`ReadError::Malformed`].
fn malformed(at: FilePosition, found: impl Into<String>, expected: &'static str) -> ReadError {
    ReadError::Malformed {
        at,
        found: found.into(),
        expected,
    }
}

/// The beginning of what stands in a file, for a message.
fn shown(bytes: &[u8]) -> String {
    let text = String::from_utf8_lossy(&bytes[..bytes.len().min(40)]);
    format!("'{}'", text.trim().escape_debug())
}
