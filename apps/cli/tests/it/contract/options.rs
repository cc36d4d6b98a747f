//! docs/options.md: which options pictures have, and where.

use std::collections::BTreeSet;
use std::fs;

use neurotess::options::Picture;

use crate::work::{Work, root};

/// The rows of the page: option, and a cell for the command, pages, Python and the window.
fn rows() -> Vec<Vec<String>> {
    let page = fs::read_to_string(root().join("docs/options.md")).expect("the page");
    let rows = page.lines().filter(|line| line.starts_with("| `"));
    let cells = |row: &str| {
        let cells = row.trim_matches('|').split(" | ");
        cells.map(|cell| cell.trim().to_owned()).collect()
    };
    // The first row names the columns.
    rows.map(cells)
        .filter(|row: &Vec<String>| row[0] != "option")
        .collect()
}

fn name(row: &[String]) -> &str {
    row[0].trim_matches('`')
}

#[neurotess_testing::test]
fn the_page_names_every_option_of_pictures_once() {
    let named: Vec<String> = rows().iter().map(|row| name(row).to_owned()).collect();
    let named_once: BTreeSet<String> = named.iter().cloned().collect();
    assert_eq!(named.len(), named_once.len());
    let all: BTreeSet<String> = Picture::keywords()
        .into_iter()
        .map(|(name, _)| name)
        .collect();
    assert_eq!(named_once, all);
    assert!(rows().iter().all(|row| row.len() == 5));
    assert!(rows().iter().flatten().all(|cell| !cell.is_empty()));
}

#[neurotess_testing::test]
fn the_command_has_what_the_page_says() {
    for (column, command) in [(1, "render"), (2, "html")] {
        let run = Work::new().run(&format!("{command} --help"));
        let help = run.exits(0).stdout();
        for row in rows() {
            let flag = format!("--{}", name(&row).replace('_', "-"));
            let mut words = help.split_whitespace();
            let has = words.any(|word| word.split('[').next() == Some(&flag));
            let said = row[column] == "yes" || row[column].starts_with("refused");
            assert_eq!(has, said, "{command} {flag}");
        }
    }
}

#[cfg(feature = "view")]
#[neurotess_testing::test]
fn the_window_has_what_the_page_says() {
    let not_taken = neurotess_viewer::picture::NOT_TAKEN;
    for row in rows() {
        let taken = not_taken.iter().all(|(not, _)| *not != name(&row));
        assert_eq!(row[4] == "yes", taken, "{}", row[0]);
    }
}

#[neurotess_testing::test]
fn python_has_what_the_page_says() {
    let file = root().join("bindings/python/python/neurotess/_pictures.py");
    let source = fs::read_to_string(file).expect("the source");
    let signature = source.split("\ndef render(").nth(1).expect("render");
    let signature = signature.split("\n) ->").next().expect("a signature");
    for row in rows() {
        let keyword = format!("\n    {}: ", name(&row));
        assert_eq!(signature.contains(&keyword), row[3] == "yes", "{}", row[0]);
    }
}
