//! Runs the bundle, on the machine with the graphics hardware: `run.sh` starts `xtask gpu-run` there.
//!
//! Nothing but the bundle's own folder is written to. Each part is bounded in time, and what it found out is written
//! before the next begins.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use anyhow::{Context, bail};
use serde_json::{Value, json};

use super::parts::{COLD, MOST, PARTS, PICTURES, Part, Work};
use super::results::{self, Ended, Results, replace};
use super::started::{CACHES, Place, Program};
use super::{drawn, page, plots, verdicts};

/// What `gpu-bundle` writes beside the programs: of which version they are.
pub(crate) const MADE: &str = "bundle.json";

const USAGE: &str = "run.sh [--software] [--adapter NAME] [--parts NAME,…] [--out FOLDER]

  --software  draw on the processor if need be: a trial, with reduced scenes
  --adapter   draw with the adapter that has this in its name
  --parts     only these, and adapter; otherwise all
  --out       folder of the results [default: results]";

/// A run under way.
struct Run {
    place: Place,
    is_software_allowed: bool,
    /// Parts that were asked for; none: all.
    parts: Option<Vec<String>>,
    began: Instant,
}

/// Runs the command. Its arguments are the bundle's folder, and those of `run.sh`.
pub(crate) fn run(mut arguments: impl Iterator<Item = String>) -> anyhow::Result<()> {
    let bundle = PathBuf::from(arguments.next().context(USAGE)?);
    let arguments: Vec<String> = arguments.collect();
    if arguments.iter().any(|argument| argument == "--help") {
        println!("{USAGE}");
        return Ok(());
    }
    let run = asked(arguments.into_iter(), bundle)?;
    let Place { work, out, .. } = &run.place;
    fs::create_dir_all(out).with_context(|| out.display().to_string())?;
    clean(work)?;
    fs::create_dir_all(work.join("cache"))?;
    let ended = run.all();
    clean(work)?;
    ended
}

/// The run that these options ask for.
fn asked(mut arguments: impl Iterator<Item = String>, bundle: PathBuf) -> anyhow::Result<Run> {
    let mut run = Run {
        place: Place {
            work: bundle.join("work"),
            out: bundle.join("results"),
            adapter: None,
            bundle,
        },
        is_software_allowed: false,
        parts: None,
        began: Instant::now(),
    };
    while let Some(argument) = arguments.next() {
        let mut value = || {
            let value = arguments.next();
            value.with_context(|| format!("{argument} needs a value"))
        };
        match argument.as_str() {
            "--software" => run.is_software_allowed = true,
            "--adapter" => run.place.adapter = Some(value()?),
            "--parts" => run.parts = Some(value()?.split(',').map(str::to_owned).collect()),
            "--out" => run.place.out = std::path::absolute(value()?)?,
            _ => bail!("{argument}: not an option\n\n{USAGE}"),
        }
    }
    let known = |name: &String| PARTS.iter().any(|part| part.name == name);
    if let Some(unknown) = run.parts.iter().flatten().find(|name| !known(name)) {
        let names: Vec<&str> = PARTS.iter().map(|part| part.name).collect();
        bail!("{unknown}: not a part; those are {}", names.join(", "));
    }
    Ok(run)
}

impl Run {
    /// All parts. What is known is written after each.
    fn all(&self) -> anyhow::Result<()> {
        let made: Value = serde_json::from_str(&fs::read_to_string(self.place.bundle.join(MADE))?)?;
        let text = |key: &str| made[key].as_str().unwrap_or_default().to_owned();
        let mut results = Results {
            version: text("version"),
            commit: text("commit"),
            date: today(),
            cores: std::thread::available_parallelism().map_or(0, usize::from),
            ..Results::default()
        };
        for part in PARTS {
            let asked = self.parts.as_ref();
            let is_asked = asked.is_none_or(|names| names.iter().any(|name| name == part.name));
            if part.name != "adapter" && !is_asked {
                continue;
            }
            let part = self.part(part, results.reduced);
            println!(
                "{:<14} {:>6.1} s  {}",
                part.name,
                part.seconds,
                headline(&part)
            );
            results.parts.push(part);
            results.reduced = results.is_software();
            results.seconds = self.began.elapsed().as_secs_f64();
            plots::draw(&mut results);
            self.write(&results)?;
            if results.figures("adapter").is_none() {
                bail!("nothing to draw with: {}", results.parts[0].why);
            }
            if results.is_software() && !self.is_software_allowed {
                bail!(
                    "{} draws on the processor, and this is for graphics hardware. For a trial with reduced scenes: \
                     --software",
                    results.adapter()
                );
            }
        }
        println!(
            "\n{} and page.md are in {}",
            results::FILE,
            self.place.out.display()
        );
        let is_well = |part: &results::Part| part.ended == Ended::Well;
        let bad: Vec<&str> = results
            .parts
            .iter()
            .filter(|part| !is_well(part))
            .map(|part| part.name.as_str())
            .collect();
        if !bad.is_empty() {
            bail!("not all went well: {}", bad.join(", "));
        }
        Ok(())
    }

    fn write(&self, results: &Results) -> anyhow::Result<()> {
        let out = &self.place.out;
        results.write(out)?;
        for (name, plot) in &results.plots {
            replace(&out.join(format!("{name}.svg")), plot)?;
        }
        replace(&out.join("page.md"), &page::page(results))
    }

