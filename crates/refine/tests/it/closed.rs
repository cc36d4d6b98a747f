//! Whatever the tree and whatever the levels: closed, oriented, Euler 2, finite.

use crate::judge::assert_closed;
use crate::trees::{Twig, grow};
use neurotess_generate::{GenerateOptions, SomaMethod, generate};
use neurotess_mesh::{PatchKind, Surface, SurfaceMesh};
use neurotess_refine::{Caps, CoarseSurface, Lod, LodCriterion, Path, RefineOptions, Refinement};
use neurotess_testing::cases;
use proptest::prelude::*;

fn twig() -> impl Strategy<Value = Twig> {
    (
        0..12_usize,
        any::<u64>(),
        1..9_usize,
        0.01_f32..6.0,
        0.0_f32..3.0,
        0.05_f32..3.0,
    )
        .prop_map(|(parent, seed, points, step, wild, radius)| Twig {
            parent,
            seed,
            points,
            step,
            wild,
            radius,
        })
}

fn refined<'l>(
    mesh: &neurotess_mesh::CoarseMesh,
    lod: impl Into<Lod<'l>>,
    options: &RefineOptions,
    what: &str,
) -> SurfaceMesh {
    let refinement = Refinement::new(mesh, lod, options);
    let surface = SurfaceMesh::collect(&refinement);
    assert_eq!(surface.vertices.len(), refinement.vertex_count(), "{what}");
    assert_eq!(
        surface.faces.triangles.len(),
        refinement.triangle_count(),
        "{what}"
    );
    assert_eq!(surface.faces.quads.len(), refinement.quad_count(), "{what}");
    assert_closed(&surface, what);
    for vertex in &surface.vertices {
        assert!(vertex.position.is_finite(), "{what}");
        assert!(
            (vertex.normal.length() - 1.0).abs() < 1e-3,
            "{what}: normal {}",
            vertex.normal
        );
    }
    surface
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(24, 96), ..ProptestConfig::default() })]

    #[neurotess_testing::test]
    fn random_trees_at_random_levels_are_closed(
        twigs in prop::collection::vec(twig(), 1..14),
        soma in prop::option::of(0.2_f32..12.0),
        seed in any::<u64>(),
        method in 0..4_usize,
        quads in any::<bool>(),
        linear in any::<bool>(),
        flat in any::<bool>(),
    ) {
        let morphology = grow(&twigs, soma);
        let soma =
            [SomaMethod::Fem, SomaMethod::Sphere, SomaMethod::Profile, SomaMethod::None][method];
        let generated = generate(&morphology, &GenerateOptions { soma, ..Default::default() }).expect("meshed");
        let mesh = &generated.mesh;
        assert_closed(&SurfaceMesh::collect(&CoarseSurface::new(mesh, true)), "coarse");
        let options = RefineOptions {
            path: if linear { Path::Linear } else { Path::Hermite },
            caps: if flat { Caps::Flat } else { Caps::Round },
            quads,
            ..RefineOptions::default()
        };
        refined(mesh, LodCriterion::Homogeneous(1), &options, "level 1");
        refined(mesh, LodCriterion::Homogeneous(3), &options, "level 3");
        // Neighbors as unlike as 1 and 64.
        let mixed: Vec<u8> = (0..mesh.tracing.len() as u64)
            .map(|i| [1, 2, 3, 5, 8, 17][((seed ^ (i * 0x9e37_79b9)) >> 7) as usize % 6])
            .collect();
        refined(mesh, Lod::per_point(&mixed), &options, "mixed levels");
        refined(mesh, LodCriterion::MaxError(0.05), &options, "by error");
    }
}

/// Sections of one or two points that branch wherever they like: forks of any number of branches,
/// many of them crowded, beside one another.
fn bush() -> impl Strategy<Value = Vec<Twig>> {
    let shoot = (
        0..60_usize,
        any::<u64>(),
        1..3_usize,
        0.3_f32..6.0,
        0.05_f32..2.0,
    );
    let shoot = shoot.prop_map(|(parent, seed, points, step, radius)| Twig {
        parent,
        seed,
        points,
        step,
        wild: 0.5,
        radius,
    });
    prop::collection::vec(shoot, 10..60)
}

