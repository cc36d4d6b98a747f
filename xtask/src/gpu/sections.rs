//! The sections of the page that have figures: each is none where its part did not end well.

use serde_json::Value;

use super::goals::{self, find, rows};
use super::results::Results;
use super::tables::{mib, number, table, whole};

/// Figure 15: a scene and a level in each row, a method in each column.
pub(super) fn refinement(results: &Results, plots: &str) -> Option<String> {
    let figures = results.figures("refinement")?;
    let scenes = rows(figures, "rows");
    let mut lines = Vec::new();
    for row in scenes.iter().filter(|row| row["method"] == "adaptive") {
        let (neurons, level) = (row["neurons"].as_u64()?, row["level"].as_u64());
        let of = |method: &str| find(&scenes, neurons, method, level);
        let ms = |method: &str| number(of(method).and_then(|row| row["ms"].as_f64()));
        let count = |method: &str, key: &str| of(method).and_then(|row| row[key].as_u64());
        lines.push(vec![
            whole(Some(neurons)),
            whole(level),
            ms("prerefined"),
            ms("homogeneous"),
            ms("adaptive"),
            // A vertex source that is still to be written.
            String::new(),
            mib(count("prerefined", "bytes")),
            mib(count("adaptive", "bytes")),
            whole(count("homogeneous", "triangles")),
            whole(count("adaptive", "triangles")),
        ]);
    }
    let head = [
        "neurons",
        "level",
        "pre-refined ms",
        "homogeneous ms",
        "adaptive ms",
        "mesh shaders ms",
        "pre-refined MiB",
        "on the fly MiB",
        "triangles",
        "adaptive",
    ];
    let mut text = described(figures) + "\n\n" + &table(&head, &lines);
    let mut lines = Vec::new();
    let grown = rows(figures, "growth");
    let is_new = |row: &&Value| {
        scenes
            .iter()
            .all(|of_scene| of_scene["neurons"] != row["neurons"])
    };
    let by_error = scenes.iter().filter(|row| row["method"] == "pixel_error");
    for row in by_error.chain(grown.iter().filter(is_new)) {
        let neurons = row["neurons"].as_u64()?;
        let stored = goals::ms(&scenes, neurons, "prerefined_pixel_error", None);
        let triangles = row["triangles"].as_u64().filter(|&n| n > 0);
        lines.push(vec![
            whole(Some(neurons)),
            number(row["ms"].as_f64()),
            number(row["waited_ms"].as_f64()),
            number(stored),
            whole(triangles),
            mib(row["bytes"].as_u64()),
        ]);
    }
    text += &format!(
        "By the error of {} pixels:\n\n",
        number(figures["pixels"].as_f64())
    );
    text += &table(
        &[
            "neurons",
            "refined ms",
            "waited ms",
            "stored ms",
            "triangles",
            "MiB",
        ],
        &lines,
    );
    text += &plot(
        results,
        plots,
        "refinement",
        "Frame time over level, by scene",
    );
    if let Some(row) = large(results) {
        text += &format!(
            "At {}: {} neurons at level {} take {} ms a frame, waited, and {} triangles.\n\n",
            size(results.figures("large_picture")?),
            whole(row["neurons"].as_u64()),
            whole(row["level"].as_u64()),
            number(row["waited_ms"].as_f64()),
            whole(row["triangles"].as_u64())
        );
    }
    Some(text)
}

fn large(results: &Results) -> Option<Value> {
    let rows = rows(results.figures("large_picture")?, "rows");
    rows.into_iter().find(|row| row["method"] == "adaptive")
}

pub(super) fn exploration(results: &Results, plots: &str) -> Option<String> {
    let figures = results.figures("exploration")?;
    let lines: Vec<Vec<String>> = rows(figures, "rows")
        .iter()
        .map(|row| {
            vec![
                whole(row["neurons"].as_u64()),
                whole(row["points"].as_u64()),
                number(row["exploration"]["waited"].as_f64()),
                number(row["exploration"]["choose"].as_f64()),
                number(row["exploration"]["draw"].as_f64()),
                whole(row["triangles"].as_u64()),
                mib(row["bytes"].as_u64()),
                number(row["adaptive"]["waited"].as_f64()),
            ]
        })
        .collect();
    let head = [
        "neurons",
        "points",
        "waited ms",
        "choosing",
        "drawing",
        "triangles",
        "MiB",
        "adaptive ms",
    ];
    let budget = whole(figures["budget"].as_u64());
    let text = format!(
        "{}At most {budget} triangles a frame.\n\n",
        described(figures)
    );
    Some(
        text + &table(&head, &lines)
            + &plot(
                results,
                plots,
                "neurons",
                "Times over the number of neurons",
            ),
    )
}

