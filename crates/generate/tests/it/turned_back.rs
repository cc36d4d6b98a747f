//! Paths that turn back within their own tube: no point of the surface is far from what was traced, and the volume is
//! not negative, at any level.

use crate::branches::add;
use glam::{DVec3, Quat, Vec3, vec3};
use neurotess_generate::{Crossings, GenerateOptions, Generated, generate};
use neurotess_mesh::{SurfaceMesh, topology};
use neurotess_morphology::{Attachment, Morphology, NeuriteKind, Node, SectionId};
use neurotess_refine::{LodCriterion, RefineOptions, Refinement};
use neurotess_testing::{cases, is_full};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// Levels at which surfaces are looked at: between the corners of rings, and finely.
const LEVELS: [u32; 4] = [1, 2, 4, 8];
/// No point of the surface is farther from the box around the tracing than this many radii of the nearest point.
const MAX_RADII: f32 = 2.0;

/// A step of a path: how far it goes in radii, by how much it turns before that (radians), about which axis, aside by
/// how much (µm), and the factor of the radius from here on.
#[derive(Clone, Copy, Debug)]
struct Step {
    way: f32,
    turn: f32,
    axis: f32,
    aside: f32,
    factor: f32,
}

fn step() -> impl Strategy<Value = Step> {
    let turn = prop_oneof![
        2 => Just(0.0),
        1 => Just(std::f32::consts::PI),
        2 => 150_f32..180.0,
    ];
    let turn = turn.prop_map(|degrees| {
        if degrees < 4.0 {
            degrees
        } else {
            degrees.to_radians()
        }
    });
    let factor = prop_oneof![4 => Just(1.0), 1 => Just(10.0), 1 => Just(0.1)];
    (
        prop_oneof![3 => 0.2_f32..3.0, 1 => 3_f32..20.0],
        turn,
        0_f32..std::f32::consts::TAU,
        prop_oneof![1 => Just(0.0), 1 => 0_f32..0.5],
        factor,
    )
        .prop_map(|(way, turn, axis, aside, factor)| Step {
            way,
            turn,
            axis,
            aside,
            factor,
        })
}

/// Points and radii along steps.
fn points(start: Vec3, radius: f32, steps: &[Step]) -> Vec<(Vec3, f32)> {
    let (mut place, mut direction, mut radius) = (start, Vec3::X, radius);
    let mut points = vec![(place, radius)];
    for step in steps {
        let (side, up) = direction.any_orthonormal_pair();
        let axis = side * step.axis.cos() + up * step.axis.sin();
        direction = (Quat::from_axis_angle(axis, step.turn) * direction).normalize_or(Vec3::X);
        place += direction * step.way * radius + axis * step.aside;
        radius = (radius * step.factor).clamp(0.05, 20.0);
        points.push((place, radius));
    }
    points
}

/// A fault of the surface at any level; none: it is sound.
fn fault(cell: &Morphology, generated: &Generated) -> Option<String> {
    let tracing = &generated.mesh.tracing;
    let most = |sign: f32| {
        let traced = cell
            .points
            .iter()
            .map(|point| (point.position, point.radius));
        // A fork may be meshed thicker than it was traced.
        let meshed = tracing.iter().map(|point| (point.center, point.radius));
        let points = traced.chain(meshed);
        let reaches = points.map(|(place, radius)| sign * place + MAX_RADII * radius);
        reaches.reduce(Vec3::max).unwrap_or_default()
    };
    let (low, high) = (-most(-1.0), most(1.0));
    for level in LEVELS {
        let lod = LodCriterion::Homogeneous(level);
        let refined = Refinement::new(&generated.mesh, lod, &RefineOptions::default());
        let surface = SurfaceMesh::collect(&refined);
        let positions: Vec<Vec3> = surface.vertices.iter().map(|v| v.position).collect();
        let topology = topology(&positions, &surface.faces);
        if !(topology.closed && topology.oriented && topology.vertex_manifold) {
            return Some(format!("level {level}: not closed"));
        }
        let outside = |p: &&Vec3| p.cmplt(low).any() || p.cmpgt(high).any();
        if let Some(outside) = positions.iter().find(outside) {
            return Some(format!(
                "level {level}: {outside} is not within {low} to {high}"
            ));
        }
        let volume: f64 = surface
            .faces
            .triangles
            .iter()
            .map(|corners| {
                let [a, b, c] = corners.map(|corner| positions[corner as usize].as_dvec3());
                a.dot(b.cross(c)) / 6.0
            })
            .sum();
        if volume.is_nan() || volume <= 0.0 {
            return Some(format!("level {level}: a volume of {volume}"));
        }
    }
    None
}

fn cell(root: Vec<(Vec3, f32)>, branch: Option<&[Step]>) -> Morphology {
    let (end, radius) = root[root.len() - 1];
    let mut cell = Morphology::default();
    add(&mut cell, Attachment::Free, root);
    if let Some(steps) = branch {
        let section = Attachment::Section(SectionId(0));
        add(
            &mut cell,
            section,
            points(end, radius, steps).into_iter().skip(1),
        );
        let away = [4.0, 12.0].map(|way| (end - Vec3::Y * way * radius, 0.7 * radius));
        add(&mut cell, section, away);
    }
    cell
}

