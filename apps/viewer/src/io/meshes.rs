//! Reads meshes beside the cells.

use std::path::Path;
use std::sync::Arc;

use neurotess::mesh::{self, ReadError};
use neurotess::precomputed;
use neurotess::render::bounds::surface_points;

use crate::model::meshes::ReadMesh;

/// Reads a mesh.
///
/// # Errors
/// A message without the file's name, which the window shows beside it.
pub(crate) fn read(file: &Path) -> Result<ReadMesh, String> {
    let surface = match precomputed::read_mesh(file) {
        Some(read) => read.map_err(|e| e.to_string())?,
        None => mesh::read(file).map_err(|e| match e {
            ReadError::Io(e) => format!("cannot be read ({e}): check the path and its permissions"),
            other => other.to_string(),
        })?,
    };
    if surface.faces.triangles.is_empty() && surface.faces.quads.is_empty() {
        return Err("it has no faces, and points are not drawn: export a surface".into());
    }
    Ok(ReadMesh {
        points: Arc::new(surface_points(&surface, 1.0)),
        surface: Arc::new(surface),
    })
}
