//! Edits keep what they should, of any tracing.

use std::collections::BTreeSet;
use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;
use neurotess_morphology::edit::{BeforeAfter, Edit, EditError, EditReport, SpinePlaces, apply};
use neurotess_morphology::smoothing::SmoothingLength;
use neurotess_morphology::{Attachment, Measures, Morphology, NeuriteKind, Node, SomaKind, shape};
use proptest::prelude::*;

/// A row: type, place, radius, and how far back its parent stands (0 for none).
type Row = (i32, [f64; 3], f64, u32);

fn built(rows: &[Row]) -> Morphology {
    let node = |(i, &(kind, position, radius, back)): (usize, &Row)| Node {
        id: i as i64 + 1,
        kind: NeuriteKind(kind),
        position: DVec3::from_array(position),
        radius,
        parent: (back > 0)
            .then(|| (i as u32).saturating_sub(back))
            .filter(|_| i > 0),
        section: None,
    };
    let nodes: Vec<Node> = rows.iter().enumerate().map(node).collect();
    Morphology::from_nodes("cell", vec!["a header".into()], &nodes)
        .expect("parents stand before")
        .morphology
}

/// Trees of all kinds, with and without somata, in several pieces.
pub(crate) fn any_tracing() -> impl Strategy<Value = Morphology> {
    let coordinate = -200.0..200.0_f64;
    let back = prop_oneof![8 => Just(1_u32), 4 => 1..9_u32, 1 => Just(0)];
    let kind = prop_oneof![1 => Just(1), 9 => 2..5_i32];
    let row = (kind, prop::array::uniform3(coordinate), 0.05..4.0_f64, back);
    prop::collection::vec(row, 1..80).prop_map(|rows| built(&rows))
}

/// Several free pieces and no soma.
fn free_tracing() -> impl Strategy<Value = Morphology> {
    any_tracing().prop_map(|m| edited(&m, &[Edit::Types(vec![(NeuriteKind(1), NeuriteKind(3))])]).0)
}

fn edited(morphology: &Morphology, edits: &[Edit]) -> (Morphology, Vec<EditReport>) {
    let edited = apply(morphology, edits).expect("possible");
    (edited.morphology, edited.reports)
}

fn every_edit(morphology: &Morphology) -> Vec<Edit> {
    let sample = morphology.sample_ids.last().copied().unwrap_or(1);
    vec![
        Edit::Types(vec![
            (NeuriteKind(2), NeuriteKind(3)),
            (NeuriteKind(3), NeuriteKind(2)),
        ]),
        Edit::Types(vec![
            (NeuriteKind(1), NeuriteKind(7)),
            (NeuriteKind(4), NeuriteKind(1)),
        ]),
        Edit::Scale(DVec3::new(0.1, 0.3, 2.0)),
        Edit::MendRadii {
            outliers: Some(5.0),
        },
        Edit::Join { distance: 50.0 },
        Edit::Subtree { sample },
        Edit::Within { distance: 120.0 },
        Edit::Prune { length: 60.0 },
        Edit::Smooth(SmoothingLength::Auto),
        Edit::Smooth(SmoothingLength::Length(40.0)),
        Edit::Resample { spacing: 30.0 },
        Edit::Simplify { tolerance: 20.0 },
        Edit::Spines {
            places: SpinePlaces::Density(0.05),
            seed: 1,
        },
        Edit::Recenter,
        Edit::Rotate {
            axis: DVec3::new(1.0, 2.0, 3.0),
            angle: 1.0,
        },
        Edit::Mirror { axis: 1 },
    ]
}

/// What every tracing is: see the crate's page.
pub(crate) fn assert_valid(m: &Morphology) {
    assert_eq!(m.points.len(), m.sample_ids.len());
    let mut next = 0;
    for (i, section) in m.sections.iter().enumerate() {
        assert_eq!(section.first, next);
        assert!(section.end > section.first);
        next = section.end;
        match section.attachment {
            Attachment::Section(parent) => assert!(parent.index() < i),
            Attachment::Soma { soma, sample } => {
                assert!((sample as usize) < m.somata[soma as usize].samples.len());
            }
            Attachment::Free => {}
        }
    }
    assert_eq!(next as usize, m.points.len());
    assert!(
        m.points
            .iter()
            .all(|p| p.position.is_finite() && p.radius.is_finite())
    );
    let ids = m.somata.iter().flat_map(|s| s.samples.iter().map(|s| s.id));
    let ids: BTreeSet<i64> = ids.chain(m.sample_ids.iter().copied()).collect();
    let samples: usize = m.somata.iter().map(|s| s.samples.len()).sum();
    assert_eq!(ids.len(), samples + m.points.len(), "numbers are unique");
    // What is put together again is the same: no edit leaves what a file could not say.
    assert_eq!(&edited(m, &[Edit::Types(Vec::new())]).0, m);
}

