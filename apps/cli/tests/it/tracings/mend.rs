//! `neurotess convert` with edits

use crate::work::{SMALL, Work, sample};

/// Columns of a row: those of the sample with this number.
fn row(text: &str, sample: i64) -> Vec<f64> {
    let rows = text.lines().filter(|line| !line.starts_with('#'));
    let mut rows = rows.map(|line| {
        line.split(' ')
            .map(|n| n.parse().expect("a number"))
            .collect()
    });
    rows.find(|row: &Vec<f64>| row[0] == sample as f64)
        .expect("the sample")
}

#[neurotess_testing::test]
fn edits_are_applied_in_the_order_of_the_help_and_reported() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    let edits = "--mirror x --rotate z=90 --scale 2 --types 3=4,axon=7";
    let json = work
        .run(&format!("convert cell.swc -o out.swc {edits} --json"))
        .exits(0)
        .json();
    let names: Vec<&str> = json[0]["edits"]
        .as_array()
        .expect("a list")
        .iter()
        .map(|edit| edit["edit"].as_str().expect("a name"))
        .collect();
    assert_eq!(names, ["types", "scale", "rotate", "mirror"]);
    let text = work.text("out.swc");
    // (2, 25, 0) becomes (4, 50, 0), (−50, 4, 0), (50, 4, 0).
    assert_eq!(row(&text, 5), [5.0, 4.0, 50.0, 4.0, 0.0, 2.0, 4.0]);
    assert_eq!(row(&text, 2)[1], 7.0);
    let scale = &json[0]["edits"][1];
    let ratio = scale["length"]["after"]
        .as_f64()
        .zip(scale["length"]["before"].as_f64());
    let ratio = ratio
        .map(|(after, before)| after / before)
        .expect("lengths");
    assert!((ratio - 2.0).abs() < 1e-6);
    assert_eq!(scale["changed"], 7);
}

#[neurotess_testing::test]
fn a_dry_run_says_what_a_real_one_does_and_writes_nothing() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    let edits =
        "--units nm --mend-radii --smooth auto --resample 0.004 --simplify 0.001 --recenter";
    let dry = work
        .run(&format!("convert cell.swc --dry-run {edits} --json"))
        .exits(0)
        .json();
    assert_eq!(work.names("."), ["cell.swc"]);
    assert_eq!(dry[0]["dry_run"], true);
    assert!(dry[0]["out"].is_null());
    let told = work
        .run(&format!("convert cell.swc -o out.swc --dry-run {edits}"))
        .exits(0);
    assert!(
        told.stdout().contains("dry run: nothing is written"),
        "{}",
        told.stdout()
    );
    assert!(
        told.stdout().contains("samples have new numbers"),
        "{}",
        told.stdout()
    );
    assert_eq!(work.names("."), ["cell.swc"]);
    let real = work
        .run(&format!("convert cell.swc -o out.swc {edits} --json"))
        .exits(0)
        .json();
    assert_eq!(real[0]["edits"], dry[0]["edits"]);
    assert_eq!(work.names("."), ["cell.swc", "out.swc"]);
}

#[neurotess_testing::test]
fn without_edits_nothing_changes() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    let json = work
        .run("convert cell.swc -o copy.swc --json")
        .exits(0)
        .json();
    assert_eq!(work.text("copy.swc"), SMALL);
    assert_eq!(json[0]["edits"].as_array().map(Vec::len), Some(0));
}

#[neurotess_testing::test]
fn pieces_are_joined_and_rerooted() {
    let work = Work::new();
    // The second piece begins 2 µm from the end of the axon, the third is far away.
    work.file(
        "pieces.swc",
        format!("{SMALL}10 2 0 -50 2 0.5 -1\n11 2 0 -32 2 0.5 10\n20 3 900 0 0 1 -1\n21 3 910 0 0 1 20\n"),
    );
    let json = work
        .run("convert pieces.swc -o out.swc --join 5 --keep-ids --json")
        .exits(0)
        .json();
    let join = &json[0]["edits"][0];
    assert_eq!(
        (&join["pieces"]["before"], &join["pieces"]["after"]),
        (&3.into(), &2.into())
    );
    assert_eq!(join["left"], 1);
    let text = work.text("out.swc");
    assert_eq!((row(&text, 11)[6], row(&text, 10)[6]), (3.0, 11.0));
    let told = work
        .run("convert pieces.swc --join 5 --dry-run")
        .exits(0)
        .stdout();
    assert!(
        told.contains("pieces 3 → 2") && told.contains("1 piece too far from others"),
        "{told}"
    );

    work.run("convert pieces.swc -o rooted.swc --reroot 21 --keep-ids")
        .exits(0);
    assert_eq!(row(&work.text("rooted.swc"), 20)[6], 21.0);
    work.run("convert pieces.swc -o part.swc --subtree 5")
        .exits(0);
    assert_eq!(work.text("part.swc").lines().count(), 4);
}

