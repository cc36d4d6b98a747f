//! The soma as users see it: counts, volume against ν, alternatives, awkward neurites.

use glam::{Vec3, vec3};
use neurotess_generate::{GenerateOptions, Generated, SomaKeep, SomaMethod, SphereKind, generate};
use neurotess_mesh::{PatchKind, Role};
use neurotess_morphology::{
    Attachment, Morphology, NeuriteKind, Point, Section, Soma, SomaKind, SomaSample,
};

/// A soma of radius 5 µm with straight neurites in the given directions.
fn cell(directions: &[Vec3], start: f32, radius: f32) -> Morphology {
    let mut m = Morphology::default();
    let sample = SomaSample {
        id: 1,
        position: Vec3::ZERO,
        radius: 5.0,
        parent: None,
    };
    m.somata.push(Soma {
        kind: SomaKind::Point,
        samples: vec![sample],
        center: Vec3::ZERO,
        radius: 5.0,
    });
    for direction in directions {
        let direction = direction.normalize_or(Vec3::X);
        let first = m.points.len() as u32;
        for step in 0_i64..4 {
            let position = direction * (start + 4.0 * step as f32);
            m.points.push(Point { position, radius });
            m.sample_ids.push(i64::from(first) + step + 2);
        }
        let end = m.points.len() as u32;
        let attachment = Attachment::Soma { soma: 0, sample: 0 };
        m.sections.push(Section {
            kind: NeuriteKind(3),
            attachment,
            first,
            end,
        });
    }
    m
}

fn five() -> [Vec3; 5] {
    [
        vec3(0.0, 1.0, 0.1),
        vec3(1.0, -0.4, 0.3),
        vec3(-1.0, -0.3, 0.4),
        vec3(0.1, -0.5, -1.0),
        vec3(0.2, -0.6, 1.0),
    ]
}

fn codes(generated: &Generated) -> Vec<&str> {
    generated.warnings.iter().map(|w| w.code).collect()
}

#[neurotess_testing::test]
fn paper_soma_has_502_triangles_with_five_neurites() {
    let options = GenerateOptions {
        sphere: SphereKind::Octahedron,
        sphere_level: Some(3),
        ..GenerateOptions::default()
    };
    let mesh = generate(&cell(&five(), 6.5, 0.5), &options)
        .expect("meshed")
        .mesh;
    let quads = mesh
        .patches
        .iter()
        .filter(|p| p.kind == PatchKind::Soma)
        .count();
    assert_eq!(2 * quads, 502);
    let on_soma = mesh.tracing.iter().filter(|t| t.role == Role::Soma).count();
    assert_eq!(on_soma + 4 * 5, 258);
}

/// The paper's figure 3: the higher ν, the less the soma swells.
#[neurotess_testing::test]
fn volume_falls_as_poissons_ratio_rises() {
    for sphere in [SphereKind::Octahedron, SphereKind::Cube] {
        let mut last = f64::INFINITY;
        for poisson in [0.0, 0.1, 0.2, 0.3, 0.4, 0.45, 0.49] {
            let options = GenerateOptions {
                poisson,
                sphere,
                soma_keep: SomaKeep::Scale,
                ..GenerateOptions::default()
            };
            let generated = generate(&cell(&five(), 6.5, 0.5), &options).expect("meshed");
            assert_eq!(codes(&generated), [""; 0]);
            let report = generated.somata[0];
            let share = report.volume / report.traced_volume;
            neurotess_testing::note!("{sphere:?} ν {poisson}: volume {share:.3} of the sphere's");
            assert!(share < last, "{sphere:?} ν {poisson}: {share} after {last}");
            assert!((0.9..1.4).contains(&share));
            last = share;
        }
    }
}

#[neurotess_testing::test]
fn rings_have_the_neurites_radius_and_plane() {
    let mesh = generate(&cell(&five(), 6.5, 0.7), &GenerateOptions::default())
        .expect("meshed")
        .mesh;
    let rings: Vec<_> = mesh
        .tracing
        .iter()
        .filter(|t| t.role == Role::Insertion)
        .collect();
    assert_eq!(rings.len(), 5);
    for (index, tracing) in mesh.tracing.iter().enumerate() {
        if tracing.role != Role::Insertion {
            continue;
        }
        let corners: Vec<_> = mesh
            .vertices
            .iter()
            .filter(|v| v.tracing == index as u32)
            .collect();
        assert_eq!(corners.len(), 4);
        for corner in corners {
            let offset = corner.position - tracing.center;
            assert!((offset.length() - 0.7).abs() < 1e-5);
            assert!(offset.dot(tracing.tangent).abs() < 1e-5);
        }
    }
}

#[neurotess_testing::test]
fn soma_scale_scales_the_soma() {
    let volume = |soma_scale| {
        let options = GenerateOptions {
            soma_scale,
            ..GenerateOptions::default()
        };
        generate(&cell(&five(), 6.5, 0.5), &options)
            .expect("meshed")
            .somata[0]
            .traced_volume
    };
    assert!((volume(0.5) / volume(1.0) - 0.125).abs() < 1e-9);
}

