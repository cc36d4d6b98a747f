//! The coarse mesh as a surface of its own: level 0.

use glam::DVec3;
use neurotess_mesh::{CoarseMesh, Faces, Soundness, Surface, SurfaceVertex, measure_surface};

/// The coarse mesh as a [`Surface`]: its quads as they are, or each cut into two triangles.
pub struct CoarseSurface<'m> {
    mesh: &'m CoarseMesh,
    quads: bool,
}

impl<'m> CoarseSurface<'m> {
    /// Shows a coarse mesh as quads, or as two triangles each.
    pub fn new(mesh: &'m CoarseMesh, quads: bool) -> Self {
        Self { mesh, quads }
    }
}

impl Surface for CoarseSurface<'_> {
    fn origin(&self) -> DVec3 {
        self.mesh.origin
    }

    fn soundness(&self) -> Option<Soundness> {
        Some(Soundness {
            volume: measure_surface(self).volume,
            reach: self.mesh.reach(),
        })
    }

    fn vertex_count(&self) -> usize {
        self.mesh.vertices.len()
    }

    fn triangle_count(&self) -> usize {
        if self.quads {
            0
        } else {
            2 * self.mesh.patches.len()
        }
    }

    fn quad_count(&self) -> usize {
        if self.quads {
            self.mesh.patches.len()
        } else {
            0
        }
    }

    fn vertex_blocks(&self) -> usize {
        1
    }

    fn vertices(&self, _block: usize, out: &mut Vec<SurfaceVertex>) {
        out.extend(self.mesh.vertices.iter().map(|vertex| {
            let tracing = &self.mesh.tracing[vertex.tracing as usize];
            SurfaceVertex {
                position: vertex.position,
                normal: vertex.normal,
                kind: tracing.kind.0,
                point: tracing.sample.0,
                section: tracing.section.0,
                radius: tracing.radius,
            }
        }));
    }

    fn face_blocks(&self) -> usize {
        1
    }

    fn faces(&self, _block: usize, out: &mut Faces) {
        let corners = self.mesh.patches.iter().map(|p| p.corners);
        if self.quads {
            out.quads.extend(corners);
        } else {
            out.triangles
                .extend(corners.flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]));
        }
    }
}
