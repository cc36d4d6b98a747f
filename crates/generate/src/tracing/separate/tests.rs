//! Whole separations of small cells.

use glam::{DVec3, dvec3};
use neurotess_morphology::SomaShape;
use proptest::prelude::*;

use super::geometry::closest;
use super::paths::OnSegment;
use super::*;
use crate::tracing::{NONE, Root, SkeletonNode};

/// Straight tubes of one radius, each cut into equal segments.
struct Tubes(Vec<SkeletonNode>);

impl Tubes {
    fn new() -> Self {
        Self(Vec::new())
    }

    fn push(&mut self, center: DVec3, radius: f64, parent: u32, root: Root) -> u32 {
        let sample = self.0.len() as i64 + 1;
        self.0.push(SkeletonNode {
            center,
            radius,
            parent,
            root,
            sample,
            kind: neurotess_mesh::SwcType(3),
            section: neurotess_mesh::SectionNumber(sample as i32),
        });
        sample as u32 - 1
    }

    /// A tube of its own, or one that leaves a node.
    fn tube(&mut self, ends: [DVec3; 2], segments: u32, radius: f64, from: u32) -> u32 {
        let mut last = from;
        for k in u32::from(from != NONE)..=segments {
            let at = ends[0].lerp(ends[1], f64::from(k) / f64::from(segments));
            last = self.push(at, radius, last, Root::Free);
        }
        last
    }

    fn separate(self, spheres: &[Option<SomaSphere>]) -> (Vec<SkeletonNode>, Separation, Warnings) {
        let mut skeleton = Skeleton::from_nodes(self.0);
        let mut warnings = Warnings::default();
        let samples = vec![-7; spheres.len()];
        let separated = separate(
            &mut skeleton,
            spheres,
            &samples,
            &mut warnings,
            &Watch::default(),
        );
        let parents_first =
            |(i, n): (usize, &SkeletonNode)| n.parent == NONE || (n.parent as usize) < i;
        assert!(skeleton.nodes().iter().enumerate().all(parents_first));
        assert!(skeleton.nodes().iter().all(|n| n.center.is_finite()));
        (skeleton.nodes().to_vec(), separated.report, warnings)
    }
}

fn touching(nodes: &[SkeletonNode], spheres: &[Option<SomaSphere>]) -> bool {
    let rods = Rods::new(&Skeleton::from_nodes(nodes.to_vec()), spheres);
    search(&rods, &rods.centers(), Margin::NONE, None).touches()
}

/// Two tubes along x and at an angle to it, whose axes are `off` apart in z.
fn crossed(angle: f64, off: f64, radii: [f64; 2]) -> Tubes {
    let mut tubes = Tubes::new();
    let x = DVec3::X * 30.0;
    tubes.tube([-x, x], 6, radii[0], NONE);
    let across = dvec3(angle.cos(), angle.sin(), 0.0) * 30.0;
    let off = DVec3::Z * off;
    tubes.tube([off - across, off + across], 7, radii[1], NONE);
    tubes
}

#[test]
fn crossing_tubes_are_parted_and_the_thinner_one_moves() {
    let (nodes, report, warnings) = crossed(1.2, 0.1, [1.0, 0.4]).separate(&[]);
    assert!(!touching(&nodes, &[]));
    assert_eq!(report.places.len(), 1);
    let place = report.places[0];
    assert!((place.before - 1.3).abs() < 1e-9, "{place:?}");
    assert_eq!(place.after, 0.0);
    assert!(report.complete);
    // The depth and the gap, shared by the two.
    assert!((1.0..2.0).contains(&report.largest_move), "{report:?}");
    assert!(report.length_change.abs() < 0.01, "{report:?}");
    let farthest = |samples: std::ops::RangeInclusive<i64>| {
        let of = nodes.iter().filter(|n| samples.contains(&n.sample));
        of.map(|n| n.center.z.abs()).fold(0.0, f64::max)
    };
    assert!(farthest(1..=7) < 0.2 * farthest(8..=15));
    let warnings = warnings.into_vec();
    assert_eq!(warnings[0].code, "branches_separated");
    assert_eq!((warnings.len(), warnings[0].count), (1, 1));
}