fn assert_near(a: &Morphology, b: &Morphology, tolerance: f32) {
    assert_eq!(a.sections, b.sections);
    assert_eq!(a.sample_ids, b.sample_ids);
    for (p, q) in a.points.iter().zip(&b.points) {
        let (p_at, q_at) = (
            p.position + a.origin.as_vec3(),
            q.position + b.origin.as_vec3(),
        );
        assert!(p_at.distance(q_at) <= tolerance, "{p_at} {q_at}");
        assert!((p.radius - q.radius).abs() <= tolerance);
    }
}

/// Links between samples by their numbers, whichever of the two is the parent.
pub(crate) fn links(m: &Morphology) -> BTreeSet<(i64, i64)> {
    let mut links = BTreeSet::new();
    for section in &m.sections {
        let mut before = match section.attachment {
            Attachment::Free => None,
            Attachment::Soma { soma, sample } => {
                Some(m.somata[soma as usize].samples[sample as usize].id)
            }
            Attachment::Section(p) => Some(m.sample_ids[m.sections[p.index()].end as usize - 1]),
        };
        for &id in &m.sample_ids[section.range()] {
            if let Some(other) = before.replace(id) {
                links.insert((id.min(other), id.max(other)));
            }
        }
    }
    links
}

pub(crate) fn length(m: &Morphology) -> f64 {
    Measures::of(m).length
}

