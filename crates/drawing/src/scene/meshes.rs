//! Meshes of a picture that are no cells.

use std::path::Path;

use itertools::Itertools;
use neurotess_color::{MeshValues, mesh_color};
use neurotess_mesh::{self as mesh, SurfaceMesh};
use neurotess_picture::bounds::surface_points;
use neurotess_picture::color::Rgb;
use neurotess_picture::{BoundingSphere, MeshLook};

use neurotess_options::words::MeshBeside;

use crate::error::DrawError;
use crate::host::Host;
use crate::text::count;

/// Meshes that were read.
#[derive(Default)]
pub(crate) struct SceneMeshes {
    meshes: Vec<SceneMesh>,
}

struct SceneMesh {
    look: MeshBeside,
    surface: SurfaceMesh,
    points: Vec<BoundingSphere>,
}

/// The mesh of a file, or of neuroglancer's folders.
fn read(file: &Path) -> Result<SurfaceMesh, String> {
    #[cfg(feature = "precomputed")]
    if let Some(read) = neurotess_precomputed::read_mesh(file) {
        return read.map_err(|e| format!("{}: {e}", file.display()));
    }
    mesh::read(file).map_err(|e| e.in_file(&file.display().to_string()))
}

/// What the colors of a mesh are looked up by.
pub(crate) enum MeshKeys {
    /// One for all of it.
    Whole(u32),
    /// One for each vertex.
    OfVertices(Vec<u32>),
}

impl SceneMeshes {
    /// Reads what the options ask for, but for those that are in memory, by their place among these.
    ///
    /// # Errors
    /// A file is invalid, or holds no faces.
    pub(crate) fn read(
        asked: &[MeshBeside],
        surfaces: Vec<Option<SurfaceMesh>>,
        host: &dyn Host,
    ) -> Result<Self, DrawError> {
        let there = surfaces.into_iter().chain(std::iter::repeat_with(|| None));
        let shown = |(look, there): (&MeshBeside, Option<SurfaceMesh>)| {
            let file = look.file.display();
            let surface = match there {
                Some(surface) => surface,
                None => read(&look.file).map_err(DrawError::Failed)?,
            };
            let faces = surface.faces.triangles.len() + surface.faces.quads.len();
            if faces == 0 {
                return Err(DrawError::Failed(format!(
                    "{file}: has no faces, and points are not drawn: export a surface"
                )));
            }
            host.note(&format!("{file}: {}", count(faces, "face")));
            Ok(SceneMesh {
                points: surface_points(&surface, look.scale),
                look: look.clone(),
                surface,
            })
        };
        let meshes = asked.iter().zip(there).map(shown);
        let meshes = meshes.collect::<Result<_, DrawError>>()?;
        Ok(Self { meshes })
    }

    /// Number of meshes.
    pub(crate) fn len(&self) -> usize {
        self.meshes.len()
    }

    /// Checks that these are numbers of their vertices.
    ///
    /// # Errors
    /// They are not.
    pub(crate) fn check(&self, values: &MeshValues) -> Result<(), DrawError> {
        if values.meshes.len() != self.meshes.len() {
            let (given, meshes) = (values.meshes.len(), self.meshes.len());
            return Err(DrawError::Failed(format!(
                "there are values of {given} meshes for {meshes}"
            )));
        }
        for (mesh, values) in self.meshes.iter().zip(&values.meshes) {
            let (file, vertices) = (mesh.look.file.display(), mesh.surface.vertices.len());
            if let Some(values) = values.as_ref().filter(|v| v.len() != vertices) {
                let given = values.len();
                return Err(DrawError::Failed(format!(
                    "{file}: there are {given} values for {vertices} vertices"
                )));
            }
        }
        Ok(())
    }

    /// Color and name of each that has no numbers.
    pub(crate) fn colors(&self, values: Option<&MeshValues>) -> Vec<(Rgb, String)> {
        let has_none = |i: usize| values.is_none_or(|v| v.meshes[i].is_none());
        let plain = self.meshes.iter().enumerate().filter(|(i, _)| has_none(*i));
        let named = plain.map(|(i, mesh)| {
            let stem = mesh.look.file.file_stem().unwrap_or_default();
            let color = mesh.look.color.map_or(mesh_color(i), |color| color.0);
            (color, stem.to_string_lossy().into_owned())
        });
        named.collect()
    }

    /// Points of those that the camera fits: what one can see through only surrounds what is shown.
    pub(crate) fn fitted(&self) -> impl Iterator<Item = BoundingSphere> {
        let fitted = self.meshes.iter().filter(|mesh| {
            let MeshBeside {
                opacity,
                edges,
                fit,
                ..
            } = mesh.look;
            fit || !(edges || opacity < 1.0)
        });
        fitted.flat_map(|mesh| mesh.points.iter().copied())
    }

    /// Points of all.
    pub(crate) fn points(&self) -> impl Iterator<Item = BoundingSphere> {
        self.meshes
            .iter()
            .flat_map(|mesh| mesh.points.iter().copied())
    }

    /// Each surface with the color keys of its vertices, if it has any, and its look.
    pub(crate) fn with_looks(
        self,
        keys: &[MeshKeys],
    ) -> impl Iterator<Item = (SurfaceMesh, &[u32], MeshLook)> {
        let keyed = self.meshes.into_iter().zip_eq(keys);
        keyed.map(|(SceneMesh { look, surface, .. }, keys)| {
            let (color_key, of_vertices) = match keys {
                MeshKeys::Whole(key) => (*key, &[][..]),
                MeshKeys::OfVertices(keys) => (0, &keys[..]),
            };
            let look = MeshLook {
                color_key,
                opacity: look.opacity as f32,
                edges: look.edges,
                scale: look.scale,
            };
            (surface, of_vertices, look)
        })
    }

    /// As the processor draws them.
    pub(crate) fn for_processor(self, keys: &[MeshKeys]) -> Vec<neurotess_raster::SceneMesh> {
        let looks = self.with_looks(keys);
        looks
            .map(|(surface, keys, look)| neurotess_raster::SceneMesh::new(surface, keys, look))
            .collect()
    }
}
