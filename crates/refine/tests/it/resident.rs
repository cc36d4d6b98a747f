//! The resident form holds every patch once, rounded by less than a hundredth of the radius,
//! closed, in few bytes.

use crate::judge::assert_closed;
use crate::trees::{Twig, grow};
use glam::Vec3;
use neurotess_generate::{GenerateOptions, generate};
use neurotess_mesh::{CoarseMesh, PatchKind, Role, SurfaceMesh, TracingPoint, Vertex};
use neurotess_refine::{
    LodCriterion, MeshPart, PATCHES_OF_SPHERE, RefineOptions, Refinement, dequantized, pack,
    sphere_around,
};
use proptest::prelude::*;

fn tree(twigs: u64, points: usize, radius: f32) -> CoarseMesh {
    let twigs: Vec<Twig> = (0..twigs)
        .map(|i| Twig {
            parent: (i / 2) as usize,
            seed: i * 77 + 5,
            points,
            step: 4.0,
            wild: 0.3,
            radius,
        })
        .collect();
    generate(&grow(&twigs, Some(6.0)), &GenerateOptions::default())
        .expect("meshed")
        .mesh
}

fn assert_complete(mesh: &CoarseMesh, parts: &[MeshPart]) {
    let mut found = vec![0; mesh.patches.len()];
    for part in parts {
        assert_eq!(
            part.spheres.len(),
            part.patches.len().div_ceil(PATCHES_OF_SPHERE)
        );
        for &patch in part.patches.iter().filter(|&&patch| patch != u32::MAX) {
            found[patch as usize] += 1;
        }
    }
    assert!(found.iter().all(|&times| times == 1), "{found:?}");
}

/// Largest move of a vertex or center, in radii of its tracing point.
fn largest_move(mesh: &CoarseMesh, rounded: &CoarseMesh) -> f32 {
    let vertices = mesh.vertices.iter().zip(&rounded.vertices).map(|(a, b)| {
        let point = &mesh.tracing[a.tracing as usize];
        a.position.distance(b.position) / point.radius
    });
    let centers = mesh
        .tracing
        .iter()
        .zip(&rounded.tracing)
        .map(|(a, b)| (a.center.distance(b.center) + (a.radius - b.radius).abs()) / a.radius);
    vertices.chain(centers).fold(0.0, f32::max)
}

/// Color keys of the points of each part.
fn color_keys_of(parts: &[MeshPart]) -> Vec<&[u32]> {
    let keys = parts
        .iter()
        .map(|p| &p.packed[p.layout.color_keys as usize..]);
    keys.collect()
}

#[neurotess_testing::test]
fn numbers_keep_all_their_bits_and_shares_of_a_scale_the_highest() {
    let mesh = tree(300, 20, 0.5);
    let points = mesh.tracing.len() as u32;
    assert!(points > 4 * 1024, "{points}");
    let numbers: Vec<u32> = (0..points).collect();
    let parts = pack(&mesh, &numbers, &[], 1 << 20);
    assert_complete(&mesh, &parts);
    let keys = color_keys_of(&parts);
    assert!(keys.iter().all(|list| list.len() <= 1024));
    let odd = keys.concat().iter().filter(|&key| key % 2 == 1).count();
    // Of the others rings are explicit: they have a key to themselves.
    assert!(odd as u32 > points * 2 / 5, "{odd} of {points}");
    let shares: Vec<u32> = numbers.iter().map(|n| n << 16).collect();
    let parts = pack(&mesh, &shares, &[], 1 << 20);
    let keys = color_keys_of(&parts);
    assert_eq!(keys.len(), 1, "parts");
    assert!((512..=1024).contains(&keys[0].len()), "{}", keys[0].len());
}

#[neurotess_testing::test]
fn resident_form_is_within_a_hundredth_of_the_radius() {
    let mut worst: f32 = 0.0;
    for radius in [0.05, 0.3, 2.0] {
        let mesh = tree(40, 12, radius);
        let parts = pack(&mesh, &[], &[], usize::MAX);
        assert_complete(&mesh, &parts);
        worst = worst.max(largest_move(&mesh, &dequantized(&mesh, &parts)));
    }
    neurotess_testing::note!("largest move: {worst} radii");
    assert!(worst < 0.01, "{worst}");
    assert!(worst > 1e-4, "{worst}: nothing was rounded");
}

#[neurotess_testing::test]
fn parts_are_closed_together() {
    let mesh = tree(30, 6, 0.8);
    let lengths = [512, 1200, usize::MAX].map(|most| {
        let parts = pack(&mesh, &[], &[], most);
        assert_complete(&mesh, &parts);
        let rounded = dequantized(&mesh, &parts);
        assert!(largest_move(&mesh, &rounded) < 0.01);
        let refined = Refinement::new(
            &rounded,
            LodCriterion::Homogeneous(3),
            &RefineOptions::default(),
        );
        assert_closed(&SurfaceMesh::collect(&refined), "rounded");
        parts.len()
    });
    assert!(
        lengths[0] > lengths[1] && lengths[1] > lengths[2],
        "{lengths:?}"
    );
    assert_eq!(lengths[2], 1);
}

