//! The page of a run: what ran, what passed, and the figures as tables.

use serde_json::Value;

use super::goals::{self, rows};
use super::results::{Ended, Part, Results};
use super::sections;
use super::tables::{number, table, whole};

/// Files of tests, with what they show; the others go by their names.
const CHECKS: [(&str, &str); 7] = [
    (
        "parity",
        "parity: vertices of the shaders are the processor's",
    ),
    ("cracks", "no cracks"),
    ("picking", "ids"),
    ("static_picture", "static pictures are those drawn anew"),
    (
        "exploration",
        "exploration is its twin's on the processor, and within its budget",
    ),
    (
        "streaming",
        "what is streamed is drawn as if all were there",
    ),
    ("golden", "pictures are those that are kept"),
];

/// The page that lies beside the figures.
pub(crate) fn page(results: &Results) -> String {
    format!("# {}\n\n{}", title(results), body(results, ""))
}

/// What the run is called: its device and its day.
pub(crate) fn title(results: &Results) -> String {
    format!("{}, {}", results.adapter(), results.date)
}

/// All that is known, with links to plots whose files begin with `plots`.
pub(crate) fn body(results: &Results, plots: &str) -> String {
    let Results {
        version,
        commit,
        cores,
        seconds,
        ..
    } = results;
    let mut text = format!(
        "neurotess {version} ({commit}), {cores} processor cores, all parts together {} s.\n\n",
        number(Some(*seconds))
    );
    if results.reduced {
        text += "**A trial in software with reduced scenes: the figures say nothing about graphics hardware.**\n\n";
    }
    for (heading, section) in [
        ("Checks", checks(results)),
        ("Goals", (!results.reduced).then(|| goals::text(results))),
        (
            "Refinement: figure 15 of García-Cantero et al. (2017)",
            sections::refinement(results, plots),
        ),
        ("Exploration", sections::exploration(results, plots)),
        ("Neurons that do not fit", sections::streaming(results)),
        ("Static mode: a recording", sections::recording(results)),
        ("Pictures", sections::pictures(results, "pictures")),
        ("Cold start", sections::cold_start(results)),
        ("Adapter", sections::adapter(results)),
        ("Parts", Some(parts(results))),
    ] {
        if let Some(section) = section {
            text += &format!("## {heading}\n\n{section}");
        }
    }
    text
}

fn checks(results: &Results) -> Option<String> {
    let part = results.part("tests")?;
    let files = rows(&part.figures, "files");
    let known = CHECKS.iter().filter_map(|(file, what)| {
        let of_file = files.iter().find(|of_file| of_file["file"] == *file)?;
        Some(check(what, of_file))
    });
    let is_known = |of_file: &&Value| CHECKS.iter().any(|(file, _)| of_file["file"] == *file);
    let others = files.iter().filter(|of_file| !is_known(of_file));
    let others = others.map(|of_file| check(of_file["file"].as_str().unwrap_or_default(), of_file));
    let lines: Vec<Vec<String>> = known.chain(others).collect();
    let mut text = table(&["", "", "tests", "skipped"], &lines);
    let [all, ended] = ["tests", "ended"].map(|key| part.figures[key].as_u64());
    if ended < all {
        let left = all.zip(ended).map(|(all, ended)| all - ended);
        text += &format!("{} tests were not reached: {}.\n\n", whole(left), part.why);
    }
    for why in rows(&part.figures, "why") {
        text += &format!("- {}\n", why.as_str().unwrap_or_default());
    }
    if text.ends_with("\n\n") {
        return Some(text);
    }
    Some(text + "\n")
}

fn check(what: &str, of_file: &Value) -> Vec<String> {
    let failed = rows(of_file, "failed");
    let failed: Vec<&str> = failed.iter().filter_map(Value::as_str).collect();
    let passed = of_file["passed"].as_u64().unwrap_or_default();
    let verdict = match (failed.is_empty(), passed) {
        (true, 0) => "skipped".to_owned(),
        (true, _) => "passed".to_owned(),
        _ => format!("**failed**: {}", failed.join(", ")),
    };
    vec![
        what.to_owned(),
        verdict,
        whole(Some(passed + failed.len() as u64)),
        whole(of_file["skipped"].as_u64()),
    ]
}

