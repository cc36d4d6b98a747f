//! Thick branches without a type that meet are one body; branches that were traced more than once are one.

use std::f64::consts::PI;

use glam::DVec3;
use neurotess_generate::{GenerateOptions, Generated, generate};
use neurotess_mesh::{PatchKind, SurfaceMesh};
use neurotess_morphology::{Morphology, NeuriteKind, Node};
use neurotess_refine::{LodCriterion, RefineOptions, Refinement};

fn meshed(nodes: &[Node]) -> Generated {
    let cell = Morphology::from_nodes("cell", Vec::new(), nodes).expect("a cell");
    let generated = generate(&cell.morphology, &GenerateOptions::default()).expect("meshed");
    let topology = generated.mesh.topology();
    assert!(topology.closed && topology.euler == 2, "{topology:?}");
    generated
}

fn surface(generated: &Generated) -> SurfaceMesh {
    let level = LodCriterion::Homogeneous(4);
    SurfaceMesh::collect(&Refinement::new(
        &generated.mesh,
        level,
        &RefineOptions::default(),
    ))
}

fn volume(surface: &SurfaceMesh) -> f64 {
    let at = |v: u32| surface.vertices[v as usize].position.as_dvec3();
    let triangles = surface.faces.triangles.iter();
    triangles
        .map(|&[a, b, c]| at(a).dot(at(b).cross(at(c))) / 6.0)
        .sum()
}

fn count(generated: &Generated, code: &str) -> usize {
    let found = generated
        .warnings
        .iter()
        .find(|warning| warning.code == code);
    found.map_or(0, |warning| warning.count)
}

/// Branches along four directions, as thick as they are far from the surface of a ball of 6 µm, hung up by the node
/// `root`: `t2_soma_without_type_root_inside.swc`.
fn hub(spacing: f64, root: usize, kind: i32) -> Vec<Node> {
    let mut places = vec![(DVec3::ZERO, 6.0, None)];
    for direction in [DVec3::X, -DVec3::X, DVec3::Y, DVec3::Z] {
        let mut last = 0;
        for step in 1..=(40.0 / spacing) as u32 {
            let way = spacing * f64::from(step);
            places.push((direction * way, f64::max(6.0 - way, 0.4), Some(last)));
            last = places.len() - 1;
        }
    }
    let mut parents: Vec<Option<usize>> = places.iter().map(|place| place.2).collect();
    let (mut here, mut above) = (root, None);
    while let Some(parent) = std::mem::replace(&mut parents[here], above) {
        (above, here) = (Some(here), parent);
    }
    type Sample = (DVec3, f64, Option<usize>);
    let node =
        |(index, (&(position, radius, _), parent)): (usize, (&Sample, &Option<usize>))| Node {
            id: index as i64 + 1,
            kind: NeuriteKind(kind),
            position,
            radius,
            parent: parent.map(|parent| parent as u32),
            section: None,
        };
    places.iter().zip(&parents).enumerate().map(node).collect()
}

/// Fault C2.
#[neurotess_testing::test]
fn a_hub_of_thick_branches_is_one_body_for_any_root_and_spacing() {
    for (spacing, root) in [
        (0.25, 0),
        (0.25, 9),
        (0.25, 160),
        (1.0, 0),
        (1.0, 55),
        (2.0, 3),
    ] {
        let generated = meshed(&hub(spacing, root, 0));
        assert_eq!(count(&generated, "hub"), 1, "{spacing} {root}");
        assert_eq!(generated.somata.len(), 1);
        let surface = surface(&generated);
        let volume = volume(&surface);
        assert!(
            (559.0..617.0).contains(&volume),
            "{spacing} {root}: {volume}"
        );
        assert_eq!(surface.self_intersections().len(), 0, "{spacing} {root}");
        let mut kinds = generated.mesh.tracing.iter().map(|point| point.kind.0);
        assert!(kinds.all(|kind| kind == 0), "types stay those of the file");
    }
}

