//! ASC and HDF5 written and read back; any bytes at all.

use crate::both_formats::{FORMATS, as_asc, as_h5, assert_same_neurites, codes, from_asc, from_h5};
use neurotess_formats::{ReadOptions, asc, h5, swc};
use neurotess_morphology::Measures;
use proptest::prelude::*;

const CELL: &[u8] = b"# made by hand
1 1 0 0 0 5 -1
2 2 0 -6 0 1 1
3 2 0 -9 0 .5 2
4 4 0 6 0 1 1
5 4 0 9 0 1 4
6 4 3 12 0 .7 5
7 4 -3 12 0 .6 5
8 4 -3 15 0 .6 7
";

#[neurotess_testing::test]
fn a_cell_body_alone_is_a_soma() {
    // Far longer than its line is wide, as a neurite is.
    let text = b"((CellBody) (9 0 0 1) (0 9 0 1) (-9 0 0 1) (0 -9 0 1) (6 -6 0 1))";
    let read = asc::read_bytes(text, "cell.asc", &ReadOptions::default()).expect("it is sound");
    assert!(read.warnings.is_empty(), "{:?}", read.warnings);
    let cell = read.morphology;
    assert_eq!((cell.somata.len(), cell.points.len()), (1, 0));
    for (write, back) in FORMATS {
        let mut bytes = Vec::new();
        write(&cell, &mut bytes);
        let again = back(&bytes);
        assert_eq!((again.somata.len(), again.points.len()), (1, 0));
    }
}

#[neurotess_testing::test]
fn a_sphere_becomes_an_outline_of_its_size_and_all_losses_are_told() {
    let read = swc::read_bytes(CELL, "cell.swc", &ReadOptions::default()).expect("it is sound");
    let cell = read.morphology;
    for (write, back) in FORMATS {
        let mut bytes = Vec::new();
        let losses = write(&cell, &mut bytes);
        assert!(codes(&losses).contains(&"soma_as_outline"));
        let again = back(&bytes);
        assert_same_neurites(&cell, &again);
        let (a, b) = (Measures::of(&cell), Measures::of(&again));
        assert_eq!((a.length, a.area, a.volume), (b.length, b.area, b.volume));
        let soma = again.soma().expect("a soma");
        assert!((soma.radius - 5.0).abs() < 1e-5 && soma.center.length() < 1e-5);
    }
}

#[neurotess_testing::test]
fn types_that_asc_has_not_are_counted() {
    let text = String::from_utf8_lossy(CELL).replace("8 4 -3 15", "8 7 -3 15");
    let read = swc::read_bytes(text.as_bytes(), "cell.swc", &ReadOptions::default());
    let cell = read.expect("it is sound").morphology;
    let losses = as_asc(&cell, &mut Vec::new());
    let changed = losses.iter().find(|w| w.code == "types_changed");
    assert_eq!(changed.map(|w| w.count), Some(1));
    let mut bytes = Vec::new();
    assert!(!codes(&as_h5(&cell, &mut bytes)).contains(&"types_changed"));
    assert_same_neurites(&cell, &from_h5(&bytes));
}

#[neurotess_testing::test]
fn forks_may_be_200_000_deep() {
    let depth = 200_000;
    let down: String = (0..depth)
        .map(|y| format!("(0 {y} 0 1) ((1 {y} 0 1) | "))
        .collect();
    let text = format!("((Axon) {down}(0 -1 0 1){})", ")".repeat(depth));
    let read = asc::read_bytes(text.as_bytes(), "deep.asc", &ReadOptions::default());
    let cell = read.expect("it is sound").morphology;
    assert_eq!(Measures::of(&cell).n_ends, depth + 1);
    for (write, back) in FORMATS {
        let mut bytes = Vec::new();
        write(&cell, &mut bytes);
        assert_same_neurites(&cell, &back(&bytes));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(neurotess_testing::cases(300, 2000)))]
    #[neurotess_testing::test]
    fn any_brackets_are_read_or_refused(
        tokens in proptest::collection::vec(
            prop_oneof![
                Just("("), Just(")"), Just("|"), Just("<"), Just(">"), Just("(Axon)"),
                Just("(CellBody)"), Just("\"CellBody\""), Just("(1 2 3 4)"), Just("(4 3 2 1)"),
                Just("(1 2 3)"), Just("Normal"), Just("(Dot (Color Red) (1 2 3 4))"), Just("\""),
                Just(";"), Just("\n"), Just("(1 2 nan 1)"), Just("(Dendrite)"), Just("x"),
            ],
            0..60,
        ),
    ) {
        let text = tokens.join(" ");
        if let Ok(read) = asc::read_bytes(text.as_bytes(), "any.asc", &ReadOptions::default()) {
            let mut bytes = Vec::new();
            let losses = as_asc(&read.morphology, &mut bytes);
            let again = from_asc(&bytes);
            if !codes(&losses).contains(&"types_changed") {
                assert_same_neurites(&read.morphology, &again);
            }
        }
    }
}

#[neurotess_testing::test]
fn flipped_bytes_of_h5_never_panic() {
    let read = swc::read_bytes(CELL, "cell.swc", &ReadOptions::default()).expect("it is sound");
    let mut bytes = Vec::new();
    as_h5(&read.morphology, &mut bytes);
    for at in 0..bytes.len() {
        for flip in [0x01, 0x80, 0xff] {
            let mut broken = bytes.clone();
            broken[at] ^= flip;
            let _ = h5::read_bytes(broken, "any.h5", &ReadOptions::default());
        }
        let _ = h5::read_bytes(bytes[..at].to_vec(), "any.h5", &ReadOptions::default());
    }
}
