//! Neurites that fork within their soma, or just outside it.

use crate::branches::add;
use glam::{Vec3, vec3};
use neurotess_generate::{GenerateOptions, Generated, SomaMethod, generate};
use neurotess_mesh::{SurfaceMesh, self_intersections, topology};
use neurotess_morphology::{Attachment, Morphology, SectionId, Soma, SomaKind, SomaSample};
use neurotess_refine::{LodCriterion, RefineOptions, Refinement};

/// Radius (µm) of the soma.
const SOMA: f32 = 5.0;

/// A neurite that leaves a soma upwards and forks so high over it (µm), into two that are so far apart (radians).
fn forked(height: f32, apart: f32, radius: f32) -> Morphology {
    let mut m = Morphology::default();
    m.somata.push(Soma {
        kind: SomaKind::Point,
        samples: vec![SomaSample {
            id: 0,
            position: Vec3::ZERO,
            radius: SOMA,
            parent: None,
        }],
        center: Vec3::ZERO,
        radius: SOMA,
    });
    let on_soma = Attachment::Soma { soma: 0, sample: 0 };
    let fork = vec3(0.0, SOMA + height, 0.0);
    add(&mut m, on_soma, [(fork, radius)]);
    for side in [-0.5, 0.5] {
        let (sin, cos) = (side * apart).sin_cos();
        let way = vec3(sin, cos, 0.1);
        let points = (1..6).map(|i| (fork + 3.0 * radius * i as f32 * way, 0.8 * radius));
        add(&mut m, Attachment::Section(SectionId(0)), points);
    }
    m
}

fn made(morphology: &Morphology) -> Generated {
    generate(morphology, &GenerateOptions::default()).expect("meshed")
}

/// Crossing pairs at level 2 of a surface that is closed.
fn crossings(generated: &Generated) -> usize {
    let level = LodCriterion::Homogeneous(2);
    let refined = Refinement::new(&generated.mesh, level, &RefineOptions::default());
    let surface = SurfaceMesh::collect(&refined);
    let positions: Vec<Vec3> = surface.vertices.iter().map(|v| v.position).collect();
    let topology = topology(&positions, &surface.faces);
    assert!(topology.closed && topology.oriented && topology.vertex_manifold);
    assert_eq!(topology.components, 1);
    self_intersections(&positions, &surface.faces).len()
}

/// Neither ring nor fork has room 1.2 µm over the soma, where the ring of a neurite of 1 µm stands 1.5 µm over it.
#[neurotess_testing::test]
fn branches_that_part_at_the_soma_leave_it_by_themselves() {
    let generated = made(&forked(1.2, 3.0, 1.0));
    assert_eq!(generated.rings.len(), 2);
    assert_eq!(crossings(&generated), 0);
    let told = generated.warnings.iter().find(|w| w.code == "fork_at_soma");
    assert_eq!(told.map(|w| (w.count, w.sample)), Some((1, Some(1))));
}

#[neurotess_testing::test]
fn branches_that_touch_at_the_soma_fork_farther_out() {
    for height in [-2.0, 0.0, 1.2] {
        let generated = made(&forked(height, 0.4, 1.0));
        assert_eq!(generated.rings.len(), 1, "fork at {height}");
        let samples = generated.mesh.tracing.iter().map(|t| t.sample.0);
        assert!(samples.into_iter().any(|sample| sample == 1), "its label");
        assert_eq!(crossings(&generated), 0);
    }
}

#[neurotess_testing::test]
fn a_fork_with_room_stays() {
    let generated = made(&forked(2.0, 2.4, 1.0));
    assert_eq!(generated.rings.len(), 1);
    assert!(generated.warnings.is_empty());
}

/// Two forks in one soma, the second on a branch of the first, and one whose branch ends in the soma.
#[neurotess_testing::test]
fn forks_one_after_the_other_in_a_soma_are_parted() {
    let mut m = forked(-3.0, 2.6, 0.6);
    for branch in [1, 2] {
        let section = m.sections[branch];
        let inner = section.first as usize;
        m.points[inner].position = vec3(0.0, 3.0, 0.0);
    }
    let inner = Attachment::Section(SectionId(0));
    add(&mut m, inner, [(vec3(0.5, 2.2, 0.0), 0.6)]);
    let within = Attachment::Section(SectionId(3));
    let ways = [vec3(1.0, 0.1, 1.0), vec3(0.2, -1.0, 1.0)];
    for way in ways {
        let points = (1..6).map(|i| (2.0 * i as f32 * way, 0.6));
        add(&mut m, within, points);
    }
    add(&mut m, within, [(vec3(0.5, 1.0, -1.0), 0.6)]);
    let generated = made(&m);
    assert_eq!(generated.rings.len(), 4);
    assert_eq!(crossings(&generated), 0);
}

#[neurotess_testing::test]
fn forks_near_somata_are_sound_by_every_method() {
    let mut pairs = 0;
    for height in [-2.0, -0.5, 0.3, 0.9, 1.3] {
        for apart in [0.3, 0.9, 1.6, 2.4, 3.0] {
            for radius in [0.3, 0.8, 1.5] {
                let morphology = forked(height * radius, apart, radius);
                pairs += crossings(&made(&morphology));
                for soma in [SomaMethod::Sphere, SomaMethod::Profile] {
                    let options = GenerateOptions {
                        soma,
                        ..GenerateOptions::default()
                    };
                    crossings(&generate(&morphology, &options).expect("meshed"));
                }
            }
        }
    }
    assert_eq!(pairs, 0); // with stems wherever a fork is within a radius of the soma: 276
}
