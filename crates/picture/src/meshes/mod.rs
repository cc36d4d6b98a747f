//! Meshes that are no cells, such as brain regions and pipettes: how they look, and normals for their light.

mod normals;

pub use self::normals::Lit;

/// Sub-pixels of depth within which layers of one mesh that face the same way count as one surface. Larger: layers
/// that are closer hide one another. Smaller: more grain on slopes.
pub const SHEET_DEPTH: f32 = 24.0;

/// How a mesh looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshLook {
    /// What its color is looked up by: see [`ColorTable`](crate::color::ColorTable). A category, since it
    /// belongs to no instance that has values. Meshes with keys of their own
    /// (`MeshGeometry::with_keys`, `SceneMesh::new`) have those instead.
    pub color_key: u32,
    /// Share of what lies behind that each of its layers hides, 0 to 1.
    pub opacity: f32,
    /// Whether only the edges of its faces are drawn.
    pub edges: bool,
    /// Micrometers of a unit of its coordinates.
    pub scale: f64,
}

impl MeshLook {
    /// Whether things behind it show.
    pub fn is_translucent(&self) -> bool {
        self.edges || self.opacity < 1.0
    }
}