#[test]
fn traced_points_keep_what_they_are_and_added_ones_take_it_from_the_nearer_end() {
    let before = crossed(1.2, 0.1, [1.0, 0.4]);
    let traced = before.0.clone();
    let (nodes, ..) = before.separate(&[]);
    assert!(nodes.len() > traced.len());
    for node in &nodes {
        let origin = traced[node.sample as usize - 1];
        assert_eq!(node.kind, origin.kind);
        // Segments are 10 µm long or less.
        assert!(node.center.distance(origin.center) < 5.0 + 2.0, "{node:?}");
        assert_eq!(node.radius, origin.radius);
    }
    let samples: std::collections::BTreeSet<i64> = nodes.iter().map(|n| n.sample).collect();
    assert_eq!(samples.len(), traced.len());
}

#[test]
fn tubes_that_pass_at_a_distance_stay_as_they_are() {
    let tubes = crossed(0.7, 1.8, [1.0, 0.4]);
    let traced = tubes.0.clone();
    let (nodes, report, warnings) = tubes.separate(&[]);
    assert_eq!(nodes, traced);
    assert_eq!(
        report,
        Separation {
            complete: true,
            ..Separation::default()
        }
    );
    assert!(warnings.into_vec().is_empty());
}

#[test]
fn what_is_far_from_all_contacts_stays_as_it_is() {
    let mut tubes = crossed(1.2, 0.1, [1.0, 0.4]);
    let far = DVec3::Y * 300.0;
    tubes.tube([far, far + DVec3::X * 40.0], 5, 1.0, NONE);
    let traced = tubes.0.clone();
    let (nodes, ..) = tubes.separate(&[]);
    let last = |nodes: &[SkeletonNode]| -> Vec<DVec3> {
        nodes.iter().rev().take(6).map(|n| n.center).collect()
    };
    assert_eq!(last(&nodes), last(&traced));
}

#[test]
fn a_branch_may_touch_its_parent_near_their_fork() {
    let mut tubes = Tubes::new();
    let fork = tubes.tube([DVec3::ZERO, DVec3::X * 20.0], 10, 1.0, NONE);
    let at = DVec3::X * 20.0;
    tubes.tube([at, at + DVec3::X * 20.0], 10, 1.0, fork);
    tubes.tube([at, at + dvec3(8.0, 16.0, 0.0)], 10, 0.6, fork);
    let traced = tubes.0.clone();
    let (nodes, report, _) = tubes.separate(&[]);
    assert!(report.places.is_empty());
    assert_eq!(nodes, traced);
}

#[test]
fn a_branch_that_comes_back_to_its_parent_is_moved_away() {
    let mut tubes = Tubes::new();
    let fork = tubes.tube([DVec3::ZERO, DVec3::X * 10.0], 5, 1.0, NONE);
    let at = DVec3::X * 10.0;
    tubes.tube([at, at + DVec3::X * 50.0], 20, 1.0, fork);
    let away = tubes.tube([at, at + dvec3(10.0, 12.0, 0.0)], 6, 0.5, fork);
    let from = at + dvec3(10.0, 12.0, 0.0);
    tubes.tube([from, from + dvec3(8.0, -30.0, 0.0)], 12, 0.5, away);
    assert!(touching(&tubes.0, &[]));
    let (nodes, report, _) = tubes.separate(&[]);
    assert_eq!(report.places.len(), 1);
    assert!(!touching(&nodes, &[]), "{report:?}");
}

fn sphere(center: DVec3, radius: f64) -> Option<SomaSphere> {
    Some(SomaSphere::new(
        SomaShape::sphere(center, radius).into(),
        1.0,
        1.0,
    ))
}

