//! Bounding spheres of a mesh, to find the empty tiles of a picture.
//!
//! The passes over a tile's sub-pixels take as long for an empty tile as for a full one, and nine
//! of ten tiles of a cell drawn 4096 pixels high are empty.

use glam::{DVec3, Vec3};
use neurotess_mesh::{CoarseMesh, Patch, Role, SurfaceMesh, TracingPoint};

use crate::view::frame::Frame;
use crate::view::frustum::BoundingSphere;
use crate::view::frustum::shows;

/// Most patches in a sphere.
const TOGETHER: usize = 8;
/// How far a surface may bulge beyond its corners, as a multiple of their distance from the center.
const BULGE: f32 = 1.5;

/// Bounding spheres that hold the refined surface of a mesh, whatever its levels.
pub fn bounds(mesh: &CoarseMesh) -> Vec<BoundingSphere> {
    let mut spheres = Vec::with_capacity(mesh.patches.len().div_ceil(TOGETHER));
    for patches in mesh.patches.chunks(TOGETHER) {
        let together = sphere(mesh, patches);
        let alone = || patches.iter().map(|patch| sphere(mesh, &[*patch]));
        // Patches that follow one another are mostly neighbors in the tree. One sphere around the end of a
        // branch and the beginning of the next would reach across the cell.
        match together.1 <= alone().map(|(_, radius)| radius).sum() {
            true => spheres.push(together),
            false => spheres.extend(alone()),
        }
    }
    spheres
}

/// Spheres around the tracing points of a mesh that its surface shows, to fit a camera to: tighter than [`bounds`], and
/// nearly all of the surface is within them.
pub fn traced(mesh: &CoarseMesh) -> Vec<BoundingSphere> {
    let mut is_shown = vec![false; mesh.tracing.len()];
    for vertex in &mesh.vertices {
        is_shown[vertex.tracing as usize] = true;
    }
    let points = mesh.tracing.iter().zip(is_shown);
    let shown = points.filter(|(_, is_shown)| *is_shown);
    let sphere = |(point, _): (&TracingPoint, bool)| {
        let center = mesh.origin + point.center.as_dvec3();
        (center, f64::from(point.radius.max(0.0)))
    };
    shown.map(sphere).collect()
}

fn sphere(mesh: &CoarseMesh, patches: &[Patch]) -> BoundingSphere {
    let corners = || patches.iter().flat_map(|patch| patch.corners);
    let positions = || corners().map(|v| mesh.vertices[v as usize].position);
    let low = positions().fold(Vec3::MAX, Vec3::min);
    let high = positions().fold(Vec3::MIN, Vec3::max);
    let center = (low + high) / 2.0;
    // A tube bulges by up to its radius, also at its end. Somata are left out, since their radius
    // is their whole size.
    let radius = corners()
        .map(|v| &mesh.tracing[mesh.vertices[v as usize].tracing as usize])
        .filter(|point| point.role != Role::Soma)
        .map(|point| point.radius)
        .fold(0.0, f32::max);
    let reach = positions().map(|p| p.distance(center)).fold(0.0, f32::max);
    let origin: DVec3 = mesh.origin;
    (
        origin + center.as_dvec3(),
        f64::from(BULGE * reach + radius),
    )
}

/// Most vertices of a surface that a camera is fitted to, beside its farthest ones.
const MAX_POINTS: usize = 20_000;

/// Points of a surface, as spheres of radius 0, that a camera is fitted to: all vertices, or of more than 20,000 some and
/// the farthest in 26 directions. `scale`: micrometers of a unit of its coordinates.
pub fn surface_points(mesh: &SurfaceMesh, scale: f64) -> Vec<BoundingSphere> {
    let step = mesh.vertices.len().div_ceil(MAX_POINTS).max(1);
    let mut kept: Vec<Vec3> = mesh
        .vertices
        .iter()
        .step_by(step)
        .map(|v| v.position)
        .collect();
    if step > 1 {
        // Of the 27 cells of a cube all but the middle one.
        for cell in (0..27).filter(|cell| *cell != 13) {
            let direction = [cell % 3, cell / 3 % 3, cell / 9].map(|k| k as f32 - 1.0);
            let along = |position: &Vec3| position.dot(Vec3::from(direction));
            let positions = mesh.vertices.iter().map(|vertex| vertex.position);
            kept.extend(positions.max_by(|a, b| along(a).total_cmp(&along(b))));
        }
    }
    let point = |position: Vec3| ((mesh.origin + position.as_dvec3()) * scale, 0.0);
    kept.into_iter().map(point).collect()
}

/// Whether any sphere may be in view, with a margin since thin tubes are drawn a pixel wide.
pub fn any_shows(spheres: &[BoundingSphere], frame: &Frame) -> bool {
    let planes = frame.frustum();
    let eye = frame.camera.eye();
    spheres.iter().any(|&(center, radius)| {
        let center = (center - eye).as_vec3();
        // Half a pixel is at most four sub-pixels; twice that, since sub-pixels are larger in the
        // picture's corners.
        let pixels = 8.0 * frame.pixel().at(f64::from(center.length()) + radius);
        shows(&planes, center, (radius + pixels) as f32)
    })
}

/// At most this many spheres that hold all of these. Spheres that follow one another should be
/// close to one another.
pub fn merged(spheres: &[BoundingSphere], most: usize) -> Vec<BoundingSphere> {
    if spheres.len() <= most {
        return spheres.to_vec();
    }
    let around = |spheres: &[BoundingSphere]| {
        let low = spheres
            .iter()
            .map(|&(c, r)| c - r)
            .fold(DVec3::MAX, DVec3::min);
        let high = spheres
            .iter()
            .map(|&(c, r)| c + r)
            .fold(DVec3::MIN, DVec3::max);
        let center = (low + high) / 2.0;
        let reach = spheres.iter().map(|&(c, r)| c.distance(center) + r);
        (center, reach.fold(0.0, f64::max))
    };
    let together = spheres.len().div_ceil(most);
    spheres.chunks(together).map(around).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn merged_spheres_hold_those_that_they_are_of() {
        let at = |i: usize| DVec3::new(i as f64, (0.3 * i as f64).sin() * 20.0, 0.0);
        let spheres: Vec<BoundingSphere> =
            (0..1000).map(|i| (at(i), 0.1 + 0.01 * i as f64)).collect();
        let few = merged(&spheres, 30);
        assert!(few.len() <= 30);
        let held =
            |&(c, r): &BoundingSphere| few.iter().any(|&(m, s)| c.distance(m) + r <= s + 1e-9);
        assert!(spheres.iter().all(held));
        assert_eq!(merged(&spheres, 1000), spheres);
    }
}
