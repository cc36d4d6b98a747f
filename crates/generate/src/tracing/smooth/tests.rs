//! What smoothing keeps and what it takes away, against theory.

use std::f64::consts::{PI, TAU};

use glam::{DVec3, dvec3};
use proptest::prelude::*;

use neurotess_morphology::smoothing::AUTO_RADII;

use super::*;
use crate::tracing::{Root, SkeletonNode};

/// A node of a neurite without a soma; its sample, section and type tell it apart.
fn node(center: DVec3, radius: f64, parent: u32, number: usize) -> SkeletonNode {
    SkeletonNode {
        center,
        radius,
        parent,
        root: Root::Free,
        sample: number as i64 + 7,
        kind: neurotess_mesh::SwcType((number % 3) as i32 + 2),
        section: neurotess_mesh::SectionNumber(number as i32 / 4 + 1),
    }
}

/// One section through these points, all of one radius.
fn path(points: impl IntoIterator<Item = DVec3>, radius: f64) -> Vec<SkeletonNode> {
    let parent = |i: usize| i.checked_sub(1).map_or(NONE, |parent| parent as u32);
    let points = points.into_iter().enumerate();
    points.map(|(i, p)| node(p, radius, parent(i), i)).collect()
}

fn smoothed(nodes: &[SkeletonNode], amount: Smooth) -> (Vec<SkeletonNode>, Option<Smoothing>) {
    let mut skeleton = Skeleton::from_nodes(nodes.to_vec());
    let report = smooth(&mut skeleton, amount, &mut Warnings::default());
    (skeleton.nodes().to_vec(), report)
}

/// Smoothed by a length, which leaves no node out.
fn by(nodes: &[SkeletonNode], length: f64) -> (Vec<SkeletonNode>, Smoothing) {
    let (smooth, report) = smoothed(nodes, Smooth::Length(length));
    assert_eq!(smooth.len(), nodes.len());
    (smooth, report.expect("asked for"))
}

/// Numbers from −1 to 1, as unlike one another as chance.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

fn mean_square(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    values.map(|v| v * v).sum::<f64>() / count
}

#[test]
fn nothing_changes_unless_asked() {
    let mut noise = Noise(3);
    let points = (0..20).map(|i| dvec3(f64::from(i), noise.next(), noise.next()));
    let traced = path(points, 0.3);
    let none = [0.0, -0.0, -1.0, f64::NAN, f64::NEG_INFINITY].map(Smooth::Length);
    for amount in [Smooth::None].into_iter().chain(none) {
        let (nodes, report) = smoothed(&traced, amount);
        assert_eq!(nodes, traced, "{amount:?}");
        assert_eq!(report, None);
    }
}

#[test]
fn a_straight_cone_stays() {
    let (from, way) = (dvec3(100.0, -20.0, 3.0), dvec3(0.6, 0.0, 0.8));
    let mut noise = Noise(5);
    let mut arc = 0.0;
    let points: Vec<f64> = (0..200)
        .map(|_| {
            arc += 0.01 + (1.0 + noise.next()).powi(3);
            arc
        })
        .collect();
    let mut traced = path(points.iter().map(|arc| from + way * *arc), 1.0);
    for (node, arc) in traced.iter_mut().zip(&points) {
        node.radius = (1.0 - 0.01 * arc).exp();
    }
    for length in [0.01, 1.0, 30.0, 1e4, f64::INFINITY] {
        let (nodes, report) = by(&traced, length);
        for (node, before) in nodes.iter().zip(&traced) {
            assert!(node.center.distance(before.center) < 1e-9, "{length}");
            assert!((node.radius / before.radius - 1.0).abs() < 1e-9, "{length}");
        }
        assert!(report.length_change.abs() < 1e-12);
        assert_eq!(report.points, 198);
    }
}

/// The equations of a uniform line have waves as eigenvectors. With the angle θ between samples that are h
/// apart, a wave keeps 1 / (1 + 3 (λ/h)⁴ (1 − cos θ)² / (2 + cos θ)).
fn kept(length: f64, step: f64, angle: f64) -> f64 {
    let cos = angle.cos();
    1.0 / (1.0 + 3.0 * (length / step).powi(4) * (1.0 - cos).powi(2) / (2.0 + cos))
}

