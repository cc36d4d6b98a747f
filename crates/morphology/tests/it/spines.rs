//! Spines are where they should be, and touch nothing.

use glam::DVec3;
use neurotess_morphology::edit::{self, Edit, EditReport, SPINE, SPINE_REACH, SpinePlaces};
use neurotess_morphology::{Morphology, NeuriteKind, Node, SectionId};

/// A soma, and on it a straight dendrite of 100 µm that forks, and an axon.
fn cell(radius: f64) -> Morphology {
    let rows = [
        (1, [0.0, 0.0, 0.0], 5.0, None),
        (3, [0.0, 6.0, 0.0], radius, Some(0)),
        (3, [0.0, 106.0, 0.0], radius, Some(1)),
        (3, [50.0, 150.0, 0.0], radius, Some(2)),
        (4, [-50.0, 150.0, 0.0], radius, Some(2)),
        (2, [0.0, -6.0, 0.0], radius, Some(0)),
        (2, [0.0, -106.0, 0.0], radius, Some(5)),
    ];
    let mut nodes = Vec::new();
    for (kind, position, radius, parent) in rows {
        nodes.push(Node {
            id: nodes.len() as i64 + 1,
            kind: NeuriteKind(kind),
            position: DVec3::from_array(position),
            radius,
            parent,
            section: None,
        });
    }
    let built = Morphology::from_nodes("cell", Vec::new(), &nodes);
    built.expect("a cell").morphology
}

fn grown(cell: &Morphology, density: f64, seed: u64) -> (Morphology, EditReport) {
    at(cell, SpinePlaces::Density(density), seed)
}

fn at(cell: &Morphology, places: SpinePlaces, seed: u64) -> (Morphology, EditReport) {
    let edited = edit::apply(cell, &[Edit::Spines { places, seed }]).expect("spines");
    (edited.morphology, edited.reports[0].clone())
}

/// Spines: the dendrite's sample that each hangs on, and its own samples, as places (µm) and radii.
fn spines(m: &Morphology) -> Vec<[Vec<(DVec3, f64)>; 2]> {
    let there = |point: usize| {
        let point = &m.points[point];
        (
            m.origin + point.position.as_dvec3(),
            f64::from(point.radius),
        )
    };
    let of = |id: usize| m.sections[id].range().map(there).collect::<Vec<_>>();
    let is_spine = |&id: &usize| m.sections[id].kind == SPINE;
    let all = (0..m.sections.len()).filter(is_spine);
    let with_base = all.map(|id| {
        let parent = m.sections[id].parent().expect("a dendrite");
        [vec![of(parent.index()).pop().expect("points")], of(id)]
    });
    with_base.collect()
}

#[neurotess_testing::test]
fn as_many_grow_as_were_asked_for_and_only_on_dendrites() {
    let cell = cell(0.3);
    for density in [0.1, 0.5, 1.0] {
        let (spiny, report) = grown(&cell, density, 1);
        let spines = spines(&spiny);
        let asked = density * (100.0 + 2.0 * 50_f64.hypot(44.0));
        let share = spines.len() as f64 / asked;
        assert!(
            (0.85..1.1).contains(&share),
            "{density}: {} of {asked}",
            spines.len()
        );
        assert!(report.left <= 2, "{}", report.left);
        assert!(
            spines.iter().all(|[base, _]| base[0].0.y > 6.0),
            "none on the axon"
        );
        // Base samples are new, and each spine has two of its neck and one or two of its head.
        assert!(report.samples.after - report.samples.before >= 4 * spines.len());
        assert_eq!(report.pieces.before, report.pieces.after);
    }
}

#[neurotess_testing::test]
fn bases_keep_apart_and_necks_are_thinner_than_anything_traced() {
    for radius in [0.2, 0.5, 2.0] {
        let (spiny, _) = grown(&cell(radius), 2.0, 3);
        let spines = spines(&spiny);
        assert!(spines.len() > 20);
        for [base, twig] in &spines {
            let (base, thick) = base[0];
            assert!((thick - radius).abs() < 1e-4);
            let (neck, head) = (twig[0].1, twig.last().expect("a head").1);
            assert!(neck <= 0.5 * radius + 1e-5 && neck < 0.6 * head + 1e-5);
            assert!((0.089..0.51).contains(&head), "{head}");
            // It points away from the dendrite, and begins outside of it.
            let outwards = (twig[0].0 - base).normalize_or_zero();
            assert!(twig[0].0.distance(base) > radius);
            let on_line =
                |(at, _): &(DVec3, f64)| (*at - base).normalize_or_zero().dot(outwards) > 0.999;
            assert!(twig.iter().all(on_line));
        }
        for [a, _] in &spines {
            let near = |b: &&[Vec<(DVec3, f64)>; 2]| b[0][0].0.distance(a[0].0) < 1.99 * radius;
            assert_eq!(spines.iter().filter(near).count(), 1, "itself");
        }
    }
}

