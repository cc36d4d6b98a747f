//! What is to be reached on graphics hardware, and what was: ratios within one run, and frames a second.

use serde_json::Value;

use super::results::Results;
use super::tables::{number, table};

/// A goal.
struct Goal {
    what: String,
    /// None: not measured.
    measured: Option<f64>,
    /// Least or most.
    bound: Bound,
    /// What García-Cantero et al. (2017) measured, on hardware of their time.
    paper: Option<f64>,
}

enum Bound {
    Least(f64),
    Most(f64),
}

/// The goals as a table.
pub(crate) fn text(results: &Results) -> String {
    let rows: Vec<Vec<String>> = goals(results)
        .into_iter()
        .map(|goal| {
            let (bound, is_met): (_, fn(f64, f64) -> bool) = match goal.bound {
                Bound::Least(least) => ((format!("≥ {least}"), least), |value, least| {
                    value >= least
                }),
                Bound::Most(most) => ((format!("≤ {most}"), most), |value, most| value <= most),
            };
            let verdict = match goal.measured {
                None => "not measured",
                Some(value) if is_met(value, bound.1) => "met",
                Some(_) => "**missed**",
            };
            let measured = number(goal.measured);
            vec![
                goal.what,
                measured,
                bound.0,
                verdict.into(),
                number(goal.paper),
            ]
        })
        .collect();
    table(&["", "measured", "goal", "", "paper"], &rows)
}

fn goals(results: &Results) -> Vec<Goal> {
    let scenes = results
        .figures("refinement")
        .map(|figures| rows(figures, "rows"));
    let scenes = scenes.unwrap_or_default();
    let highest = scenes.iter().filter_map(|row| row["level"].as_u64()).max();
    let level = highest.unwrap_or(6);
    let mean = |slow: &str, fast: &str, level: Option<u64>| mean_ratio(&scenes, slow, fast, level);
    let of_level = |method: &str, level: u64| {
        let largest = scenes
            .iter()
            .filter_map(|row| row["neurons"].as_u64())
            .max()?;
        ms(&scenes, largest, method, Some(level))
    };
    let rise = of_level("adaptive", level).zip(of_level("adaptive", 1));
    let large = results
        .figures("large_picture")
        .map(|figures| rows(figures, "rows"));
    let large = large.unwrap_or_default();
    let large = large.iter().find(|row| row["method"] == "adaptive");
    let million = last_row(results, "exploration");
    let recording = last_row(results, "recording");
    let paper = |figure: f64| (level == 6).then_some(figure);
    let goal = |what: String, measured, bound, paper| Goal {
        what,
        measured,
        bound,
        paper,
    };
    vec![
        goal(
            format!("pre-refined / adaptive at level {level}, mean of scenes"),
            mean("prerefined", "adaptive", Some(level)),
            Bound::Least(12.5),
            paper(12.5),
        ),
        goal(
            format!("homogeneous / adaptive at level {level}, mean of scenes"),
            mean("homogeneous", "adaptive", Some(level)),
            Bound::Least(2.4),
            paper(2.4),
        ),
        goal(
            "refined / stored, at equal triangles, mean of scenes".into(),
            mean("pixel_error", "prerefined_pixel_error", None),
            Bound::Most(1.1),
            None,
        ),
        goal(
            format!("adaptive: level {level} / level 1, largest scene"),
            rise.map(|(high, low)| high / low),
            Bound::Most(1.9),
            paper(1.9),
        ),
        goal(
            of_neurons("adaptive at its level, 1920 × 1080: frames a second", large),
            large.and_then(|row| per_second(&row["waited_ms"])),
            Bound::Least(60.0),
            None,
        ),
        goal(
            of_neurons("explored: frames a second", million.as_ref()),
            million
                .as_ref()
                .and_then(|row| per_second(&row["exploration"]["waited"])),
            Bound::Least(60.0),
            None,
        ),
        goal(
            of_neurons(
                "of a recording, colored anew: pictures a second",
                recording.as_ref(),
            ),
            recording
                .as_ref()
                .and_then(|row| per_second(&row["recolored_ms"])),
            Bound::Least(200.0),
            None,
        ),
    ]
}

/// The rows of a benchmark's figures.
pub(crate) fn rows(figures: &Value, name: &str) -> Vec<Value> {
    figures[name].as_array().cloned().unwrap_or_default()
}

/// The time (ms) of a method in a scene.
pub(crate) fn ms(scenes: &[Value], neurons: u64, method: &str, level: Option<u64>) -> Option<f64> {
    find(scenes, neurons, method, level)?["ms"].as_f64()
}

/// The row of a method in a scene.
pub(crate) fn find<'a>(
    scenes: &'a [Value],
    neurons: u64,
    method: &str,
    level: Option<u64>,
) -> Option<&'a Value> {
    scenes.iter().find(|row| {
        row["neurons"] == neurons && row["method"] == method && row["level"].as_u64() == level
    })
}

/// The geometric mean, over the scenes, of how much longer one method takes; none if a scene lacks one of them.
fn mean_ratio(scenes: &[Value], slow: &str, fast: &str, level: Option<u64>) -> Option<f64> {
    let mut neurons: Vec<u64> = scenes
        .iter()
        .filter_map(|row| row["neurons"].as_u64())
        .collect();
    neurons.dedup();
    let logarithms: Option<Vec<f64>> = neurons
        .iter()
        .map(|&count| {
            let ratio = ms(scenes, count, slow, level)? / ms(scenes, count, fast, level)?;
            Some(ratio.ln())
        })
        .collect();
    let logarithms = logarithms.filter(|list| !list.is_empty())?;
    Some((logarithms.iter().sum::<f64>() / logarithms.len() as f64).exp())
}

fn last_row(results: &Results, part: &str) -> Option<Value> {
    rows(results.figures(part)?, "rows").pop()
}

fn of_neurons(what: &str, row: Option<&Value>) -> String {
    let neurons = row.and_then(|row| row["neurons"].as_u64());
    format!("{} neurons {what}", super::tables::whole(neurons))
}

fn per_second(ms: &Value) -> Option<f64> {
    Some(1000.0 / ms.as_f64()?)
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn ratios_are_geometric_means_of_scenes() {
        let row = |neurons: u64, method: &str, ms: f64| json!({"neurons": neurons, "method": method, "level": 6, "ms": ms});
        let scenes = [
            row(1, "prerefined", 2.0),
            row(1, "adaptive", 1.0),
            row(10, "prerefined", 8.0),
            row(10, "adaptive", 1.0),
            row(10, "homogeneous", 1.0),
        ];
        let mean = |slow| mean_ratio(&scenes, slow, "adaptive", Some(6));
        assert!(mean("prerefined").is_some_and(|ratio| (ratio - 4.0).abs() < 1e-12));
        // It is not there in each scene.
        assert_eq!(mean("homogeneous"), None);
        assert_eq!(mean_ratio(&[], "a", "b", None), None);
    }

    #[test]
    fn what_was_not_measured_meets_nothing() {
        let text = text(&Results::default());
        assert!(
            text.contains("not measured") && !text.contains("met |"),
            "{text}"
        );
    }
}
