//! Meshes of the picture that are no cells: which show, and in which colors.

use std::path::PathBuf;
use std::sync::Arc;

use neurotess::coloring;
use neurotess::mesh::SurfaceMesh;
use neurotess::render::color::{ColorTable, Rgb, category};
use neurotess::render::overlay::Legend;
use neurotess::render::{DeviceError, Gpu, MeshGeometry, MeshLook, Meshes};

use crate::model::state::State;
use crate::scene::content::SceneContent;

/// A mesh that shows.
#[derive(Clone, Debug)]
pub(crate) struct SceneMesh {
    pub(crate) file: PathBuf,
    name: String,
    color: Rgb,
    /// Its color key is that of the table of [`add_to`].
    pub(crate) look: MeshLook,
    pub(crate) surface: Arc<SurfaceMesh>,
}

impl SceneMesh {
    pub(crate) fn name(&self) -> &str {
        &self.name
    }

    /// Whether another differs in nothing but its color and name.
    pub(crate) fn is_recolored(&self, other: &Self) -> bool {
        let MeshLook { color_key, .. } = self.look;
        let same = MeshLook {
            color_key,
            ..other.look
        };
        self.file == other.file && self.look == same && Arc::ptr_eq(&self.surface, &other.surface)
    }
}

/// The meshes that show, without their color keys.
pub(crate) fn shown(state: &State) -> Vec<SceneMesh> {
    let meshes = state.meshes_shown().map(|(entry, read)| SceneMesh {
        file: entry.file.clone(),
        name: entry.name(),
        color: entry.color,
        look: MeshLook {
            color_key: 0,
            opacity: entry.opacity,
            edges: entry.edges,
            scale: entry.um(),
        },
        surface: Arc::clone(&read.surface),
    });
    meshes.collect()
}

/// Adds the colors of meshes to a table behind all others, and sets their color keys. `categories`: those that cells use,
/// also beyond the end of the table.
pub(crate) fn add_colors(meshes: &mut [SceneMesh], table: &mut ColorTable, categories: usize) {
    let all = &mut table.categories;
    let last = all.last().copied().unwrap_or(coloring::NOTHING);
    all.resize(all.len().max(categories), last);
    for mesh in meshes {
        mesh.look.color_key = category(all.len() as u32);
        all.push(mesh.color);
    }
}

/// A legend with the names of meshes below.
pub(crate) fn legend_below(meshes: &[SceneMesh], legend: Legend) -> Legend {
    if meshes.is_empty() {
        return legend;
    }
    let named = meshes.iter().map(|mesh| (mesh.color, mesh.name.clone()));
    legend.with_below(Legend::swatches("", named))
}

/// Adds the colors and names of meshes to those of the scene.
pub(crate) fn add_to(meshes: &mut [SceneMesh], content: &mut SceneContent) {
    add_colors(meshes, &mut content.table, content.categories);
    content.legend = legend_below(meshes, content.legend.clone());
}

/// Uploads meshes to a device, if there are any.
pub(crate) fn upload(gpu: &Gpu, meshes: &[SceneMesh]) -> Result<Option<Meshes>, DeviceError> {
    if meshes.is_empty() {
        return Ok(None);
    }
    let mut uploaded = Vec::new();
    for mesh in meshes {
        let surface = SurfaceMesh::clone(&mesh.surface);
        uploaded.push((Arc::new(MeshGeometry::new(gpu, surface)?), mesh.look));
    }
    Ok(Some(Meshes::new(gpu, uploaded)))
}
