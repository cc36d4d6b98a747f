//! Are the triangles such as solvers like? Quads are judged as their two halves.

use glam::{DVec3, Vec3};
use rayon::prelude::*;
use serde::Serialize;

use crate::gaps::{Gaps, gaps};
use crate::{Faces, SurfaceMesh};

/// Shapes of triangles, those without an area aside. Serialized under these names.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Quality {
    /// The least angle (degrees) of any triangle; 60 is the best.
    pub min_angle: f64,
    /// Of the smallest angles of all triangles: one in a hundred is below this.
    pub min_angle_p1: f64,
    /// Of the smallest angles of all triangles: half are below this.
    pub min_angle_median: f64,
    /// √3/2 × longest side over the height on it, 1 for equal sides: half are below this.
    pub aspect_median: f64,
    /// One in a hundred is above this.
    pub aspect_p99: f64,
    /// The largest.
    pub aspect_max: f64,
    /// Length of an edge over the radius that its ends have: half are below this. None without radii.
    pub edge_over_radius_median: Option<f64>,
    /// The largest.
    pub edge_over_radius_max: Option<f64>,
    /// Share of the triangles in front of which another one, no neighbor, faces it at less than the mean
    /// length of its own sides.
    pub thin_gaps: f64,
    /// The least of these distances over that length; none if there is none.
    pub least_gap: Option<f64>,
}

/// Judges the shapes of triangles and the gaps between them.
pub fn quality(mesh: &SurfaceMesh) -> Quality {
    let triangles = halves(&mesh.faces);
    let at = |corner: u32| mesh.vertices[corner as usize].position;
    let shapes: Vec<(f64, f64)> = triangles
        .par_iter()
        .filter_map(|face| shape(face.map(at)))
        .collect();
    let mut angles: Vec<f64> = shapes.iter().map(|shape| shape.0).collect();
    let mut aspects: Vec<f64> = shapes.iter().map(|shape| shape.1).collect();
    let mut edges: Vec<f64> = triangles
        .par_iter()
        .flat_map_iter(|&face| edges_over_radius(mesh, face))
        .collect();
    let positions = mesh.positions();
    let of_shapes = || Quality {
        min_angle: quantile(&mut angles, 0.0).unwrap_or_default(),
        min_angle_p1: quantile(&mut angles, 0.01).unwrap_or_default(),
        min_angle_median: quantile(&mut angles, 0.5).unwrap_or_default(),
        aspect_median: quantile(&mut aspects, 0.5).unwrap_or_default(),
        aspect_p99: quantile(&mut aspects, 0.99).unwrap_or_default(),
        aspect_max: quantile(&mut aspects, 1.0).unwrap_or_default(),
        edge_over_radius_median: quantile(&mut edges, 0.5),
        edge_over_radius_max: quantile(&mut edges, 1.0),
        ..Quality::default()
    };
    let (shapes, Gaps { share, least }) = rayon::join(of_shapes, || gaps(&positions, &triangles));
    Quality {
        thin_gaps: share,
        least_gap: least,
        ..shapes
    }
}

/// Triangles, and quads split along the diagonal from their first corner.
fn halves(faces: &Faces) -> Vec<[u32; 3]> {
    let quads = faces.quads.iter();
    let halves = quads.flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
    faces.triangles.iter().copied().chain(halves).collect()
}

/// The smallest angle (degrees) and the aspect of a triangle; none if it has no area.
fn shape(corners: [Vec3; 3]) -> Option<(f64, f64)> {
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    let mut sides = [b - a, c - b, a - c];
    sides.sort_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
    let [_, middle, long] = sides;
    let double_area = (b - a).cross(c - a).length();
    let sound = double_area.is_finite() && double_area > 0.0;
    // The smallest angle is between the two longer sides.
    let angle = double_area.atan2(middle.dot(long).abs()).to_degrees();
    let aspect = 0.75_f64.sqrt() * long.length_squared() / double_area;
    sound.then_some((angle, aspect))
}

/// Lengths of the sides of a triangle over the mean radius of their ends, each by the face that runs up it:
/// on a closed surface each edge once.
fn edges_over_radius(mesh: &SurfaceMesh, face: [u32; 3]) -> impl Iterator<Item = f64> + '_ {
    (0..3).filter_map(move |n| {
        let [a, b] = [face[n], face[(n + 1) % 3]];
        let [from, to] = [a, b].map(|corner| &mesh.vertices[corner as usize]);
        let radius = f32::midpoint(from.radius, to.radius);
        let length = DVec3::from(from.position).distance(to.position.into());
        (a < b && radius > 0.0).then(|| length / f64::from(radius))
    })
}

/// The value below which a share of all lies; none if there is none.
fn quantile(values: &mut [f64], share: f64) -> Option<f64> {
    let last = values.len().checked_sub(1)?;
    let at = (share * last as f64).round() as usize;
    let (_, value, _) = values.select_nth_unstable_by(at, f64::total_cmp);
    Some(*value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SurfaceVertex;

    fn mesh(corners: &[[f32; 3]], triangles: &[[u32; 3]]) -> SurfaceMesh {
        let vertex = |&corner: &[f32; 3]| SurfaceVertex {
            position: corner.into(),
            radius: 0.5,
            ..SurfaceVertex::default()
        };
        SurfaceMesh {
            vertices: corners.iter().map(vertex).collect(),
            faces: Faces {
                triangles: triangles.to_vec(),
                quads: vec![],
            },
            ..SurfaceMesh::default()
        }
    }

    #[test]
    fn equal_sides_are_the_best() {
        let corners = [[0., 0., 0.], [1., 0., 0.], [0.5, 0.75_f32.sqrt(), 0.]];
        let found = quality(&mesh(&corners, &[[0, 1, 2]]));
        assert!((found.min_angle - 60.0).abs() < 1e-4);
        assert!((found.aspect_max - 1.0).abs() < 1e-6);
        // From the first corner to the second, and from there to the third: twice the radius.
        assert!((found.edge_over_radius_median.expect("radii") - 2.0).abs() < 1e-6);
    }

    #[test]
    fn a_needle_has_a_small_angle_and_a_large_aspect() {
        let corners = [
            [0., 0., 0.],
            [100., 0.5, 0.],
            [100., -0.5, 0.],
            [0., 9., 0.],
        ];
        let found = quality(&mesh(&corners, &[[0, 2, 1], [0, 0, 3]]));
        let expected = 2.0 * 0.5_f64.atan2(100.0).to_degrees();
        assert!((found.min_angle - expected).abs() < 1e-5);
        assert_eq!(found.min_angle, found.min_angle_median);
        assert!((found.aspect_max / (0.75_f64.sqrt() * 100.0) - 1.0).abs() < 1e-3);
    }

    #[test]
    fn nothing_has_no_shape() {
        assert_eq!(quality(&SurfaceMesh::default()), Quality::default());
    }
}
