//! Files of many somata, outlines, stems and children: read in work that grows with them.
//!
//! Compared are the instructions of four times as many with those of as many, both without those of a few, by a wide
//! margin: in proportion they are 4 times as many, where work grows with the square 16 times.

use std::fmt::Write as _;

use neurotess_formats::{ReadOptions, asc, swc};
use neurotess_testing::{counted_case, full, instructions, valgrind};

/// The growth that is allowed: between proportion and a square, nearer to the first.
const MAX_GROWTH: f64 = 9.0;

/// How many make the middle one of three files.
const COUNT: u32 = 4_000;

/// A name, and the text of a file of so many.
type Kind = (&'static str, fn(u32) -> String);

/// `test`: the name of the test that calls this.
fn grows_with(test: &str, kinds: &[Kind], read: fn(&[u8])) {
    if let Some(case) = counted_case() {
        let (name, count) = case.rsplit_once(", ").expect("a name and a count");
        let kind = kinds.iter().find(|(kind, _)| *kind == name);
        let (_, text) = kind.expect("a kind");
        read(text(count.parse().expect("a count")).as_bytes());
        return;
    }
    for (name, _) in kinds {
        let cost = |count: u32| instructions(test, &format!("{name}, {count}")) as f64;
        let [few, some, many] = [8, COUNT, 4 * COUNT].map(cost);
        let growth = (many - few) / (some - few);
        assert!(growth < MAX_GROWTH, "{name}: {growth:.1}");
    }
}

fn rows(head: &str, n: u32, row: impl Fn(u32) -> String) -> String {
    let mut text = head.to_owned();
    for i in 0..n {
        let _ = writeln!(text, "{}", row(i));
    }
    text
}

#[neurotess_testing::test(needs(full, valgrind))]
fn swc_grows_with_its_rows() {
    let kinds: [Kind; 4] = [
        ("lone somata", |n| {
            rows("", n, |i| format!("{} 1 {} 0 0 5 -1", i + 1, 20 * i))
        }),
        ("somata in one place", |n| {
            rows("", n, |i| format!("{} 1 0 0 0 5 -1", i + 1))
        }),
        ("children", |n| {
            let head = "1 1 0 0 0 5 -1\n2 3 0 9 0 1 1\n";
            rows(head, n, |i| format!("{} 3 {i} 20 0 1 2", i + 3))
        }),
        ("stems", |n| {
            rows("1 1 0 0 0 5 -1\n", n, |i| {
                format!("{} 3 {i} 20 0 1 1", i + 2)
            })
        }),
    ];
    grows_with("growth::swc_grows_with_its_rows", &kinds, |text| {
        swc::read_bytes(text, "many.swc", &ReadOptions::default()).expect("a cell");
    });
}

#[neurotess_testing::test(needs(full, valgrind))]
fn asc_grows_with_its_outlines_and_stems() {
    fn body(x: u32) -> String {
        format!("((CellBody) ({x} 0 0 1) ({x} 1 0 1) ({x} 1 1 1))")
    }
    let kinds: [Kind; 3] = [
        ("outlines in a row", |n| rows("", n, |i| body(20 * i))),
        ("outlines in one place", |n| rows("", n, |_| body(0))),
        ("stems of a long outline", |n| {
            let soma = rows("((CellBody)\n", n, |i| {
                format!("({} {} 0 0.1)", f64::from(i) * 0.01, i % 7)
            });
            let x = |i: u32| f64::from(i) * 0.01;
            let stem = |i| format!("((Dendrite) ({} 20 0 1) ({} 30 0 1))", x(i), x(i));
            rows(&(soma + ")\n"), n, stem)
        }),
    ];
    grows_with(
        "growth::asc_grows_with_its_outlines_and_stems",
        &kinds,
        |text| {
            asc::read_bytes(text, "many.asc", &ReadOptions::default()).expect("a cell");
        },
    );
}
