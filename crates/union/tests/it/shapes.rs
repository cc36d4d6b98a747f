//! Closed bodies to merge.

use glam::{Quat, Vec3};
use neurotess_mesh::{Report, SurfaceMesh, SurfaceVertex, check};
use neurotess_union::{Union, UnionOptions, union};

/// A closed tube along a line, its labels those of a section; each ring is a tracing point.
pub(crate) fn tube(line: &[Vec3], radius: f32, sides: u32, section: i32) -> SurfaceMesh {
    let mut mesh = SurfaceMesh::default();
    let mut vertex = |position: Vec3, normal: Vec3, ring: usize| {
        mesh.vertices.push(SurfaceVertex {
            position,
            normal,
            kind: 3,
            point: 1000 * section + ring as i32,
            section,
            radius,
        });
    };
    let last = line.len() - 1;
    let along = |ring: usize| {
        let (before, after) = (line[ring.saturating_sub(1)], line[last.min(ring + 1)]);
        (after - before)
            .try_normalize()
            .expect("points that differ")
    };
    // One frame, turned from ring to ring.
    let mut across = along(0).any_orthonormal_vector();
    for (ring, &center) in line.iter().enumerate() {
        if ring > 0 {
            across = Quat::from_rotation_arc(along(ring - 1), along(ring)) * across;
        }
        for side in 0..sides {
            let angle = std::f32::consts::TAU * side as f32 / sides as f32;
            let normal = Quat::from_axis_angle(along(ring), angle) * across;
            vertex(center + radius * normal, normal, ring);
        }
    }
    vertex(line[0], -along(0), 0);
    vertex(line[last], along(last), last);
    let rings = line.len() as u32;
    let at = |ring: u32, side: u32| ring * sides + side % sides;
    for side in 0..sides {
        for ring in 0..rings - 1 {
            mesh.faces.quads.push([
                at(ring, side),
                at(ring, side + 1),
                at(ring + 1, side + 1),
                at(ring + 1, side),
            ]);
        }
        let (first, end) = (rings * sides, rings * sides + 1);
        let triangles = &mut mesh.faces.triangles;
        triangles.push([first, at(0, side + 1), at(0, side)]);
        triangles.push([end, at(rings - 1, side), at(rings - 1, side + 1)]);
    }
    mesh
}

/// A straight tube of some rings.
pub(crate) fn straight(from: [f32; 3], to: [f32; 3], radius: f32, section: i32) -> SurfaceMesh {
    let (from, to) = (Vec3::from(from), Vec3::from(to));
    let line: Vec<Vec3> = (0..=8).map(|n| from.lerp(to, n as f32 / 8.0)).collect();
    tube(&line, radius, 9, section)
}

/// A box along the axes.
pub(crate) fn brick(low: [f32; 3], high: [f32; 3]) -> SurfaceMesh {
    let mut mesh = SurfaceMesh::default();
    for n in 0..8 {
        let pick = |axis: usize| {
            if n >> axis & 1 == 1 {
                high[axis]
            } else {
                low[axis]
            }
        };
        mesh.vertices.push(SurfaceVertex {
            position: Vec3::new(pick(0), pick(1), pick(2)),
            ..SurfaceVertex::default()
        });
    }
    mesh.faces.quads = vec![
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    mesh
}

/// Bodies as one mesh.
pub(crate) fn together(bodies: &[SurfaceMesh]) -> SurfaceMesh {
    let mut mesh = SurfaceMesh::default();
    for body in bodies {
        let first = mesh.vertices.len() as u32;
        mesh.vertices.extend(&body.vertices);
        let triangles = body.faces.triangles.iter();
        mesh.faces
            .triangles
            .extend(triangles.map(|face| face.map(|corner| first + corner)));
        let quads = body.faces.quads.iter();
        mesh.faces
            .quads
            .extend(quads.map(|face| face.map(|corner| first + corner)));
    }
    mesh
}

/// The same body inside out.
pub(crate) fn inverted(mut mesh: SurfaceMesh) -> SurfaceMesh {
    mesh.faces
        .triangles
        .iter_mut()
        .for_each(|face| face.reverse());
    mesh.faces.quads.iter_mut().for_each(|face| face.reverse());
    mesh
}

/// No tidying and no smoothing: the union itself.
pub(crate) const BARE: UnionOptions = UnionOptions {
    rounds: 8,
    needles: 0.0,
    smoothing: 0.0,
    press: 0.0,
    fill: 0.0,
    rejoin: false,
    least_angle: 0.0,
};

/// A union, of which the least is asserted: it is closed, oriented, manifold and nothing crosses, by the
/// checks of the mesh crate.
pub(crate) fn merged(mesh: &SurfaceMesh, options: &UnionOptions) -> (Union, Report) {
    let merged = union(mesh, options).expect("a union");
    let report = check(&merged.mesh);
    assert_eq!(report.self_intersections, 0, "{report:?}");
    assert_eq!(merged.report.pairs, 0);
    assert!(
        report.closed && report.oriented && report.vertex_manifold,
        "{report:?}"
    );
    assert_eq!(merged.report.components, report.components);
    assert_eq!(merged.report.handles, report.genus);
    (merged, report)
}

pub(crate) fn assert_near(found: f64, expected: f64, share: f64) {
    assert!(
        (found - expected).abs() <= share * expected.abs(),
        "{found}, expected {expected}"
    );
}
