//! `--areas`

use std::fs;
use std::path::Path;

use serde_json::Value;

use super::neurotess;
use crate::work::sample;

/// A row of a section.
struct Row {
    section: u32,
    exposed: Option<f64>,
    meshed: f64,
    stem: Option<f64>,
    cap: Option<f64>,
}

/// The rows of a cell, and what the mesh itself says.
fn areas(folder: &Path, cell: &str, options: &str) -> (Vec<Row>, Value) {
    let command = format!("mesh {cell} -o cell.ply --areas areas.csv --json -q --force {options}");
    let report = neurotess(folder, command.trim_end()).expect("meshed");
    let text = fs::read_to_string(folder.join("areas.csv")).expect("a table");
    let mut lines = text.lines();
    assert_eq!(
        lines.next(),
        Some(
            "section,type,parent,first_sample,last_sample,length,traced_area,exposed_area,mesh_area,stem_area,cap_area"
        )
    );
    let row = |line: &str| {
        let words: Vec<&str> = line.split(',').collect();
        assert_eq!(words.len(), 11, "{line}");
        Row {
            section: words[0].parse().expect("a number"),
            exposed: words[7].parse().ok(),
            meshed: words[8].parse().expect("an area"),
            stem: words[9].parse().ok(),
            cap: words[10].parse().ok(),
        }
    };
    let report: Value = serde_json::from_str(&report).expect("JSON");
    (lines.map(row).collect(), report[0].clone())
}

/// By how much areas of sections are off what shows of their cones: the median, and the 95th percentile.
fn off(rows: &[Row]) -> [f64; 2] {
    let exposed = rows.iter().filter_map(|row| Some((row, row.exposed?)));
    let shown = exposed.filter(|(_, exposed)| *exposed > 0.0);
    let mut off: Vec<f64> = shown
        .map(|(row, exposed)| (row.meshed / exposed - 1.0).abs())
        .collect();
    off.sort_by(f64::total_cmp);
    [off[off.len() / 2], off[off.len() * 95 / 100]]
}

#[neurotess_testing::test]
fn areas_of_sections_are_those_that_show_of_their_cones() {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["basket.swc", "pyramidal.swc", "star.swc"] {
        let (rows, report) = areas(
            folder.path(),
            &sample(name),
            "--level 4 --radii equal-perimeter",
        );
        // All faces are counted, and once.
        let all: f64 = rows
            .iter()
            .map(|row| row.meshed + row.stem.unwrap_or(0.0) + row.cap.unwrap_or(0.0))
            .sum();
        let area = report["area"].as_f64().expect("an area");
        assert!((all / area - 1.0).abs() < 1e-4, "{name}: {all}, {area}");
        assert_eq!(rows[0].section, 0, "the soma");
        assert!(
            rows.iter().any(|row| row.stem.is_some()),
            "neurites at the soma"
        );
        let [median, most] = off(&rows);
        assert!(median < 0.007 && most < 0.045, "{name}: {median}, {most}");
    }
}

#[neurotess_testing::test(needs(neurotess_testing::shared))]
fn areas_of_a_well_sampled_cell_are_within_a_quarter_of_a_per_cent() {
    let folder = tempfile::tempdir().expect("a folder");
    let cell = neurotess_testing::shared_data().join("swc/C210401C.swc");
    for level in [4, 8] {
        let options = format!("--level {level} --radii equal-perimeter");
        let (rows, _) = areas(folder.path(), &cell.display().to_string(), &options);
        let [median, most] = off(&rows);
        // The largest are sections not much longer than thick.
        assert!(median < 0.0025 && most < 0.035, "{level}: {median}, {most}");
    }
}

#[neurotess_testing::test]
fn a_table_of_areas_is_of_one_cell() {
    let folder = tempfile::tempdir().expect("a folder");
    let [star, basket] = ["star.swc", "basket.swc"].map(sample);
    let two = neurotess(
        folder.path(),
        &format!("mesh {star} {basket} -o out --areas a.csv"),
    );
    assert!(two.is_err_and(|told| told.contains("--areas is of one cell")));
    let same = neurotess(
        folder.path(),
        &format!("mesh {star} -o a.ply --table b.csv --areas b.csv"),
    );
    assert!(same.is_err_and(|told| told.contains("--areas and --table name the same file")));
    assert!(!folder.path().join("a.ply").exists());
}
