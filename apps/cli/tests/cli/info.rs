//! `neurotess info`

use std::fs;
use std::path::Path;

use crate::work::{BROKEN, SMALL, Work};

#[neurotess_testing::test]
fn has_the_keys_of_the_contract() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    let run = work.run("info cell.swc --json").exits(0);
    insta::assert_json_snapshot!(run.json());
}

#[neurotess_testing::test]
fn samples_are_as_recorded() {
    let samples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples");
    let mut paths: Vec<_> = fs::read_dir(&samples)
        .expect("the samples are part of the repository")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|e| e == "swc"))
        .collect();
    paths.sort();
    assert!(!paths.is_empty());
    let work = Work::new();
    for path in paths {
        let name = path
            .file_name()
            .expect("a name")
            .to_string_lossy()
            .into_owned();
        fs::copy(&path, work.path(&name)).expect("copied");
        let run = work.run(&format!("info {name} --json")).exits(0);
        insta::assert_json_snapshot!(format!("sample_{name}"), run.json());
    }
}

#[neurotess_testing::test]
fn people_get_a_table() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    let one = work.run("info cell.swc").exits(0);
    insta::assert_snapshot!("table_of_one", one.stdout());
    work.file("other.swc", "1 3 0 0 0 1 -1\n2 3 0 9 0 1 1\n");
    let two = work.run("info cell.swc other.swc").exits(0);
    insta::assert_snapshot!("table_of_two", two.stdout());
}

#[neurotess_testing::test]
fn failures_are_lines_and_the_others_are_done() {
    let work = Work::new();
    work.file("cells/a.swc", SMALL);
    work.file("cells/b.swc", BROKEN);
    work.file("cells/c.swc", "");
    let run = work.run("info cells --json").exits(1);
    let json = run.json();
    assert_eq!(json[0]["n_points"], 6);
    assert!(json[1]["error"].is_string() && json[2]["error"].is_string());
    let errors = run.errors();
    assert_eq!(errors.len(), 2, "{}", run.stderr());
    let file = Path::new("cells").join("b.swc");
    assert!(errors[0].starts_with(&format!("error: {}:2: 6 columns", file.display())));
}

#[neurotess_testing::test]
fn strict_turns_warnings_into_errors() {
    let work = Work::new();
    work.file("free.swc", "1 3 0 0 0 1 -1\n2 3 0 9 0 1 1\n");
    let json = work.run("info free.swc --json").exits(0).json();
    let warning = &json[0]["warnings"][0];
    assert!(warning["line"].is_u64() && warning["code"].is_string());
    assert!(warning["message"].is_string());
    let run = work.run("info free.swc --strict").exits(1);
    assert!(run.errors()[0].contains("--strict"), "{}", run.stderr());
    work.file("cell.swc", SMALL);
    work.run("info cell.swc --strict").exits(0);
}
