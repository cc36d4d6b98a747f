//! The table of figures, and what two of them come to.

use std::fmt::Write as _;
use std::path::Path;

use serde_json::Value;

use super::cells::is_held_out;

/// Sums are made of cells that numbers are chosen by, and of those that are held out.
const GROUPS: [(&str, bool); 2] = [("tuning", false), ("held out", true)];

/// How much worse a sum may be.
const WORSE: f64 = 1.05;

/// Figures whose sums are compared, with how much of them is a trifle in all cells together.
const COMPARED: [(&str, f64); 14] = [
    ("near_2", 5.0),
    ("pairs_2", 5.0),
    ("folded_2", 5.0),
    ("near_4", 5.0),
    ("pairs_4", 5.0),
    ("folded_4", 5.0),
    ("off", 1e-3),
    ("sections", 1e-3),
    ("sections_95", 1e-2),
    ("subtrees", 1e-2),
    ("vanished", 5.0),
    ("inside", 1e-2),
    ("inside_narrow", 1e-2),
    ("bytes", 0.1),
];

/// Markdown, a row for each cell and two of sums.
pub(super) fn table(figures: &Value) -> String {
    let mut text = format!("{}.\n\n", figures["commit"].as_str().unwrap_or_default());
    text += "| cell | points | near, all, folded: 2 | 4 | off % | sections, subtrees % | vanished | bends | volume | bytes | ms | soma: volume, area % | silhouette % | drawn out | neck | ms | simulation: pairs | pieces, genus | angle | s |\n";
    text += "| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n";
    for cell in cells(figures) {
        let name = Path::new(file(cell)).file_stem().unwrap_or_default();
        let mut name: String = name.to_string_lossy().chars().take(20).collect();
        if is_held_out(file(cell)) {
            name += ", held out";
        }
        let closed = [&cell["closed_2"], &cell["closed_4"]];
        let open = match closed.iter().all(|closed| closed.as_bool() == Some(true)) {
            true => "",
            false => " **open**",
        };
        let simulation = &cell["simulation"];
        let of = |key: &str| number(&simulation[key]);
        let _ = writeln!(
            text,
            "| {name}{open} | {} | {} | {} | {:.2} | {:.1}, {:.0}, {:.1} | {} | {:.2}, {:.2} | {:.0} | {:.1} | {:.1} | {} | {} | {}, {} | {:.1} | {:.1} |",
            cell["points"],
            counts(cell, 2),
            counts(cell, 4),
            100.0 * number(&cell["off"]),
            100.0 * number(&cell["sections"]),
            100.0 * number(&cell["sections_95"]),
            100.0 * number(&cell["subtrees"]),
            number(&cell["vanished"]),
            number(&cell["inside"]),
            number(&cell["inside_narrow"]),
            number(&cell["volume"]),
            number(&cell["bytes"]),
            1e3 * number(&cell["seconds"]),
            soma(cell),
            told(simulation),
            of("pieces"),
            of("genus"),
            of("angle_p1"),
            of("seconds"),
        );
    }
    for (name, held_out) in GROUPS {
        text += &sums(name, &cells_of(figures, held_out));
    }
    text
}

/// The row of sums of some cells.
fn sums(name: &str, cells: &[&Value]) -> String {
    let all = |key: &str| sum(cells, key);
    let mean = |key: &str| sum(cells, key) / cells.len().max(1) as f64;
    let counts = |level: u32| {
        ["near", "pairs", "folded"]
            .map(|what| all(&format!("{what}_{level}")).to_string())
            .join(", ")
    };
    // Cells count by their bends.
    let per_bend = |count: &str, inside: &str| {
        let sums = cells
            .iter()
            .map(|cell| number(&cell[count]) * number(&cell[inside]));
        sums.sum::<f64>() / all(count).max(1.0)
    };
    format!(
        "| **{name}** (off, sections, subtrees, bends, bytes: mean) | {} | {} | {} | {:.2} | {:.1}, {:.0}, {:.1} | {} | {:.2}, {:.2} | {:.0} | {:.1} | {:.0} | | | | | | | | | |\n",
        all("points"),
        counts(2),
        counts(4),
        100.0 * mean("off"),
        100.0 * mean("sections"),
        100.0 * mean("sections_95"),
        100.0 * mean("subtrees"),
        all("vanished"),
        per_bend("bends", "inside"),
        per_bend("narrow_bends", "inside_narrow"),
        all("volume"),
        mean("bytes"),
        1e3 * all("seconds"),
    )
}

/// A soma's figures: by how much volume, area and silhouette (median, largest) are off what was traced, how far it is drawn
/// out, the angles at its necks (median, 99th percentile), and the time that it takes.
fn soma(cell: &Value) -> String {
    let figure = |key: &str, factor: f64, digits: usize| match cell[key].as_f64() {
        Some(value) => format!("{:.digits$}", factor * value),
        None => "–".into(),
    };
    let percent = |key: &str| figure(key, 100.0, 1);
    format!(
        "{}, {} | {}, {} | {} | {}, {} | {}",
        percent("soma_volume"),
        percent("soma_area"),
        percent("silhouette"),
        percent("silhouette_max"),
        figure("drawn_out", 1.0, 2),
        figure("neck", 1.0, 0),
        figure("neck_99", 1.0, 0),
        figure("soma_seconds", 1e3, 1),
    )
}

