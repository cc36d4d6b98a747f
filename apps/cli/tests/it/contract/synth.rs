//! `neurotess synth`

use crate::work::Work;

#[neurotess_testing::test]
fn the_seed_decides() {
    let work = Work::new();
    let json = work
        .run("synth star -o a.swc --seed 7 --points 300 --json")
        .exits(0)
        .json();
    assert_eq!(json[0]["seed"], 7);
    work.run("synth star -o b.swc --seed 7 --points 300")
        .exits(0);
    work.run("synth star -o c.swc --seed 8 --points 300")
        .exits(0);
    let read = |name: &str| std::fs::read(work.path(name)).expect("there");
    assert_eq!(read("a.swc"), read("b.swc"));
    assert_ne!(read("a.swc"), read("c.swc"));
    work.run("synth star -o a.swc").exits(1);
}

#[neurotess_testing::test]
fn branches_cross_only_if_they_may() {
    let work = Work::new();
    let pairs = |options: &str, name: &str| {
        let grow = format!("synth purkinje -o {name}.swc --points 1000 {options}");
        work.run(&grow).exits(0);
        work.run(&format!("mesh {name}.swc -o {name}.ply --level 2"))
            .exits(0);
        let json = work.run(&format!("check {name}.ply --json")).json();
        json[0]["self_intersections"].as_u64().expect("a number")
    };
    let (clear, crossing) = (pairs("", "clear"), pairs("--may-cross", "crossing"));
    assert!(clear < 10 && crossing > 100, "{clear}, {crossing}");
}

#[neurotess_testing::test]
fn many_cells_are_distinct_and_mesh() {
    let work = Work::new();
    work.run("synth pyramidal -o cells --count 4 --points 200")
        .exits(0);
    let files = work.files("cells");
    assert_eq!(files.len(), 4);
    let distinct: std::collections::BTreeSet<_> = files.values().collect();
    assert_eq!(distinct.len(), 4);
    let json = work
        .run("mesh cells -o out --json --level 1")
        .exits(0)
        .json();
    for cell in json.as_array().expect("a list") {
        assert_eq!(
            (&cell["closed"], &cell["euler"]),
            (&true.into(), &2.into()),
            "{cell}"
        );
    }
}

#[neurotess_testing::test]
fn every_kind_grows() {
    let work = Work::new();
    for kind in [
        "pyramidal",
        "purkinje",
        "granule",
        "basket",
        "motor",
        "star",
    ] {
        work.run(&format!("synth {kind} -o {kind}.swc --points 100"))
            .exits(0);
        work.run(&format!("info {kind}.swc --strict")).exits(0);
    }
}
