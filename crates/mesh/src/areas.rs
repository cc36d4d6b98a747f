//! How much of a surface is of which section, or of whatever its triangles are sorted by.

use std::collections::BTreeMap;

use rayon::prelude::*;

use crate::write::corners::{VertexBlocks, triangles};
use crate::write::{WriteError, faces_of, groups};
use crate::{FaceLabel, Surface};

/// Area of each section's triangles, in the square of the surface's unit, by the section of their label: 0 is the
/// soma, walls are negative.
///
/// # Errors
/// As [`write()`](crate::write()).
pub fn section_areas(surface: &dyn Surface) -> Result<BTreeMap<i32, f64>, WriteError> {
    areas_by(surface, |label, _| label.section)
}

/// Area of the triangles that have the same key, in the square of the surface's unit. A key is made of a triangle's
/// label and its center in the tracing's own coordinates. Holds a few blocks of the surface.
///
/// # Errors
/// As [`write()`](crate::write()).
pub fn areas_by<K: Ord + Send>(
    surface: &dyn Surface,
    key: impl Fn(FaceLabel, glam::DVec3) -> K + Sync,
) -> Result<BTreeMap<K, f64>, WriteError> {
    let blocks = VertexBlocks::find(surface)?;
    let origin = surface.origin();
    let of_group = |group: std::ops::Range<usize>| {
        let faces = faces_of(surface, group);
        let corners = blocks.corners(&faces);
        let mut areas = BTreeMap::<K, f64>::new();
        for triangle in triangles(&faces) {
            let [a, b, c] = triangle.map(|corner| corners.vertex(corner).position.as_dvec3());
            let key = key(corners.label(triangle), (a + b + c) / 3.0 + origin);
            *areas.entry(key).or_default() += 0.5 * (b - a).cross(c - a).length();
        }
        areas
    };
    let count = surface.triangle_count() + surface.quad_count();
    let groups = groups(surface.face_blocks(), count);
    let areas: Vec<_> = groups.into_par_iter().map(of_group).collect();
    // In the order of the groups: equal surfaces give equal sums, whatever the number of threads.
    let mut sums = BTreeMap::new();
    for (key, area) in areas.into_iter().flatten() {
        *sums.entry(key).or_default() += area;
    }
    Ok(sums)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Faces, SurfaceMesh, SurfaceVertex};

    #[test]
    fn triangles_count_for_the_section_that_they_show() {
        let vertex = |x: f32, y: f32, section| SurfaceVertex {
            position: [x, y, 0.0].into(),
            section,
            ..SurfaceVertex::default()
        };
        let mesh = SurfaceMesh {
            vertices: vec![
                vertex(0., 0., 1),
                vertex(3., 0., 1),
                vertex(3., 2., 1),
                vertex(0., 2., 2),
                vertex(6., 0., 0),
            ],
            faces: Faces {
                triangles: vec![[1, 4, 2]],
                quads: vec![[0, 1, 2, 3]],
            },
            ..SurfaceMesh::default()
        };
        let areas = section_areas(&mesh).expect("finite");
        assert_eq!(areas, BTreeMap::from([(0, 3.0), (1, 3.0), (2, 3.0)]));
        let sides = areas_by(&mesh, |_, center| center.x > 2.5).expect("finite");
        assert_eq!(sides, BTreeMap::from([(false, 6.0), (true, 3.0)]));
    }
}
