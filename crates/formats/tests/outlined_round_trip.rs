//! ASC and H5 written and read back; broken files; any bytes at all.

#[allow(dead_code, reason = "tables are for the tests of references")]
mod shared;

use neurotess_formats::{ReadOptions, Warning, asc, h5, read, swc};
use neurotess_morphology::{Measures, Morphology};
use proptest::prelude::*;
use shared::data;

type Write = fn(&Morphology, &mut Vec<u8>) -> Vec<Warning>;
type Read = fn(&[u8]) -> Morphology;

fn as_asc(m: &Morphology, bytes: &mut Vec<u8>) -> Vec<Warning> {
    asc::write(m, bytes).expect("memory takes it")
}

fn as_h5(m: &Morphology, bytes: &mut Vec<u8>) -> Vec<Warning> {
    h5::write(m, bytes).expect("memory takes it")
}

fn from_asc(bytes: &[u8]) -> Morphology {
    let read = asc::read_bytes(bytes, "cell.asc", &ReadOptions::default());
    read.expect("our own file").morphology
}

fn from_h5(bytes: &[u8]) -> Morphology {
    let read = h5::read_bytes(bytes.to_vec(), "cell.h5", &ReadOptions::default());
    read.expect("our own file").morphology
}

const FORMATS: [(Write, Read); 2] = [(as_asc, from_asc), (as_h5, from_h5)];

fn codes(losses: &[Warning]) -> Vec<&str> {
    losses.iter().map(|w| w.code).collect()
}

/// What both formats can say comes back to the bit: positions, radii, sections and their types.
fn assert_same_neurites(a: &Morphology, b: &Morphology) {
    assert_eq!(a.points, b.points);
    let sections = |m: &Morphology| -> Vec<_> {
        let section = |s: &neurotess_morphology::Section| (s.kind, s.first, s.end, s.parent());
        m.sections.iter().map(section).collect()
    };
    assert_eq!(sections(a), sections(b));
}

#[test]
fn shared_files_come_back() {
    let Some(data) = data() else { return };
    let mut files = 0;
    for folder in ["asc", "h5"] {
        let entries = std::fs::read_dir(data.join(folder)).expect("the folder");
        for entry in entries.filter_map(Result::ok) {
            let Ok(cell) = read(entry.path(), &ReadOptions::default()) else {
                assert_eq!(entry.file_name(), "merged.h5", "refused as a container");
                continue;
            };
            let cell = cell.morphology;
            for (write, back) in FORMATS {
                let mut bytes = Vec::new();
                let losses = write(&cell, &mut bytes);
                let again = back(&bytes);
                if !codes(&losses).contains(&"types_changed") {
                    assert_same_neurites(&cell, &again);
                }
                assert_eq!(cell.somata.len(), again.somata.len());
                for (a, b) in cell.somata.iter().zip(&again.somata) {
                    let scale = a.radius + a.center.abs().max_element();
                    assert!((a.radius - b.radius).abs() <= 1e-5 * scale);
                    assert!(a.center.distance(b.center) <= 1e-5 * scale);
                }
                files += 1;
            }
        }
    }
    assert!(files > 40, "only {files}");
}

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

#[test]
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

#[test]
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

#[test]
fn broken_files_are_refused_with_their_place() {
    let Some(data) = data() else { return };
    let said = |name: &str| match read(data.join("malformed").join(name), &ReadOptions::default()) {
        Ok(_) => "read".to_owned(),
        Err(e) => e
            .to_string()
            .split_once(name)
            .expect("the name")
            .1
            .to_owned(),
    };
    for (name, expected) in [
        ("broken-spine.asc", ":14: a spine (<) is not closed"),
        (
            "invalid-incomplete.asc",
            ":15: a branch goes on after the word that ends it",
        ),
        ("unbalanced.asc", ":2: a bracket is not closed"),
        (
            "empty.h5",
            ": the file has no datasets 'points' and 'structure'",
        ),
        ("incorrect_point_columns.h5", ": dataset 'points' has shape"),
        ("monodim.h5", ": dataset 'points' has shape"),
        (
            "simple-negative-section-type.h5",
            ": dataset 'structure', row 6: the type",
        ),
        (
            "reversed_NRN_neurite_order.h5",
            ": dataset 'structure', row 3: the first point",
        ),
        ("truncated.h5", ": "),
        ("not_hdf5.h5", ": the file cannot be read as HDF5"),
    ] {
        let said = said(name);
        assert!(said.starts_with(expected), "{name}{said}");
        assert!(said.contains(": "), "what to do: {said}");
    }
    // Read, with a warning.
    for name in ["simple2.asc", "soma_after_dendrite.h5"] {
        assert_eq!(said(name), "read", "{name}");
    }
}

#[test]
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
    #![proptest_config(ProptestConfig::with_cases(2000))]
    #[test]
    fn any_brackets_are_read_or_refused(
        words in proptest::collection::vec(
            prop_oneof![
                Just("("), Just(")"), Just("|"), Just("<"), Just(">"), Just("(Axon)"),
                Just("(CellBody)"), Just("\"CellBody\""), Just("(1 2 3 4)"), Just("(4 3 2 1)"),
                Just("(1 2 3)"), Just("Normal"), Just("(Dot (Color Red) (1 2 3 4))"), Just("\""),
                Just(";"), Just("\n"), Just("(1 2 nan 1)"), Just("(Dendrite)"), Just("x"),
            ],
            0..60,
        ),
    ) {
        let text = words.join(" ");
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

#[test]
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
