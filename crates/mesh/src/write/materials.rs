//! What files say of the looks of a surface: colors of vertices, and a material for each type, as in pictures.

use std::str::FromStr;

use crate::palette::{Palette, Rgb, linear};
use crate::{SurfaceVertex, WALL};

/// What the colors of vertices tell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ColorBy {
    /// SWC type.
    Type,
}

impl ColorBy {
    /// All of them.
    pub const ALL: [Self; 1] = [Self::Type];

    /// Its name, as options have it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Type => "type",
        }
    }

    /// The color of a vertex.
    pub(super) fn of(self, vertex: &SurfaceVertex) -> Rgb {
        match self {
            Self::Type => type_color(vertex.kind),
        }
    }

    /// The light of a vertex, as glTF has colors; 65,535 is all of it. Of 8 bits, dark colors would be a tenth off.
    pub(super) fn light(self, vertex: &SurfaceVertex) -> [u16; 3] {
        linear(self.of(vertex)).map(|light| (light * 65_535.0).round() as u16)
    }
}

/// How triangles and their numbers are compressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Compression {
    /// By [Draco](crate::draco); a GLB tells its readers by `KHR_draco_mesh_compression`.
    Draco,
}

impl Compression {
    /// All of them.
    pub const ALL: [Self; 1] = [Self::Draco];

    /// Its name, as options have it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Draco => "draco",
        }
    }
}

impl FromStr for ColorBy {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let found = Self::ALL.into_iter().find(|by| by.name() == name);
        found.ok_or_else(|| "files have colors by type".into())
    }
}

impl FromStr for Compression {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let found = Self::ALL.into_iter().find(|by| by.name() == name);
        found.ok_or_else(|| "use draco".into())
    }
}

/// What a file tells beside the surface itself.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct WriteOptions {
    /// The name of the file of materials ([`obj_materials`](crate::obj_materials)) that an OBJ refers to; none: its faces
    /// are in groups by type all the same, but have no materials.
    pub material_file: Option<String>,
    /// Whether the triangles of a GLB are parted by type, each with its material. Many readers then make a mesh of each
    /// type, none of which is closed.
    pub glb_materials: bool,
    /// Colors of the vertices of a PLY, VTU or GLB.
    pub color_by: Option<ColorBy>,
    /// Whether a GLB is compressed: it has its triangles and vertices in another order then, is whole in memory while it is
    /// made, and has no [materials](WriteOptions::glb_materials), whose vertices it could not share.
    pub compression: Option<Compression>,
}

/// The color of a type: that of pictures on white. Walls are light, since they are no membrane.
pub(super) fn type_color(kind: i32) -> Rgb {
    match kind {
        WALL => [220; 3],
        kind => Palette::default().of_type(kind),
    }
}
