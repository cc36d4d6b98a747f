//! What edits take away, and what stays.

use glam::DVec3;
use neurotess_morphology::edit::{BeforeAfter, Edit, EditError, EditReport, apply};
use neurotess_morphology::{Morphology, NeuriteKind, Node};
use proptest::prelude::*;

use crate::edits::{any_tracing, assert_valid, length, links};

/// A row: number, type, x, y, radius, number of the parent (0 for none).
type Row = (i64, i32, f64, f64, f64, i64);

/// A soma with an axon that forks at (30, 0) into a twig of 10 µm with one of 3 µm on it and a branch of 40 µm,
/// a dendrite, and a piece apart of 20 µm.
const CELL: [Row; 12] = [
    (1, 1, 0.0, 0.0, 5.0, 0),
    (2, 2, 10.0, 0.0, 2.0, 1),
    (3, 2, 30.0, 0.0, 2.0, 2),
    (4, 2, 30.0, 6.0, 1.0, 3),
    (5, 2, 30.0, 10.0, 1.0, 4),
    (6, 2, 33.0, 6.0, 1.0, 4),
    (7, 2, 70.0, 0.0, 1.0, 3),
    (8, 3, -10.0, 0.0, 1.0, 1),
    (9, 3, -20.0, 0.0, 1.0, 8),
    (10, 4, -60.0, 0.0, 1.0, 9),
    (20, 3, 500.0, 0.0, 1.0, 0),
    (21, 3, 520.0, 0.0, 1.0, 20),
];

fn built(rows: &[Row]) -> Morphology {
    let index = |number: i64| {
        rows.iter()
            .position(|row| row.0 == number)
            .map(|i| i as u32)
    };
    let node = |&(id, kind, x, y, radius, parent): &Row| Node {
        id,
        kind: NeuriteKind(kind),
        position: DVec3::new(x, y, 0.0),
        radius,
        parent: index(parent),
        section: None,
    };
    let nodes: Vec<Node> = rows.iter().map(node).collect();
    let built = Morphology::from_nodes("cell", Vec::new(), &nodes);
    built.expect("parents stand before").morphology
}

fn edited(m: &Morphology, edit: Edit) -> (Morphology, EditReport) {
    let mut edited = apply(m, &[edit]).expect("possible");
    (edited.morphology, edited.reports.remove(0))
}

fn numbers(m: &Morphology) -> Vec<i64> {
    let somata = m.somata.iter().flat_map(|s| s.samples.iter().map(|s| s.id));
    let mut numbers: Vec<i64> = somata.chain(m.sample_ids.iter().copied()).collect();
    numbers.sort_unstable();
    numbers
}

fn cut(samples: &[i64]) -> Edit {
    let samples = samples.to_vec();
    Edit::Cut { samples }
}

#[neurotess_testing::test]
fn a_cut_takes_its_sample_and_all_below_and_no_more() {
    let cell = built(&CELL);
    let (after, report) = edited(&cell, cut(&[4, 9]));
    assert_eq!(numbers(&after), [1, 2, 3, 7, 8, 20, 21]);
    assert_eq!(
        (report.edit, report.changed, report.largest_move),
        ("cut", 5, 0.0)
    );
    // The fork at sample 3 has lost a child: what is left of the axon is one section.
    let axons = after
        .sections
        .iter()
        .filter(|s| s.kind == NeuriteKind::AXON);
    assert_eq!(axons.count(), 1);
    assert_eq!(
        report.sections,
        BeforeAfter {
            before: 8,
            after: 3
        }
    );
    // A sample below another that is cut, and one that is given twice, are no errors.
    assert_eq!(edited(&cell, cut(&[5, 4, 9, 10, 9])).0, after);
    assert_eq!(edited(&cell, cut(&[])).0, cell);
}

#[neurotess_testing::test]
fn a_cut_at_the_soma_takes_its_tree_and_leaves_the_others() {
    let cell = built(&CELL);
    let (after, report) = edited(&cell, cut(&[1]));
    assert_eq!(numbers(&after), [20, 21]);
    assert_eq!(
        report.pieces,
        BeforeAfter {
            before: 2,
            after: 1
        }
    );
    assert!(after.somata.is_empty());
    let three = [
        (1, 1, 0.0, 0.0, 5.0, 0),
        (2, 1, 0.0, -5.0, 5.0, 1),
        (3, 1, 0.0, 5.0, 5.0, 1),
        (4, 3, 9.0, 0.0, 1.0, 1),
        (9, 3, 90.0, 0.0, 1.0, 0),
    ];
    let three = built(&three);
    assert_eq!(numbers(&edited(&three, cut(&[2, 1])).0), [9]);
    let error = apply(&three, &[cut(&[2])]).expect_err("half a soma");
    assert_eq!(
        error,
        EditError::PartOfSoma {
            sample: 2,
            first: 1
        }
    );
}

