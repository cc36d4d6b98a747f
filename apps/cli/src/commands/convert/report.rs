//! What edits did, or would do, for people.

use neurotess::morphology::edit::{BeforeAfter, EditReport};

use crate::report::count;

/// A line for one edit.
pub(super) fn line(report: &EditReport) -> String {
    let mut parts = vec![format!("{} changed", count(report.changed, "sample"))];
    let mut add = |part: String| parts.push(part);
    if report.largest_move > 0.0 {
        add(format!("moved by up to {} µm", short(report.largest_move)));
    }
    if report.largest_radius_change > 0.0 {
        let change = short(report.largest_radius_change);
        add(format!("radii changed by up to {change} µm"));
    }
    for (name, numbers) in [
        ("samples", report.samples),
        ("sections", report.sections),
        ("pieces", report.pieces),
    ] {
        if numbers.before != numbers.after {
            add(format!("{name} {} → {}", numbers.before, numbers.after));
        }
    }
    add(length(report.length));
    if report.left > 0 {
        add(match report.edit {
            "join" => format!("{} too far from others", count(report.left, "piece")),
            "spines" => format!("{} without room on a dendrite", count(report.left, "spine")),
            _ => format!(
                "{} without a good radius in their neurite",
                count(report.left, "sample")
            ),
        });
    }
    if report.renumbered {
        add("samples have new numbers".into());
    }
    let name = report.edit.replace('_', "-");
    format!("  {name:<10} {}", parts.join(", "))
}

fn length(length: BeforeAfter<f64>) -> String {
    let [before, after] = [length.before, length.after].map(short);
    match before == after {
        true => format!("length {before} µm"),
        false => format!("length {before} → {after} µm"),
    }
}

/// A number with no more digits than one reads.
fn short(number: f64) -> String {
    match number.abs() {
        n if n >= 1000.0 => format!("{number:.0}"),
        n if n >= 1.0 => format!("{number:.2}"),
        n if n >= 0.001 || n == 0.0 => format!("{number:.4}"),
        _ => format!("{number:.1e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_as_long_as_they_need_be() {
        assert_eq!(
            [12345.6, 12.345, 0.0123, 1e-6, 0.0].map(short),
            ["12346", "12.35", "0.0123", "1.0e-6", "0.0000"]
        );
    }
}
