//! `neurotess diff`

use crate::work::{SMALL, Work, sample};

#[neurotess_testing::test]
fn the_same_cell_is_the_same_in_other_numbers() {
    let work = Work::new();
    work.file("a.swc", SMALL);
    work.file(
        "b.swc",
        SMALL
            .replace("7 3 -9", "70 3 -9")
            .replace("42 -4", "42.0004 -4"),
    );
    let run = work.run("diff a.swc b.swc").exits(0);
    assert!(
        run.stdout().contains("are the same within 0.001 µm"),
        "{}",
        run.stdout()
    );
    assert_eq!(
        work.run("diff a.swc b.swc --json").exits(0).json()["same"],
        true
    );
    let exact = work
        .run("diff a.swc b.swc --tolerance 0 --json")
        .exits(1)
        .json();
    assert_eq!(
        (&exact["moved"]["count"], &exact["matched_by"]),
        (&1.into(), &"order".into())
    );
}

#[neurotess_testing::test]
fn each_difference_is_named_with_its_samples() {
    let work = Work::new();
    work.file("a.swc", SMALL);
    let changed = SMALL
        .replace("3 2 0 -30 2 0.8", "3 2 0 -30 5 0.9")
        .replace("7 3 -9", "7 4 -9")
        .replace("1 1 0 0 0 5", "1 1 0 0 0 6");
    work.file("b.swc", changed);
    let json = work.run("diff a.swc b.swc --json").exits(1).json();
    assert_eq!(json["same"], false);
    assert_eq!(json["moved"]["samples"][0], 3);
    assert!((json["moved"]["largest"].as_f64().expect("a length") - 3.0).abs() < 1e-6);
    assert_eq!(json["radii"]["count"], 1);
    assert_eq!(
        (&json["retyped"][0]["from"], &json["retyped"][0]["to"]),
        (&3.into(), &4.into())
    );
    assert_eq!(
        (
            &json["soma"]["radius"]["before"],
            &json["soma"]["radius"]["after"]
        ),
        (&5.0.into(), &6.0.into())
    );
    assert_eq!(json["only_in_first"]["count"], 0);
    let text = work.run("diff a.swc b.swc").exits(1);
    assert!(text.stderr().is_empty(), "{}", text.stderr());
    for line in [
        "moved      1 sample by up to 3.0000 µm: 3",
        "basal_dendrite → apical_dendrite: 1 sample",
    ] {
        assert!(text.stdout().contains(line), "{}", text.stdout());
    }
}

#[neurotess_testing::test]
fn what_was_cut_off_or_added_is_found() {
    let work = Work::new();
    work.file("a.swc", SMALL);
    work.run("convert a.swc -o part.swc --subtree 4").exits(0);
    let json = work.run("diff a.swc part.swc --json").exits(1).json();
    assert_eq!(json["matched_by"], "number");
    assert_eq!(json["only_in_first"]["samples"], serde_json::json!([2, 3]));
    assert_eq!(json["soma"]["kind"]["after"], "none");
    let cell = sample("granule.swc");
    work.run(&format!("convert {cell} -o resampled.swc --resample 3"))
        .exits(0);
    let json = work
        .run(&format!("diff {cell} resampled.swc --json"))
        .exits(1)
        .json();
    assert_eq!(json["matched_by"], "place");
    assert_eq!(json["forks"]["before"], json["forks"]["after"]);
    assert_eq!(
        (&json["moved"]["count"], &json["types"]["count"]),
        (&0.into(), &0.into())
    );
}

#[neurotess_testing::test]
fn what_cannot_be_read_is_an_error_with_a_document() {
    let work = Work::new();
    work.file("a.swc", SMALL);
    let run = work.run("diff a.swc missing.swc --json").exits(1);
    assert!(
        run.stderr()
            .starts_with("error: missing.swc: cannot be read"),
        "{}",
        run.stderr()
    );
    assert!(run.json()["errors"][0].is_string());
    for wrong in ["diff a.swc", "diff - -", "diff a.swc a.swc --tolerance -1"] {
        work.run(wrong).exits(2);
    }
}
