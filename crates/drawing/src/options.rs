//! All that a drawing is asked for.

use neurotess_color::{MeshValues, OwnNumbers};
use neurotess_mesh::SurfaceMesh;
use neurotess_options::Picture;
use neurotess_options::groups::DeviceOptions;
use neurotess_picture::color::Rgb;

/// All that a drawing is asked for: the picture, and how it is come by.
#[derive(Clone, Debug, Default)]
pub struct DrawOptions {
    /// What it shows, and how.
    pub picture: Picture,
    /// What draws.
    pub device: DeviceOptions,
    /// Whether meshes of a circuit are neither read from nor written beside it.
    pub no_cache: bool,
    /// Whether every warning of the reader is an error.
    pub strict: bool,
    /// Colors of numbers, from low to high, instead of a color map.
    pub scale: Option<Vec<Rgb>>,
}

impl From<Picture> for DrawOptions {
    fn from(picture: Picture) -> Self {
        Self {
            picture,
            ..Self::default()
        }
    }
}

/// What a picture shows that options do not say.
#[derive(Clone, Debug, Default)]
pub struct OwnData {
    /// Numbers of the cells, which they are colored by.
    pub numbers: Option<OwnNumbers>,
    /// Meshes beside the cells that are in memory, by their place among those of the options: the others are read.
    pub surfaces: Vec<Option<SurfaceMesh>>,
    /// Numbers of the meshes beside the cells, in the order of the options.
    pub mesh_values: Option<MeshValues>,
}
