//! The number by which outputs of other builds are told apart.

use neurotess_mesh::SurfaceMesh;
use neurotess_recipe::{MESHES, MeshOptions, mesh, read};

/// Vertices and volume (µm³) of two samples, as the meshes of this number have them.
const KNOWN: (u32, [(&str, usize, f64); 2]) = (
    5,
    [
        ("granule.swc", 59_098, 251.67),
        ("star.swc", 112_850, 1688.89),
    ],
);

/// Where this fails because meshes have become others on purpose: raise [`MESHES`], and write down what they are now.
/// Otherwise `mesh --resume` would mix them with those of earlier builds.
#[neurotess_testing::test]
fn the_number_is_raised_when_meshes_change() {
    let folder = neurotess_testing::workspace().join("samples");
    let now = KNOWN.1.map(|(name, ..)| {
        let tracing = read(folder.join(name)).expect("a sample");
        let made = mesh(&tracing, &MeshOptions::default()).expect("meshed");
        let surface = made.surface();
        let (volume, _) = surface.volume_and_area();
        let vertices = SurfaceMesh::collect(surface.surface()).vertices.len();
        (name, vertices, (volume * 100.0).round() / 100.0)
    });
    assert_eq!((MESHES, now), KNOWN);
}
