//! A surface somewhere else: turned, scaled and moved.

use glam::{DAffine3, DVec3, Mat3};

use crate::{Region, Soundness, Surface, SurfaceVertex, forward_surface};

/// A surface under a rotation, a uniform scale and a translation. Nothing is copied: blocks are moved
/// when they are asked for.
///
/// The translation is the origin's, in `f64`: at 10⁴ µm `f32` resolves 0.001 µm, which a membrane
/// would show.
pub struct Placed<'a> {
    surface: &'a dyn Surface,
    origin: DVec3,
    linear: Mat3,
    turn: Mat3,
    scale: f32,
}

impl<'a> Placed<'a> {
    /// Places a surface. `world_from_surface` must not mirror: faces would look inwards.
    pub fn new(surface: &'a dyn Surface, world_from_surface: DAffine3) -> Self {
        let linear = world_from_surface.matrix3;
        let scale = linear.determinant().cbrt();
        Self {
            surface,
            origin: world_from_surface.transform_point3(surface.origin()),
            linear: linear.as_mat3(),
            turn: (linear * scale.recip()).as_mat3(),
            scale: scale as f32,
        }
    }
}

impl Surface for Placed<'_> {
    forward_surface!(surface: unit attributes vertex_count triangle_count quad_count vertex_blocks face_blocks faces);

    fn origin(&self) -> DVec3 {
        self.origin
    }

    fn regions(&self) -> Vec<Region> {
        let mut regions = self.surface.regions();
        for region in &mut regions {
            let offset = (region.seed - self.surface.origin()).as_vec3();
            region.seed = self.origin + (self.linear * offset).as_dvec3();
        }
        regions
    }

    fn soundness(&self) -> Option<Soundness> {
        let soundness = self.surface.soundness()?;
        Some(Soundness {
            reach: soundness.reach.transformed(self.linear),
            ..soundness
        })
    }

    fn vertices(&self, block: usize, out: &mut Vec<SurfaceVertex>) {
        let first = out.len();
        self.surface.vertices(block, out);
        for vertex in &mut out[first..] {
            vertex.position = self.linear * vertex.position;
            vertex.normal = self.turn * vertex.normal;
            vertex.radius *= self.scale;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Faces;
    use crate::SurfaceMesh;
    use glam::{DQuat, Vec3};

    #[test]
    fn vertices_normals_and_radii_are_placed() {
        let vertex = SurfaceVertex {
            position: Vec3::new(1.0, 0.0, 0.0),
            normal: Vec3::X,
            radius: 0.5,
            ..SurfaceVertex::default()
        };
        let mesh = SurfaceMesh {
            origin: DVec3::new(0.0, 10.0, 0.0),
            vertices: vec![vertex],
            faces: Faces::default(),
        };
        let world_from_surface = DAffine3::from_scale_rotation_translation(
            DVec3::splat(2.0),
            DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2),
            DVec3::new(1e4, 0.0, 0.0),
        );
        let placed = SurfaceMesh::collect(&Placed::new(&mesh, world_from_surface));
        assert!(placed.origin.distance(DVec3::new(1e4 - 20.0, 0.0, 0.0)) < 1e-9);
        let moved = placed.vertices[0];
        assert!(moved.position.distance(Vec3::new(0.0, 2.0, 0.0)) < 1e-6);
        assert!(moved.normal.distance(Vec3::Y) < 1e-6);
        assert_eq!(moved.radius, 1.0);
    }
}
