//! Somata keep what was traced of them: volume, area, outlines; and what is no soma becomes a neurite.

use std::collections::HashSet;
use std::f64::consts::{PI, TAU};

use glam::{DVec3, Vec3};
use neurotess_generate::{GenerateOptions, Generated, SomaKeep, SomaMethod, generate};
use neurotess_mesh::{PatchKind, Role, SurfaceMesh};
use neurotess_morphology::{Morphology, NeuriteKind, Node};
use neurotess_refine::{LodCriterion, RefineOptions, Refinement};

/// Somata of samples `(x, y, z, r, parent)` with straight neurites from places on them.
fn cell(
    soma: &[([f64; 3], f64, Option<u32>)],
    neurites: &[(DVec3, f64)],
    outlined: bool,
) -> Morphology {
    let mut nodes: Vec<Node> = Vec::new();
    let mut push = |kind, position, radius, parent| {
        let id = nodes.len() as i64 + 1;
        nodes.push(Node {
            id,
            kind,
            position,
            radius,
            parent,
            section: None,
        });
        nodes.len() as u32 - 1
    };
    for &(position, radius, parent) in soma {
        push(
            NeuriteKind::SOMA,
            DVec3::from_array(position),
            radius,
            parent,
        );
    }
    for &(start, radius) in neurites {
        let mut last = 0;
        for step in 0..5 {
            let place = start + start.normalize_or_zero() * (4.0 * f64::from(step));
            last = push(NeuriteKind(3), place, radius, Some(last));
        }
    }
    let built = match outlined {
        true => Morphology::from_outlined_nodes("cell", Vec::new(), &nodes, &[]),
        false => Morphology::from_nodes("cell", Vec::new(), &nodes),
    };
    built.expect("a cell").morphology
}

/// An outline like a drop: its tip at (14, 0).
fn drop() -> Vec<([f64; 3], f64, Option<u32>)> {
    let corner = |i: u32| {
        let angle = TAU * f64::from(i) / 40.0;
        let r = 7.0 + 7.0 * (0.5 + 0.5 * angle.cos()).powi(6);
        let place = [r * angle.cos(), r * angle.sin(), 0.0];
        (place, 0.0, i.checked_sub(1))
    };
    (0..40).map(corner).collect()
}

fn five(start: f64, radius: f64) -> Vec<(DVec3, f64)> {
    [
        DVec3::new(0.0, 1.0, 0.1),
        DVec3::new(1.0, -0.4, 0.3),
        DVec3::new(-1.0, -0.3, 0.4),
        DVec3::new(0.1, -0.5, -1.0),
        DVec3::new(0.2, -0.6, 1.0),
    ]
    .map(|direction| (direction.normalize_or_zero() * start, radius))
    .to_vec()
}

fn meshed(cell: &Morphology, soma_keep: SomaKeep) -> Generated {
    let options = GenerateOptions {
        soma_keep,
        ..GenerateOptions::default()
    };
    let generated = generate(cell, &options).expect("meshed");
    let topology = generated.mesh.topology();
    assert!(topology.closed && topology.euler == 2, "{topology:?}");
    generated
}

/// Volume (µm³) of the refined soma, closed by fans about the centers of its first rings.
fn refined_volume(generated: &Generated) -> f64 {
    let mut mesh = generated.mesh.clone();
    let is_soma = |v: u32| {
        let tracing = mesh.vertices[v as usize].tracing;
        mesh.tracing[tracing as usize].role == Role::Soma
    };
    let keep: Vec<bool> = (mesh.patches.iter())
        .map(|patch| match patch.kind {
            PatchKind::Soma => true,
            PatchKind::Loft => patch.corners.into_iter().any(is_soma),
            PatchKind::Lateral | PatchKind::Cap => false,
        })
        .collect();
    let mut keep = keep.into_iter();
    mesh.patches.retain(|_| keep.next() == Some(true));
    let level = LodCriterion::Homogeneous(8);
    let surface = SurfaceMesh::collect(&Refinement::new(&mesh, level, &RefineOptions::default()));
    let at = |v: u32| surface.vertices[v as usize].position.as_dvec3();
    let triangles = &surface.faces.triangles;
    let edges = triangles
        .iter()
        .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let all: HashSet<[u32; 2]> = edges.clone().collect();
    let of = |a: DVec3, b: DVec3, c: DVec3| a.dot(b.cross(c)) / 6.0;
    let walls: f64 = triangles
        .iter()
        .map(|&[a, b, c]| of(at(a), at(b), at(c)))
        .sum();
    let open = edges.filter(|&[a, b]| !all.contains(&[b, a]));
    let caps = open.map(|[a, b]| {
        let centers = generated.rings.iter().map(|ring| ring.center);
        let nearest = centers.min_by(|c, d| {
            let distance = |center: &DVec3| center.distance_squared(at(a));
            distance(c).total_cmp(&distance(d))
        });
        of(at(b), at(a), nearest.expect("a border is a ring's"))
    });
    walls + caps.sum::<f64>()
}

