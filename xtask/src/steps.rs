//! Steps with a name and a time, and the summary at the end.

use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use anyhow::{Context, bail};

/// Folder of the workspace.
pub(crate) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
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
    done: Vec<(&'static str, Duration, String)>,
}

impl Steps {
    /// Runs a step; what it returns stands in the summary.
    pub(crate) fn step(
        &mut self,
        name: &'static str,
        work: impl FnOnce() -> anyhow::Result<String>,
    ) -> anyhow::Result<()> {
        println!("── {name}");
        let clock = Instant::now();
        let said = work().with_context(|| format!("step '{name}'"))?;
        let took = clock.elapsed();
        println!("   {name}: {said} ({:.1} s)", took.as_secs_f64());
        self.done.push((name, took, said));
        Ok(())
    }

    /// Prints all steps with their times.
    pub(crate) fn summary(&self) {
        println!("\n── summary");
        for (name, took, said) in &self.done {
            println!("   {name:<13} {:>7.1} s  {said}", took.as_secs_f64());
        }
        let total: Duration = self.done.iter().map(|(_, took, _)| *took).sum();
        println!("   {:<13} {:>7.1} s", "together", total.as_secs_f64());
    }
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
fn typed(command: &Command) -> String {
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
    fn both_outputs_of_a_command_are_heard() {
        let mut lines = Vec::new();
        let mut hear = |line: &str| lines.push(line.to_owned());
        run_listening(&mut cargo("--version"), &mut hear).expect("Cargo has a version");
        run_listening(&mut cargo("no-such-command"), &mut hear).expect_err("it fails");
        assert!(lines[0].starts_with("cargo "), "{lines:?}");
        assert!(lines[1..].concat().contains("no-such-command"), "{lines:?}");
    }
}