#[neurotess_testing::test]
fn heads_touch_neither_one_another_nor_neurites() {
    // Two dendrites side by side, with a gap that few spines fit into.
    let mut rows = Vec::new();
    for (first, x) in [(0_u32, 0.0), (2, 1.6)] {
        rows.push(([x, 0.0, 0.0], None));
        rows.push(([x, 60.0, 0.0], Some(first)));
    }
    let node = |(id, (position, parent)): (i64, ([f64; 3], Option<u32>))| Node {
        id,
        kind: NeuriteKind(3),
        position: DVec3::from_array(position),
        radius: 0.4,
        parent,
        section: None,
    };
    let nodes: Vec<Node> = (1..).zip(rows).map(node).collect();
    let two = Morphology::from_nodes("two", Vec::new(), &nodes)
        .expect("two")
        .morphology;
    let (spiny, _) = grown(&two, 1.0, 1);
    let heads: Vec<(DVec3, f64)> = spines(&spiny)
        .iter()
        .map(|[_, twig]| twig[twig.len() - 1])
        .collect();
    assert!(heads.len() > 60, "{}", heads.len());
    for (i, (a, r)) in heads.iter().enumerate() {
        for x in [0.0, 1.6] {
            assert!((a.x - x).hypot(a.z) > r + 0.4, "{a} is in a dendrite");
        }
        assert!(heads[..i].iter().all(|(b, s)| a.distance(*b) > r + s));
    }
}

#[neurotess_testing::test]
fn equal_seeds_give_equal_spines_and_traced_samples_stay() {
    let cell = cell(0.4);
    let (one, _) = grown(&cell, 0.7, 5);
    assert_eq!(one, grown(&cell, 0.7, 5).0);
    assert_ne!(one, grown(&cell, 0.7, 6).0);
    for (point, &id) in cell.points.iter().zip(&cell.sample_ids) {
        let place = one
            .sample_ids
            .iter()
            .position(|&other| other == id)
            .expect("stays");
        assert_eq!(one.points[place].radius, point.radius);
        let [a, b] = [(&cell, point), (&one, &one.points[place])]
            .map(|(m, p)| m.origin + p.position.as_dvec3());
        assert!(a.distance(b) < 1e-4);
    }
    let kinds = |m: &Morphology, id: u32| m.sections[SectionId(id).index()].kind;
    assert_eq!(kinds(&one, 0), NeuriteKind(3));
}

/// Places (µm) as a file's or synapses'.
fn given(places: &[[f64; 3]]) -> SpinePlaces {
    SpinePlaces::At(places.iter().map(|&place| DVec3::from(place)).collect())
}

#[neurotess_testing::test]
fn a_spine_ends_at_its_place_or_leaves_the_membrane_there() {
    // Beyond the membrane of the dendrite along y, on it, and on its axis.
    let places = [[1.5, 20.0, 0.0], [0.0, 40.0, 0.3], [0.0, 60.0, 0.0]];
    let (spiny, report) = at(&cell(0.3), given(&places), 4);
    let spines = spines(&spiny);
    assert_eq!((spines.len(), report.left), (3, 0));
    for ([base, _], place) in spines.iter().zip(places) {
        assert!((base[0].0.y - place[1]).abs() < 1e-4, "{base:?}");
    }
    let end = |spine: usize| {
        let [base, twig] = &spines[spine];
        let &(center, radius) = twig.last().expect("a head");
        center + radius * (center - base[0].0).normalize_or_zero()
    };
    assert!(end(0).distance(DVec3::from(places[0])) < 1e-4, "{}", end(0));
    let outwards = end(1) - spines[1][0][0].0;
    assert!(outwards.normalize_or_zero().z > 0.999 && outwards.z > 0.55);
    let towards = end(2) - DVec3::from(places[2]);
    assert!(towards.y.abs() < 1e-4 && towards.length() > 0.55);
    assert_eq!(spiny, at(&cell(0.3), given(&places), 4).0);
    assert_ne!(spiny, at(&cell(0.3), given(&places), 5).0);
}