fn parts(results: &Results) -> String {
    let ended = |part: &Part| match part.ended {
        Ended::Well => "ended well".to_owned(),
        Ended::Failed => format!("**failed**: {}", part.why),
        Ended::TooLate => format!("**not done**: {}", part.why),
    };
    let line = |part: &Part| {
        let name = part.name.replace('_', " ");
        vec![name, number(Some(part.seconds)), ended(part)]
    };
    let lines: Vec<Vec<String>> = results.parts.iter().map(line).collect();
    table(&["part", "seconds", ""], &lines)
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn part(name: &str, figures: Value) -> Part {
        Part {
            name: name.into(),
            ended: Ended::Well,
            seconds: 1.0,
            figures,
            why: String::new(),
        }
    }

    /// A run on hardware whose parts all ended well, but for one.
    fn results() -> Results {
        let row = |method: &str, level: Option<u64>, ms: f64| {
            json!({"neurons": 100, "method": method, "level": level, "ms": ms, "waited_ms": ms,
                   "triangles": 5000, "bytes": 1 << 20})
        };
        let refinement = json!({"size": [600, 600], "distinct": 30, "pixels": 0.5, "growth": [], "rows": [
            row("prerefined", Some(1), 1.0),
            row("homogeneous", Some(1), 1.0),
            row("adaptive", Some(1), 1.0),
            row("prerefined", Some(6), 26.0),
            row("homogeneous", Some(6), 4.0),
            row("adaptive", Some(6), 2.0),
            row("pixel_error", None, 2.2),
            row("prerefined_pixel_error", None, 2.0),
        ]});
        let tests = json!({"tests": 5, "ended": 4, "why": ["no_back_face off by 3"], "files": [
            {"file": "cracks", "passed": 1, "skipped": 0, "failed": ["no_back_face"]},
            {"file": "parity", "passed": 2, "skipped": 0, "failed": []},
            {"file": "opengl", "passed": 0, "skipped": 4, "failed": []},
        ]});
        let exploration = json!({"size": [600, 600], "distinct": 30, "budget": 100_000, "rows": [
            {"neurons": 1_000_000, "points": 1, "exploration": {"waited": 10.0}, "triangles": 1, "bytes": 1},
        ]});
        let late = Part {
            ended: Ended::TooLate,
            why: "ended after 40 s".into(),
            ..part("recording", Value::Null)
        };
        Results {
            date: "2026-01-01".into(),
            parts: vec![
                part("adapter", json!({"adapter": "A card", "software": false})),
                part("tests", tests),
                part("refinement", refinement),
                part("exploration", exploration),
                late,
            ],
            ..Results::default()
        }
    }

    fn line<'a>(page: &'a str, start: &str) -> &'a str {
        let found = page.lines().find(|line| line.starts_with(start));
        found.unwrap_or_else(|| panic!("{start} in {page}"))
    }

    #[test]
    fn checks_have_passed_or_failed_with_their_names() {
        let page = page(&results());
        assert!(page.starts_with("# A card, 2026-01-01\n"));
        assert!(line(&page, "| no cracks").contains("**failed**: no_back_face"));
        assert!(line(&page, "| parity").contains("passed | 2"));
        assert!(line(&page, "| opengl").contains("skipped | 0 | 4"));
        assert!(page.contains("1 tests were not reached") && page.contains("off by 3"));
        assert!(line(&page, "| recording").contains("**not done**: ended after 40 s"));
    }

    #[test]
    fn figure_15_has_four_columns_and_goals_are_judged() {
        let page = page(&results());
        assert!(line(&page, "| neurons | level").contains("adaptive ms | mesh shaders ms |"));
        assert!(line(&page, "| 100 | 6").starts_with("| 100 | 6 | 26.0 | 4.00 | 2.00 |  | 1.00 |"));
        assert!(line(&page, "| pre-refined / adaptive").contains("| 13.0 | ≥ 12.5 | met |"));
        assert!(line(&page, "| homogeneous / adaptive").contains("| 2.00 | ≥ 2.4 | **missed** |"));
        assert!(line(&page, "| refined / stored").contains("| 1.10 | ≤ 1.1 |"));
        assert!(line(&page, "| 1,000,000 neurons explored").contains("| 100 | ≥ 60 | met |"));
        // The part was not done.
        assert!(line(&page, "| – neurons of a recording").contains("not measured"));
    }

    #[test]
    fn trials_in_software_meet_no_goals() {
        let page = page(&Results {
            reduced: true,
            ..results()
        });
        assert!(page.contains("A trial in software") && !page.contains("## Goals"));
    }
}