#[neurotess_testing::test]
fn what_is_told_of_a_soma_is_what_its_refined_surface_holds() {
    let sphere = vec![([0.0; 3], 6.0, None)];
    for soma in [sphere, drop()] {
        for (start, radius) in [(6.5, 0.3), (7.5, 1.8)] {
            let cell = cell(&soma, &five(start, radius), false);
            for keep in [SomaKeep::Volume, SomaKeep::Scale] {
                let generated = meshed(&cell, keep);
                let (told, found) = (generated.somata[0].volume, refined_volume(&generated));
                assert!(
                    (told / found - 1.0).abs() < 3e-3,
                    "{start} {radius} {keep:?}: {told}, {found}"
                );
            }
        }
    }
}

#[neurotess_testing::test]
fn the_volume_or_the_area_is_the_traced_one() {
    let sphere = [([0.0; 3], 6.0, None)];
    for (start, radius) in [(6.5, 0.3), (6.0, 0.9), (7.5, 1.8), (3.0, 1.2)] {
        let cell = cell(&sphere, &five(start, radius), false);
        let generated = meshed(&cell, SomaKeep::Volume);
        let kept = generated.somata[0];
        // What was traced of neurites up to their rings is in it.
        let ring = generated.rings[0].center.length();
        let stub = PI * radius * radius * (ring - f64::max(6.0, start)).max(0.0);
        let traced = 4.0 / 3.0 * PI * 216.0 + 5.0 * stub;
        assert!(
            (kept.traced_volume / traced - 1.0).abs() < 0.01,
            "{start} {radius}: {} of {traced}",
            kept.traced_volume
        );
        assert!(
            (kept.volume / kept.traced_volume - 1.0).abs() < 1e-3,
            "{start} {radius}: {} of {traced}",
            kept.volume
        );
        let kept = meshed(&cell, SomaKeep::Area).somata[0];
        let holes = 5.0 * PI * radius * radius;
        let area = (kept.area + holes) / (4.0 * PI * 36.0);
        assert!((area - 1.0).abs() < 1e-3, "{start} {radius}: {area}");
    }
    // As before, the pull adds what it may.
    let cell = cell(&sphere, &five(7.5, 1.8), false);
    let scaled = meshed(&cell, SomaKeep::Scale).somata[0];
    assert!(scaled.volume > 1.03 * scaled.traced_volume, "{scaled:?}");
}

/// Volume (µm³) of the refined mesh.
fn volume(generated: &Generated, level: u32) -> f64 {
    let level = LodCriterion::Homogeneous(level);
    let options = RefineOptions::default();
    let surface = SurfaceMesh::collect(&Refinement::new(&generated.mesh, level, &options));
    let at = |v: u32| surface.vertices[v as usize].position.as_dvec3();
    let triangles = surface.faces.triangles.iter();
    triangles
        .map(|&[a, b, c]| at(a).dot(at(b).cross(at(c))) / 6.0)
        .sum()
}

/// Fault C3, `m1_traced_hillock.swc`: a ball with an axon that was traced from within it outwards, cone by cone.
#[neurotess_testing::test]
fn a_hillock_that_was_traced_is_the_somas_and_the_ball_keeps_its_own() {
    let axon = [
        [3.0, 6.5],
        [7.0, 5.0],
        [11.0, 3.4],
        [15.0, 1.7],
        [19.0, 0.6],
        [40.0, 0.5],
        [80.0, 0.5],
    ];
    let dendrite = [[-8.5, 1.0], [-60.0, 0.8]];
    let node = |id: usize, kind: i32, [x, radius]: [f64; 2], parent: Option<u32>| Node {
        id: id as i64,
        kind: NeuriteKind(kind),
        position: DVec3::X * x,
        radius,
        parent,
        section: None,
    };
    let mut nodes = vec![node(1, 1, [0.0, 8.0], None)];
    for (kind, points) in [(2, &axon[..]), (3, &dendrite)] {
        for (step, &point) in points.iter().enumerate() {
            let parent = if step == 0 { 0 } else { nodes.len() as u32 - 1 };
            nodes.push(node(nodes.len() + 1, kind, point, Some(parent)));
        }
    }
    let cell = Morphology::from_nodes("cell", Vec::new(), &nodes).expect("a cell");
    let generated = meshed(&cell.morphology, SomaKeep::Volume);
    // The union of the ball and the frusta.
    let volume = volume(&generated, 8);
    assert!((volume / 2645.0 - 1.0).abs() < 0.02, "{volume}");
}

