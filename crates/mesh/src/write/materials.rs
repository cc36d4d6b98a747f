//! What files say of the looks of a surface: a material for each type, in the color of pictures.

use crate::WALL;
use crate::palette::{Palette, Rgb};

/// What a file tells beside the surface itself.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct WriteOptions {
    /// The name of the file of materials ([`obj_materials`](crate::obj_materials)) that an OBJ refers to; none: its faces
    /// are in groups by type all the same, but have no materials.
    pub material_file: Option<String>,
    /// Whether the triangles of a GLB are parted by type, each with its material. Many readers then make a mesh of each
    /// type, none of which is closed.
    pub glb_materials: bool,
}

/// The color of a type: that of pictures on white. Walls are light, since they are no membrane.
pub(super) fn type_color(kind: i32) -> Rgb {
    match kind {
        WALL => [220; 3],
        kind => Palette::default().of_type(kind),
    }
}
