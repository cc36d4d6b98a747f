//! Which rings can be computed from their points, and how.

use glam::Vec3;
use neurotess_mesh::{CoarseMesh, Role, TracingPoint};

use crate::decode::{
    ImplicitRing, MAX_CREASE, MAX_HEIGHT, ShapedRing, to_collar_or_border, to_crease,
    to_octahedral, to_radius, to_signed16, to_taper, to_turn,
};

/// Greatest distance, in radii, of a computed corner from the mesh's own, apart from the center's
/// error.
const MAX_APART: f32 = 0.0095;
/// Least cosine of the angle between a shaped ring's normal and the mesh's own (2.5°).
const MIN_ALIKE: f32 = 0.999;

/// How a ring is computed from its point.
#[derive(Clone, Copy, Debug)]
pub(crate) enum RingForm {
    /// A circle with corners a quarter turn apart. Only patches of its run and caps name it.
    Implicit(ImplicitRing),
    /// Any patch may name it.
    Shaped(ShapedRing),
}

impl RingForm {
    /// Tracing point, radius, tangent and taper.
    pub(crate) fn circle(&self) -> &ImplicitRing {
        match self {
            Self::Implicit(circle) => circle,
            Self::Shaped(shaped) => &shaped.circle,
        }
    }

    /// Position and normal of corner k around a center.
    pub(crate) fn corner(&self, center: Vec3, k: usize) -> (Vec3, Vec3) {
        match self {
            Self::Implicit(circle) => circle.corner(center, k as u32),
            Self::Shaped(shaped) => shaped.corner(center, k),
        }
    }
}

/// A ring as a circle around its tracing point, if it is one.
pub(crate) fn implicit_ring(mesh: &CoarseMesh, ring: [u32; 4]) -> Option<ImplicitRing> {
    let mut circle = circle(mesh, ring, &[Role::Ordinary, Role::End])?;
    let point = &mesh.tracing[circle.tracing as usize];
    let offset = mesh.vertices[ring[0] as usize].position - point.center;
    circle.turn = to_turn(circle.tangent(), offset.normalize_or(Vec3::X));
    near(mesh, ring, point.radius, |k| {
        circle.corner(point.center, k as u32)
    })
    .then_some(circle)
}

/// A ring around its tracing point whose corners have turns and heights of their own, if they are within
/// range.
pub(crate) fn shaped_ring(mesh: &CoarseMesh, ring: [u32; 4]) -> Option<ShapedRing> {
    let circle = circle(mesh, ring, &[Role::Ordinary, Role::Inset])?;
    let point = &mesh.tracing[circle.tracing as usize];
    let tangent = circle.tangent();
    let offsets = ring.map(|v| mesh.vertices[v as usize].position - point.center);
    let inset = circle.role == Role::Inset;
    let shaped = ShapedRing {
        circle,
        turns: offsets.map(|offset| to_turn(tangent, offset)),
        heights: offsets.map(|o| to_signed16(o.dot(tangent) / (MAX_HEIGHT * point.radius))),
        upper: to_collar_or_border(point),
        crease: if inset { 0 } else { crease(offsets, point) },
    };
    let alike = (0..4).all(|k| {
        let normal = shaped.corner(point.center, k).1;
        normal.dot(mesh.vertices[ring[k] as usize].normal) >= MIN_ALIKE
    });
    let near = near(mesh, ring, point.radius, |k| shaped.corner(point.center, k));
    (alike && near).then_some(shaped)
}

/// The corner of a ring that is farther out than the others, as it is stored; 0 for none.
fn crease(offsets: [Vec3; 4], point: &TracingPoint) -> u32 {
    let reaches = offsets.map(|offset| offset.reject_from(point.tangent).length() / point.radius);
    let corners = reaches.into_iter().enumerate();
    match corners.max_by(|a, b| a.1.total_cmp(&b.1)) {
        Some((corner, reach)) if reach > 1.0 + MAX_APART && reach <= MAX_CREASE => {
            to_crease(corner, reach)
        }
        _ => 0,
    }
}

/// What a ring's four vertices have in common, if they are those of one tracing point.
fn circle(mesh: &CoarseMesh, ring: [u32; 4], roles: &[Role]) -> Option<ImplicitRing> {
    let vertices = [0, 1, 2, 3].map(|k: usize| &mesh.vertices[ring[k] as usize]);
    let tracing = vertices[0].tracing;
    let point = &mesh.tracing[tracing as usize];
    let ours = (0..4).all(|k| ring[k] == ring[0] + k as u32 && vertices[k].tracing == tracing);
    if !ours || !roles.contains(&point.role) {
        return None;
    }
    Some(ImplicitRing {
        tracing,
        radius: to_radius(point.radius)?,
        tangent: to_octahedral(point.tangent, 511.0),
        turn: 0,
        taper: to_taper(point.taper),
        role: point.role,
    })
}

/// Whether all computed corners of a ring are near the mesh's own.
fn near(
    mesh: &CoarseMesh,
    ring: [u32; 4],
    radius: f32,
    corner: impl Fn(usize) -> (Vec3, Vec3),
) -> bool {
    (0..4).all(|k| {
        let own = mesh.vertices[ring[k] as usize].position;
        corner(k).0.distance(own) <= MAX_APART * radius
    })
}