/// Farthest vertex of the soma along a direction.
fn extent(generated: &Generated, direction: Vec3) -> f32 {
    let mesh = &generated.mesh;
    let on_soma = mesh
        .vertices
        .iter()
        .filter(|vertex| mesh.tracing[vertex.tracing as usize].role == Role::Soma);
    on_soma
        .map(|vertex| vertex.position.dot(direction))
        .fold(f32::MIN, f32::max)
}

#[neurotess_testing::test]
fn a_drop_is_a_drop_as_deep_as_it_is_wide() {
    let cell = cell(&drop(), &[], true);
    let generated = meshed(&cell, SomaKeep::Volume);
    let (tip, back) = (extent(&generated, Vec3::X), extent(&generated, -Vec3::X));
    assert!((tip / 14.0 - 1.0).abs() < 0.08, "{tip}");
    assert!((back / 7.0 - 1.0).abs() < 0.03, "{back}");
    let (wide, deep) = (extent(&generated, Vec3::Y), extent(&generated, Vec3::Z));
    assert!((wide / 7.1 - 1.0).abs() < 0.05, "{wide}");
    assert!((deep / wide - 1.0).abs() < 0.1, "{deep} of {wide}");
    // A sphere is made of it where one is asked for.
    let options = GenerateOptions {
        soma: SomaMethod::Sphere,
        ..GenerateOptions::default()
    };
    let ball = generate(&cell, &options).expect("meshed");
    let sides = [Vec3::X, -Vec3::X, Vec3::Y, Vec3::Z]
        .map(|side| extent(&ball, side) - cell.somata[0].center.dot(side));
    assert!(
        sides
            .iter()
            .all(|side| (side / sides[0] - 1.0).abs() < 1e-3),
        "{sides:?}"
    );
}

#[neurotess_testing::test]
fn a_neurite_that_begins_on_the_surface_or_within_draws_it_out() {
    let sphere = [([0.0; 3], 6.0, None)];
    for start in [2.0, 5.9, 6.0, 6.3] {
        let neurite = (DVec3::Y * start, 1.0);
        let generated = meshed(&cell(&sphere, &[neurite], false), SomaKeep::Volume);
        let ring = generated.rings[0];
        let height = ring.center.length() - 6.0;
        assert!((0.9..3.0).contains(&height), "{start}: {height}");
        assert!(extent(&generated, Vec3::Y) > 6.2, "{start}");
    }
}

#[neurotess_testing::test]
fn the_ring_of_a_thin_neurite_leans_towards_it() {
    let sphere = [([0.0; 3], 6.0, None)];
    let mut cell = cell(&sphere, &[(DVec3::Y * 6.2, 0.3)], false);
    for (step, point) in (0_u8..).zip(&mut cell.points).skip(1) {
        point.position = Vec3::new(3.0 * f32::from(step), 6.2 + 2.0 * f32::from(step), 0.0);
    }
    let generated = meshed(&cell, SomaKeep::Volume);
    let ring = generated.rings[0];
    let outwards = ring.center.normalize_or_zero();
    let angle = ring.outwards.angle_between(outwards).to_degrees();
    assert!((20.0..41.0).contains(&angle), "{angle}");
    let lofts = generated.mesh.patches.iter();
    assert_eq!(
        lofts.filter(|patch| patch.kind == PatchKind::Loft).count(),
        4
    );
}

#[neurotess_testing::test]
fn a_soma_traced_around_a_bend_is_a_thick_neurite() {
    let bent = [
        ([0.0, 0.0, 0.0], 3.0, None),
        ([12.0, 0.0, 0.0], 3.0, Some(0)),
        ([12.0, 12.0, 0.0], 3.0, Some(1)),
        ([0.0, 12.0, 0.0], 2.5, Some(2)),
    ];
    let mut cell = cell(&bent, &[(DVec3::new(-5.0, 0.0, 0.0), 0.5)], false);
    cell.sections[0].attachment = neurotess_morphology::Attachment::Soma { soma: 0, sample: 0 };
    let generated = meshed(&cell, SomaKeep::Volume);
    let codes: Vec<&str> = generated
        .warnings
        .iter()
        .map(|warning| warning.code)
        .collect();
    assert!(codes.contains(&"soma_as_neurite"), "{codes:?}");
    assert!(generated.somata.is_empty());
    let patches = generated.mesh.patches.iter();
    assert!(patches.clone().all(|patch| patch.kind != PatchKind::Soma));
    // As it was before, by the other methods.
    let options = GenerateOptions {
        soma: SomaMethod::Sphere,
        ..GenerateOptions::default()
    };
    assert_eq!(generate(&cell, &options).expect("meshed").somata.len(), 1);
}