#[neurotess_testing::test]
fn bad_radii_are_mended_even_if_they_are_no_numbers() {
    let work = Work::new();
    work.file(
        "bad.swc",
        "1 3 0 0 0 1 -1\n2 3 10 0 0 nan 1\n3 3 20 0 0 -4 2\n4 3 30 0 0 4 3\n",
    );
    let refused = work.run("convert bad.swc -o out.swc").exits(1).stderr();
    assert!(
        refused.starts_with("error: bad.swc:2: the radius is nan"),
        "{refused}"
    );
    let json = work
        .run("convert bad.swc -o out.swc --mend-radii --json")
        .exits(0)
        .json();
    assert_eq!(json[0]["edits"][0]["changed"], 2);
    let radii = [2, 3].map(|sample| row(&work.text("out.swc"), sample)[5]);
    assert_eq!(radii, [2.0, 3.0]);
    let outlier = work
        .run("convert bad.swc -o other.swc --mend-radii=100")
        .exits(0);
    assert!(
        outlier.stdout().contains("mend-radii 2 samples changed"),
        "{}",
        outlier.stdout()
    );
}

#[neurotess_testing::test]
fn nanometers_are_hinted_at() {
    let work = Work::new();
    let cell = sample("star.swc");
    work.run(&format!("convert {cell} -o nm.swc --scale 1000"))
        .exits(0);
    for command in ["info nm.swc", "convert nm.swc -o copy.swc"] {
        let said = work.run(command).exits(0).stderr();
        assert!(
            said.contains("--units nm") && said.contains("too_large"),
            "{said}"
        );
    }
    let json = work.run("info nm.swc --json").exits(0).json();
    assert_eq!(json[0]["warnings"][0]["code"], "too_large");
    assert_eq!(json[0]["warnings"][0]["count"], 1);
    // Whoever says the unit needs no hint, and gets the cell back.
    let said = work
        .run("convert nm.swc -o um.swc --units nm")
        .exits(0)
        .stderr();
    assert!(said.is_empty(), "{said}");
    work.run(&format!("diff {cell} um.swc")).exits(0);
    let json = work.run(&format!("info {cell} --json")).exits(0).json();
    assert_eq!(json[0]["warnings"].as_array().map(Vec::len), Some(0));
}

#[neurotess_testing::test]
fn what_cannot_be_edited_fails_alone_and_leaves_no_file() {
    let work = Work::new();
    work.file("cells/a.swc", SMALL);
    work.file("cells/b.swc", "1 3 0 0 0 1 -1\n2 3 9 0 0 1 1\n");
    let run = work.run("convert cells -o out --subtree 7").exits(1);
    let errors: Vec<String> = run.stderr().lines().map(str::to_owned).collect();
    assert_eq!(errors.len(), 1, "{errors:?}");
    assert!(
        errors[0].contains("b.swc: no sample has the number 7"),
        "{errors:?}"
    );
    assert!(work.path("out/a.swc").exists() && !work.path("out/b.swc").exists());
    let run = work.run("convert cells/a.swc -o x.swc --reroot 7").exits(1);
    assert!(
        run.stderr().contains("give the soma another type"),
        "{}",
        run.stderr()
    );
    work.run("convert cells/a.swc -o x.swc --reroot 7 --types soma=3")
        .exits(0);
    work.run("convert cells/a.swc -o y.swc --resample 1e-9")
        .exits(1);
    assert!(!work.path("y.swc").exists());
}

