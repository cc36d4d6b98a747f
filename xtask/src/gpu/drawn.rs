//! A picture that `neurotess render` draws, and what it took.

use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use super::results::Ended;
use super::started::{Place, Program};
use crate::steps::children_time;

/// A picture that was drawn.
pub(super) struct Drawn {
    pub(super) ended: Program,
    seconds: f64,
    /// Of the processors, user and system.
    processor_seconds: f64,
    /// What `--stats` says.
    stats: Value,
}

/// Draws it.
pub(super) fn draw(
    place: &Place,
    arguments: &str,
    file: &Path,
    variables: &[(&str, &str)],
    most: Duration,
) -> anyhow::Result<Drawn> {
    let stats = place.work.join("stats.json");
    let (picture, stats_name) = (file.display().to_string(), stats.display().to_string());
    let mut words: Vec<&str> = vec!["render"];
    words.extend(arguments.split(' '));
    words.extend(["--force", "--quiet", "-o", &picture, "--stats", &stats_name]);
    let (clock, before) = (Instant::now(), children_time());
    let ended = place.start(&place.program("neurotess"), &words, variables, most)?;
    let processor = children_time()
        .zip(before)
        .map(|(after, before)| after - before);
    let stats = match ended.how {
        Ended::Well => serde_json::from_str(&fs::read_to_string(stats)?)?,
        _ => Value::Null,
    };
    Ok(Drawn {
        ended,
        seconds: clock.elapsed().as_secs_f64(),
        processor_seconds: processor.unwrap_or_default().as_secs_f64(),
        stats,
    })
}

impl Drawn {
    /// Its row among the figures.
    pub(super) fn row(&self, name: &str) -> Value {
        json!({
            "name": name,
            "seconds": self.seconds,
            "processor_seconds": self.processor_seconds,
            "stages": self.stats["seconds"],
            "triangles": self.stats["triangles"],
        })
    }
}