fn config(quick: u32, full: u32) -> ProptestConfig {
    ProptestConfig {
        cases: cases(quick, full),
        failure_persistence: None,
        // The same few in the quick lane, new ones in the full one.
        rng_seed: match is_full() {
            true => RngSeed::Random,
            false => RngSeed::Fixed(1),
        },
        ..ProptestConfig::default()
    }
}

proptest! {
    #![proptest_config(config(300, 100_000))]
    #[neurotess_testing::test]
    fn paths_that_turn_back_stay_near_their_tracing(
        radius in prop_oneof![Just(1.0_f32), 0.1_f32..3.0],
        steps in prop::collection::vec(step(), 2..9),
        branch in prop::option::of(prop::collection::vec(step(), 2..5)),
        separate in any::<bool>(),
    ) {
        let cell = cell(points(Vec3::ZERO, radius, &steps), branch.as_deref());
        let options = GenerateOptions {
            crossings: if separate { Crossings::Separate } else { Crossings::Keep },
            ..GenerateOptions::default()
        };
        let generated = generate(&cell, &options).expect("meshed");
        prop_assert_eq!(fault(&cell, &generated), None);
    }
}

/// Thick, thin, and back to where it began: the volume is that of the thick part and the long thin one.
#[neurotess_testing::test]
fn a_thick_end_that_the_path_comes_back_to_has_its_volume() {
    let cell = cell(
        vec![
            (vec3(0.0, 5.0, 0.0), 8.45),
            (vec3(0.0, 0.0, 0.0), 2.29),
            (vec3(0.0, 5.0, 0.0), 0.75),
            (vec3(0.0, -25.0, 0.0), 0.75),
            (vec3(0.0, -60.0, 0.0), 0.75),
        ],
        None,
    );
    let generated = generate(&cell, &GenerateOptions::default()).expect("meshed");
    assert_eq!(fault(&cell, &generated), None);
}

/// Two children that leave side by side meet far from their fork: there a corner's offset is many radii long.
#[neurotess_testing::test]
fn a_fork_whose_children_leave_side_by_side_reaches_no_farther() {
    let step = |way, turn, axis, factor| Step {
        way,
        turn,
        axis,
        aside: 0.0,
        factor,
    };
    let back = std::f32::consts::PI;
    let root = [
        step(18.0, 0.0, 0.0, 10.0),
        step(0.764, 0.0, 0.0, 1.0),
        step(0.2, back, 3.073, 1.0),
        step(7.217, 2.848, 0.906, 1.0),
    ];
    let branch = [
        step(2.876, back, 0.0, 1.0),
        step(10.101, 0.0, 0.0, 0.1),
        step(2.55, back, 0.0, 0.1),
        step(2.553, 2.618, 0.0, 10.0),
    ];
    let cell = cell(points(Vec3::ZERO, 1.0, &root), Some(&branch));
    let generated = generate(&cell, &GenerateOptions::default()).expect("meshed");
    assert_eq!(fault(&cell, &generated), None);
}

/// Fault C6, `f1_fork_folds_back.swc`: a branch that goes on where its trunk turns back, from places beside that.
#[neurotess_testing::test]
fn a_branch_that_goes_on_where_its_trunk_turns_back_has_no_empty_faces() {
    for [ahead, aside] in [
        [0.16, 0.0],
        [0.16, 0.02],
        [0.3, 0.0],
        [0.05, 0.0],
        [0.16, -0.1],
    ] {
        let rows = [
            ([6.0, 1.0, 0.0], None),
            ([3.5, 0.3, 0.0], Some(0)),
            ([1.2, 0.0, 0.0], Some(1)),
            ([0.0, 0.0, 0.0], Some(2)),
            ([ahead, aside, 0.0], Some(3)),
            ([1.2, 0.0, 0.0], Some(4)),
            ([1.7, -0.2, 0.0], Some(5)),
            ([4.0, -2.0, 0.0], Some(6)),
            ([0.33, 0.0, 0.0], Some(3)),
            ([-1.2, 0.0, 0.0], Some(8)),
            ([-4.0, 0.5, 0.0], Some(9)),
        ];
        let node = |(index, ([x, y, z], parent)): (usize, ([f64; 3], Option<u32>))| Node {
            id: index as i64 + 1,
            kind: NeuriteKind(3),
            position: DVec3::new(x, y, z),
            radius: 0.165,
            parent,
            section: None,
        };
        let nodes: Vec<Node> = rows.into_iter().enumerate().map(node).collect();
        let cell = Morphology::from_nodes("cell", Vec::new(), &nodes).expect("a cell");
        let generated = generate(&cell.morphology, &GenerateOptions::default()).expect("meshed");
        for level in [2, 4] {
            let level = LodCriterion::Homogeneous(level);
            let options = RefineOptions::default();
            let surface = SurfaceMesh::collect(&Refinement::new(&generated.mesh, level, &options));
            let at = |v: u32| surface.vertices[v as usize].position;
            let areas = surface.faces.triangles.iter();
            let least = areas
                .map(|&[a, b, c]| (at(b) - at(a)).cross(at(c) - at(a)).length())
                .fold(f32::INFINITY, f32::min);
            assert!(least > 1e-9, "{ahead} {aside}: {least}");
        }
    }
}