#[test]
fn a_branch_through_the_soma_of_another_cell_is_led_round_it() {
    let soma = [sphere(DVec3::ZERO, 4.0)];
    let mut tubes = Tubes::new();
    let off = dvec3(0.0, 2.5, 0.5);
    tubes.tube(
        [off - DVec3::X * 60.0, off + DVec3::X * 60.0],
        24,
        0.5,
        NONE,
    );
    let root = tubes.push(DVec3::Z * 4.0, 1.0, NONE, Root::Insertion(0));
    tubes.tube([DVec3::Z * 4.0, DVec3::Z * 30.0], 8, 1.0, root);
    assert!(touching(&tubes.0, &soma));
    let (nodes, report, _) = tubes.separate(&soma);
    assert_eq!(report.places.len(), 1);
    assert_eq!(report.places[0].samples[1], -7);
    assert!(!touching(&nodes, &soma), "{report:?}");
    let ring = nodes
        .iter()
        .find(|n| n.root == Root::Insertion(0))
        .expect("the ring");
    assert_eq!(ring.center, DVec3::Z * 4.0);
}

/// As many tubes in one place, by `number`.
fn pile(count: u32, tube: impl Fn(f64) -> [DVec3; 2]) -> Tubes {
    let mut tubes = Tubes::new();
    for k in 0..count {
        tubes.tube(tube(f64::from(k)), 4, 0.5, NONE);
    }
    tubes
}

#[test]
fn doubled_branches_are_parted() {
    let tubes = pile(2, |_| [DVec3::ZERO, dvec3(20.0, 3.0, 1.0)]);
    let (nodes, report, _) = tubes.separate(&[]);
    assert_eq!(report.places.len(), 1);
    assert!(!touching(&nodes, &[]), "{report:?}");
    assert_eq!(report.places[0].after, 0.0);
}

#[test]
fn hundreds_of_branches_in_one_spot_end_with_a_report() {
    let tubes = pile(500, |k| {
        let way = dvec3((0.7 * k).sin(), (1.3 * k).cos(), (2.1 * k).sin()) * 20.0;
        [-way, way]
    });
    let (nodes, report, warnings) = tubes.separate(&[]);
    assert!(!report.complete);
    let left = report.places.iter().any(|p| p.after > 0.0);
    assert_eq!(left, touching(&nodes, &[]));
    let codes: Vec<&str> = warnings.into_vec().iter().map(|w| w.code).collect();
    assert_eq!(codes.contains(&"branches_touch"), left);
    assert!(codes.contains(&"crowded_branches"));
}

#[test]
fn coincident_branches_end_with_a_report() {
    let tubes = pile(50, |_| [DVec3::ZERO, dvec3(20.0, 3.0, 1.0)]);
    let (nodes, report, _) = tubes.separate(&[]);
    let left = report.places.iter().any(|p| p.after > 0.0);
    assert_eq!(left, touching(&nodes, &[]));
}

#[test]
fn no_length_is_no_crash() {
    let tubes = pile(6, |_| [DVec3::ONE, DVec3::ONE]);
    let (_, report, _) = tubes.separate(&[]);
    assert!(!report.places.is_empty());
}

#[test]
fn a_point_stays_if_the_shorter_way_would_touch_another_branch() {
    let mut tubes = Tubes::new();
    let (left, right) = (DVec3::X * -3.0, DVec3::X * 3.0);
    let first = tubes.push(left, 0.5, NONE, Root::Free);
    let bend = tubes.push(DVec3::Y * 2.0, 0.5, first, Root::Free);
    let last = tubes.push(right, 0.5, bend, Root::Free);
    tubes.tube([DVec3::Z * -9.0, DVec3::Z * 9.0], 2, 0.5, NONE);
    let mut skeleton = Skeleton::from_nodes(tubes.0);
    let separated = separate(
        &mut skeleton,
        &[],
        &[],
        &mut Warnings::default(),
        &Watch::default(),
    );
    assert!(separated.report.places.is_empty());
    assert!(!separated.clearance.allows(first, last));
    assert!(separated.clearance.allows(first, bend));
}

