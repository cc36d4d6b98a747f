//! Files of many somata, outlines, stems and children: read in a time that grows with them.
//!
//! What is compared is the work of twice as many with that of as many, by a wide margin: work that grows
//! with the square takes four times as long.

use std::fmt::Write as _;
use std::time::Instant;

use neurotess_formats::{ReadOptions, asc, swc};

/// Least seconds of three.
fn seconds(read: impl Fn()) -> f64 {
    let once = |_| {
        let clock = Instant::now();
        read();
        clock.elapsed().as_secs_f64()
    };
    (0..3).map(once).fold(f64::MAX, f64::min)
}

fn grows_with(name: &str, text: impl Fn(u32) -> String, read: impl Fn(&[u8])) {
    let [one, four] = [10_000, 40_000].map(|n| {
        let text = text(n);
        seconds(|| read(text.as_bytes()))
    });
    // In proportion 4, with the square 16; a few milliseconds are lost in the noise.
    assert!(four < 9.0 * one + 0.05, "{name}: {one} s then {four} s");
}

fn rows(head: &str, n: u32, row: impl Fn(u32) -> String) -> String {
    let mut text = head.to_owned();
    for i in 0..n {
        let _ = writeln!(text, "{}", row(i));
    }
    text
}

#[test]
fn swc_grows_with_its_rows() {
    let read = |text: &[u8]| {
        swc::read_bytes(text, "many.swc", &ReadOptions::default()).expect("a cell");
    };
    let lone = |n| rows("", n, |i| format!("{} 1 {} 0 0 5 -1", i + 1, 20 * i));
    grows_with("lone somata", lone, read);
    let in_one_place = |n| rows("", n, |i| format!("{} 1 0 0 0 5 -1", i + 1));
    grows_with("somata in one place", in_one_place, read);
    let children = |n| {
        let head = "1 1 0 0 0 5 -1\n2 3 0 9 0 1 1\n";
        rows(head, n, |i| format!("{} 3 {i} 20 0 1 2", i + 3))
    };
    grows_with("children", children, read);
    let stems = |n| {
        rows("1 1 0 0 0 5 -1\n", n, |i| {
            format!("{} 3 {i} 20 0 1 1", i + 2)
        })
    };
    grows_with("stems", stems, read);
}

#[test]
fn asc_grows_with_its_outlines_and_stems() {
    let read = |text: &[u8]| {
        asc::read_bytes(text, "many.asc", &ReadOptions::default()).expect("a cell");
    };
    let body = |x: u32| format!("((CellBody) ({x} 0 0 1) ({x} 1 0 1) ({x} 1 1 1))");
    grows_with("outlines in a row", |n| rows("", n, |i| body(20 * i)), read);
    grows_with("outlines in one place", |n| rows("", n, |_| body(0)), read);
    let stems = |n| {
        let soma = rows("((CellBody)\n", n, |i| {
            format!("({} {} 0 0.1)", f64::from(i) * 0.01, i % 7)
        });
        let x = |i: u32| f64::from(i) * 0.01;
        let stem = |i| format!("((Dendrite) ({} 20 0 1) ({} 30 0 1))", x(i), x(i));
        rows(&(soma + ")\n"), n, stem)
    };
    grows_with("stems of a long outline", stems, read);
}