/// On a circle the chord is h = R √(2 − 2 cos θ), so that the loss is at most
/// (λ/R)⁴/4 · 3/(2 + cos θ) of the radius. The ends are held without curvature, which a bend is to have: they are
/// off by up to √½ e^(−π/4) · λ²/2R = 0.161 λ²/R more, and that fades by e^(−t/λ).
#[test]
fn a_circle_keeps_its_radius_to_the_fourth_order() {
    let (radius, angle) = (20.0, TAU / 90.0);
    let on_circle = |i: u32| (radius * glam::DVec2::from_angle(angle * f64::from(i))).extend(0.0);
    let traced = path((0..600).map(on_circle), 0.5);
    let step = traced[0].center.distance(traced[1].center);
    for length in [2.0, 4.0, 8.0] {
        let (nodes, report) = by(&traced, length);
        let shares = nodes.iter().map(|node| node.center.length() / radius);
        let shares: Vec<f64> = shares.collect();
        let most = (length / radius).powi(4) / 4.0 * 3.0 / (2.0 + angle.cos());
        let at_ends = 0.161 * (length / radius).powi(2);
        for (i, share) in shares.iter().enumerate() {
            assert!(
                (1.0 - share).abs() < most + at_ends,
                "{length}: {share} at {i}"
            );
        }
        let middle = shares[300];
        assert!(1.0 - middle < most, "{length}: {middle}");
        assert!((middle - kept(length, step, angle)).abs() < 1e-9);
        assert!(report.largest_move < radius * (most + at_ends));
        assert!((report.largest_move_radii - 2.0 * report.largest_move).abs() < 1e-9);
    }
}

/// Of independent errors, samples a small step h apart keep √(3/8 · h/λ), by Parseval from the kernel's waves;
/// exactly, the root of the mean of the squares of what waves keep.
#[test]
fn white_noise_is_reduced_as_theory_says() {
    let (count, size) = (40_000_u32, 1e-3);
    for length in [2.0, 5.0, 20.0] {
        let mut noise = Noise(11);
        let points =
            (0..count).map(|i| dvec3(f64::from(i), size * noise.next(), size * noise.next()));
        let mut traced = path(points, 1.0);
        for node in &mut traced {
            node.radius = (size * noise.next()).exp();
        }
        let (nodes, _) = by(&traced, length);
        let waves = (0..1000).map(|k| kept(length, 1.0, PI * (f64::from(k) + 0.5) / 1000.0));
        let exactly = mean_square(waves).sqrt();
        assert!(
            (exactly / (0.375 / length).sqrt() - 1.0).abs() < 0.02,
            "{exactly}"
        );
        let of: [fn(&SkeletonNode) -> f64; 3] = [|n| n.center.y, |n| n.center.z, |n| n.radius.ln()];
        for value in of {
            let before = mean_square(traced.iter().map(value)).sqrt();
            let after = mean_square(nodes.iter().map(value)).sqrt();
            // One in √(2 · samples that are independent), about 2,000 here for the longest.
            assert!(
                (after / before / exactly - 1.0).abs() < 0.06,
                "{length}: {}",
                after / before
            );
        }
    }
}

#[test]
fn waves_keep_what_the_documentation_says() {
    for (wave, share) in [(10.0, 0.96), (4.44, 0.5), (2.0, 0.04)] {
        let (length, step) = (50.0, 1.0);
        let turn = TAU / (wave * length);
        let at = |i: u32| dvec3(step * f64::from(i), 0.01 * (turn * f64::from(i)).sin(), 0.0);
        let (nodes, _) = by(&path((0..3000).map(at), 1.0), length);
        let middle = nodes[1000..2000].iter().map(|node| node.center.y);
        let kept = middle.fold(0.0, f64::max) / 0.01;
        assert!((kept - share).abs() < 0.005, "{wave}: {kept}");
    }
}

/// However a curve was sampled, densely here and there, it becomes nearly the same.
#[test]
fn density_does_not_matter() {
    let curve = |arc: f64| dvec3(arc, (0.4 * arc).sin(), 0.0);
    let even: Vec<f64> = (0..=400).map(|i| 0.1 * f64::from(i)).collect();
    let mut uneven = even.clone();
    uneven.extend((0..5000).map(|i| 15.0 + 1e-3 * f64::from(i)));
    uneven.sort_by(f64::total_cmp);
    uneven.dedup_by(|b, a| *b - *a < 1e-9);
    let smooth = |places: &[f64]| by(&path(places.iter().map(|&arc| curve(arc)), 0.1), 3.0).0;
    let (few, many) = (smooth(&even), smooth(&uneven));
    for (place, node) in even.iter().zip(few) {
        let same = uneven
            .iter()
            .position(|other| (other - place).abs() < 1e-9)
            .expect("of both");
        let apart = node.center.distance(many[same].center);
        assert!(apart < 2e-3, "{apart} at {place}");
    }
}

#[test]
fn a_thick_trunk_does_not_widen_its_twigs() {
    let mut nodes = path((0..5).map(|i| DVec3::X * f64::from(i)), 5.0);
    let mut parent = 4;
    for i in 1..30 {
        nodes.push(node(
            DVec3::X * 4.0 + DVec3::Y * f64::from(i),
            0.5,
            parent,
            20 + i as usize,
        ));
        parent = nodes.len() as u32 - 1;
    }
    nodes.push(node(DVec3::X * 20.0, 5.0, 4, 60));
    let (smooth, _) = by(&nodes, 6.0);
    for (node, before) in smooth.iter().zip(&nodes) {
        assert!(
            (node.radius / before.radius - 1.0).abs() < 1e-12,
            "{node:?}"
        );
    }
}