/// A tree that wanders through its own neighborhood.
fn wandering() -> impl Strategy<Value = Vec<(u32, [f64; 3], f64)>> {
    let step = (any::<u32>(), [-3.0..3.0, -3.0..3.0, -3.0..3.0], 0.1..1.0);
    prop::collection::vec(step, 2..60)
}

fn wander(steps: &[(u32, [f64; 3], f64)]) -> Tubes {
    let mut tubes = Tubes::new();
    for (i, &(draw, step, radius)) in steps.iter().enumerate() {
        // Mostly a path, now and then a branch, or a tree of its own.
        let i = i as u32;
        let parent = match draw % 10 {
            _ if i == 0 => NONE,
            0 => NONE,
            1 | 2 => draw / 10 % i,
            _ => i - 1,
        };
        let from = if parent == NONE {
            DVec3::ZERO
        } else {
            tubes.0[parent as usize].center
        };
        tubes.push(from + DVec3::from(step), radius, parent, Root::Free);
    }
    tubes
}

/// Depth of the deepest pair that may not touch, of all pairs.
fn deepest(rods: &Rods) -> f64 {
    let radius = |i: u32, share: f64| {
        let above = rods.radius(rods.parent(i));
        above + share * (rods.radius(i) - above)
    };
    let mut deepest = 0.0_f64;
    for a in rods.segments() {
        for b in rods.segments().filter(|&b| b > a) {
            let (up_a, up_b) = (rods.parent(a), rods.parent(b));
            if up_a == b || up_b == a || up_a == up_b {
                continue;
            }
            let place = |i: u32| rods.points[i as usize].node.center;
            let (p, q) = ([up_a, a].map(place), [up_b, b].map(place));
            let (s, t) = closest(p, q);
            let on = |segment: u32, share: f64| OnSegment {
                segment,
                arc: rods.paths.arc(segment) - (1.0 - share) * rods.length[segment as usize],
            };
            let radii = radius(a, s) + radius(b, t);
            let short = rods.paths.way(on(a, s), on(b, t)).is_some_and(|way| {
                let fork = way.fork.map_or(0.0, |fork| 1.5 * rods.radius(fork));
                way.length <= 2.0 * radii.max(fork)
            });
            if !short {
                let distance = p[0].lerp(p[1], s).distance(q[0].lerp(q[1], t));
                deepest = deepest.max(radii - distance);
            }
        }
    }
    deepest
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(64) })]
    #[test]
    fn reports_exactly_what_is_left(steps in wandering()) {
        let skeleton = Skeleton::from_nodes(wander(&steps).0);
        let mut rods = Rods::new(&skeleton, &[]);
        let depths = Depths::new(&skeleton, &[]);
        let report = move_apart(&mut rods, depths, &Watch::default());
        let left = report.places.iter().map(|p| p.after).fold(0.0, f64::max);
        prop_assert!(left <= deepest(&rods));
        if report.complete {
            prop_assert_eq!(left, deepest(&rods));
        }
    }

    #[test]
    fn says_the_same_again(steps in wandering()) {
        let (nodes, report, _) = wander(&steps).separate(&[]);
        let (again, second, _) = wander(&steps).separate(&[]);
        prop_assert_eq!(&nodes, &again);
        prop_assert_eq!(&report, &second);
        if report.places.is_empty() {
            prop_assert_eq!(nodes, wander(&steps).0);
        }
    }

    #[test]
    fn two_tubes_that_cross_are_always_parted(
        angle in 0.3..1.57, off in -1.0..1.0, thick in 0.2..1.5, thin in 0.2..1.0,
    ) {
        let (nodes, report, _) = crossed(angle, off, [thick, thin * thick]).separate(&[]);
        prop_assert!(!touching(&nodes, &[]), "{:?}", report);
    }
}
