//! `cargo xtask sweep`: which numbers of the code move what meshes of real cells are worth.
//!
//! A copy of the sources is changed and built once in a folder of its own, so that the checkout stays as it is; the program
//! then measures with one number after another times each factor. Cells that are held out take no part.

mod copy;
mod results;
mod rewrite;
mod scan;

use std::io::Read;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use super::cells;
use copy::Program;
use results::Results;

/// Factors where none are given; whole numbers change by one at least.
const FACTORS: [f64; 2] = [0.7, 1.3];
/// Factors on all numbers at once: what these change is noise.
const NOISE: [f64; 4] = [0.999, 1.001, 0.998, 1.002];
/// Longest time of a measurement; what takes longer does not end.
const LIMIT: Duration = Duration::from_secs(40);

/// Runs the command: names of numbers or how they begin, factors, files.
pub(crate) fn run(arguments: impl Iterator<Item = String>) -> anyhow::Result<()> {
    let (mut names, mut factors, mut files) = (Vec::new(), Vec::new(), Vec::new());
    for argument in arguments {
        if let Ok(factor) = argument.parse::<f64>() {
            factors.push(factor);
        } else if PathBuf::from(&argument).is_file() {
            files.push(PathBuf::from(argument));
        } else {
            names.push(argument);
        }
    }
    if factors.is_empty() {
        factors.extend(FACTORS);
    }
    let program = copy::program()?;
    let mut results = Results::open(&program)?;
    let is_asked =
        |name: &str| names.is_empty() || names.iter().any(|asked| name.starts_with(asked));
    let asked: Vec<(usize, &str)> = (program.knobs.iter().enumerate())
        .map(|(number, knob)| (number, knob.name.as_str()))
        .filter(|(_, name)| is_asked(name))
        .collect();
    let is_needed = |way: &Way| asked.iter().any(|(_, name)| way.shows(name));
    for way in Way::ALL.into_iter().filter(is_needed) {
        let files = match way {
            _ if !files.is_empty() => files.clone(),
            Way::Digests => cells::tuning()?,
            _ => cells::swept()?,
        };
        results.get_or(way, "as it is", 1.0, || {
            measure(&program, way, "none", 1.0, &files)
        })?;
        for factor in NOISE.into_iter().filter(|_| way != Way::Digests) {
            results.get_or(way, "all", factor, || {
                measure(&program, way, "all", factor, &files)
            })?;
        }
        for &(number, name) in asked.iter().filter(|(_, name)| way.shows(name)) {
            let number = number.to_string();
            for &factor in &factors {
                // Meshes that are the same are not measured.
                if way != Way::Surfaces || !results.is_same(Way::Digests, name, factor)? {
                    results.get_or(way, name, factor, || {
                        measure(&program, way, &number, factor, &files)
                    })?;
                }
            }
        }
    }
    let names: Vec<&str> = asked.iter().map(|(_, name)| *name).collect();
    results.print(&program, &names, &factors)
}

/// What is measured of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    /// Whether coarse meshes are the same, of all tuning cells.
    Digests,
    Separated,
    Simulated,
    Surfaces,
}

impl Way {
    const ALL: [Self; 4] = [
        Self::Digests,
        Self::Separated,
        Self::Simulated,
        Self::Surfaces,
    ];

    /// What shows the effect of a number; of those of coarse meshes, digests say whether there is any.
    fn of(name: &str) -> Self {
        match name {
            name if name.starts_with("union/") => Self::Simulated,
            name if name.starts_with("generate/tracing/separate/") => Self::Separated,
            _ => Self::Surfaces,
        }
    }

    fn shows(self, name: &str) -> bool {
        let way = Self::of(name);
        way == self || (way == Self::Surfaces && self == Self::Digests)
    }

    fn flag(self) -> &'static str {
        match self {
            Self::Digests => "--digest",
            Self::Separated => "--separated",
            Self::Simulated => "--simulated",
            Self::Surfaces => "--once",
        }
    }
}

/// Figures of all files with a number times a factor; an error where the program panics or does not end.
fn measure(
    program: &Program,
    way: Way,
    number: &str,
    factor: f64,
    files: &[PathBuf],
) -> anyhow::Result<Value> {
    let mut child = Command::new(&program.file)
        .arg(way.flag())
        .args(files)
        .env("NEUROTESS_KNOB", format!("{number}:{factor}"))
        .env("RAYON_NUM_THREADS", "1")
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()?;
    let mut pipe = child.stdout.take();
    let reader = std::thread::spawn(move || {
        let mut text = String::new();
        if let Some(pipe) = &mut pipe {
            pipe.read_to_string(&mut text)?;
        }
        Ok::<_, std::io::Error>(text)
    });
    let begin = Instant::now();
    let ended = loop {
        if let Some(status) = child.try_wait()? {
            break status.success();
        }
        if begin.elapsed() > LIMIT {
            child.kill()?;
            child.wait()?;
            break false;
        }
        std::thread::sleep(Duration::from_millis(20));
    };
    let printed = reader.join().unwrap_or_else(|_| Ok(String::new()))?;
    let rows: Result<Vec<Value>, _> = printed.lines().map(serde_json::from_str).collect();
    match rows {
        Ok(rows) if ended && rows.iter().all(|row| row["error"].is_null()) => Ok(json!(rows)),
        _ => Ok(json!("fails")),
    }
}
