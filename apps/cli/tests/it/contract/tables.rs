//! `neurotess nodes` and `neurotess report`: circuits as tables.

use neurotess::circuit::{Attribute, Circuit, NodeRef, Report, Spikes};

use crate::work::Work;

fn made() -> (Work, Circuit) {
    let work = Work::new();
    work.run("synth circuit -o c --neurons 40 --morphologies 3 --points 100 --reported 6 --seed 9")
        .exits(0);
    let circuit = Circuit::open(work.path("c")).expect("a circuit");
    (work, circuit)
}

/// Rows of a table whose cells have no commas.
fn rows(text: &str) -> Vec<Vec<String>> {
    let row = |line: &str| line.split(',').map(str::to_owned).collect();
    text.lines().map(row).collect()
}

fn number(cell: &str) -> f64 {
    cell.parse().expect("a number")
}

#[neurotess_testing::test]
fn nodes_are_written_with_place_and_attributes() {
    let (work, circuit) = made();
    let table = work.run("nodes c").exits(0).stdout();
    let rows = rows(&table);
    let nodes = &circuit.populations[0];
    assert_eq!(rows.len(), 1 + nodes.len());
    let column = |name: &str| {
        let place = rows[0].iter().position(|head| head == name);
        place.unwrap_or_else(|| panic!("no column {name}: {:?}", rows[0]))
    };
    for (row, found) in rows[1..].iter().enumerate() {
        assert_eq!(found[column("node_id")], nodes.ids[row].to_string());
        let place = ["x", "y", "z"].map(|axis| number(&found[column(axis)]));
        assert_eq!(place, nodes.positions[row].to_array());
        assert_eq!(number(&found[column("rotation_w")]), nodes.rotations[row].w);
        for (name, attribute) in &nodes.attributes {
            let cell = &found[column(name)];
            match attribute {
                Attribute::Text { .. } => assert_eq!(Some(&**cell), attribute.text(row)),
                Attribute::Numbers(_) => assert_eq!(Some(number(cell)), attribute.number(row)),
            }
        }
    }
    // Chosen nodes and columns, in a file with tabs, told as JSON.
    let json = work
        .run("nodes c --nodes 3,5-6 --columns layer --csv n.tsv --json")
        .exits(0)
        .json();
    assert_eq!(json["nodes"], 3);
    let text = work.text("n.tsv");
    assert_eq!(text.lines().count(), 4);
    assert!(
        text.starts_with("population\tnode_id\tmorphology\t"),
        "{text}"
    );
    let again = work.run("nodes c --csv n.tsv").exits(1);
    assert!(again.stderr().contains("--force"), "{}", again.stderr());
    let unknown = work.run("nodes c --columns weather").exits(2);
    assert!(
        unknown
            .stderr()
            .contains("no node has an attribute 'weather'")
    );
}

#[neurotess_testing::test]
fn values_of_a_report_are_written_time_by_time() {
    let (work, _) = made();
    let report = Report::open(work.path("c/reports/voltage.h5")).expect("a report");
    let population = &report.populations[0];
    let nodes = format!("--nodes {},{}", population.nodes[0], population.nodes[1]);
    let table = work
        .run(&format!("report c --report voltage --time 1:3:1 {nodes}"))
        .exits(0);
    let rows = rows(&table.stdout());
    assert_eq!(
        rows[0],
        [
            "time_ms",
            "population",
            "node_id",
            "section",
            "position",
            "value"
        ]
    );
    let mut expected = Vec::new();
    for time in [1.0, 2.0] {
        let frame = population.time.frame_at(time).expect("a frame");
        for index in 0..2 {
            let compartments: Vec<u64> = population.compartment_range(index).collect();
            let values = population.values(frame, &compartments).expect("values");
            expected.extend(
                values
                    .into_iter()
                    .map(|value| (time, population.nodes[index].to_string(), value)),
            );
        }
    }
    let found: Vec<(f64, String, f32)> = rows[1..]
        .iter()
        .map(|row| (number(&row[0]), row[2].clone(), number(&row[5]) as f32))
        .collect();
    assert_eq!(found, expected);
    // The mean of each node.
    let means = work
        .run(&format!(
            "report c --report voltage --time 1 --per node {nodes}"
        ))
        .exits(0);
    let means = self::rows(&means.stdout());
    assert_eq!(means.len(), 3);
    let count = population.compartment_range(0).count();
    let first = expected[..count].iter().map(|row| f64::from(row.2));
    let mean = first.sum::<f64>() / count as f64;
    assert!((number(&means[1][3]) - mean).abs() < 1e-9);
}

