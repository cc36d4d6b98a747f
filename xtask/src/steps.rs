//! Steps with a name and a time, and the summary at the end.

use std::fs::{self, OpenOptions};
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use anyhow::{Context, bail};

/// Folder of the workspace that cargo runs us in. Where two checkouts share a target folder, the one that built this
/// program may be the other.
pub(crate) fn root() -> PathBuf {
    let built = || env!("CARGO_MANIFEST_DIR").into();
    let xtask = std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_else(built);
    Path::new(&xtask).join("..")
}

/// Cargo as it called us, in the workspace.
pub(crate) fn cargo(arguments: &str) -> Command {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    command
        .args(arguments.split_whitespace())
        .current_dir(root());
    command
}

/// Cargo's folder of what it builds.
pub(crate) fn target_folder() -> anyhow::Result<PathBuf> {
    let metadata = output(&mut cargo("metadata --format-version 1 --no-deps --locked"))?;
    let metadata: serde_json::Value = serde_json::from_str(&metadata)?;
    let target = metadata["target_directory"].as_str().context("a folder")?;
    Ok(PathBuf::from(target))
}

/// Runs steps and remembers what they took.
#[derive(Default)]
pub(crate) struct Steps {
    done: Vec<Step>,
}

/// A step that ended.
struct Step {
    name: &'static str,
    took: Duration,
    /// Of all processes that it waited for, user and system; not every system tells.
    processor: Option<Duration>,
    said: String,
}

impl Steps {
    /// Runs a step; what it returns stands in the summary.
    pub(crate) fn step(
        &mut self,
        name: &'static str,
        work: impl FnOnce() -> anyhow::Result<String>,
    ) -> anyhow::Result<()> {
        println!("── {name}");
        let (clock, before) = (Instant::now(), children_time());
        let said = work().with_context(|| format!("step '{name}'"))?;
        let step = Step {
            name,
            took: clock.elapsed(),
            processor: children_time()
                .zip(before)
                .map(|(after, before)| after - before),
            said,
        };
        println!(
            "   {name}: {} ({:.1} s)",
            step.said,
            step.took.as_secs_f64()
        );
        self.done.push(step);
        Ok(())
    }

    /// Prints all steps with their times: by the clock, and by the processors.
    pub(crate) fn summary(&self) {
        println!("\n── summary");
        println!("   {:<13} {:>9} {:>11}", "", "seconds", "processor s");
        let row = |name: &str, took: Duration, processor: Option<Duration>, said: &str| {
            let processor =
                processor.map_or("–".into(), |time| format!("{:.1}", time.as_secs_f64()));
            println!(
                "   {name:<13} {:>9.1} {processor:>11}  {said}",
                took.as_secs_f64()
            );
        };
        for step in &self.done {
            row(step.name, step.took, step.processor, &step.said);
        }
        let took = self.done.iter().map(|step| step.took).sum();
        let processor = self.done.iter().map(|step| step.processor).sum();
        row("together", took, processor, "");
    }

    /// Adds a line for each step to `target/test-times.csv`.
    pub(crate) fn record(&self, lane: &str) -> anyhow::Result<()> {
        let file = target_folder()?.join("test-times.csv");
        let is_new = !file.exists();
        let mut out = OpenOptions::new().create(true).append(true).open(&file)?;
        if is_new {
            writeln!(
                out,
                "ended (s since 1970),lane,step,seconds,processor seconds"
            )?;
        }
        let now = SystemTime::now().duration_since(UNIX_EPOCH)?.as_secs();
        for step in &self.done {
            let processor = step
                .processor
                .map_or(String::new(), |time| format!("{:.2}", time.as_secs_f64()));
            let seconds = step.took.as_secs_f64();
            writeln!(out, "{now},{lane},{},{seconds:.2},{processor}", step.name)?;
        }
        Ok(())
    }
}

/// Processor time, user and system, of all processes that ended and were waited for, with theirs. Linux tells.
pub(crate) fn children_time() -> Option<Duration> {
    let stat = fs::read_to_string("/proc/self/stat").ok()?;
    // The name, in parentheses, may hold blanks. Of what follows, fields 14 and 15 are of the children; their
    // unit is a hundredth of a second on every Linux (USER_HZ).
    let fields: Vec<&str> = stat.rsplit_once(')')?.1.split_whitespace().collect();
    let ticks: u64 = fields.get(13)?.parse::<u64>().ok()? + fields.get(14)?.parse::<u64>().ok()?;
    Some(Duration::from_millis(10 * ticks))
}

/// Runs a command; its output is ours.
pub(crate) fn run(command: &mut Command) -> anyhow::Result<()> {
    println!("   $ {}", typed(command));
    let status = command
        .status()
        .with_context(|| format!("cannot start: {}", typed(command)))?;
    if !status.success() {
        bail!("{status}: {}", typed(command));
    }
    Ok(())
}

/// Runs a command, shows what it prints and hands each line over: standard output and standard error in
/// the order in which they were written.
pub(crate) fn run_listening(
    command: &mut Command,
    mut heard: impl FnMut(&str),
) -> anyhow::Result<()> {
    println!("   $ {}", typed(command));
    let (output, input) = std::io::pipe()?;
    let mut child = command
        .stdout(input.try_clone()?)
        .stderr(input)
        .spawn()
        .with_context(|| format!("cannot start: {}", typed(command)))?;
    // The command holds the other ends of the pipe, and its output ends when they close.
    command.stdout(Stdio::null()).stderr(Stdio::null());
    for line in BufReader::new(output).split(b'\n') {
        let line = line?;
        let line = String::from_utf8_lossy(&line);
        println!("{line}");
        heard(&line);
    }
    let status = child.wait()?;
    if !status.success() {
        bail!("{status}: {}", typed(command));
    }
    Ok(())
}

/// What a command prints on standard output.
pub(crate) fn output(command: &mut Command) -> anyhow::Result<String> {
    let output = command
        .stderr(Stdio::inherit())
        .output()
        .with_context(|| format!("cannot start: {}", typed(command)))?;
    if !output.status.success() {
        bail!("{}: {}", output.status, typed(command));
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

/// The command as it could be typed.
pub(crate) fn typed(command: &Command) -> String {
    let program = Path::new(command.get_program());
    let name = program.file_name().unwrap_or(program.as_os_str());
    let words = std::iter::once(name).chain(command.get_args());
    let words: Vec<_> = words.map(|word| word.to_string_lossy()).collect();
    words.join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(target_os = "linux")]
    fn the_time_of_children_grows() {
        let before = children_time().expect("a time");
        let mut command = cargo("--version");
        while children_time().expect("a time") == before {
            output(&mut command).expect("Cargo has a version");
        }
    }

    #[test]
    fn both_outputs_of_a_command_are_heard() {
        let mut lines = Vec::new();
        let mut hear = |line: &str| lines.push(line.to_owned());
        run_listening(&mut cargo("--version"), &mut hear).expect("Cargo has a version");
        run_listening(&mut cargo("no-such-command"), &mut hear).expect_err("it fails");
        assert!(lines[0].starts_with("cargo "), "{lines:?}");
        assert!(lines[1..].concat().contains("no-such-command"), "{lines:?}");
    }
}
