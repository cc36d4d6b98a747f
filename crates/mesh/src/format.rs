//! File formats of surfaces.

use std::fmt;
use std::path::Path;
use std::str::FromStr;

/// A file format of surfaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// Stanford polygon file, binary; normals and attributes.
    Ply,
    /// Wavefront, text; normals.
    Obj,
    /// Stereolithography, binary; triangles without shared vertices.
    Stl,
    /// glTF 2.0, binary; triangles, normals and attributes.
    Glb,
    /// Object file format, text.
    Off,
    /// VTK unstructured grid, XML with raw binary data; normals and attributes.
    Vtu,
    /// Gmsh 4.1, binary; triangles with a surface for each section and a physical group for each type.
    Msh,
    /// Gmsh 2.2, text, which STEPS and older programs read; with the same surfaces and groups.
    Msh2,
    /// TetGen's piecewise linear complex, text; triangles with their type as facet marker.
    Poly,
    /// TetGen's simple form of it, with a line for each facet.
    Smesh,
}

/// No format has this name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("unknown mesh format '{0}': use ply, obj, stl, glb, off, vtu, msh, msh2, poly or smesh")]
pub struct UnknownFormat(pub String);

impl Format {
    /// All formats.
    pub const ALL: [Self; 10] = [
        Self::Ply,
        Self::Obj,
        Self::Stl,
        Self::Glb,
        Self::Off,
        Self::Vtu,
        Self::Msh,
        Self::Msh2,
        Self::Poly,
        Self::Smesh,
    ];

    /// The name that options and messages give it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ply => "ply",
            Self::Obj => "obj",
            Self::Stl => "stl",
            Self::Glb => "glb",
            Self::Off => "off",
            Self::Vtu => "vtu",
            Self::Msh => "msh",
            Self::Msh2 => "msh2",
            Self::Poly => "poly",
            Self::Smesh => "smesh",
        }
    }

    /// The extension of files, without a dot: the name, but `msh` for both versions of it.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Msh2 => "msh",
            other => other.name(),
        }
    }

    /// The format that a path's extension names, in either case; `gltf` is read as GLB. `msh` is version 4.1 to write,
    /// and whichever the file says to read.
    pub fn from_extension(path: &Path) -> Result<Self, UnknownFormat> {
        let extension = path.extension().unwrap_or_default().to_string_lossy();
        extension.parse()
    }

    /// Whether files of this format tell what each face belongs to, so that mesh generators find walls in them.
    pub fn has_regions(self) -> bool {
        matches!(self, Self::Msh | Self::Msh2 | Self::Poly | Self::Smesh)
    }

    /// Whether files of this format have colors of vertices.
    pub fn has_colors(self) -> bool {
        matches!(self, Self::Ply | Self::Vtu | Self::Glb)
    }

    /// Whether files of this format can hold quads.
    pub fn has_quads(self) -> bool {
        matches!(self, Self::Ply | Self::Obj | Self::Off | Self::Vtu)
    }
}

impl FromStr for Format {
    type Err = UnknownFormat;

    fn from_str(name: &str) -> Result<Self, UnknownFormat> {
        let lower = name.to_ascii_lowercase();
        let found = Self::ALL.into_iter().find(|format| format.name() == lower);
        let found = found.or((lower == "gltf").then_some(Self::Glb));
        found.ok_or_else(|| UnknownFormat(name.to_owned()))
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