#[neurotess_testing::test]
fn a_vertex_that_parts_share_is_in_one_place() {
    let mesh = tree(30, 6, 0.8);
    let parts = pack(&mesh, &[], &[], 512);
    // As each part alone has its vertices.
    let mut places: Vec<Option<(Vec3, Vec3)>> = vec![None; mesh.vertices.len()];
    let mut shared = 0;
    for part in &parts {
        let rounded = dequantized(&mesh, std::slice::from_ref(part));
        let patches = part.patches.iter().filter(|&&patch| patch != u32::MAX);
        let corners = patches.flat_map(|&patch| mesh.patches[patch as usize].corners);
        let corners: std::collections::BTreeSet<u32> = corners.collect();
        for v in corners {
            let vertex = &rounded.vertices[v as usize];
            let place = (vertex.position, vertex.normal);
            let known = places[v as usize].replace(place);
            shared += usize::from(known.is_some());
            assert_eq!(known.unwrap_or(place), place, "vertex {v}");
        }
    }
    assert!(shared > 10, "{shared}");
}

#[neurotess_testing::test]
fn spheres_hold_their_patches_at_any_level() {
    for (radius, level) in [(0.4, 2), (1.5, 9), (0.1, 5)] {
        let mesh = tree(30, 5, radius);
        let parts = pack(&mesh, &[], &[], usize::MAX);
        let rounded = dequantized(&mesh, &parts);
        let refined = Refinement::new(
            &rounded,
            LodCriterion::Homogeneous(level),
            &RefineOptions::default(),
        );
        for part in &parts {
            let (center, whole) = sphere_around(part.spheres.iter().copied());
            for (patches, &(middle, reach)) in
                part.patches.chunks(PATCHES_OF_SPHERE).zip(&part.spheres)
            {
                assert!(middle.distance(center) + reach <= whole * 1.000_1);
                for &patch in patches.iter().filter(|&&patch| patch != u32::MAX) {
                    let (own, radius) =
                        neurotess_refine::patch_sphere(&rounded, &rounded.patches[patch as usize]);
                    let (nx, ny) = refined.patch_grid(patch as usize);
                    for (i, j) in (0..=nx).flat_map(|i| (0..=ny).map(move |j| (i, j))) {
                        let p = refined.grid_vertex(patch as usize, i, j).position;
                        assert!(p.distance(middle) <= reach, "outside the sphere of many");
                        assert!(p.distance(own) <= radius, "outside its own sphere");
                    }
                }
            }
        }
    }
}

#[neurotess_testing::test]
fn a_cell_of_two_thousand_points_takes_24_bytes_a_point() {
    let mesh = tree(80, 28, 0.5);
    let points = mesh.tracing.iter().filter(|t| t.role != Role::Soma).count();
    let parts = pack(&mesh, &[1, 2, 3], &[], usize::MAX);
    let bytes: usize = parts.iter().map(|part| 4 * part.packed.len()).sum();
    let each = bytes as f64 / points as f64;
    neurotess_testing::note!(
        "{points} points, {each:.2} bytes each: {:?}",
        parts[0].bytes()
    );
    assert!((2000..2600).contains(&points), "{points}");
    assert!(each <= 24.0, "{each}");
}

#[neurotess_testing::test]
fn a_mesh_of_any_patches_is_packed() {
    // Two lateral patches that are no tube, one soma patch, a cap: all explicit.
    let mut mesh = CoarseMesh::default();
    for i in 0..12_u8 {
        let at = f32::from(i);
        mesh.tracing.push(TracingPoint {
            center: Vec3::new(at, 0.0, 0.0),
            radius: 1.0,
            ..TracingPoint::default()
        });
        mesh.vertices.push(Vertex {
            position: Vec3::new(at, at.sin(), at.cos()),
            normal: Vec3::X,
            tracing: u32::from(i),
        });
    }
    let kinds = [
        PatchKind::Lateral,
        PatchKind::Lateral,
        PatchKind::Soma,
        PatchKind::Cap,
    ];
    for (i, kind) in (0..).zip(kinds) {
        let corners = [i, i + 5, i + 8, i + 2];
        mesh.patches.push(neurotess_mesh::Patch { corners, kind });
    }
    let parts = pack(&mesh, &[], &[], usize::MAX);
    assert_complete(&mesh, &parts);
    assert!(largest_move(&mesh, &dequantized(&mesh, &parts)) < 0.01);
    assert!(pack(&CoarseMesh::default(), &[], &[], 1).is_empty());
}

proptest! {
    #![proptest_config(ProptestConfig { cases: neurotess_testing::cases(24, 48), ..ProptestConfig::default() })]

    #[neurotess_testing::test]
    fn random_trees_are_packed_completely(
        seeds in prop::collection::vec((0..9_usize, any::<u64>(), 1..9_usize), 1..12),
        step in 0.01_f32..9.0,
        wild in 0.0_f32..3.0,
        radius in 0.02_f32..3.0,
        soma in prop::option::of(0.2_f32..12.0),
    ) {
        let twigs: Vec<Twig> = seeds
            .into_iter()
            .map(|(parent, seed, points)| Twig { parent, seed, points, step, wild, radius })
            .collect();
        let mesh = generate(&grow(&twigs, soma), &GenerateOptions::default()).expect("meshed").mesh;
        let parts = pack(&mesh, &[], &[], 4096);
        assert_complete(&mesh, &parts);
        let apart = largest_move(&mesh, &dequantized(&mesh, &parts));
        prop_assert!(apart < 0.01, "{}", apart);
    }
}