#[neurotess_testing::test]
fn types_go_and_what_hung_on_them_stays_as_a_piece() {
    let cell = built(&CELL);
    let (after, report) = edited(&cell, Edit::DropTypes(vec![NeuriteKind(3), NeuriteKind(9)]));
    assert_eq!(numbers(&after), [1, 2, 3, 4, 5, 6, 7, 10]);
    assert_eq!((report.edit, report.changed), ("drop_types", 4));
    // The piece apart went, the apical dendrite came apart.
    assert_eq!(
        report.pieces,
        BeforeAfter {
            before: 2,
            after: 2
        }
    );
    let (after, report) = edited(&cell, Edit::DropTypes(vec![NeuriteKind::SOMA]));
    assert_eq!((after.somata.len(), report.pieces.after), (0, 3));
}

#[neurotess_testing::test]
fn what_is_within_a_distance_ends_at_it() {
    let cell = built(&CELL);
    // 20 µm halves the axon between samples 2 and 3; the dendrite has a sample there; the piece counts from its
    // own root.
    let (after, report) = edited(&cell, Edit::Within { distance: 20.0 });
    assert_eq!(numbers(&after), [1, 2, 8, 9, 20, 21, 22]);
    let new = after
        .sample_ids
        .iter()
        .position(|&id| id == 22)
        .expect("new");
    assert_eq!(after.points[new].position.to_array(), [20.0, 0.0, 0.0]);
    assert_eq!(after.points[new].radius, 2.0);
    assert_eq!((report.changed, report.largest_move), (7, 0.0));
    assert_eq!(report.length.after, 10.0 + 10.0 + 20.0);
    // A fork that is crossed on both sides, radii in proportion.
    let after = edited(&cell, Edit::Within { distance: 33.0 }).0;
    let at = |id: i64| {
        let i = after.sample_ids.iter().position(|&other| other == id);
        after.points[i.expect("a sample")]
    };
    assert_eq!(at(22).position.to_array(), [30.0, 3.0, 0.0]);
    assert_eq!((at(22).radius, at(23).position.x), (1.5, 33.0));
    // Neurites that begin beyond go, somata and roots stay.
    let after = edited(&cell, Edit::Within { distance: 1.0 }).0;
    assert_eq!(numbers(&after), [1, 20, 22]);
    let far = edited(&cell, Edit::Within { distance: 1e9 });
    assert_eq!((far.0, far.1.changed), (cell, 0));
}

#[neurotess_testing::test]
fn twigs_are_pruned_once() {
    let cell = built(&CELL);
    let pruned = |length: f64| numbers(&edited(&cell, Edit::Prune { length }).0);
    // A twig of just this length stays.
    assert_eq!(pruned(3.0), numbers(&cell));
    assert_eq!(pruned(3.5), [1, 2, 3, 4, 5, 7, 8, 9, 10, 20, 21]);
    // Both twigs on the branch of 6 µm go, and that stays: it was no twig before.
    assert_eq!(pruned(8.0), [1, 2, 3, 4, 7, 8, 9, 10, 20, 21]);
    // A neurite without a fork is a twig of the soma, of all its types; a piece without a fork is none.
    assert_eq!(pruned(49.9), [1, 2, 3, 4, 8, 9, 10, 20, 21]);
    assert_eq!(pruned(50.1), [1, 2, 3, 4, 20, 21]);
}

#[neurotess_testing::test]
fn what_cannot_be_cut_is_an_error_that_names_it() {
    let cell = built(&CELL);
    let fails = |edit: Edit| apply(&cell, &[edit]).expect_err("an error").to_string();
    assert_eq!(
        fails(cut(&[5, 77])),
        "no sample has the number 77: the numbers are from 1 to 21"
    );
    assert_eq!(
        fails(cut(&[77, 5, -3])),
        "no samples have the numbers 77, -3: the numbers are from 1 to 21"
    );
    assert_eq!(
        fails(cut(&[1, 20])),
        "cut leaves nothing of the tracing: keep at least one sample"
    );
    let all = [1, 2, 3, 4].map(NeuriteKind).to_vec();
    assert!(fails(Edit::DropTypes(all)).starts_with("drop-types leaves nothing"));
    for wrong in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(fails(Edit::Within { distance: wrong }).contains("must be above 0"));
        assert!(fails(Edit::Prune { length: wrong }).contains("must be above 0"));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(neurotess_testing::cases(64, 256)))]

    #[neurotess_testing::test]
    fn what_is_left_of_any_tracing_is_a_part_of_it(m in any_tracing(), size in 1.0..400.0) {
        let (pruned, report) = edited(&m, Edit::Prune { length: size });
        assert_valid(&pruned);
        prop_assert!(links(&pruned).is_subset(&links(&m)));
        prop_assert_eq!(report.pieces.before, report.pieces.after);
        let (near, report) = edited(&m, Edit::Within { distance: size });
        assert_valid(&near);
        prop_assert!(length(&near) <= length(&m) + 1e-3);
        prop_assert_eq!(report.pieces.before, report.pieces.after);
        // What was cut there is not cut much shorter by cutting there again.
        let again = edited(&near, Edit::Within { distance: size }).0;
        prop_assert!((length(&again) - length(&near)).abs() < 0.05);
    }
}