#[test]
fn the_amount_by_itself_follows_the_thickness() {
    let zigzag = |i: u32| dvec3(0.5 * f64::from(i), 0.02 * f64::from(i % 2), 0.0);
    let thin = path((0..100).map(zigzag), 0.4);
    let (by_itself, _) = smoothed(&thin, Smooth::Auto);
    let (by_length, _) = by(&thin, 0.4 * AUTO_RADII);
    assert_eq!(by_itself, by_length);
}

#[test]
fn what_can_hardly_be_smoothed_is_no_crash() {
    let one = |_| DVec3::ONE;
    let step = |i: u32| DVec3::X * (1e-12 * f64::from(i) + f64::from(i / 5));
    let turned = |i: u32| DVec3::X * f64::from(5 - i.abs_diff(5));
    let far = |i: u32| DVec3::X * 1e13 * f64::from(i);
    let paths: [&dyn Fn(u32) -> DVec3; 5] = [&one, &step, &turned, &far, &|i| {
        DVec3::X * 1e-40 * f64::from(i)
    }];
    for (k, points) in paths.iter().enumerate() {
        for count in [1, 2, 3, 11] {
            for radius in [1e-30, 1.0, 1e12] {
                let traced = path((0..count).map(points), radius);
                let lengths = [1e-300, 1e-9, 1.0, 1e300, f64::INFINITY].map(Smooth::Length);
                for amount in lengths.into_iter().chain([Smooth::Auto]) {
                    let (nodes, report) = smoothed(&traced, amount);
                    for node in nodes {
                        assert!(node.center.is_finite(), "{k} {count} {amount:?}");
                        assert!((node.radius / radius - 1.0).abs() < 1e-9);
                    }
                    let report = report.expect("asked for");
                    assert!(report.length_change.is_finite() && report.largest_move.is_finite());
                }
            }
        }
    }
}

#[test]
fn a_loop_that_becomes_one_place_leaves_no_coincident_points() {
    let around = |i: u32| {
        dvec3(
            (TAU * f64::from(i) / 12.0).cos() - 1.0,
            (TAU * f64::from(i) / 12.0).sin(),
            0.0,
        )
    };
    let (nodes, _) = smoothed(&path((0..=12).map(around), 0.1), Smooth::Length(1e9));
    for node in nodes.iter().filter(|node| node.parent != NONE) {
        assert!(node.center.distance(nodes[node.parent as usize].center) > 1e-5);
    }
}

/// A tree of nodes each of which mostly goes on from the one before.
fn tree() -> impl Strategy<Value = Vec<SkeletonNode>> {
    let step = (
        any::<u32>(),
        [-3.0..3.0, -3.0..3.0, -3.0..3.0],
        0.0..1.0,
        0.01..3.0,
    );
    prop::collection::vec(step, 1..80).prop_map(|steps| {
        let mut nodes: Vec<SkeletonNode> = Vec::new();
        for (i, (draw, step, size, radius)) in steps.into_iter().enumerate() {
            let parent = match draw % 12 {
                _ if i == 0 => NONE,
                0 => NONE,
                1 | 2 => draw / 12 % i as u32,
                _ => i as u32 - 1,
            };
            let from = nodes
                .get(parent as usize)
                .map_or(DVec3::ZERO, |node| node.center);
            // Some steps are far shorter than others.
            let step = DVec3::from_array(step) * f64::powi(size, 6);
            nodes.push(node(from + step, radius, parent, i));
        }
        nodes
    })
}

fn amount() -> impl Strategy<Value = Smooth> {
    let length = (-6.0..4.0).prop_map(|power| Smooth::Length(f64::powf(10.0, power)));
    prop_oneof![length, Just(Smooth::Auto)]
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(256) })]
    #[test]
    fn forks_and_ends_stay_and_radii_keep_their_range(traced in tree(), amount in amount()) {
        let mut before = Skeleton::from_nodes(traced);
        // Smoothing does so at its end.
        mend::merge_coincident(&mut before, &mut Warnings::default());
        let (nodes, report) = smoothed(before.nodes(), amount);
        let bounds = |of: fn(&SkeletonNode) -> f64| {
            let values = before.nodes().iter().map(of);
            values.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(v), b.max(v)])
        };
        let [least, most] = bounds(|node| node.radius);
        for node in &nodes {
            prop_assert!(node.center.is_finite());
            prop_assert!(node.radius >= least * (1.0 - 1e-12) && node.radius <= most * (1.0 + 1e-12));
        }
        if nodes.len() == before.nodes().len() {
            let mut free = 0;
            for (i, (node, traced)) in nodes.iter().zip(before.nodes()).enumerate() {
                let ordinary = traced.parent != NONE && before.children().of(i as u32).len() == 1;
                free += usize::from(ordinary);
                let (center, radius) = (node.center, node.radius);
                // But for center and radius, all is as before; of forks and ends these too.
                let now = if ordinary { SkeletonNode { center, radius, ..*traced } } else { *traced };
                prop_assert_eq!(*node, now);
            }
            prop_assert_eq!(report.map(|report| report.points), Some(free));
        }
        let again = smoothed(before.nodes(), amount);
        prop_assert_eq!((nodes, report), again);
    }
}