pub(super) fn streaming(results: &Results) -> Option<String> {
    let figures = results.figures("streaming")?;
    let line = |name: &str, flight: &Value| {
        vec![
            name.to_owned(),
            number(flight["median"].as_f64()),
            number(flight["slowest"].as_f64()),
            mib(flight["uploaded"].as_u64()),
        ]
    };
    let text = format!(
        "A flight of {} pictures past {} distinct neurons of {} MiB, of which the device may hold {}.\n\n",
        whole(figures["frames"].as_u64()),
        whole(figures["neurons"].as_u64()),
        mib(figures["bytes"].as_u64()),
        mib(figures["memory"].as_u64())
    );
    let lines = [
        line("all there", &figures["whole"]),
        line("streamed", &figures["streamed"]),
    ];
    Some(text + &table(&["", "median ms", "slowest ms", "uploaded MiB"], &lines))
}

pub(super) fn recording(results: &Results) -> Option<String> {
    let figures = results.figures("recording")?;
    let lines: Vec<Vec<String>> = rows(figures, "rows")
        .iter()
        .map(|row| {
            vec![
                whole(row["neurons"].as_u64()),
                whole(row["values"].as_u64()),
                number(row["drawn_ms"].as_f64()),
                number(row["made_ms"].as_f64()),
                number(row["recolored_ms"].as_f64()),
                mib(row["bytes"].as_u64()),
            ]
        })
        .collect();
    let head = [
        "neurons",
        "values",
        "drawn anew ms",
        "made ms",
        "colored anew ms",
        "MiB",
    ];
    let text = format!(
        "{}{} samples a pixel; times are until the picture is back.\n\n",
        described(figures),
        whole(figures["samples"].as_u64())
    );
    Some(text + &table(&head, &lines))
}

pub(super) fn pictures(results: &Results, part: &str) -> Option<String> {
    let lines: Vec<Vec<String>> = results
        .figures(part)?
        .as_array()?
        .iter()
        .map(|row| {
            vec![
                row["name"].as_str().unwrap_or_default().to_owned(),
                number(row["seconds"].as_f64()),
                number(row["processor_seconds"].as_f64()),
                number(row["stages"]["read"].as_f64()),
                number(row["stages"]["adapter"].as_f64()),
                number(row["stages"]["upload"].as_f64()),
                number(row["stages"]["draw"].as_f64()),
                whole(row["triangles"].as_u64()),
            ]
        })
        .collect();
    let head = [
        "",
        "seconds",
        "processor s",
        "read, mesh",
        "adapter",
        "upload",
        "draw",
        "triangles",
    ];
    Some(table(&head, &lines))
}

pub(super) fn cold_start(results: &Results) -> Option<String> {
    let first = pictures(results, "cold_start");
    let first = first.map(|text| {
        format!("The first picture of a cell with an empty cache of shaders, and the second, in seconds:\n\n{text}")
    });
    let opening = results.figures("opening").map(|figures| {
        let lines: Vec<Vec<String>> = rows(figures, "rows")
            .iter()
            .map(|row| {
                let stage = |name: &str| number(row["seconds"][name].as_f64());
                let cache = row["cache"].as_str().unwrap_or_default().to_owned();
                let mut line = vec![cache, number(row["all"].as_f64())];
                line.extend(["read", "adapter", "upload", "draw"].map(stage));
                line
            })
            .collect();
        format!(
            "A circuit of {} neurons from {} tracings, without its cache, while it is written, and with it, in seconds:\n\n{}",
            whole(figures["neurons"].as_u64()),
            whole(figures["morphologies"].as_u64()),
            table(&["cache", "all", "read, mesh", "adapter", "upload", "draw"], &lines)
        )
    });
    let text: String = [first, opening].into_iter().flatten().collect();
    (!text.is_empty()).then_some(text)
}

pub(super) fn adapter(results: &Results) -> Option<String> {
    let figures = results.figures("adapter")?.as_object()?;
    let line = |(name, value): (&String, &Value)| {
        let value = match value {
            Value::String(text) => text.clone(),
            Value::Number(number) => whole(number.as_u64()),
            Value::Bool(true) => "yes".into(),
            Value::Bool(false) => "no".into(),
            other => other.to_string(),
        };
        vec![name.replace('_', " "), value]
    };
    let lines: Vec<Vec<String>> = figures.iter().map(line).collect();
    Some(table(&["", ""], &lines))
}

/// Size of the pictures, and the neurons that they show.
fn described(figures: &Value) -> String {
    let distinct = figures["distinct"].as_u64();
    format!("{}, {} distinct neurons. ", size(figures), whole(distinct))
}

fn size(figures: &Value) -> String {
    let [width, height] = [0, 1].map(|axis| figures["size"][axis].as_u64().unwrap_or_default());
    format!("{width} × {height} pixels")
}

fn plot(results: &Results, plots: &str, name: &str, words: &str) -> String {
    match results.plots.contains_key(name) {
        true => format!("![{words}]({plots}{name}.svg)\n\n"),
        false => String::new(),
    }
}