    /// Runs a part.
    fn part(&self, part: &Part, reduced: bool) -> results::Part {
        let clock = Instant::now();
        // In software there is no haste: what counts is that each part runs.
        let most = if reduced || part.name == "adapter" {
            part.most[1]
        } else {
            let left = MOST.saturating_sub(self.began.elapsed().as_secs());
            part.most[0].min(left)
        };
        let most = Duration::from_secs(most);
        let done = match part.work {
            Work::Bench(hardware, software) => {
                let arguments = if reduced { software } else { hardware };
                self.bench(part.name, arguments, most)
            }
            Work::Tests => self.tests(reduced, most),
            Work::Pictures => self.pictures(most),
            Work::ColdStart => self.cold_start(most),
        };
        let done = done.unwrap_or_else(|e| Done {
            ended: Ended::Failed,
            figures: Value::Null,
            why: format!("{e:#}"),
        });
        results::Part {
            name: part.name.to_owned(),
            ended: done.ended,
            seconds: clock.elapsed().as_secs_f64(),
            figures: done.figures,
            why: done.why,
        }
    }

    fn bench(&self, name: &str, arguments: &str, most: Duration) -> anyhow::Result<Done> {
        let mut words: Vec<&str> = vec!["bench"];
        words.extend(arguments.split(' '));
        words.push("--json");
        let folder = self.place.work.join(name);
        let plot = folder.join("refinement.svg");
        let folder = folder.display().to_string();
        if name == "refinement" {
            words.extend(["--out", &folder]);
        }
        let ended = self
            .place
            .start(&self.place.program("neurotess"), &words, &[], most)?;
        if ended.how != Ended::Well {
            return Ok(Done::of(ended, Value::Null));
        }
        let mut figures: Value = serde_json::from_str(&ended.printed).context("its figures")?;
        if let Ok(plot) = fs::read_to_string(plot) {
            figures["plot"] = plot.into();
        }
        Ok(Done::of(ended, figures))
    }

    fn tests(&self, reduced: bool, most: Duration) -> anyhow::Result<Done> {
        let program = self.place.program("graphics-tests");
        let seconds = Duration::from_secs(30).min(most);
        let listed = self
            .place
            .start(&program, &["--list"], &[], seconds)?
            .printed;
        let lane = ("NEUROTESS_FULL", if reduced { "0" } else { "1" });
        let ended =
            self.place
                .start(&program, &[], &[lane, ("NEUROTESS_REQUIRE_GPU", "1")], most)?;
        let figures = verdicts::figures(&ended.printed, &listed);
        Ok(Done::of(ended, figures))
    }

    fn pictures(&self, most: Duration) -> anyhow::Result<Done> {
        let clock = Instant::now();
        let mut pictures = Vec::new();
        for (name, arguments) in PICTURES {
            let file = self.place.out.join(format!("{name}.png"));
            let left = most.saturating_sub(clock.elapsed());
            let picture = drawn::draw(&self.place, arguments, &file, &[], left)?;
            if picture.ended.how != Ended::Well {
                return Ok(Done::of(picture.ended, json!(pictures)));
            }
            pictures.push(picture.row(name));
        }
        Ok(Done::well(json!(pictures)))
    }

    /// The first picture, with caches that are empty, and the second with what it left there.
    fn cold_start(&self, most: Duration) -> anyhow::Result<Done> {
        let clock = Instant::now();
        let cache = self.place.work.join("first");
        // NVIDIA's driver keeps nothing in a folder that is not there.
        fs::create_dir_all(&cache)?;
        let cache = cache.display().to_string();
        let caches = CACHES.map(|name| (name, cache.as_str()));
        let file = self.place.work.join("cold.png");
        let mut pictures = Vec::new();
        for name in ["first", "second"] {
            let left = most.saturating_sub(clock.elapsed());
            let picture = drawn::draw(&self.place, COLD, &file, &caches, left)?;
            if picture.ended.how != Ended::Well {
                return Ok(Done::of(picture.ended, json!(pictures)));
            }
            pictures.push(picture.row(name));
        }
        Ok(Done::well(json!(pictures)))
    }
}

/// Deletes caches and temporary files, also those of a run that was killed.
fn clean(work: &Path) -> anyhow::Result<()> {
    match work.exists() {
        true => fs::remove_dir_all(work).with_context(|| work.display().to_string()),
        false => Ok(()),
    }
}

/// How a part's work ended.
struct Done {
    ended: Ended,
    figures: Value,
    why: String,
}

impl Done {
    /// What a program's end comes to, with these figures.
    fn of(ended: Program, figures: Value) -> Self {
        Self {
            ended: ended.how,
            figures,
            why: ended.why,
        }
    }

    fn well(figures: Value) -> Self {
        Self {
            ended: Ended::Well,
            figures,
            why: String::new(),
        }
    }
}

fn headline(part: &results::Part) -> String {
    match part.ended {
        Ended::Well => "well".into(),
        Ended::Failed => format!("FAILED: {}", part.why),
        Ended::TooLate => format!("NOT DONE: {}", part.why),
    }
}

/// The day, by the system's clock.
fn today() -> String {
    let output = Command::new("date").args(["-u", "+%Y-%m-%d"]).output();
    let day = output.map(|output| String::from_utf8_lossy(&output.stdout).trim().to_owned());
    day.unwrap_or_default()
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    #[test]
    fn unknown_options_and_parts_are_errors() {
        let error = |words: &[&str]| {
            let words: Vec<String> = words.iter().map(|&word| word.to_owned()).collect();
            asked(words.into_iter(), PathBuf::from("bundle"))
                .map(drop)
                .expect_err("an error")
                .to_string()
        };
        assert!(error(&["--nonsense"]).contains("not an option"));
        assert!(error(&["--parts", "tests,nonsense"]).contains("not a part; those are adapter"));
        assert!(error(&["--out"]).contains("needs a value"));
    }
}