fn root(m: &Morphology) -> i64 {
    m.sample_ids[0]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(neurotess_testing::cases(64, 256)))]

    #[neurotess_testing::test]
    fn every_edit_gives_a_valid_tracing_and_says_what_it_did(m in any_tracing()) {
        for edit in every_edit(&m) {
            let (after, reports) = edited(&m, std::slice::from_ref(&edit));
            assert_valid(&after);
            let report = &reports[0];
            prop_assert_eq!(report.edit, edit.name());
            prop_assert_eq!(report.sections, BeforeAfter { before: m.sections.len(), after: after.sections.len() });
            prop_assert!((report.length.after - length(&after)).abs() < 1e-9);
            prop_assert_eq!(&after.header, &m.header);
        }
        let all = edited(&m, &every_edit(&m)[2..5]);
        assert_valid(&all.0);
        prop_assert_eq!(all.1.len(), 3);
    }

    #[neurotess_testing::test]
    fn scale_then_its_inverse_gives_the_same(m in any_tracing(), factor in 0.01..100.0) {
        let there_and_back = [factor, 1.0 / factor].map(|f| Edit::Scale(DVec3::splat(f)));
        let (after, reports) = edited(&m, &there_and_back);
        assert_near(&after, &m, 1e-3);
        let expected = reports[0].length.before * factor;
        prop_assert!((reports[0].length.after - expected).abs() <= 1e-4 * expected);
        let exact = [2.0, 0.5].map(|f| Edit::Scale(DVec3::splat(f)));
        prop_assert_eq!(edited(&m, &exact).0, m);
    }

    #[neurotess_testing::test]
    fn turns_and_mirrors_come_back(m in any_tracing(), axis in 0..3_usize) {
        let mirror = Edit::Mirror { axis };
        prop_assert_eq!(&edited(&m, &[mirror.clone(), mirror]).0, &m);
        let quarter = Edit::Rotate { axis: DVec3::AXES[axis], angle: FRAC_PI_2 };
        let (after, reports) = edited(&m, &vec![quarter; 4]);
        assert_near(&after, &m, 1e-2);
        prop_assert!((reports[3].length.after - length(&m)).abs() < 1e-2);
    }

    #[neurotess_testing::test]
    fn recentered_cells_stand_on_the_origin(m in any_tracing()) {
        let after = edited(&m, &[Edit::Scale(DVec3::splat(300.0)), Edit::Recenter]).0;
        let center = after.soma().map(|s| s.center).or(after.points.first().map(|p| p.position));
        let center = center.map(|c| c.as_dvec3() + after.origin).unwrap_or_default();
        // Thirty meters of f32 around the soma.
        prop_assert!(center.length() < 0.05, "{center}");
    }

    #[neurotess_testing::test]
    fn resampling_keeps_forks_ends_and_nearly_the_length(m in any_tracing(), spacing in 1.0..60.0) {
        let (after, reports) = edited(&m, &[Edit::Resample { spacing }]);
        prop_assert_eq!(after.sections.len(), m.sections.len());
        let before = shape::section_lengths(&m);
        let lengths = shape::section_lengths(&after);
        for (i, (section, old)) in after.sections.iter().zip(&m.sections).enumerate() {
            let last = |m: &Morphology, end: u32| m.points[end as usize - 1];
            prop_assert_eq!(last(&after, section.end), last(&m, old.end));
            if section.parent().is_none() && before[i] > 0.0 {
                prop_assert_eq!(after.points[section.first as usize], m.points[old.first as usize]);
            }
            // Of n equal parts each cuts off less than itself at a bend.
            prop_assert!(lengths[i] <= before[i] * (1.0 + 1e-5));
            let links = shape::links(&after, neurotess_morphology::SectionId(i as u32));
            let parts = links.clone().count() as f64;
            if before[i] > 0.0 {
                prop_assert_eq!(parts, (before[i] / spacing).round().max(1.0));
                for (a, b) in links {
                    let way = f64::from(a.position.distance(b.position));
                    prop_assert!(way <= before[i] / parts + 1e-3);
                }
            }
        }
        prop_assert!(reports[0].renumbered);
        // A straight line keeps its length.
        let straight = built(&(0..30).map(|i| (3, [f64::from(i * i), 0.0, 0.0], 1.0, 1)).collect::<Vec<Row>>());
        let resampled = edited(&straight, &[Edit::Resample { spacing }]).0;
        prop_assert!((length(&resampled) - length(&straight)).abs() < 1e-3);
    }

    #[neurotess_testing::test]
    fn simplified_tubes_are_near_the_traced_ones(m in any_tracing(), tolerance in 0.1..60.0) {
        let (after, reports) = edited(&m, &[Edit::Simplify { tolerance }]);
        prop_assert_eq!(after.sections.len(), m.sections.len());
        prop_assert!(reports[0].largest_move <= tolerance);
        let kept: BTreeSet<i64> = after.sample_ids.iter().copied().collect();
        prop_assert!(kept.iter().all(|id| m.sample_ids.contains(id)));
        for (id, point) in m.sample_ids.iter().zip(&m.points) {
            // Each sample that went is within the tolerance of some frustum.
            let near = |i: usize| shape::links(&after, neurotess_morphology::SectionId(i as u32)).any(|(a, b)| {
                let (p, a_at, b_at) = (point.position, a.position, b.position);
                let along = b_at - a_at;
                let t = ((p - a_at).dot(along) / along.length_squared().max(1e-30)).clamp(0.0, 1.0);
                p.distance(a_at + t * along) <= tolerance as f32 + 1e-3
            });
            prop_assert!(kept.contains(id) || (0..after.sections.len()).any(near));
        }
    }

    #[neurotess_testing::test]
    fn rerooting_turns_links_round_and_no_more(m in free_tracing(), pick in any::<prop::sample::Index>()) {
        let sample = *pick.get(&m.sample_ids);
        let (once, reports) = edited(&m, &[Edit::Reroot { sample }]);
        assert_valid(&once);
        prop_assert_eq!(links(&once), links(&m));
        prop_assert!((reports[0].length.after - reports[0].length.before).abs() < 1e-2);
        let again = Edit::Reroot { sample };
        prop_assert_eq!(&edited(&once, &[again]).0, &once);
        // Back at the old root the tree is as it was.
        let pieces = |m: &Morphology| m.sections.iter().filter(|s| s.parent().is_none()).count();
        prop_assert_eq!(pieces(&once), pieces(&m));
        let back = edited(&once, &[Edit::Reroot { sample: root(&m) }]).0;
        let parents = |m: &Morphology| -> BTreeSet<(i64, Option<i64>)> {
            let of = |s: &neurotess_morphology::Section| {
                let mut before = s.parent().map(|p| m.sample_ids[m.sections[p.index()].end as usize - 1]);
                m.sample_ids[s.range()].iter().map(|&id| (id, before.replace(id))).collect::<Vec<_>>()
            };
            m.sections.iter().flat_map(of).collect()
        };
        if pieces(&m) == 1 {
            prop_assert_eq!(parents(&back), parents(&m));
        }
    }

    #[neurotess_testing::test]
    fn joining_leaves_one_piece(m in free_tracing(), with_soma in any::<bool>()) {
        let m = match with_soma {
            true => edited(&m, &[Edit::Types(vec![(NeuriteKind(3), NeuriteKind(1))])]).0,
            false => m,
        };
        let (after, reports) = edited(&m, &[Edit::Join { distance: f64::INFINITY }]);
        assert_valid(&after);
        prop_assert_eq!(reports[0].pieces.after, after.somata.len().max(1));
        prop_assert_eq!(reports[0].left, 0);
        prop_assert!(links(&after).is_superset(&links(&m)));
        prop_assert_eq!(after.points.len(), m.points.len());
        let near = edited(&m, &[Edit::Join { distance: 20.0 }]);
        let joined = near.1[0].pieces.before - near.1[0].pieces.after;
        prop_assert!(near.1[0].length.after <= near.1[0].length.before + 20.0 * joined as f64 + 1e-2);
    }

    #[neurotess_testing::test]
    fn a_subtree_is_what_hangs_on_the_sample(m in any_tracing(), pick in any::<prop::sample::Index>()) {
        prop_assume!(!m.sample_ids.is_empty());
        let sample = *pick.get(&m.sample_ids);
        let (after, reports) = edited(&m, &[Edit::Subtree { sample }]);
        prop_assert!(links(&after).is_subset(&links(&m)));
        prop_assert!(after.somata.len() <= 1);
        prop_assert_eq!(reports[0].pieces.after, 1);
        if after.somata.is_empty() {
            prop_assert_eq!(root(&after), sample);
        }
    }
}

