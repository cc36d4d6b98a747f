//! Vertices and faces of single patches are those of the whole surface, to the bit.

use std::collections::HashSet;

use crate::trees::{Twig, grow};
use neurotess_generate::{GenerateOptions, generate};
use neurotess_mesh::{CoarseMesh, Surface, SurfaceMesh, SurfaceVertex};
use neurotess_refine::{
    EdgeRule, Lod, LodCriterion, LodView, PatchBlock, RefineOptions, Refinement,
};

/// A soma with branches and twigs on them: patches of all kinds.
fn mesh() -> CoarseMesh {
    let twigs: Vec<Twig> = (0..20)
        .map(|i| Twig {
            parent: i / 3,
            seed: 7 + 31 * i as u64,
            points: 2 + i % 5,
            step: 1.5 + 0.1 * i as f32,
            wild: 0.6,
            radius: 0.2 + 0.05 * i as f32,
        })
        .collect();
    let options = GenerateOptions::default();
    generate(&grow(&twigs, Some(4.0)), &options)
        .expect("meshed")
        .mesh
}

fn point_levels(mesh: &CoarseMesh) -> Vec<u8> {
    let points = 0..mesh.tracing.len();
    points.map(|i| [1, 2, 3, 5, 2, 8][i * 7 / 3 % 6]).collect()
}

/// Levels of many kinds.
fn lods(point_levels: &[u8]) -> Vec<Lod<'_>> {
    let view = LodView {
        eye: [0.0, 0.0, -30.0].into(),
        forward: [0.0, 0.0, 1.0].into(),
        slope: 0.004,
        flat: 0.0,
        near: 0.1,
    };
    let lengths = EdgeRule::Lengths {
        radii: 0.7,
        aspect: 2.0,
        least: 0.0,
        most: 10.0,
    };
    vec![
        LodCriterion::Homogeneous(1).into(),
        LodCriterion::Homogeneous(4).into(),
        Lod::per_point(point_levels),
        Lod::seen_from(LodCriterion::PixelError(0.25), view),
        Lod::by_edge(lengths),
    ]
}

/// All of a vertex, to the bit.
fn bits(vertex: &SurfaceVertex) -> [u32; 10] {
    let SurfaceVertex {
        position,
        normal,
        kind,
        point,
        section,
        radius,
    } = *vertex;
    let [x, y, z] = position.to_array().map(f32::to_bits);
    let [nx, ny, nz] = normal.to_array().map(f32::to_bits);
    let [kind, point, section] = [kind, point, section].map(i32::cast_unsigned);
    [x, y, z, nx, ny, nz, kind, point, section, radius.to_bits()]
}

/// The vertices of each triangle, by patch.
fn triangles(refinement: &Refinement<'_>, patches: usize) -> Vec<Vec<[[u32; 10]; 3]>> {
    let surface = SurfaceMesh::collect(refinement);
    let vertex = |v: u32| bits(&surface.vertices[v as usize]);
    let mut all = surface.faces.triangles.iter();
    let of_patch = |patch| {
        let count = refinement.patch_face_count(patch);
        let some = all.by_ref().take(count);
        some.map(|triangle| triangle.map(vertex)).collect()
    };
    let by_patch = (0..patches).map(of_patch).collect();
    assert_eq!(all.next(), None);
    by_patch
}

#[neurotess_testing::test]
fn patches_that_are_shown_are_as_in_the_whole() {
    let mesh = mesh();
    let (count, options) = (mesh.patches.len(), RefineOptions::default());
    let levels = point_levels(&mesh);
    let none = Refinement::of_patches(&mesh, LodCriterion::default(), &options, &[]);
    assert_eq!((none.triangle_count(), none.edge_count()), (0, 0));
    for lod in lods(&levels) {
        let whole = Refinement::new(&mesh, lod, &options);
        let of_whole = triangles(&whole, count);
        for every in [1, 2, 3, 7, usize::MAX] {
            let is_shown = |patch: usize| (patch / 3).is_multiple_of(every);
            let shown: Vec<bool> = (0..count).map(is_shown).collect();
            let part = Refinement::of_patches(&mesh, lod, &options, &shown);
            for (patch, triangles) in triangles(&part, count).iter().enumerate() {
                match shown[patch] {
                    true => {
                        assert_eq!(*triangles, of_whole[patch], "{patch}, {lod:?}");
                        assert_eq!(part.patch_levels(patch), whole.patch_levels(patch));
                        assert_eq!(part.patch_grid(patch), whole.patch_grid(patch));
                    }
                    false => assert_eq!((triangles.len(), part.patch_grid(patch)), (0, (0, 0))),
                }
            }
            let surface = SurfaceMesh::collect(&part);
            assert_eq!(surface.vertices.len(), part.vertex_count());
            let sides =
                surface.faces.triangles.iter().flat_map(|&[a, b, c]| {
                    [[a, b], [b, c], [c, a]].map(|[a, b]| [a.min(b), a.max(b)])
                });
            assert_eq!(sides.collect::<HashSet<_>>().len(), part.edge_count());
            // Nothing but the corners of hidden patches is without a face.
            let used: HashSet<u32> = surface.faces.triangles.iter().flatten().copied().collect();
            let unused = (0..surface.vertices.len() as u32).filter(|v| !used.contains(v));
            assert!(
                unused
                    .max()
                    .is_none_or(|v| (v as usize) < mesh.vertices.len())
            );
        }
    }
}

/// Whatever else is evaluated with it.
#[neurotess_testing::test]
fn vertices_are_the_same_one_by_one() {
    let mesh = mesh();
    let (count, options) = (mesh.patches.len(), RefineOptions::default());
    let levels = point_levels(&mesh);
    for lod in lods(&levels) {
        let refinement = Refinement::new(&mesh, lod, &options);
        for (patch, triangles) in triangles(&refinement, count).iter().enumerate() {
            let together: HashSet<_> = triangles.iter().flatten().copied().collect();
            let (nx, ny) = refinement.patch_grid(patch);
            let places = (0..=ny).flat_map(|j| (0..=nx).map(move |i| (i, j)));
            let alone = places.map(|(i, j)| bits(&refinement.grid_vertex(patch, i, j)));
            assert_eq!(alone.collect::<HashSet<_>>(), together, "{patch}, {lod:?}");
        }
    }
}

/// With indices of their own, and with patches hidden.
#[neurotess_testing::test]
fn blocks_of_patches_together_are_the_surface() {
    let mesh = mesh();
    let (count, options) = (mesh.patches.len(), RefineOptions::default());
    let levels = point_levels(&mesh);
    let shown: Vec<bool> = (0..count).map(|patch| patch % 5 != 0).collect();
    for lod in lods(&levels) {
        for refinement in [
            Refinement::new(&mesh, lod, &options),
            Refinement::of_patches(&mesh, lod, &options, &shown),
        ] {
            let surface = SurfaceMesh::collect(&refinement);
            let whole = surface.faces.triangles.iter();
            let whole = whole.map(|t| t.map(|v| bits(&surface.vertices[v as usize])));
            let mut in_blocks = Vec::new();
            let mut block = PatchBlock::default();
            for k in 0..refinement.patch_blocks() {
                refinement.patch_block(k, &mut block);
                let vertex = |v: u32| bits(&block.vertices[v as usize]);
                in_blocks.extend(block.faces.triangles.iter().map(|t| t.map(vertex)));
                // Each is there once, and used.
                let used: HashSet<u32> = block.faces.triangles.iter().flatten().copied().collect();
                assert_eq!(used.len(), block.vertices.len());
            }
            assert!(whole.eq(in_blocks), "{lod:?}");
        }
    }
}