#[neurotess_testing::test]
fn places_without_a_dendrite_are_left() {
    let far = 0.3 + SPINE_REACH + 0.1;
    let places = [
        [0.0, 4.9, 1.0],   // the soma
        [0.3, -50.0, 0.0], // the axon
        [far, 50.0, 0.0],  // too far away
        [0.0, f64::NAN, 0.0],
    ];
    let (spiny, report) = at(&cell(0.3), given(&places), 1);
    assert_eq!((spines(&spiny).len(), report.left), (0, 4));
    assert_eq!(report.changed, 0);
    let near = [[far - 0.2, 50.0, 0.0]];
    assert_eq!(spines(&at(&cell(0.3), given(&near), 1).0).len(), 1);
}

#[neurotess_testing::test]
fn where_places_are_too_close_bases_move_on_and_then_are_left() {
    let radius = 0.3;
    let places = [[radius, 50.0, 0.0]; 12];
    let (spiny, report) = at(&cell(radius), given(&places), 1);
    let spines = spines(&spiny);
    assert_eq!(spines.len() + report.left, 12);
    assert!((3..6).contains(&spines.len()), "{}", spines.len());
    for pair in spines.windows(2) {
        let apart = pair[1][0][0].0.y - pair[0][0][0].0.y;
        assert!(apart > 1.99 * radius, "{apart}");
    }
    assert!(
        spines
            .iter()
            .all(|[base, _]| (49.99..52.01).contains(&base[0].0.y))
    );
}

#[neurotess_testing::test]
fn bases_keep_away_from_forks_and_ends_however_many_places_are_there() {
    let radius = 0.3;
    let all = (0..400).map(|i| [0.1 * f64::from(i % 4), 70.0 + 0.1 * f64::from(i), 0.0]);
    let places: Vec<[f64; 3]> = all.collect();
    let (spiny, _) = at(&cell(radius), given(&places), 1);
    let grown = spines(&spiny);
    // The fork is at 106 µm.
    let trunk = grown.iter().filter(|[base, _]| base[0].0.x == 0.0);
    let last = trunk.map(|[base, _]| base[0].0.y).fold(0.0, f64::max);
    assert!(last > 104.0 && last < 106.0 - 1.99 * radius, "{last}");
    for (i, [a, _]) in grown.iter().enumerate() {
        let near = grown[..i]
            .iter()
            .any(|[b, _]| b[0].0.distance(a[0].0) < 1.99 * radius);
        assert!(!near, "{a:?}");
    }
}

#[neurotess_testing::test]
fn shares_of_sections_are_places_too() {
    let cell = cell(0.3);
    let id = |kind: i32| {
        let mut sections = cell.sections.iter();
        let found = sections.position(|section| section.kind == NeuriteKind(kind));
        SectionId(found.expect("a section") as u32)
    };
    let shares = vec![
        (id(3), 0.25),
        (id(2), 0.5),
        (SectionId(99), 0.5),
        (id(3), 1.5),
    ];
    let (spiny, report) = at(&cell, SpinePlaces::Along(shares), 1);
    assert_eq!(report.left, 3);
    let spines = spines(&spiny);
    assert_eq!(spines.len(), 1);
    assert!((spines[0][0][0].0.y - 31.0).abs() < 1e-4);
}

#[neurotess_testing::test]
fn spines_that_a_file_tells_of_move_with_the_cell_and_grow_once() {
    let mut told = cell(0.3);
    told.spines = vec![
        glam::Vec3::new(1.2, 30.0, 0.0),
        glam::Vec3::new(0.0, 70.0, -1.0),
    ];
    let edits = [
        Edit::Scale(DVec3::splat(2.0)),
        Edit::Place(glam::DAffine3::from_translation(DVec3::X * 10.0)),
        Edit::Mirror { axis: 0 },
    ];
    let moved = edit::apply(&told, &edits).expect("moved").morphology;
    let expected = [[-12.4, 60.0, 0.0], [-10.0, 140.0, -2.0]].map(glam::Vec3::from);
    for (spine, expected) in moved.spines.iter().zip(expected) {
        assert!(spine.distance(expected) < 1e-4, "{spine}");
    }
    let (spiny, report) = at(&moved, SpinePlaces::File, 1);
    assert_eq!((spines(&spiny).len(), report.left), (2, 0));
    assert!(spiny.spines.is_empty());
    assert_eq!(at(&spiny, SpinePlaces::File, 1).0, spiny, "none is left");
}