/// A dendrite's own forks are none, and what has a type says itself where its soma is.
#[neurotess_testing::test]
fn forks_of_neurites_are_no_hubs() {
    let typed = meshed(&hub(1.0, 0, 3));
    assert_eq!((count(&typed, "hub"), typed.somata.len()), (0, 0));
    let node = |id: i64, x: f64, y: f64, radius: f64, parent: Option<u32>| Node {
        id,
        kind: NeuriteKind(0),
        position: DVec3::new(x, y, 0.0),
        radius,
        parent,
        section: None,
    };
    let fork = meshed(&[
        node(1, 0.0, 0.0, 1.0, None),
        node(2, 10.0, 0.0, 1.2, Some(0)),
        node(3, 20.0, 8.0, 0.8, Some(1)),
        node(4, 20.0, -8.0, 0.9, Some(1)),
        node(5, 18.0, 0.0, 0.7, Some(1)),
    ]);
    assert_eq!(count(&fork, "hub"), 0);
    let patches = fork.mesh.patches.iter();
    assert!(patches.clone().all(|patch| patch.kind != PatchKind::Soma));
}

/// Fault C8, `w1_branch_three_times.swc`, and copies that are longer than the first or hang on the soma.
#[neurotess_testing::test]
fn of_branches_in_the_same_place_one_is_meshed() {
    let run = |nodes: &mut Vec<Node>, mut parent: Option<u32>, points: usize| {
        let rows = [
            ([10.0, 0.0, 0.0], 1.0),
            ([20.0, 2.0, 0.0], 0.8),
            ([30.0, 5.0, 1.0], 0.7),
            ([40.0, 9.0, 1.0], 0.7),
        ];
        for (position, radius) in rows.into_iter().take(points) {
            nodes.push(Node {
                id: nodes.len() as i64 + 1,
                kind: NeuriteKind(3),
                position: DVec3::from_array(position),
                radius,
                parent,
                section: None,
            });
            parent = Some(nodes.len() as u32 - 1);
        }
    };
    for kind in [1, 3] {
        let first = Node {
            id: 1,
            kind: NeuriteKind(kind),
            position: DVec3::ZERO,
            radius: if kind == 1 { 6.0 } else { 1.0 },
            parent: None,
            section: None,
        };
        for lengths in [[3, 3, 3], [3, 4, 2], [2, 3, 4]] {
            let mut once = vec![first];
            run(&mut once, Some(0), lengths.into_iter().max().unwrap_or(0));
            let mut thrice = vec![first];
            for length in lengths {
                run(&mut thrice, Some(0), length);
            }
            let [once, thrice] = [once, thrice].map(|nodes| meshed(&nodes));
            assert_eq!(count(&thrice, "branch_repeated"), 2, "{kind} {lengths:?}");
            let [once, thrice] = [once, thrice].map(|generated| volume(&surface(&generated)));
            assert!(
                (thrice / once - 1.0).abs() < 1e-6,
                "{kind} {lengths:?}: {thrice} of {once}"
            );
        }
    }
}

/// A soma that is a thick neurite has its frusta's volume, whatever its neurites hang on.
#[neurotess_testing::test]
fn a_long_soma_has_the_volume_of_its_frusta() {
    let node = |id: i64, kind: i32, [x, y]: [f64; 2], radius: f64, parent: Option<u32>| Node {
        id,
        kind: NeuriteKind(kind),
        position: DVec3::new(x, y, 0.0),
        radius,
        parent,
        section: None,
    };
    let soma = [
        node(1, 1, [-50.0, 0.0], 10.0, None),
        node(2, 1, [50.0, 0.0], 10.0, Some(0)),
    ];
    let at_the_end = [
        node(3, 3, [50.0, 0.0], 1.0, Some(1)),
        node(4, 3, [150.0, 0.0], 1.0, Some(2)),
    ];
    let aside = [
        node(3, 3, [0.0, 10.0], 1.0, Some(0)),
        node(4, 3, [0.0, 110.0], 1.0, Some(2)),
    ];
    for neurite in [at_the_end, aside] {
        let generated = meshed(&[&soma[..], &neurite].concat());
        assert_eq!(count(&generated, "soma_as_neurite"), 1);
        let level = LodCriterion::Homogeneous(16);
        let options = RefineOptions::default();
        let surface = SurfaceMesh::collect(&Refinement::new(&generated.mesh, level, &options));
        let right = PI * (100.0 * 100.0 + 100.0);
        let volume = volume(&surface);
        assert!((volume / right - 1.0).abs() < 0.02, "{volume} of {right}");
    }
}
