//! What the test program says, test by test, also if it was ended before its last.

use std::collections::BTreeMap;

use serde_json::{Value, json};

/// How the tests of one file ended.
#[derive(Default)]
struct Group {
    passed: u64,
    skipped: u64,
    failed: Vec<String>,
}

/// The figures of the part: for each file of tests how many passed, failed and were skipped.
pub(crate) fn figures(printed: &str, listed: &str) -> Value {
    let mut groups: BTreeMap<&str, Group> = BTreeMap::new();
    let mut ended = 0;
    for (name, outcome) in printed.lines().filter_map(outcome) {
        let (file, test) = name.split_once("::").unwrap_or((name, name));
        let group = groups.entry(file).or_default();
        ended += 1;
        match outcome.split([',', ' ']).next() {
            Some("ok") => group.passed += 1,
            Some("ignored") => group.skipped += 1,
            _ => group.failed.push(test.to_owned()),
        }
    }
    let all = listed
        .lines()
        .filter(|line| line.ends_with(": test"))
        .count();
    let files: Vec<Value> = groups
        .iter()
        .map(|(file, group)| {
            json!({
                "file": file,
                "passed": group.passed,
                "skipped": group.skipped,
                "failed": group.failed,
            })
        })
        .collect();
    json!({ "files": files, "tests": all, "ended": ended, "why": whys(printed) })
}

/// `test cracks::no_back_face ... ok`
fn outcome(line: &str) -> Option<(&str, &str)> {
    let (name, outcome) = line.strip_prefix("test ")?.split_once(" ... ")?;
    Some((name.trim_end(), outcome))
}

/// What failed tests said, each cut to what a page can hold.
fn whys(printed: &str) -> Vec<String> {
    const LONGEST: usize = 400;
    let said = printed.split("\n---- ").skip(1);
    said.map(|said| {
        let lines: Vec<&str> = said.lines().take(6).map(str::trim).collect();
        lines.join(" ").chars().take(LONGEST).collect()
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const PRINTED: &str = "running 3 tests
test cracks::none           ... ok
test parity::vertices       ... FAILED
test memory::real           ... ignored, no reference data

failures:

---- parity::vertices ----
panicked at parity.rs:3:
off by 3

";

    #[test]
    fn each_file_has_its_tests() {
        let listed = "cracks::none: test\nparity::vertices: test\nmemory::real: test\nparity::more: test\n4 tests\n";
        let figures = figures(PRINTED, listed);
        let files = figures["files"].as_array().expect("files");
        assert_eq!(files.len(), 3);
        assert_eq!(
            files[0],
            json!({"file": "cracks", "passed": 1, "skipped": 0, "failed": []})
        );
        assert_eq!(files[1]["skipped"], 1);
        assert_eq!(files[2]["failed"], json!(["vertices"]));
        assert_eq!(
            (&figures["tests"], &figures["ended"]),
            (&json!(4), &json!(3))
        );
        let why = figures["why"][0].as_str().expect("why");
        assert!(
            why.contains("parity::vertices") && why.contains("off by 3"),
            "{why}"
        );
    }
}
