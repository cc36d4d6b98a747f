//! Meshes of a picture that are no cells.

use itertools::Itertools;
use neurotess::coloring::{MeshValues, mesh_color};
use neurotess::mesh::{self, SurfaceMesh};
use neurotess::picture::bounds::surface_points;
use neurotess::picture::color::Rgb;
use neurotess::picture::{BoundingSphere, MeshLook};
use neurotess::raster;

use crate::io::meshes::named;
use crate::options::meshes::{MeshArg, MeshArgs};
use crate::report::{Reporter, count};

/// Meshes that were read.
#[derive(Default)]
pub(crate) struct SceneMeshes {
    meshes: Vec<SceneMesh>,
}

struct SceneMesh {
    arg: MeshArg,
    surface: SurfaceMesh,
    points: Vec<BoundingSphere>,
}

/// What the colors of a mesh are looked up by.
pub(crate) enum MeshKeys {
    /// One for all of it.
    Whole(u32),
    /// One for each vertex.
    OfVertices(Vec<u32>),
}

impl SceneMeshes {
    /// Reads what the options ask for.
    ///
    /// # Errors
    /// A file is invalid, or holds no faces.
    pub(super) fn read(args: &MeshArgs, reporter: &Reporter) -> anyhow::Result<Self> {
        let read = |arg: &MeshArg| {
            let file = arg.file.display();
            let surface = mesh::read(&arg.file)
                .map_err(|e| anyhow::anyhow!("{}", named(&file.to_string(), &e)))?;
            let faces = surface.faces.triangles.len() + surface.faces.quads.len();
            if faces == 0 {
                anyhow::bail!("{file}: has no faces, and points are not drawn: export a surface");
            }
            reporter.note(&format!("{file}: {}", count(faces, "face")));
            Ok(SceneMesh {
                arg: arg.clone(),
                points: surface_points(&surface, arg.scale),
                surface,
            })
        };
        let meshes = args.mesh.iter().map(read).collect::<anyhow::Result<_>>()?;
        Ok(Self { meshes })
    }

    /// Number of meshes.
    pub(super) fn len(&self) -> usize {
        self.meshes.len()
    }

    /// Checks that these are numbers of their vertices.
    ///
    /// # Errors
    /// They are not.
    pub(super) fn check(&self, values: &MeshValues) -> anyhow::Result<()> {
        if values.meshes.len() != self.meshes.len() {
            let (given, meshes) = (values.meshes.len(), self.meshes.len());
            anyhow::bail!("there are values of {given} meshes for {meshes}");
        }
        for (mesh, values) in self.meshes.iter().zip(&values.meshes) {
            let (file, vertices) = (mesh.arg.file.display(), mesh.surface.vertices.len());
            if let Some(values) = values.as_ref().filter(|v| v.len() != vertices) {
                let given = values.len();
                anyhow::bail!("{file}: there are {given} values for {vertices} vertices");
            }
        }
        Ok(())
    }

    /// Color and name of each that has no numbers.
    pub(super) fn colors(&self, values: Option<&MeshValues>) -> Vec<(Rgb, String)> {
        let has_none = |i: usize| values.is_none_or(|v| v.meshes[i].is_none());
        let plain = self.meshes.iter().enumerate().filter(|(i, _)| has_none(*i));
        let named = plain.map(|(i, mesh)| {
            let stem = mesh.arg.file.file_stem().unwrap_or_default();
            let color = mesh.arg.color.unwrap_or(mesh_color(i));
            (color, stem.to_string_lossy().into_owned())
        });
        named.collect()
    }

    /// Points of those that the camera fits: what one can see through only surrounds what is shown.
    pub(super) fn fitted(&self) -> impl Iterator<Item = BoundingSphere> {
        let fitted = self.meshes.iter().filter(|mesh| {
            let MeshArg {
                opacity,
                edges,
                fit,
                ..
            } = mesh.arg;
            fit || !(edges || opacity < 1.0)
        });
        fitted.flat_map(|mesh| mesh.points.iter().copied())
    }

    /// Points of all.
    pub(super) fn points(&self) -> impl Iterator<Item = BoundingSphere> {
        self.meshes
            .iter()
            .flat_map(|mesh| mesh.points.iter().copied())
    }

    /// Each surface with the color keys of its vertices, if it has any, and its look.
    pub(super) fn with_looks(
        self,
        keys: &[MeshKeys],
    ) -> impl Iterator<Item = (SurfaceMesh, &[u32], MeshLook)> {
        let keyed = self.meshes.into_iter().zip_eq(keys);
        keyed.map(|(SceneMesh { arg, surface, .. }, keys)| {
            let (color_key, of_vertices) = match keys {
                MeshKeys::Whole(key) => (*key, &[][..]),
                MeshKeys::OfVertices(keys) => (0, &keys[..]),
            };
            let look = MeshLook {
                color_key,
                opacity: arg.opacity as f32,
                edges: arg.edges,
                scale: arg.scale,
            };
            (surface, of_vertices, look)
        })
    }

    /// As the processor draws them.
    pub(super) fn for_processor(self, keys: &[MeshKeys]) -> Vec<raster::SceneMesh> {
        let looks = self.with_looks(keys);
        looks
            .map(|(surface, keys, look)| raster::SceneMesh::new(surface, keys, look))
            .collect()
    }
}
