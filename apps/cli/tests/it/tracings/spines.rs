//! `neurotess convert --spines`: where spines grow.

use serde_json::Value;

use crate::work::Work;

const ASC: &str =
    "((Dendrite) (0 0 0 1) (0 20 0 1) <(1.5 21 0 1)> (0 40 0 1) <(-1.2 35 0 1)> (0 60 0 1))";

/// Spines that were grown, and those that were left.
fn grown(document: &Value) -> [i64; 2] {
    let edits = document[0]["edits"].as_array().expect("a list");
    let spines = edits.iter().find(|edit| edit["edit"] == "spines");
    let spines = spines.expect("the edit");
    let sections = ["after", "before"].map(|when| spines["sections"][when].as_i64());
    let [after, before] = sections.map(|n| n.expect("a number"));
    // Each adds itself and a piece of its dendrite.
    [
        (after - before) / 2,
        spines["left"].as_i64().expect("a number"),
    ]
}

#[neurotess_testing::test]
fn spines_that_an_asc_file_tells_of_are_grown() {
    let work = Work::new();
    work.file("cell.asc", ASC);
    let run = work
        .run("convert cell.asc -o spiny.swc --spines file --json")
        .exits(0);
    assert_eq!(grown(&run.json()), [2, 0]);
    // Without the option they are lost, and that is said.
    let lost = work.run("convert cell.asc -o plain.swc").exits(0).stderr();
    assert!(lost.contains("spines_lost"), "{lost}");
    work.run("mesh spiny.swc -o spiny.ply --level 3").exits(0);
    let judged = work.run("check spiny.ply --json").exits(0).json();
    let judged = &judged[0];
    assert_eq!(
        (&judged["closed"], &judged["components"]),
        (&true.into(), &1.into())
    );
    assert_eq!(judged["self_intersections"], 0, "{judged}");
    // A mesh may leave them out: as many faces as that of the cell without them, give or take the bases' points.
    let faces = |file: &str, options: &str| {
        let made = work.run(&format!(
            "mesh {file} -o {file}.ply --level 1 --force --json {options}"
        ));
        let json = made.exits(0).json();
        json[0]["triangles"].as_i64().expect("a number")
    };
    let types = "--types axon,dendrite";
    let [all, without] = ["", types].map(|options| faces("spiny.swc", options));
    let plain = faces("plain.swc", "");
    assert!(
        all > without && without <= plain + 64,
        "{all} {without} {plain}"
    );
}

#[neurotess_testing::test]
fn a_table_has_places_of_one_cell() {
    let work = Work::new();
    work.file("cell.asc", ASC);
    work.file("at.csv", "x,y,z\n0.5,10,0\n90,0,0\n");
    work.file("along.csv", "section,position\n1,0.5\n0,0.5\n");
    for table in ["at.csv", "along.csv,3"] {
        let run = work.run(&format!(
            "convert cell.asc -o out.swc --force --spines {table} --json"
        ));
        assert_eq!(grown(&run.exits(0).json()), [1, 1], "{table}");
    }
    work.file("cells/a.asc", ASC);
    work.run("convert cells -o out --spines at.csv").exits(2);
    let run = work
        .run("convert cell.asc -o none.swc --spines none.csv")
        .exits(1);
    assert!(run.stderr().contains("none.csv"), "{}", run.stderr());
    let run = work
        .run("convert cell.asc -o none.swc --spines synapses")
        .exits(2);
    assert!(
        run.stderr().contains("of the cells of a circuit"),
        "{}",
        run.stderr()
    );
}

#[neurotess_testing::test]
fn cells_of_a_circuit_are_written_with_spines_at_their_synapses() {
    let work = Work::new();
    work.run(
        "synth circuit -o c --neurons 12 --morphologies 3 --points 300 --reported 4 --synapses 40",
    )
    .exits(0);
    let run = work
        .run("convert c --nodes 3 -o 3.swc --spines synapses --json")
        .exits(0);
    let document = run.json();
    assert_eq!(document[0]["node"]["node_id"], 3);
    assert_eq!(document[0]["edits"][0]["edit"], "place");
    let [spines, left] = grown(&document);
    assert!(spines > 20 && spines + left == 40, "{spines} and {left}");
    // It is where the circuit has it.
    let nodes = work.run("nodes c --nodes 3 --csv -").exits(0).stdout();
    let row: Vec<&str> = nodes.lines().nth(1).expect("a row").split(',').collect();
    let at = row.iter().filter_map(|field| field.parse::<f64>().ok());
    let at: Vec<f64> = at.skip(1).take(3).collect();
    let text = work.text("3.swc");
    let soma = text
        .lines()
        .find(|line| !line.starts_with('#'))
        .expect("a row");
    let soma: Vec<f64> = soma
        .split(' ')
        .map(|n| n.parse().expect("a number"))
        .collect();
    for (soma, at) in soma[2..5].iter().zip(at) {
        assert!((soma - at).abs() < 0.01, "{soma} {at}");
    }
    // Several cells go into a folder.
    work.run("convert c --nodes 1,2 -o cells --format asc")
        .exits(0);
    let names = work.names("cells");
    assert_eq!(names, ["cortex_1.asc", "cortex_2.asc"]);
    work.run("convert c --nodes 1 -o 1.swc --scale 2").exits(2);
    work.run("convert 3.swc -o 4.swc --nodes 1").exits(2);
}
