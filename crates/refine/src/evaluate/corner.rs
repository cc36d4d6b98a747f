//! Corners of patches, and points with derivatives: four at once.

use neurotess_mesh::{CoarseMesh, Role};

use super::four::{F32x4, Mask, Vec3x4};
use crate::fours::four;

/// Points of four curves or surfaces with their derivatives.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Jets {
    pub(crate) position: Vec3x4,
    pub(crate) derivative: Vec3x4,
}

/// A corner with all that its edges depend on, of each of four edges or patches.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Corners {
    pub(crate) position: Vec3x4,
    pub(crate) normal: Vec3x4,
    /// Centers of their tracing points.
    pub(crate) center: Vec3x4,
    /// From the center to the corner.
    pub(crate) offset: Vec3x4,
    /// Unit direction of the offset; of an inset's corner, across the tangent.
    pub(crate) radial: Vec3x4,
    pub(crate) tangent: Vec3x4,
    /// Radii of their tracing points.
    pub(crate) radius: F32x4,
    /// Change of the radius along the path (µm per µm), of an ordinary tracing point or an end.
    pub(crate) taper: F32x4,
    pub(crate) role: [Role; 4],
    /// Of an inset's corner: length of a loft's last leg along the tangent, negative against it.
    pub(crate) collar: F32x4,
}

impl Corners {
    #[inline(always)]
    pub(crate) fn new(mesh: &CoarseMesh, vertices: [u32; 4]) -> Self {
        let vertices = four(|k| &mesh.vertices[vertices[k] as usize]);
        let points = four(|k| &mesh.tracing[vertices[k].tracing as usize]);
        let position = Vec3x4::new(four(|k| vertices[k].position));
        let normal = Vec3x4::new(four(|k| vertices[k].normal));
        let center = Vec3x4::new(four(|k| points[k].center));
        let offset = position - center;
        let role = four(|k| points[k].role);
        // An inset follows the trunk's surface, so its corners' offsets lean; its tube must not.
        let radial = match has_any(role, Role::Inset) {
            false => offset.normalize_or(normal),
            true => {
                let is_inset = mask(role, |role| role == Role::Inset);
                Vec3x4::select(is_inset, normal, offset.normalize_or(normal))
            }
        };
        Self {
            position,
            normal,
            center,
            offset,
            radial,
            tangent: Vec3x4::new(four(|k| points[k].tangent)),
            radius: four(|k| points[k].radius).into(),
            taper: four(|k| points[k].taper).into(),
            role,
            collar: four(|k| points[k].collar).into(),
        }
    }

    /// Those where edges start and end. Written out, since a closure would not be inlined, and most edges need little of
    /// corners.
    #[inline(always)]
    pub(crate) fn of_edges(mesh: &CoarseMesh, edges: [[u32; 2]; 4]) -> [Self; 2] {
        let [a, b, c, d] = edges;
        [
            Self::new(mesh, [a[0], b[0], c[0], d[0]]),
            Self::new(mesh, [a[1], b[1], c[1], d[1]]),
        ]
    }

    /// Those of patches, by corner.
    #[inline(always)]
    pub(crate) fn of_patches(mesh: &CoarseMesh, patches: [[u32; 4]; 4]) -> [Self; 4] {
        let [a, b, c, d] = patches;
        [
            Self::new(mesh, [a[0], b[0], c[0], d[0]]),
            Self::new(mesh, [a[1], b[1], c[1], d[1]]),
            Self::new(mesh, [a[2], b[2], c[2], d[2]]),
            Self::new(mesh, [a[3], b[3], c[3], d[3]]),
        ]
    }

    /// Which are of a circle around a path, across its tangent.
    pub(super) fn on_ring(&self) -> Mask {
        mask(self.role, |role| !matches!(role, Role::Joint | Role::Soma))
    }

    pub(super) fn has_role(&self, role: Role) -> Mask {
        mask(self.role, |of| of == role)
    }

    /// The cubics of somata and lofts leave a corner at right angles to this normal. At a neurite's ring it
    /// is the tube's, so that the soma runs smoothly into the neurite.
    pub(super) fn cubic_normal(&self) -> Vec3x4 {
        Vec3x4::select(self.has_role(Role::Soma), self.normal, self.radial)
    }
}

fn has_any(roles: [Role; 4], role: Role) -> bool {
    let [a, b, c, d] = roles;
    (a == role) | (b == role) | (c == role) | (d == role)
}

#[inline(always)]
pub(super) fn mask(roles: [Role; 4], is: impl Fn(Role) -> bool) -> Mask {
    let [a, b, c, d] = roles;
    Mask::new(is(a), is(b), is(c), is(d))
}
