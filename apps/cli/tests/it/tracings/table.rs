//! `neurotess info --table`

use crate::work::{SMALL, Work};

/// The column of a name, row by row.
fn column(text: &str, name: &str, separator: char) -> Vec<String> {
    let mut lines = text
        .lines()
        .map(|line| line.split(separator).collect::<Vec<_>>());
    let header = lines.next().expect("a header");
    let index = header.iter().position(|n| *n == name).expect("the column");
    lines.map(|line| line[index].to_owned()).collect()
}

/// Two cells.
fn cells() -> Work {
    let work = Work::new();
    work.file("cells/a.swc", SMALL);
    work.file("cells/b.swc", "1 3 0 0 0 1 -1\n2 3 9 0 0 1 1\n");
    work
}

#[neurotess_testing::test]
fn all_tracings_are_in_one_table() {
    let work = cells();
    let text = work
        .run("info cells --table - --sholl 20")
        .exits(0)
        .stdout();
    assert_eq!(column(&text, "number_of_points", ','), ["6", "2"]);
    assert_eq!(column(&text, "soma_kind", ','), ["point", "none"]);
    assert_eq!(
        column(&text, "max_section_strahler_orders", ','),
        ["2", "1"]
    );
    // The axon ends at 30, the dendrite forks at 25 and ends at 42 and 43; the other cell is 9 µm long.
    assert_eq!(column(&text, "sholl_20", ','), ["2", "0"]);
    assert_eq!(column(&text, "sholl_40", ','), ["2", "0"]);
    assert_eq!(column(&text, "mean_local_bifurcation_angles", ',')[1], "");
    let json = work.run("info cells --json").exits(0).json();
    let lengths = column(&text, "total_length", ',');
    assert_eq!(lengths[0].parse::<f64>().ok(), json[0]["length"].as_f64());
    assert!(json[0].get("rows").is_none() && json[0].get("sholl").is_none());
}

#[neurotess_testing::test]
fn rows_are_of_cells_neurites_sections_or_bars() {
    let work = cells();
    for (per, rows) in [("cell", 2), ("neurite", 3), ("section", 5), ("bar", 4)] {
        let name = format!("{per}.tsv");
        work.run(&format!("info cells --table {name} --per {per}"))
            .exits(0);
        assert_eq!(column(&work.text(&name), "file", '\t').len(), rows, "{per}");
        let json = work
            .run(&format!("info cells --json --by {per}"))
            .exits(0)
            .json();
        let lists = json.as_array().expect("a list").iter();
        let count: usize = lists
            .map(|cell| cell["rows"].as_array().map_or(0, Vec::len))
            .sum();
        assert_eq!(count, rows, "{per}");
    }
    let bars = work.text("bar.tsv");
    assert_eq!(column(&bars, "end_sample", '\t'), ["3", "6", "7", "2"]);
    // The farther end, 7, goes on to the neurite's first sample; the other stops at the fork.
    assert_eq!(column(&bars, "fork_sample", '\t'), ["2", "5", "4", "1"]);
    let sections = work.text("section.tsv");
    assert_eq!(
        column(&sections, "parent", '\t'),
        ["-1", "-1", "1", "1", "-1"]
    );
}

#[neurotess_testing::test]
fn tables_are_replaced_only_with_force_and_failures_are_left_out() {
    let work = cells();
    work.file("cells/broken.swc", "1 1 0 0 0 5 -1\n2 2 0 9 0 1\n");
    let run = work.run("info cells --table all.csv").exits(1);
    assert!(
        run.stdout().contains("all.csv: 2 rows of 2 tracings"),
        "{}",
        run.stdout()
    );
    assert_eq!(run.stderr().lines().count(), 1, "{}", run.stderr());
    assert_eq!(column(&work.text("all.csv"), "file", ',').len(), 2);
    let before = work.text("all.csv");
    let run = work.run("info cells/a.swc --table all.csv").exits(1);
    assert!(run.stderr().contains("--force"), "{}", run.stderr());
    assert_eq!(work.text("all.csv"), before);
    work.run("info cells/a.swc --table all.csv --force")
        .exits(0);
    let run = work
        .run("info cells/a.swc --table x.csv --sholl 1e-9")
        .exits(1);
    assert!(
        run.stderr().contains("take a larger distance"),
        "{}",
        run.stderr()
    );
    assert_eq!(work.names("."), ["all.csv", "a.swc", "b.swc", "broken.swc"]);
    for wrong in [
        "--table a.xlsx",
        "--per cell",
        "--table - --json",
        "--sholl 0",
        "--table - --per branch",
    ] {
        work.run(&format!("info cells {wrong}")).exits(2);
    }
}

#[neurotess_testing::test]
fn people_see_crossings_of_one_cell() {
    let work = cells();
    let text = work.run("info cells/a.swc --sholl 20").exits(0).stdout();
    assert!(text.contains("every 20 µm: 2 2"), "{text}");
    let json = work
        .run("info cells/a.swc --sholl 20 --json")
        .exits(0)
        .json();
    assert_eq!(
        json[0]["sholl"],
        serde_json::json!({ "step": 20.0, "crossings": [2, 2] })
    );
}
