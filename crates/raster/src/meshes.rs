//! Meshes that are no cells. Twin of meshes.wgsl.

use std::borrow::Cow;

use glam::DVec3;
use neurotess_mesh::SurfaceMesh;
use neurotess_picture::MeshLook;
use neurotess_picture::meshes::Lit;
use rayon::prelude::*;

use crate::bins::{Bins, Triangle, Vertices};
use crate::fragment::Paint;
use crate::painting::{NO_INSTANCE, Painting, vertex};
use crate::sheet::Sheet;
use crate::triangle::Drawn;

/// Triangles that a task takes.
const TOGETHER: usize = 1 << 14;

/// A surface that is no cell, such as a brain region.
pub struct SceneMesh {
    lit: Lit,
    origin: DVec3,
    /// How it looks.
    pub look: MeshLook,
}

impl SceneMesh {
    /// A mesh with a color key for each vertex; without keys it has the color of its look. Triangles without an area are
    /// left out.
    ///
    /// # Panics
    /// If there are keys, but not one for each vertex.
    pub fn new(mesh: SurfaceMesh, keys: &[u32], look: MeshLook) -> Self {
        Self {
            origin: mesh.origin,
            lit: Lit::new(mesh, keys),
            look,
        }
    }

    /// Number of triangles.
    pub fn triangles(&self) -> usize {
        self.lit.triangles.len()
    }

    /// On the grid; none if nothing of it shows. `number`: its own among all.
    pub(crate) fn drawn<'a>(&'a self, number: u32, painting: &Painting<'a>) -> Option<Drawn<'a>> {
        let Self { lit, look, .. } = self;
        if look.opacity <= 0.0 {
            return None;
        }
        let projection = painting.projection;
        let offset = (self.origin * look.scale - projection.eye).as_vec3();
        let scale = look.scale as f32;
        let has_keys = !lit.keys.is_empty();
        let sheet = Sheet {
            number,
            opacity: look.opacity.clamp(0.0, 1.0),
            edges: look.edges,
            projection: *projection,
        };
        let on_grid = |corner: u32| {
            let [position, normal] = lit.vertices[corner as usize];
            let point = if has_keys { corner } else { 0 };
            vertex(projection, scale * position + offset, normal, point)
        };
        let parts = lit.triangles.par_chunks(TOGETHER).enumerate();
        let pieces = parts.map(|(part, triangles)| {
            let mut vertices = Vertices::default();
            let mut bins = Bins::default();
            for (index, &corners) in triangles.iter().enumerate() {
                let first = vertices.vertices.len() as u32;
                let made = corners.map(on_grid);
                made.into_iter().for_each(|vertex| vertices.push(vertex));
                let triangle = Triangle {
                    corners: [first, first + 1, first + 2],
                    is_front: true,
                    is_half: part * TOGETHER + index >= lit.first_half,
                };
                bins.add((painting.grid, projection), &vertices, triangle, true);
            }
            bins.finished(vertices, painting.grid.len())
        });
        let pieces = pieces.collect();
        let keys: Cow<'a, [u32]> = match has_keys {
            true => Cow::Borrowed(&lit.keys),
            false => Cow::Owned(vec![look.color_key]),
        };
        Some(Drawn {
            pieces,
            paint: Paint {
                colors: Cow::Owned(painting.colors.of_keys(&keys, NO_INSTANCE, 0)),
                keys,
                instance: NO_INSTANCE,
                sheet: Some(sheet),
                filled: None,
                wire: painting.wire,
            },
            perspective: projection.is_perspective(),
        })
    }
}