/// Crossing pairs of a mesh for simulations, or that there is none.
fn told(simulation: &Value) -> String {
    match (&simulation["pairs"], simulation["closed"].as_bool()) {
        (Value::Number(pairs), Some(true)) => pairs.to_string(),
        (Value::Number(pairs), _) => format!("{pairs} **open**"),
        _ => "**none**".into(),
    }
}

fn counts(cell: &Value, level: u32) -> String {
    ["near", "pairs", "folded"]
        .map(|what| cell[format!("{what}_{level}")].to_string())
        .join(", ")
}

fn cells(figures: &Value) -> &[Value] {
    figures["cells"].as_array().map_or(&[], Vec::as_slice)
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_default()
}

/// Those that are held out, or the others.
fn cells_of(figures: &Value, held_out: bool) -> Vec<&Value> {
    let cells = cells(figures).iter();
    cells
        .filter(|cell| is_held_out(file(cell)) == held_out)
        .collect()
}

fn file(cell: &Value) -> &str {
    cell["file"].as_str().unwrap_or_default()
}

fn sum(cells: &[&Value], key: &str) -> f64 {
    cells.iter().map(|cell| number(&cell[key])).sum()
}

/// Two tables beside one another.
pub(super) struct Compared {
    pub(super) text: String,
    /// What got worse.
    pub(super) worse: Vec<String>,
}

/// Compares sums over cells that are in both; a mesh that opens, or that solvers would not take any more, is worse, too.
pub(super) fn compare(before: &Value, after: &Value) -> Compared {
    let known = |cell: &&Value| cells(before).iter().any(|was| file(was) == file(cell));
    let pairs: Vec<(&Value, &Value)> = (cells(after).iter().filter(known))
        .filter_map(|is| Some((cells(before).iter().find(|was| file(was) == file(is))?, is)))
        .collect();
    let mut compared = Compared {
        text: "| sum | tuning: before | after | ratio | held out: before | after | ratio |\n| --- | ---: | ---: | ---: | ---: | ---: | ---: |\n".into(),
        worse: Vec::new(),
    };
    let trifles = COMPARED.into_iter();
    let rest = ["volume", "seconds"].map(|key| (key, f64::INFINITY));
    for (key, trifle) in trifles.chain(rest) {
        // Figures of earlier commits may lack some, and the base has no times.
        if pairs.iter().all(|(was, _)| was[key].is_null()) {
            continue;
        }
        let _ = write!(compared.text, "| {key} |");
        for (name, held_out) in GROUPS {
            let of = pairs
                .iter()
                .filter(|(_, is)| is_held_out(file(is)) == held_out);
            let (was, is): (Vec<&Value>, Vec<&Value>) = of.copied().unzip();
            let [was, is] = [sum(&was, key), sum(&is, key)];
            let ratio = is / was.max(1e-12);
            let _ = write!(compared.text, " {was:.3} | {is:.3} | {ratio:.3} |");
            if is > WORSE * was && is - was > trifle {
                compared.worse.push(format!("{key} ({name})"));
            }
        }
        compared.text.push('\n');
    }
    for (was, is) in pairs {
        let opens = |key: &str| was[key].as_bool() == Some(true) && is[key].as_bool() != Some(true);
        let of_simulation = |cell: &Value| {
            let simulation = &cell["simulation"];
            simulation["closed"].as_bool() == Some(true) && simulation["pairs"].as_i64() == Some(0)
        };
        if opens("closed_2") || opens("closed_4") {
            compared.worse.push(format!("{} opens", file(is)));
        }
        if of_simulation(was) && !of_simulation(is) {
            compared.worse.push(format!("{} for simulations", file(is)));
        }
    }
    compared
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn figures(folded: u32, closed: bool, pairs: u32) -> Value {
        let simulation = json!({ "closed": true, "pairs": pairs });
        let cell = json!({ "file": "a.swc", "folded_2": folded, "closed_2": closed, "simulation": simulation });
        json!({ "commit": "abc", "cells": [cell] })
    }

    #[test]
    fn worse_is_more_than_a_twentieth_an_open_mesh_or_a_crossing() {
        let before = figures(1000, true, 0);
        let worse = |after: &Value| compare(&before, after).worse;
        assert!(worse(&figures(1049, true, 0)).is_empty());
        assert_eq!(worse(&figures(1051, true, 0)), ["folded_2 (tuning)"]);
        assert_eq!(worse(&figures(900, false, 0)), ["a.swc opens"]);
        assert_eq!(worse(&figures(900, true, 1)), ["a.swc for simulations"]);
    }

    #[test]
    fn trifles_are_none() {
        assert!(
            compare(&figures(0, true, 0), &figures(5, true, 0))
                .worse
                .is_empty()
        );
    }
}