/// A neurite along x with these radii, without a soma.
fn with_radii(radii: &[f64]) -> Morphology {
    let row = |(i, &radius): (usize, &f64)| (3, [10.0 * i as f64, 0.0, 0.0], radius, 1);
    built(&radii.iter().enumerate().map(row).collect::<Vec<Row>>())
}

fn mended(radii: &[f64]) -> (Vec<f32>, EditReport) {
    let mend = Edit::MendRadii {
        outliers: Some(5.0),
    };
    let (after, mut reports) = edited(&with_radii(radii), &[mend]);
    (
        after.points.iter().map(|p| p.radius).collect(),
        reports.remove(0),
    )
}

#[neurotess_testing::test]
fn bad_radii_are_interpolated_along_the_path() {
    let (radii, report) = mended(&[1.0, 0.0, -3.0, 4.0, 0.0]);
    assert_eq!(radii, [1.0, 2.0, 3.0, 4.0, 4.0]);
    assert_eq!((report.changed, report.left), (3, 0));
    let (radii, report) = mended(&[2.0, 2.0, 90.0, 2.0, 1.0, 1.0, 0.01, 1.0]);
    assert_eq!(radii, [2.0, 2.0, 2.0, 2.0, 1.0, 1.0, 1.0, 1.0]);
    assert_eq!(report.largest_radius_change, 88.0);
    // A taper and a bouton are no outliers; without any good radius nothing can be done.
    let taper = [9.0, 7.0, 5.0, 3.5, 2.0, 1.0, 0.5, 0.3];
    assert_eq!(mended(&taper).0, taper.map(|r| r as f32));
    assert_eq!(mended(&[1.0, 1.0, 3.0, 1.0, 1.0]).1.changed, 0);
    assert_eq!(mended(&[0.0, 0.0]).1.left, 2);
}

#[neurotess_testing::test]
fn a_soma_is_as_near_as_its_surface() {
    // A soma of radius 10, a neurite that begins 3 µm outside of it and ends near another piece.
    let cell = built(&[
        (1, [0.0, 0.0, 0.0], 10.0, 0),
        (3, [60.0, 0.0, 0.0], 1.0, 0),
        (3, [13.0, 0.0, 0.0], 1.0, 1),
        (3, [64.0, 0.0, 0.0], 1.0, 0),
    ]);
    let (after, reports) = edited(&cell, &[Edit::Join { distance: 4.0 }]);
    assert_eq!(
        reports[0].pieces,
        BeforeAfter {
            before: 3,
            after: 1
        }
    );
    assert_eq!(after.sample_ids, [3, 2, 4]);
    assert_eq!(
        after.sections[0].attachment,
        Attachment::Soma { soma: 0, sample: 0 }
    );
    let (_, reports) = edited(&cell, &[Edit::Join { distance: 2.0 }]);
    assert_eq!((reports[0].pieces.after, reports[0].left), (3, 2));
}

#[neurotess_testing::test]
fn neurites_join_the_first_of_three_points() {
    let cell = built(&[
        (1, [0.0, 0.0, 0.0], 10.0, 0),
        (1, [0.0, -10.0, 0.0], 10.0, 1),
        (1, [0.0, 10.0, 0.0], 10.0, 2),
        (3, [0.0, 12.0, 0.0], 1.0, 0),
    ]);
    assert_eq!(cell.somata[0].kind, SomaKind::ThreePoint);
    let after = edited(&cell, &[Edit::Join { distance: 4.0 }]).0;
    let first = Attachment::Soma { soma: 0, sample: 0 };
    assert_eq!(after.sections[0].attachment, first);
}

