//! The one place that scales a surface to another unit.

use crate::{Placed, Surface, Unit, forward_surface};

/// A surface in µm with coordinates and radii in another unit. Nothing is copied.
pub struct InUnit<'a> {
    placed: Placed<'a>,
    unit: Unit,
}

impl<'a> InUnit<'a> {
    /// Shows a surface in a unit.
    pub fn new(surface_um: &'a dyn Surface, unit: Unit) -> Self {
        Self {
            placed: Placed::new(surface_um, unit.unit_from_um()),
            unit,
        }
    }
}

impl Surface for InUnit<'_> {
    forward_surface!(
        placed: origin regions soundness attributes vertex_count triangle_count quad_count
        vertex_blocks face_blocks faces vertices
    );

    fn unit(&self) -> Unit {
        self.unit
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, Vec3};

    use super::*;
    use crate::SurfaceMesh;
    use crate::{Faces, SurfaceVertex};

    fn point_um() -> SurfaceMesh {
        let vertex = SurfaceVertex {
            position: Vec3::new(3.0, -7.0, 0.25),
            normal: Vec3::Y,
            radius: 0.5,
            section: 4,
            ..SurfaceVertex::default()
        };
        SurfaceMesh {
            origin: DVec3::new(5000.0, 0.0, -1.0),
            vertices: vec![vertex],
            faces: Faces::default(),
        }
    }

    #[test]
    fn meters_scale_coordinates_and_radii_only() {
        let surface = point_um();
        let scaled = InUnit::new(&surface, Unit::Meter);
        assert_eq!(scaled.unit(), Unit::Meter);
        let found = SurfaceMesh::collect(&scaled);
        let [vertex] = found.vertices[..] else {
            panic!("one vertex")
        };
        let at = vertex.position.as_dvec3() + found.origin;
        let expected = DVec3::new(5003.0, -7.0, -0.75) * 1e-6;
        assert!(at.distance(expected) < 1e-12, "{at}");
        assert!((vertex.radius / 0.5e-6 - 1.0).abs() < 1e-6);
        assert!(vertex.normal.distance(Vec3::Y) < 1e-6);
        assert_eq!(vertex.section, 4);
    }

    #[test]
    fn micrometers_change_nothing() {
        let surface = point_um();
        let found = SurfaceMesh::collect(&InUnit::new(&surface, Unit::Micrometer));
        assert_eq!(found, surface);
    }
}
