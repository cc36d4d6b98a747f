//! `neurotess convert`

use crate::work::{BROKEN, SMALL, Work};

#[neurotess_testing::test]
fn swc_becomes_equal_swc() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    let json = work
        .run("convert cell.swc -o copy.swc --json")
        .exits(0)
        .json();
    assert_eq!(json[0]["out"], "copy.swc");
    let rows = |name: &str| work.text(name);
    assert_eq!(rows("copy.swc"), SMALL);
    work.run("convert cell.swc -o copy.swc").exits(1);
    work.run("convert cell.swc -o copy.swc --force").exits(0);
}

#[neurotess_testing::test]
fn folders_are_converted_and_failures_reported() {
    let work = Work::new();
    work.file("cells/a.swc", SMALL);
    work.file("cells/sub/b.swc", BROKEN);
    let run = work.run("convert cells -o out").exits(1);
    assert_eq!(run.errors().len(), 1);
    assert_eq!(work.names("out"), ["a.swc"]);
}

#[neurotess_testing::test]
fn formats_turn_into_one_another_and_losses_are_reported() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    for (from, to) in [
        ("cell.swc", "a.asc"),
        ("a.asc", "b.h5"),
        ("b.h5", "c.asc"),
        ("c.asc", "d.swc"),
        ("cell.swc", "g.cell.nml"),
    ] {
        work.run(&format!("convert {from} -o {to}")).exits(0);
    }
    let measures = |name: &str| {
        let info = work.run(&format!("info {name} --json")).exits(0).json();
        [
            "length",
            "area",
            "volume",
            "n_sections",
            "n_ends",
            "length_by_type",
        ]
        .map(|key| info[0][key].clone())
    };
    assert_eq!(measures("cell.swc"), measures("d.swc"));
    assert_eq!(measures("cell.swc"), measures("g.cell.nml"));
    let json = work.run("convert cell.swc -o e.asc --json").exits(0).json();
    let lost = json[0]["lost"].as_array().expect("a list");
    assert!(lost.iter().any(|w| w["code"] == "soma_as_outline"));
    let said = work.run("convert cell.swc -o f.asc").exits(0).stderr();
    assert!(said.contains("soma_as_outline"), "{said}");
    work.run("mesh b.h5 -o b.ply").exits(0);
    work.run("convert cell.swc -o folder/ --format h5").exits(0);
    assert_eq!(work.names("folder"), ["cell.h5"]);
}

#[neurotess_testing::test]
fn other_formats_are_refused_with_what_can_be_written() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    for name in ["cell.traces", "cell.obj", "cell"] {
        let run = work.run(&format!("convert cell.swc -o {name}")).exits(2);
        assert!(
            run.stderr().contains("use swc, asc, h5, nml"),
            "{}",
            run.stderr()
        );
    }
}
