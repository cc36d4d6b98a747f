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

#[neurotess_testing::test]
fn what_lies_between_two_samples_is_measured() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    let arguments = "info cell.swc --between 7 3 --between soma 6";
    let json = work.run(&format!("{arguments} --json")).exits(0).json();
    let [across, down] = [0, 1].map(|i| &json[0]["between"][i]);
    let near = |value: &serde_json::Value, expected: f64| {
        let number = value.as_f64().expect("a number");
        assert!((number - expected).abs() < 1e-4, "{number}, not {expected}");
    };
    // (2, 25, 0) to (12, 40, 3) and to (-9, 42, -4); (0, 9, 0) to (2, 25, 0); (0, -9, 0) to (0, -30, 2).
    let [to_6, to_7] = [(334_f64).sqrt(), (426_f64).sqrt()];
    let (trunk, axon) = (260_f64.sqrt(), 445_f64.sqrt());
    near(&across["path"]["length"], to_7 + trunk + 9.0 + 9.0 + axon);
    near(&across["path"]["in_soma"], 18.0);
    near(&across["distance"], (81.0 + 72.0 * 72.0 + 36.0_f64).sqrt());
    near(&across["from"]["diameter"], 1.4);
    near(&across["from"]["path_from_soma"], to_7 + trunk);
    assert_eq!(across["path"]["forks"][0]["sample"], 5);
    // 10 × -11 + 15 × 17 + 3 × -4 = 133.
    let angle = (133.0 / (to_6 * to_7)).acos();
    near(&across["path"]["forks"][0]["local_angle"], angle);
    assert_eq!(down["from"]["sample"], "soma");
    near(&down["path"]["length"], 9.0 + trunk + to_6);
    let text = work.run(arguments).exits(0).stdout();
    insta::assert_snapshot!("between", text);
    // Several files: below the line of each. What is not there is an error of that file.
    work.file("other.swc", "1 3 0 0 0 1 -1\n2 3 0 9 0 1 1\n");
    let run = work.run("info cell.swc other.swc --between 1 2").exits(0);
    assert_eq!(run.stdout().matches("distance 9.00 µm").count(), 2);
    let run = work.run("info cell.swc other.swc --between 1 7").exits(1);
    assert!(
        run.errors()[0].contains("sample 7 is not there"),
        "{}",
        run.stderr()
    );
    work.run("info cell.swc --between 1").exits(2);
    work.run("info cell.swc --between 1 axon").exits(2);
}
