//! Meshes of a picture that are no cells.

use std::sync::Arc;

use neurotess::coloring::mesh_color;
use neurotess::mesh::{self, SurfaceMesh};
use neurotess::render::bounds::surface_points;
use neurotess::render::color::Rgb;
use neurotess::render::{BoundingSphere, Gpu, MeshGeometry, MeshLook, Meshes};

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

    /// Color and name of each.
    pub(super) fn colors(&self) -> Vec<(Rgb, String)> {
        let named = self.meshes.iter().enumerate().map(|(i, mesh)| {
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

    /// Uploads them with these color keys; none if there are none.
    ///
    /// # Errors
    /// They do not fit the device.
    pub(super) fn upload(self, gpu: &Gpu, color_keys: &[u32]) -> anyhow::Result<Option<Meshes>> {
        if self.meshes.is_empty() {
            return Ok(None);
        }
        let mut all = Vec::new();
        for (SceneMesh { arg, surface, .. }, &color_key) in self.meshes.into_iter().zip(color_keys)
        {
            let geometry = MeshGeometry::new(gpu, surface)?;
            let look = MeshLook {
                color_key,
                opacity: arg.opacity as f32,
                edges: arg.edges,
                scale: arg.scale,
            };
            all.push((Arc::new(geometry), look));
        }
        Ok(Some(Meshes::new(gpu, all)))
    }
}