/// Trees to try: as many as are usual, or as `NEUROTESS_TREES` says.
fn trees(usual: u32) -> u32 {
    let asked = std::env::var("NEUROTESS_TREES").ok();
    asked.and_then(|n| n.parse().ok()).unwrap_or(usual)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: trees(cases(60, 400)), ..ProptestConfig::default() })]

    #[neurotess_testing::test]
    fn bushy_trees_are_closed(twigs in bush(), soma in prop::option::of(0.5_f32..6.0)) {
        let mesh = generate(&grow(&twigs, soma), &GenerateOptions::default()).expect("meshed").mesh;
        assert_closed(&SurfaceMesh::collect(&CoarseSurface::new(&mesh, true)), "coarse");
    }
}

/// As many branches, or stems, as nobody has: one closed piece all the same, with nothing left
/// behind.
#[neurotess_testing::test]
fn a_crowd_of_branches_is_one_closed_piece() {
    for (count, soma) in [
        (7, None),
        (25, None),
        (800, None),
        (60, Some(5.0)),
        (800, Some(5.0)),
    ] {
        let root = usize::from(soma.is_none());
        let twig = |i: usize| Twig {
            // A free tree's branches leave its first section, a soma's stems leave the soma.
            parent: if soma.is_none() { 0 } else { i },
            seed: i as u64,
            points: 3,
            step: 12.0,
            wild: 0.8,
            radius: 0.5,
        };
        let twigs: Vec<Twig> = (0..count + root).map(twig).collect();
        let generated = generate(&grow(&twigs, soma), &GenerateOptions::default()).expect("meshed");
        let surface = SurfaceMesh::collect(&CoarseSurface::new(&generated.mesh, true));
        assert_closed(&surface, "a crowd");
        let euler = surface.vertices.len() as i64 - surface.faces.quads.len() as i64;
        assert_eq!(
            euler, 2,
            "{count} branches, soma {soma:?}: one piece, as quads have half their edges"
        );
        let ends = generated.mesh.patches.iter();
        let ends = ends.filter(|p| p.kind == PatchKind::Cap).count();
        let inside = generated.warnings.iter();
        let inside = inside.filter(|w| ["neurite_inside_soma", "buried_twig"].contains(&w.code));
        let inside: usize = inside.map(|w| w.count).sum();
        assert_eq!(
            ends + inside,
            count + root,
            "{count} branches, soma {soma:?}"
        );
    }
}

#[neurotess_testing::test]
fn levels_1_and_64_side_by_side_are_closed() {
    let twigs: Vec<Twig> = (0..cases(2, 5))
        .map(|i| Twig {
            parent: i / 2,
            seed: i as u64,
            points: 3,
            step: 3.0,
            wild: 0.4,
            radius: 1.0,
        })
        .collect();
    // A soma at level 64 takes ten times as long as all else.
    let soma = cases(None, Some(6.0));
    let mesh = generate(&grow(&twigs, soma), &GenerateOptions::default())
        .expect("meshed")
        .mesh;
    let levels: Vec<u8> = (0..mesh.tracing.len())
        .map(|i| if i % 2 == 0 { 1 } else { 64 })
        .collect();
    refined(
        &mesh,
        Lod::per_point(&levels),
        &RefineOptions::default(),
        "1 and 64",
    );
}

/// A million patches of level 64 have more vertices than 32 bits count.
#[neurotess_testing::test]
fn vertices_are_counted_beyond_32_bits() {
    let twig = Twig {
        parent: 0,
        seed: 1,
        points: 8,
        step: 3.0,
        wild: 0.5,
        radius: 1.0,
    };
    let generated = generate(
        &grow(&vec![twig; 4], Some(5.0)),
        &GenerateOptions::default(),
    );
    let mut mesh = generated.expect("meshed").mesh;
    let count = |mesh: &neurotess_mesh::CoarseMesh| {
        let options = RefineOptions::default();
        Refinement::new(mesh, LodCriterion::Homogeneous(64), &options).vertex_count()
    };
    let (once, patches) = (count(&mesh), mesh.patches.clone());
    let times = 1_500_000 / patches.len();
    mesh.patches = patches.repeat(times);
    // Each patch has 63 × 63 of its own, and shares its edges with the others.
    let expected = once + (times - 1) * patches.len() * 63 * 63;
    assert!(expected > u32::MAX as usize);
    assert_eq!(count(&mesh), expected);
}
