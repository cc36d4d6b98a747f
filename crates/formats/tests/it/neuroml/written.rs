//! What is written as NeuroML reads back equal.

use neurotess_formats::{ReadOptions, neuroml, swc};
use neurotess_morphology::{Measures, Morphology, SomaKind};
use proptest::prelude::*;

fn of_swc(text: &str) -> Morphology {
    let read = swc::read_bytes(text.as_bytes(), "cell.swc", &ReadOptions::default());
    read.expect("it is sound").morphology
}

/// The file, codes of what was lost, and the morphology that comes back.
fn written(cell: &Morphology) -> (String, Vec<&'static str>, Morphology) {
    let mut bytes = Vec::new();
    let lost = neuroml::write(cell, &mut bytes).expect("memory takes it");
    let read = neuroml::read_bytes(&bytes, "cell.nml", &ReadOptions::default());
    let text = String::from_utf8(bytes).expect("text");
    let back = read.unwrap_or_else(|e| panic!("{e}\n{text}")).morphology;
    (text, lost.iter().map(|w| w.code).collect(), back)
}

const CELL: &str = "# a <small> cell & more\n1 1 0 0 0 5 -1\n2 2 0 -9 0 1 1\n3 2 0 -30 2 0.8 2\n\
                    4 3 0 9 0 1.2 1\n5 3 2 25 0 1 4\n6 4 12 40 3 0.7 5\n7 3 -9 42 -4 0.7 5\n8 3 -9 52 -4 0.1 7\n";

#[neurotess_testing::test]
fn a_cell_comes_back_equal() {
    let cell = of_swc(CELL);
    let (text, lost, back) = written(&cell);
    assert_eq!(back, cell);
    assert_eq!(lost, <[&str; 0]>::default());
    for part in [
        "<cell id=\"cell\">",
        "<![CDATA[a <small> cell & more]]>",
        "<segmentGroup id=\"soma_group\" neuroLexId=\"GO:0043025\">",
        "<segmentGroup id=\"dendrite_group\" neuroLexId=\"GO:0030425\">",
    ] {
        assert!(text.contains(part), "{part} in {text}");
    }
}

#[neurotess_testing::test]
fn somata_of_frusta_stay_and_others_become_spheres() {
    let frusta =
        of_swc("1 1 0 0 0 5 -1\n2 1 0 6 0 4 1\n3 1 0 9 0 2 2\n4 3 0 20 0 1 1\n5 3 0 30 0 1 4\n");
    let (_, lost, back) = written(&frusta);
    assert_eq!(back, frusta);
    assert_eq!(lost, <[&str; 0]>::default());
    let outline = of_swc(
        "1 1 5 5 0 0 -1\n2 1 -5 5 0 0 1\n3 1 -5 -5 0 0 2\n4 1 5 -5 0 0 3\n5 3 9 9 0 1 1\n6 3 20 9 0 1 5\n",
    );
    assert_eq!(outline.somata[0].kind, SomaKind::Contour);
    let (_, lost, back) = written(&outline);
    assert_eq!(lost, ["soma_as_sphere", "renumbered"]);
    let [before, after] = [&outline, &back].map(Measures::of);
    assert_eq!((after.soma.kind, after.length), ("point", before.length));
    assert_eq!(after.soma.radius, before.soma.radius);
}

#[neurotess_testing::test]
fn single_points_free_trees_and_custom_types_are_written() {
    // A stem of one point, one that forks at its first point, one whose types differ there, and a free tree.
    let cell = of_swc(
        "1 1 0 0 0 5 -1\n2 2 9 0 0 1 1\n3 3 0 9 0 1 1\n4 3 5 20 0 1 3\n5 3 -5 20 0 1 3\n\
         6 3 0 -9 0 1 1\n7 4 5 -20 0 1 6\n8 4 -5 -20 0 1 6\n9 2 99 0 0 1 -1\n10 2 99 9 0 1 9\n",
    );
    let (_, lost, back) = written(&cell);
    assert_eq!(back, cell);
    assert_eq!(lost, <[&str; 0]>::default());
    let custom = of_swc("1 1 0 0 0 5 -1\n2 7 9 0 0 1 1\n3 7 19 0 0 1 2\n");
    let (_, lost, back) = written(&custom);
    assert_eq!(lost, ["types_lost"]);
    assert_eq!(back.sections[0].kind.0, 0);
    assert_eq!(back.points, custom.points);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(neurotess_testing::cases(200, 1000)))]
    #[neurotess_testing::test]
    fn trees_come_back_equal(
        rows in proptest::collection::vec(
            (any::<u16>(), prop_oneof![3 => Just(3), 1 => Just(2), 1 => Just(4), 1 => Just(0)],
             [-5e4..5e4_f64, -500.0..500.0, -500.0..500.0], 0.01..9.0_f64),
            1..40,
        ),
        has_soma in any::<bool>(),
    ) {
        let mut text = String::new();
        for (i, (parent, kind, [x, y, z], r)) in rows.iter().enumerate() {
            let kind = if has_soma && i == 0 { 1 } else { *kind };
            let parent = if i == 0 { -1 } else { 1 + i64::from(*parent) % i as i64 };
            text.push_str(&format!("{} {kind} {x} {y} {z} {r} {parent}\n", i + 1));
        }
        let cell = of_swc(&text);
        let (_, _, back) = written(&cell);
        prop_assert_eq!(&back.points, &cell.points);
        prop_assert_eq!(&back.sections, &cell.sections);
        prop_assert_eq!(back.origin, cell.origin);
        prop_assert_eq!(back.somata.len(), cell.somata.len());
    }
}
