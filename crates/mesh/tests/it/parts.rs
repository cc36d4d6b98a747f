//! Parts of surfaces.

use std::collections::BTreeMap;

use crate::shapes::{Blocks, neuron};
use glam::DVec3;
use neurotess_mesh::{Faces, Parts, Surface, SurfaceMesh, check, measure_surface, with_walls};

fn of(surface: &dyn Surface) -> BTreeMap<i32, SurfaceMesh> {
    let parts = Parts::find(surface).expect("sound");
    let collected = parts.iter().map(|part| {
        let mesh = SurfaceMesh::collect(&part);
        assert_eq!(mesh.vertices.len(), part.vertex_count());
        assert_eq!(mesh.faces.triangles.len(), part.triangle_count());
        assert_eq!(mesh.faces.quads.len(), part.quad_count());
        (part.kind(), mesh)
    });
    collected.collect()
}

/// Corners of faces by position, in order.
fn places(mesh: &SurfaceMesh) -> Vec<Vec<[u32; 3]>> {
    let at = |&corner: &u32| {
        let position = mesh.vertices[corner as usize].position;
        position.to_array().map(f32::to_bits)
    };
    let Faces { triangles, quads } = &mesh.faces;
    let triangles = triangles.iter().map(|face| face.iter().map(at).collect());
    let quads = quads.iter().map(|face| face.iter().map(at).collect());
    let mut all: Vec<Vec<_>> = triangles.chain(quads).collect();
    all.sort_unstable();
    all
}

#[neurotess_testing::test]
fn parts_are_the_whole_cut_at_borders() {
    let mesh = neuron(DVec3::new(3000.25, 0.0, 0.0));
    for size in [7, 100_000] {
        let parts = of(&Blocks(mesh.clone(), size));
        assert_eq!(parts.keys().copied().collect::<Vec<_>>(), [1, 2, 3, 4]);
        let mut together: Vec<_> = parts.values().flat_map(places).collect();
        together.sort_unstable();
        assert_eq!(together, places(&mesh));
        let area: f64 = parts.values().map(|part| measure_surface(part).area).sum();
        assert!((area / measure_surface(&mesh).area - 1.0).abs() < 1e-9);
        for part in parts.values() {
            let report = check(part);
            assert!(!report.closed && report.oriented && report.components == 1);
            assert_eq!(part.origin, mesh.origin);
        }
    }
}

#[neurotess_testing::test]
fn walls_close_parts() {
    let mut mesh = neuron(DVec3::ZERO);
    for [a, b, c, d] in std::mem::take(&mut mesh.faces.quads) {
        mesh.faces.triangles.extend([[a, b, c], [a, c, d]]);
    }
    let volume = measure_surface(&mesh).volume;
    let walled = with_walls(mesh);
    assert!(walled.left_out.is_empty());
    let parts = of(&walled);
    assert_eq!(parts.len(), 4);
    let mut sum = 0.0;
    for (kind, part) in &parts {
        let report = check(part);
        assert!(
            report.closed && report.oriented && report.volume > 0.0,
            "{kind}"
        );
        sum += report.volume;
    }
    assert!((sum / volume - 1.0).abs() < 1e-6, "{sum} of {volume}");
}