#[neurotess_testing::test]
fn radius_factor_thickens_neurites_alone() {
    let meshed = |radius_factor| {
        let options = GenerateOptions {
            radius_factor,
            ..GenerateOptions::default()
        };
        generate(&cell(&five(), 6.5, 0.5), &options).expect("meshed")
    };
    let radius = |of: &Generated| {
        let points = of.mesh.tracing.iter();
        let ends = points.filter(|t| t.role == Role::End);
        ends.map(|t| t.radius).fold(0.0, f32::max)
    };
    let (traced, thick) = (meshed(1.0), meshed(2.5));
    assert!(thick.mesh.topology().closed);
    assert!((radius(&thick) / radius(&traced) - 2.5).abs() < 1e-6);
    assert_eq!(
        thick.somata[0].traced_volume,
        traced.somata[0].traced_volume
    );
    // Radii that coordinates of 32 bits cannot hold are refused like those of a tracing.
    let huge = GenerateOptions {
        radius_factor: 1e30,
        ..GenerateOptions::default()
    };
    assert!(generate(&cell(&five(), 6.5, 0.5), &huge).is_err());
}

#[neurotess_testing::test]
fn alternatives_differ_as_they_should() {
    let volume = |soma| {
        let options = GenerateOptions {
            soma,
            ..GenerateOptions::default()
        };
        let report = generate(&cell(&five(), 7.5, 0.5), &options)
            .expect("meshed")
            .somata
            .first()
            .copied();
        report.map(|r| r.volume / r.traced_volume)
    };
    let (sphere, profile) = (volume(SomaMethod::Sphere), volume(SomaMethod::Profile));
    assert!(
        sphere.is_some_and(|v| (0.93..1.001).contains(&v)),
        "{sphere:?}"
    );
    assert!(profile > sphere, "{profile:?} {sphere:?}");
    assert_eq!(volume(SomaMethod::None), None);
}

#[neurotess_testing::test]
fn crowded_and_thick_neurites_fold_nothing() {
    let crowd: Vec<Vec3> = (0..24)
        .map(|i| vec3((i % 5) as f32 * 0.1, 1.0, (i / 5) as f32 * 0.1))
        .collect();
    for radius in [0.3, 1.0, 4.0] {
        let generated =
            generate(&cell(&crowd, 6.0, radius), &GenerateOptions::default()).expect("meshed");
        let codes = codes(&generated);
        assert!(
            !codes.contains(&"soma_folded"),
            "radius {radius}: {codes:?}"
        );
        assert!(
            !codes.contains(&"no_insertion_quad"),
            "radius {radius}: {codes:?}"
        );
    }
}

/// Beside a thick dendrite the soma is pulled out: the ring of a thin neurite stands over that, not in a pit.
#[neurotess_testing::test]
fn a_thin_neurite_stands_over_what_its_neighbor_pulls_out() {
    let (thick, thin) = (vec3(0.0, 1.0, 0.0), vec3(0.0, 0.89, 0.45));
    let mut m = cell(&[thick, thin], 12.0, 0.3);
    for point in &mut m.points[..4] {
        point.radius = 1.6;
    }
    let mesh = generate(&m, &GenerateOptions::default())
        .expect("meshed")
        .mesh;
    let is_ring = |v: u32| {
        let tracing = mesh.vertices[v as usize].tracing;
        mesh.tracing[tracing as usize].role == Role::Inset
    };
    let lofts = mesh.patches.iter().filter(|p| p.kind == PatchKind::Loft);
    let corners: Vec<u32> = lofts.flat_map(|p| p.corners).collect();
    let (ring, quad): (Vec<u32>, Vec<u32>) = corners.into_iter().partition(|&v| is_ring(v));
    assert_eq!([ring.len(), quad.len()], [8, 8]);
    let heights = |vertices: &[u32]| -> Vec<f32> {
        let positions = vertices.iter().map(|&v| mesh.vertices[v as usize].position);
        positions.map(Vec3::length).collect()
    };
    let mean = heights(&quad).iter().sum::<f32>() / 8.0;
    assert!(mean > 5.3, "pulled out to {mean}");
    for height in heights(&ring) {
        assert!(
            (0.1..0.6).contains(&(height - mean)),
            "{height} over {mean}"
        );
    }
}

#[neurotess_testing::test]
fn far_first_points_are_bridged_and_inner_ones_left_out() {
    let far = generate(&cell(&five(), 40.0, 0.5), &GenerateOptions::default()).expect("meshed");
    assert!(codes(&far).contains(&"far_from_soma"));
    let inside = generate(&cell(&five(), 1.0, 0.5), &GenerateOptions::default()).expect("meshed");
    let warning = inside
        .warnings
        .iter()
        .find(|w| w.code == "inside_soma")
        .expect("a warning");
    assert_eq!((warning.count, warning.sample), (10, Some(2)));
}

#[neurotess_testing::test]
fn empty_morphology_gives_an_empty_mesh() {
    let generated = generate(&Morphology::default(), &GenerateOptions::default()).expect("meshed");
    assert!(generated.mesh.patches.is_empty());
}
