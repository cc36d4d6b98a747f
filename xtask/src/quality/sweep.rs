//! `cargo xtask sweep`: what surfaces of real cells are worth with a number of the code halved, doubled, …
//!
//! A copy of the sources is changed and built in a folder of its own, so that the checkout stays as it is.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, bail};
use serde_json::{Value, json};

use super::{cells, table};
use crate::steps::{self, output, root};

const USAGE: &str = "cargo xtask sweep CRATE/MODULE::CONSTANT [FACTOR…] [FILE…], as in generate/plan/zone::MAX_RATIO 0.5 2";
/// Where the copy is built.
const FOLDER: &str = "target/sweep";
/// Factors where none are given.
const FACTORS: [f64; 2] = [0.5, 2.0];

/// Runs the command.
pub(crate) fn run(arguments: impl Iterator<Item = String>) -> anyhow::Result<()> {
    let mut arguments = arguments.peekable();
    let name = arguments.next().context(USAGE)?;
    let mut factors = Vec::new();
    while let Some(factor) = arguments.peek().and_then(|word| word.parse::<f64>().ok()) {
        factors.push(factor);
        arguments.next();
    }
    if factors.is_empty() {
        factors.extend(FACTORS);
    }
    let mut files: Vec<PathBuf> = arguments.map(PathBuf::from).collect();
    if files.is_empty() {
        files = cells::files()?;
    }
    let constant = Constant::find(&name)?;
    let copy = root().join(FOLDER).join("sources");
    copy_sources(&copy)?;
    let mut measured = Vec::new();
    for factor in [1.0].into_iter().chain(factors) {
        let literal = constant.times(factor);
        fs::write(copy.join(&constant.file), constant.with(&literal))?;
        measured.push((literal, measure(&copy, &files)?));
    }
    println!(
        "\n{name}, beside what it is now\n\n{}",
        table::beside(&measured)
    );
    Ok(())
}

/// A number in the sources.
struct Constant {
    /// From the root.
    file: PathBuf,
    text: String,
    /// Where its value stands in the text.
    place: std::ops::Range<usize>,
    is_whole: bool,
}

impl Constant {
    fn find(name: &str) -> anyhow::Result<Self> {
        let (module, constant) = name.split_once("::").context(USAGE)?;
        let (of_crate, module) = module.split_once('/').context(USAGE)?;
        let folder = Path::new("crates").join(of_crate).join("src");
        let candidates = [format!("{module}.rs"), format!("{module}/mod.rs")];
        let mut files = candidates.iter().map(|file| folder.join(file));
        let file = files
            .find(|file| root().join(file).is_file())
            .with_context(|| format!("no module {module} in {}", folder.display()))?;
        let text = fs::read_to_string(root().join(&file))?;
        let head = format!("const {constant}: ");
        let at = text
            .find(&head)
            .with_context(|| format!("no constant {constant} in {}", file.display()))?;
        let rest = &text[at + head.len()..];
        let (kind, value) = rest
            .split_once(" = ")
            .context("a constant without a value")?;
        let value = value.split(';').next().unwrap_or_default();
        let start = at + head.len() + kind.len() + 3;
        if value.replace('_', "").parse::<f64>().is_err() {
            bail!("{constant} is {value}: only numbers are swept");
        }
        Ok(Self {
            is_whole: !kind.starts_with('f'),
            place: start..start + value.len(),
            file,
            text,
        })
    }

    /// Its value times a factor, as Rust writes it.
    fn times(&self, factor: f64) -> String {
        let value = self.text[self.place.clone()].replace('_', "");
        let value = factor * value.parse::<f64>().unwrap_or_default();
        match self.is_whole {
            true => format!("{}", value.round()),
            false => format!("{value:?}"),
        }
    }

    /// The file with another value.
    fn with(&self, literal: &str) -> String {
        let mut text = self.text.clone();
        text.replace_range(self.place.clone(), literal);
        text
    }
}

/// Copies what git knows or would add; files that are the same stay untouched, so that little is built again.
fn copy_sources(to: &Path) -> anyhow::Result<()> {
    let mut list = Command::new("git");
    list.current_dir(root())
        .args(["ls-files", "--cached", "--others", "--exclude-standard"]);
    for file in output(&mut list)?.lines() {
        let (from, to) = (root().join(file), to.join(file));
        let Ok(bytes) = fs::read(&from) else {
            continue; // removed, and not yet committed
        };
        if fs::read(&to).is_ok_and(|there| there == bytes) {
            continue;
        }
        fs::create_dir_all(to.parent().context("a file is in a folder")?)?;
        fs::write(to, bytes)?;
    }
    Ok(())
}

/// Figures of surfaces, by the copy as it is now.
fn measure(copy: &Path, files: &[PathBuf]) -> anyhow::Result<Value> {
    let target = root().join(FOLDER).join("build");
    let mut build = Command::new(env!("CARGO"));
    build
        .current_dir(copy)
        .env("CARGO_TARGET_DIR", &target)
        .args("build --release --locked -p neurotess --example quality".split(' '));
    steps::run(&mut build)?;
    let printed = output(Command::new(target.join("release/examples/quality")).args(files))?;
    let rows: Result<Vec<Value>, _> = printed.lines().map(serde_json::from_str).collect();
    Ok(json!({ "cells": rows? }))
}
