//! Corners of patches, and points with derivatives.

use glam::Vec3;
use neurotess_mesh::{CoarseMesh, Role};

/// A point of a curve or surface with its derivative.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Jet {
    pub(crate) position: Vec3,
    pub(crate) derivative: Vec3,
}

/// A corner with all that its edges depend on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Corner {
    pub(crate) position: Vec3,
    pub(crate) normal: Vec3,
    /// Center of its tracing point.
    pub(crate) center: Vec3,
    /// From the center to the corner.
    pub(crate) offset: Vec3,
    /// Unit direction of the offset; of an inset's corner, across the tangent.
    pub(crate) radial: Vec3,
    pub(crate) tangent: Vec3,
    /// Radius of its tracing point.
    pub(crate) radius: f32,
    /// Change of the radius along the path (µm per µm), of an ordinary tracing point or an end.
    pub(crate) taper: f32,
    pub(crate) role: Role,
    /// Of an inset's corner: length of a loft's last leg along the tangent, negative against it.
    pub(crate) collar: f32,
}

impl Corner {
    pub(crate) fn new(mesh: &CoarseMesh, vertex: u32) -> Self {
        let vertex = &mesh.vertices[vertex as usize];
        let tracing = &mesh.tracing[vertex.tracing as usize];
        let offset = vertex.position - tracing.center;
        // An inset follows the trunk's surface, so its corners' offsets lean; its tube must not.
        let radial = match tracing.role {
            Role::Inset => vertex.normal,
            _ => offset.normalize_or(vertex.normal),
        };
        Self {
            position: vertex.position,
            normal: vertex.normal,
            center: tracing.center,
            offset,
            radial,
            tangent: tracing.tangent,
            radius: tracing.radius,
            taper: tracing.taper,
            role: tracing.role,
            collar: tracing.collar,
        }
    }

    /// Whether it is of a circle around a path, across its tangent.
    pub(super) fn on_ring(&self) -> bool {
        !matches!(self.role, Role::Joint | Role::Soma)
    }

    /// The cubics of somata and lofts leave a corner at right angles to this normal. At a neurite's ring it
    /// is the tube's, so that the soma runs smoothly into the neurite.
    pub(super) fn cubic_normal(&self) -> Vec3 {
        if self.role == Role::Soma {
            self.normal
        } else {
            self.radial
        }
    }
}