#[neurotess_testing::test]
fn branches_types_far_parts_and_twigs_are_cut_off() {
    let work = Work::new();
    // An axon of 40 µm with a twig of 3 µm at its middle, and two dendrites.
    work.file(
        "cell.swc",
        "1 1 0 0 0 5 -1\n2 2 10 0 0 1 1\n3 2 30 0 0 1 2\n4 2 50 0 0 3 3\n5 2 30 3 0 1 3\n\
         6 3 -10 0 0 1 1\n7 3 -20 0 0 1 6\n8 4 0 10 0 1 1\n9 4 0 30 0 1 8\n",
    );
    let left = |options: &str| {
        work.run(&format!("convert cell.swc -o out.swc --force {options}"))
            .exits(0);
        let text = work.text("out.swc");
        let rows = text.lines().filter(|line| !line.starts_with('#'));
        let number = |line: &str| line.split(' ').next().and_then(|n| n.parse().ok());
        let numbers: Vec<i64> = rows.filter_map(number).collect();
        (numbers, text)
    };
    assert_eq!(left("--cut 3 --cut 9 --cut 4").0, [1, 2, 6, 7, 8]);
    assert_eq!(left("--drop-types axon,4").0, [1, 6, 7]);
    assert_eq!(left("--drop-types dendrite").0, [1, 2, 3, 4, 5]);
    assert_eq!(left("--prune 3.1").0, [1, 2, 3, 4, 6, 7, 8, 9]);
    let (numbers, text) = left("--within 40 --drop-types 3,4 --prune 4");
    assert_eq!(numbers, [1, 2, 3, 6]);
    assert_eq!(row(&text, 6), [6.0, 2.0, 40.0, 0.0, 0.0, 2.0, 3.0]);
    let told = work
        .run("convert cell.swc --dry-run --prune 3.1 --drop-types axon")
        .exits(0)
        .stdout();
    assert!(
        told.contains("drop-types 4 samples changed") && told.contains("prune      0 samples"),
        "{told}"
    );
    for (options, error) in [
        (
            "--cut 3 --cut 77 --cut 88",
            "no samples have the numbers 77, 88",
        ),
        ("--cut 1", "cut leaves nothing of the tracing"),
        (
            "--drop-types soma,dendrite,axon",
            "drop-types leaves nothing of the tracing",
        ),
    ] {
        let run = work
            .run(&format!("convert cell.swc -o none.swc {options}"))
            .exits(1);
        assert!(run.stderr().contains(error), "{}", run.stderr());
    }
    assert!(!work.path("none.swc").exists());
}

#[neurotess_testing::test]
fn wrong_values_are_wrong_usage() {
    let work = Work::new();
    work.file("cell.swc", SMALL);
    for wrong in [
        "--scale 0",
        "--scale -1",
        "--units mm",
        "--units voxel=1,2",
        "--units nm --scale 2",
        "--types 3",
        "--types 3=dendrite",
        "--rotate z",
        "--mirror w",
        "--resample 0",
        "--simplify nan",
        "--smooth 0",
        "--join -3",
        "--reroot a",
        "--cut a",
        "--drop-types branch",
        "--within 0",
        "--prune -1",
        "--mend-radii=1",
    ] {
        let run = work
            .run(&format!("convert cell.swc -o out.swc {wrong}"))
            .exits(2);
        assert!(!run.stderr().is_empty(), "{wrong}");
    }
    work.run("convert cell.swc").exits(2);
    assert_eq!(work.names("."), ["cell.swc"]);
}

#[neurotess_testing::test]
fn spines_become_a_part_of_the_one_closed_membrane() {
    let work = Work::new();
    let granule = sample("granule.swc");
    let json = work
        .run(&format!(
            "convert {granule} -o spiny.swc --spines 1,3 --json"
        ))
        .exits(0)
        .json();
    let sections = &json[0]["edits"][0]["sections"];
    let grown = sections["after"].as_i64().zip(sections["before"].as_i64());
    // Each adds itself and a piece of its dendrite.
    let grown = grown.map(|(after, before)| (after - before) / 2);
    assert!(grown.expect("numbers") > 200, "{grown:?}");
    work.run("mesh spiny.swc -o spiny.ply --level 2").exits(0);
    let judged = work.run("check spiny.ply --json").exits(0).json();
    let judged = &judged[0];
    assert_eq!(judged["closed"], true);
    assert_eq!(
        (&judged["components"], &judged["genus"]),
        (&1.into(), &0.into())
    );
    assert_eq!(judged["self_intersections"], 0, "{judged}");
}
