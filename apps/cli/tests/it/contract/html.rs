//! `neurotess html`: pages. What is in them is tested in `crates/web`.

use crate::work::{SMALL, Work};

#[neurotess_testing::test]
fn a_page_is_one_file_with_its_title() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    let run = work.run("html cell.swc -o cell.html --color-by depth --title Mine --json");
    let told: serde_json::Value = serde_json::from_str(&run.exits(0).stdout()).expect("JSON");
    let page = work.text("cell.html");
    assert!(page.starts_with("<!doctype html>") && page.contains("<title>Mine</title>"));
    assert_eq!(told["bytes"], page.len());
    assert_eq!(told["cells"], serde_json::json!(["cell"]));
    // It is replaced only with --force.
    work.run("html cell.swc -o cell.html").exits(1);
    work.run("html cell.swc -o cell.html --force").exits(0);
    assert!(work.text("cell.html").contains("<title>cell</title>"));
}

#[neurotess_testing::test]
fn circuits_play_in_a_page() {
    let work = Work::new();
    work.run("synth circuit -o c --neurons 12 --morphologies 2 --points 80 --reported 3 --seed 9")
        .exits(0);
    work.run("html c/circuit_config.json -o c.html --report c/reports/voltage.h5 --time 0:10:1")
        .exits(0);
    assert!(work.text("c.html").contains("<title>12 neurons</title>"));
    work.file("cell.swc", SMALL);
    let run = work.run("html cell.swc -o no.html --report c/reports/voltage.h5");
    assert!(run.exits(2).stderr().contains("--report needs a circuit"));
}

#[neurotess_testing::test]
fn a_cell_that_fails_leaves_no_page() {
    let work = Work::new();
    work.file("broken.swc", "1 1 0 0\n");
    work.run("html broken.swc -o broken.html").exits(1);
    assert!(!work.path("broken.html").exists());
}

#[neurotess_testing::test]
fn own_values_come_from_a_table() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    work.file("v.csv", "section,0,0.5\n0,-65,-60\n");
    work.run("html cell.swc -o v.html --values v.csv").exits(0);
    work.file("wrong.csv", "name,value\n1,2\n");
    let run = work.run("html cell.swc -o no.html --values wrong.csv");
    let told = run.exits(1).stderr();
    assert!(told.contains("wrong.csv:1: the first column"), "{told}");
    work.run("html cell.swc -o no.html --color-by value")
        .exits(2);
    assert!(!work.path("no.html").exists());
}
