//! What is read, written and read again stays equal: random forests, and trees of great depth.

use std::fmt::Write;

use neurotess_formats::{ReadOptions, swc};
use neurotess_morphology::{Measures, Morphology};
use proptest::prelude::*;

fn read(text: &[u8]) -> Morphology {
    swc::read_bytes(text, "cell.swc", &ReadOptions::default())
        .expect("it is taken")
        .morphology
}

fn written(morphology: &Morphology) -> Vec<u8> {
    let mut text = Vec::new();
    swc::write_numbered(morphology, swc::SampleNumbers::Kept, &mut text).expect("memory");
    text
}

/// One sample: which earlier one it hangs on, its type, position and radius.
type Sample = (u16, i32, [f64; 3], f64);

fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        6 => -500.0..500.0,
        1 => -60_000.0..60_000.0,
        1 => -1e12..1e12,
        1 => 4095.999..4096.001,
        1 => Just(4096.5),
        1 => Just(-4_999.499_999_999_999),
        1 => Just(5_000.499_999_999_999),
        1 => -1e-30..1e-30,
    ]
}

fn forest() -> impl Strategy<Value = Vec<Sample>> {
    let position = [coordinate(), coordinate(), coordinate()];
    let kind = prop_oneof![2 => Just(1), 4 => Just(3), 1 => 0..20];
    proptest::collection::vec((any::<u16>(), kind, position, -0.1..9.0_f64), 1..40)
}

/// Rows in a shuffled order; `seed` decides on it and on the gaps between the numbers.
fn rows(forest: &[Sample], seed: u64) -> String {
    let n = forest.len() as u64;
    let number = |i: usize| 3 + (i as u64 * (1 + seed % 9));
    let mut rows = Vec::new();
    for (i, (parent, kind, [x, y, z], r)) in forest.iter().enumerate() {
        let root = i == 0 || parent % 11 == 0;
        let parent = if root {
            -1
        } else {
            number(usize::from(*parent) % i) as i64
        };
        rows.push(format!("{} {kind} {x} {y} {z} {r} {parent}\n", number(i)));
    }
    if seed.is_multiple_of(3) {
        rows.rotate_left((seed % n) as usize);
    }
    rows.concat()
}

proptest! {
    #[neurotess_testing::test]
    fn forests_come_back_equal(forest in forest(), seed in any::<u64>()) {
        let first = read(rows(&forest, seed).as_bytes());
        let text = written(&first);
        let again = read(&text);
        prop_assert_eq!(&again, &first);
        prop_assert_eq!(written(&again), text);
    }

    #[neurotess_testing::test]
    fn no_sample_is_lost_and_sections_follow_one_another(forest in forest(), seed in any::<u64>()) {
        let cell = read(rows(&forest, seed).as_bytes());
        let in_somata: usize = cell.somata.iter().map(|s| s.samples.len()).sum();
        prop_assert_eq!(in_somata + cell.points.len(), forest.len());
        prop_assert_eq!(cell.sample_ids.len(), cell.points.len());
        let mut end = 0;
        for (i, section) in cell.sections.iter().enumerate() {
            prop_assert!(section.first == end && section.end > end);
            prop_assert!(section.parent().is_none_or(|parent| parent.index() < i));
            end = section.end;
        }
        prop_assert_eq!(end as usize, cell.points.len());
    }
}

/// A fork at every point: `n` nested forks.
fn caterpillar(n: usize) -> String {
    let mut text = String::from("1 1 0 0 0 5 -1\n2 3 0 6 0 1 1\n");
    for i in 0..n {
        let (stem, y) = (2 + 2 * i, 7 + i);
        let _ = writeln!(text, "{} 3 1 {y} 0 0.5 {stem}", stem + 1);
        let _ = writeln!(text, "{} 3 0 {y} 0 1 {stem}", stem + 2);
    }
    text
}

#[neurotess_testing::test]
fn sixty_thousand_nested_forks_are_read_measured_and_written() {
    let cell = read(caterpillar(60_000).as_bytes());
    let measures = Measures::of(&cell);
    assert_eq!(measures.n_bifurcations, 60_000);
    assert_eq!(measures.max_branch_order, 60_000);
    assert_eq!(read(&written(&cell)), cell);
}

#[neurotess_testing::test]
fn sixty_thousand_samples_above_their_parents_are_turned_round() {
    let n = 60_000;
    let mut text = String::new();
    for i in (1..=n).rev() {
        let kind = if i == n { 1 } else { 2 + i % 2 }; // the soma is farthest from the root
        let _ = writeln!(
            text,
            "{i} {kind} 0 {i} 0 1 {}",
            if i == 1 { -1 } else { i as i64 - 1 }
        );
    }
    let cell = read(text.as_bytes());
    assert_eq!((cell.sections.len(), cell.somata.len()), (n - 1, 1));
    assert_eq!(Measures::of(&cell).max_branch_order, 0);
    assert_eq!(read(&written(&cell)), cell);
}

#[neurotess_testing::test]
fn sixty_thousand_somata_in_one_chain_are_one_soma_and_points() {
    let mut text = String::from("1 3 0 0 0 1 -1\n");
    for i in 2..60_000 {
        let _ = writeln!(text, "{i} {} 0 {i} 0 1 {}", 1 + 2 * (i % 2), i - 1);
    }
    let cell = read(text.as_bytes());
    assert_eq!(cell.somata.len(), 1);
    assert_eq!(read(&written(&cell)), cell);
}

/// Formats that hold diameters read what they were given, up to the largest radius.
#[neurotess_testing::test]
fn the_largest_radii_come_back_from_every_format() {
    let cell = read(b"1 1 0 0 0 5 -1\n2 3 0 9 0 9e36 1\n3 3 0 30 0 9e36 2\n");
    for format in neurotess_formats::Format::WRITTEN {
        let mut file = std::io::Cursor::new(Vec::new());
        neurotess_formats::write(&cell, format, &mut file).expect("written");
        let options = ReadOptions::default();
        let back = neurotess_formats::read_bytes(file.into_inner(), "cell", Some(format), &options);
        let back = back.unwrap_or_else(|e| panic!("{format:?}: {e}"));
        let radii = back.morphology.points.iter().map(|point| point.radius);
        assert!(radii.clone().all(|radius| radius == 9e36), "{format:?}");
    }
}