#[neurotess_testing::test]
fn spikes_are_written_in_order() {
    let (work, circuit) = made();
    let file = circuit
        .reports
        .values()
        .find(|path| Spikes::open(path).is_ok())
        .cloned()
        .unwrap_or_else(|| work.path("c/spikes.h5"));
    let spikes = Spikes::open(&file).expect("spikes");
    let command = format!("report c --report {}", file.display());
    let rows = rows(&work.run(&command).exits(0).stdout());
    let times: Vec<f64> = rows[1..].iter().map(|row| number(&row[0])).collect();
    assert_eq!(times.len(), spikes.populations[0].times.len());
    assert!(times.is_sorted());
}

#[neurotess_testing::test]
fn what_cannot_be_written_says_why() {
    let (work, circuit) = made();
    let unknown = work.run("report c --report weather").exits(1);
    assert!(
        unknown.stderr().contains("no such report"),
        "{}",
        unknown.stderr()
    );
    let late = work
        .run("report c --report voltage --time 1e6 --csv late.csv")
        .exits(1);
    assert!(
        late.stderr().contains("ms: choose --time"),
        "{}",
        late.stderr()
    );
    assert!(!work.path("late.csv").exists(), "nothing is half written");
    // Cells that are not in the report: an empty table, and a warning.
    let report = Report::open(work.path("c/reports/voltage.h5")).expect("a report");
    let nodes = &circuit.populations[0];
    let missing = (0..nodes.len()).find(|&row| {
        let node = NodeRef {
            population: 0,
            row: row as u32,
        };
        let known = report.populations[0].nodes_in(&circuit).expect("its nodes");
        !known.contains(&node)
    });
    let missing = nodes.ids[missing.expect("six of forty are reported")];
    let none = work
        .run(&format!("report c --report voltage --nodes {missing}"))
        .exits(0);
    assert!(
        none.stderr().contains("the table is empty"),
        "{}",
        none.stderr()
    );
}

#[neurotess_testing::test]
fn a_table_of_nodes_is_a_circuit_again() {
    let (work, circuit) = made();
    work.run("nodes c --csv cells.csv").exits(0);
    let again = Circuit::open(work.path("cells.csv")).expect("a table");
    let (before, after) = (&circuit.populations[0], &again.populations[0]);
    assert!(again.warnings.is_empty() && again.failures.is_empty());
    assert_eq!(
        (&before.ids, &before.positions),
        (&after.ids, &after.positions)
    );
    for (a, b) in before.rotations.iter().zip(&after.rotations) {
        assert!(a.abs_diff_eq(*b, 1e-12), "{a} {b}");
    }
    let file = |circuit: &Circuit, row: usize| {
        let template = circuit.populations[0].templates[row].expect("a morphology");
        circuit.templates[template.index()].path.clone()
    };
    for row in 0..before.len() {
        assert_eq!(file(&circuit, row), file(&again, row));
    }
    let json = work.run("info cells.csv --json").exits(0).json();
    assert_eq!(json[0]["n_neurons"], 40);
}

#[neurotess_testing::test]
fn values_and_spikes_are_drawn() {
    let (work, circuit) = made();
    let report = Report::open(work.path("c/reports/voltage.h5")).expect("a report");
    let population = &report.populations[0];
    let (node, count) = (population.nodes[1], population.compartment_range(1).count());
    let drawn = |options: &str| {
        let figure = work
            .run(&format!("report c {options} --svg -"))
            .exits(0)
            .stdout();
        assert!(
            figure.starts_with("<svg") && figure.ends_with("</svg>\n"),
            "{figure}"
        );
        figure.matches("stroke=\"#").count() - figure.matches("stroke=\"#e4e4e4\"").count()
    };
    assert_eq!(drawn(&format!("--report voltage --nodes {node}")), count);
    let some = format!("--report voltage --nodes {node} --per node --time 0:50");
    assert_eq!(drawn(&some), 1);
    let spikes = Spikes::open(&circuit.reports["spikes"]).expect("spikes");
    let mut firing = spikes.populations[0].nodes.clone();
    firing.sort_unstable();
    firing.dedup();
    assert_eq!(drawn("--report spikes"), firing.len());
    let many = work.run("report c --report voltage --svg v.svg").exits(2);
    assert!(many.stderr().contains("--per node"), "{}", many.stderr());
    assert!(!work.path("v.svg").exists());
    let both = work.run("report c --report voltage --svg v.svg --csv v.csv");
    both.exits(2);
}