#[neurotess_testing::test]
fn voxels_scale_each_axis() {
    let cell = built(&[
        (2, [10.0, 20.0, 30.0], 4.0, 0),
        (2, [20.0, 20.0, 30.0], 4.0, 1),
    ]);
    let after = edited(&cell, &[Edit::Scale(DVec3::new(0.5, 0.5, 2.0))]).0;
    assert_eq!(after.points[1].position.to_array(), [10.0, 10.0, 60.0]);
    assert_eq!(after.points[1].radius, 2.0);
}

#[neurotess_testing::test]
fn angles_turn_counterclockwise() {
    let cell = built(&[(2, [1.0, 0.0, 0.0], 1.0, 0)]);
    let turn = Edit::Rotate {
        axis: DVec3::Z,
        angle: PI / 2.0,
    };
    let at = edited(&cell, &[turn]).0.points[0].position;
    assert!(at.distance(glam::Vec3::Y) < 1e-6);
}

#[neurotess_testing::test]
fn outlines_stay_outlines() {
    let corner = |i: u32, x: f64, y: f64| Node {
        id: i64::from(i) + 1,
        kind: NeuriteKind::SOMA,
        position: DVec3::new(x, y, 0.0),
        radius: 3.0,
        parent: i.checked_sub(1),
        section: None,
    };
    let nodes = [
        corner(0, -5.0, -5.0),
        corner(1, 5.0, -5.0),
        corner(2, 5.0, 5.0),
        corner(3, -5.0, 5.0),
    ];
    let cell = Morphology::from_outlined_nodes("cell", Vec::new(), &nodes, &[])
        .expect("built")
        .morphology;
    let after = edited(&cell, &[Edit::Scale(DVec3::splat(2.0))]).0;
    assert_eq!(after.somata[0].kind, cell.somata[0].kind);
    assert_eq!(after.somata[0].radius, 2.0 * cell.somata[0].radius);
}

#[neurotess_testing::test]
fn smoothing_takes_noise_and_leaves_ends() {
    let noisy = |i: u32| (3, [f64::from(i), f64::from(i % 2), 0.0], 1.0, 1);
    let cell = built(&(0..50).map(noisy).collect::<Vec<Row>>());
    let (after, reports) = edited(&cell, &[Edit::Smooth(SmoothingLength::Length(5.0))]);
    assert_eq!(
        (after.points[0], after.points[49]),
        (cell.points[0], cell.points[49])
    );
    assert!(reports[0].length.after < 0.8 * reports[0].length.before);
    assert!(reports[0].largest_move > 0.3);
}

#[neurotess_testing::test]
fn what_cannot_be_done_is_an_error() {
    let dendrite = |x: f64| (3, [x, 0.0, 0.0], 1.0, 1);
    let cell = built(&[(1, [0.0; 3], 5.0, 0), dendrite(9.0), dendrite(20.0)]);
    let fails = |edit: Edit| apply(&cell, &[edit]).expect_err("an error");
    assert_eq!(
        fails(Edit::Subtree { sample: 7 }),
        EditError::NoSample {
            sample: 7,
            least: 1,
            most: 3
        }
    );
    assert_eq!(
        fails(Edit::Reroot { sample: 2 }),
        EditError::RootIsSoma { sample: 2 }
    );
    for edit in [
        Edit::Scale(DVec3::new(1.0, 0.0, 1.0)),
        Edit::Scale(DVec3::splat(1e37)),
        Edit::Resample { spacing: f64::NAN },
        Edit::Resample { spacing: 1e-20 },
        Edit::Simplify { tolerance: -1.0 },
        Edit::Spines {
            places: SpinePlaces::Density(1e9),
            seed: 1,
        },
        Edit::Smooth(SmoothingLength::Length(0.0)),
        Edit::Join { distance: f64::NAN },
        Edit::MendRadii {
            outliers: Some(1.0),
        },
        Edit::Rotate {
            axis: DVec3::ZERO,
            angle: 1.0,
        },
        Edit::Rotate {
            axis: DVec3::X,
            angle: f64::INFINITY,
        },
        Edit::Mirror { axis: 3 },
    ] {
        let _ = fails(edit);
    }
    let empty = Morphology::default();
    for edit in every_edit(&empty)
        .into_iter()
        .filter(|e| e.name() != "subtree")
    {
        assert_eq!(edited(&empty, &[edit]).0, empty);
    }
}
