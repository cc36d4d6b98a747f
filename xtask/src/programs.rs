//! The workspace's test programs: built in one go, then run two at a time.

use std::io::Read;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::sync::{Mutex, PoisonError, mpsc};
use std::thread;
use std::time::Instant;

use anyhow::{Context, anyhow};
use serde_json::Value;

use crate::counts::Counts;
use crate::lane::Lane;
use crate::steps::{self, cargo, output};

/// Programs that run at the same time. Each runs a test on every core, but each has stretches that one core does:
/// its last test, a driver that waits. With two the cores are busy, with more the programs that look at a clock
/// wait for each other.
const AT_ONCE: usize = 2;

/// What takes longest begins first, so that nothing of length is left for the end.
const FIRST: [&str; 3] = [
    "neurotess-viewer it",
    "neurotess-cli it",
    "neurotess-render it",
];

/// A test program that Cargo has built.
#[derive(Debug)]
pub(crate) struct Program {
    /// The package, and which of its programs.
    name: String,
    file: PathBuf,
    /// Whether libtest runs it, or the harness of `neurotess-testing`.
    has_libtest: bool,
    /// The package's folder, in which its tests run.
    folder: PathBuf,
}

/// Builds the libraries, the command, the Python module and all test programs. The quick lane leaves the examples
/// to clippy.
pub(crate) fn build(lane: Lane) -> anyhow::Result<Vec<Program>> {
    let mut build = cargo("build --workspace --locked --lib --bins --tests");
    if lane == Lane::Full {
        build.arg("--examples");
    }
    build.arg("--message-format=json-render-diagnostics");
    println!("   $ {}", steps::typed(&build));
    let messages = output(&mut build)?;
    let mut programs: Vec<Program> = messages.lines().filter_map(program).collect();
    programs.sort_by_key(|program| {
        let first = FIRST.iter().position(|name| *name == program.name);
        (first.unwrap_or(FIRST.len()), program.name.clone())
    });
    Ok(programs)
}

/// Builds a single program and says where it is.
pub(crate) fn executable(build: &str) -> anyhow::Result<PathBuf> {
    let mut build = cargo(build);
    build.arg("--message-format=json-render-diagnostics");
    println!("   $ {}", steps::typed(&build));
    let messages = output(&mut build)?;
    let executable = |message: &str| {
        let message: Value = serde_json::from_str(message).ok()?;
        message["executable"].as_str().map(PathBuf::from)
    };
    let found = messages.lines().rev().find_map(executable);
    found.context("Cargo built no program")
}

/// The test program that a message of Cargo's tells of.
fn program(message: &str) -> Option<Program> {
    let message: Value = serde_json::from_str(message).ok()?;
    if message["reason"] != "compiler-artifact" || message["profile"]["test"] != true {
        return None;
    }
    let text = |value: &Value| value.as_str().map(str::to_owned);
    let folder = PathBuf::from(text(&message["manifest_path"])?)
        .parent()?
        .to_path_buf();
    let manifest: toml::Table = std::fs::read_to_string(folder.join("Cargo.toml"))
        .ok()?
        .parse()
        .ok()?;
    let package = manifest.get("package")?.get("name")?.as_str()?;
    let target = match text(&message["target"]["kind"][0])?.as_str() {
        "test" => text(&message["target"]["name"])?,
        _ => "unit".into(),
    };
    Some(Program {
        has_libtest: target == "unit",
        name: format!("{package} {target}"),
        file: text(&message["executable"])?.into(),
        folder,
    })
}

/// Runs all programs; what each prints is shown when it has ended.
pub(crate) fn run(programs: &[Program], lane: Lane, counts: &mut Counts) -> anyhow::Result<()> {
    let waiting = Mutex::new(programs.iter());
    let (sender, ended) = mpsc::channel();
    thread::scope(|scope| {
        for _ in 0..AT_ONCE {
            let (sender, waiting) = (sender.clone(), &waiting);
            scope.spawn(move || {
                let next = || {
                    waiting
                        .lock()
                        .unwrap_or_else(PoisonError::into_inner)
                        .next()
                };
                while let Some(program) = next() {
                    // The receiver is there until all have ended.
                    let _ = sender.send((program, program.run(lane)));
                }
            });
        }
        drop(sender);
        let mut first = Ok(());
        for (program, ended) in ended {
            let failed_before = counts.failures().len();
            let run = ended?;
            counts.begin(&program.name);
            println!("     Running {} ({:.1} s)", program.name, run.seconds);
            for line in run.printed.lines() {
                println!("{line}");
                counts.hear(line);
            }
            // A test that failed is told of at the end; a program that ended in another way is told of at once.
            if !run.ended_well && counts.failures().len() == failed_before && first.is_ok() {
                first = Err(anyhow!("{} ended before its tests", program.name));
            }
        }
        first
    })
}

/// How a program ended.
struct Run {
    printed: String,
    ended_well: bool,
    seconds: f64,
}

impl Program {
    fn run(&self, lane: Lane) -> anyhow::Result<Run> {
        let clock = Instant::now();
        let (mut output, input) = std::io::pipe()?;
        let mut command = Command::new(&self.file);
        if lane == Lane::Full && self.has_libtest {
            command.arg("--include-ignored");
        }
        command
            .current_dir(&self.folder)
            .stdin(Stdio::null())
            .stdout(input.try_clone()?)
            .stderr(input)
            .envs(lane.variables())
            // Lines are read: without colors.
            .env("NO_COLOR", "1")
            .env_remove("CLICOLOR_FORCE");
        let mut child = command
            .spawn()
            .with_context(|| format!("cannot start {}", self.name))?;
        // The command holds the other ends of the pipe, and its output ends when they close.
        drop(command);
        let mut printed = Vec::new();
        output.read_to_end(&mut printed)?;
        let status = child.wait()?;
        let mut printed = String::from_utf8_lossy(&printed).into_owned();
        if status.code().is_none() {
            printed += &format!("\n{status}\n");
        }
        Ok(Run {
            printed,
            ended_well: status.success(),
            seconds: clock.elapsed().as_secs_f64(),
        })
    }
}
