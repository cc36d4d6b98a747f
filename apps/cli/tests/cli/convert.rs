//! `neurotess convert`

use std::fs;

use crate::work::{BROKEN, SMALL, Work};

#[test]
fn swc_becomes_equal_swc() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    let json = work
        .run("convert cell.swc -o copy.swc --json")
        .exits(0)
        .json();
    assert_eq!(json[0]["out"], "copy.swc");
    let rows = |name: &str| fs::read_to_string(work.path(name)).expect("there");
    assert_eq!(rows("copy.swc"), SMALL);
    work.run("convert cell.swc -o copy.swc").exits(1);
    work.run("convert cell.swc -o copy.swc --force").exits(0);
}

#[test]
fn folders_are_converted_and_failures_told() {
    let work = Work::new();
    work.file("cells/a.swc", SMALL);
    work.file("cells/sub/b.swc", BROKEN);
    let run = work.run("convert cells -o out").exits(1);
    assert_eq!(run.errors().len(), 1);
    assert_eq!(work.names("out"), ["a.swc"]);
}

#[test]
fn other_formats_are_refused_with_what_can_be_written() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    let run = work.run("convert cell.swc -o cell.asc").exits(2);
    assert!(run.stderr().contains("'asc'") && run.stderr().contains("writes swc"));
}
