//! `cargo xtask quality`: what meshes of real cells are worth, as one table; and whether it got worse.
//!
//! Figures are those of the example `quality` of the crate `neurotess`.

mod cells;
pub(crate) mod sweep;
mod table;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, bail};
use serde_json::{Value, json};

use crate::steps::{self, Steps, cargo, output, root, target_folder};

const USAGE: &str = "cargo xtask quality [--against BEFORE.json] [--page] [--base] [FILE…]";
/// Where figures and table are written.
const FOLDER: &str = "out/quality";

/// Figures of a commit that all later ones are compared with, so that many small losses are seen as one.
const BASE: &str = "benchmarks/quality_base.json";

/// What is built, without what it does not need.
const PROGRAM: &str = "-p neurotess --example quality --no-default-features --features asc,h5";

/// What stands above the table of the page.
const PREFACE: &str = include_str!("preface.md");

/// What was asked for.
#[derive(Default)]
struct Asked {
    /// Figures of another build, to compare with.
    against: Option<PathBuf>,
    /// Whether the table becomes `benchmarks/quality.md`.
    page: bool,
    /// Whether the figures become the base that later ones are compared with.
    base: bool,
    files: Vec<PathBuf>,
}

/// Runs the command.
pub(crate) fn run(mut arguments: impl Iterator<Item = String>) -> anyhow::Result<()> {
    let mut asked = Asked::default();
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--against" => asked.against = Some(arguments.next().context(USAGE)?.into()),
            "--page" => asked.page = true,
            "--base" => asked.base = true,
            option if option.starts_with('-') => bail!("{option}: not an option\n\n{USAGE}"),
            file => asked.files.push(file.into()),
        }
    }
    if asked.files.is_empty() {
        asked.files = cells::files()?;
    }
    let base = root().join(BASE);
    let mut before = vec![("the base", base.clone())];
    before.extend(asked.against.map(|file| ("before", file)));
    let before: anyhow::Result<Vec<(&str, Value)>> = (before.into_iter())
        .filter(|(_, file)| !asked.base || *file != base)
        .map(|(name, file)| Ok((name, read(&file)?)))
        .collect();
    let before = before?;
    let folder = root().join(FOLDER);
    fs::create_dir_all(&folder)?;
    let mut rows = Vec::new();
    let mut steps = Steps::default();
    steps.step("build", build)?;
    steps.step("surfaces", || {
        rows = measured(None, &asked.files)?;
        if let Some(row) = rows.iter().find(|row| row["error"].is_string()) {
            bail!("{}: {}", row["file"], row["error"]);
        }
        Ok(format!("{} cells", rows.len()))
    })?;
    steps.step("simulation", || {
        let meshes = measured(Some("--simulated"), &asked.files)?;
        for (row, mesh) in rows.iter_mut().zip(meshes) {
            row["simulation"] = mesh;
        }
        Ok("a mesh for simulations of each".into())
    })?;
    let commit = output(
        Command::new("git")
            .current_dir(root())
            .args(["describe", "--always", "--dirty"]),
    )?;
    let figures = json!({ "commit": commit.trim(), "cells": rows });
    fs::write(
        folder.join("quality.json"),
        serde_json::to_string_pretty(&figures)?,
    )?;
    let text = format!("{PREFACE}\n{}", table::table(&figures));
    fs::write(folder.join("quality.md"), &text)?;
    if asked.page {
        fs::write(root().join("benchmarks/quality.md"), &text)?;
    }
    println!("\n{}", table::table(&figures));
    println!("{FOLDER}/quality.json has the figures");
    if asked.base {
        fs::write(base, format!("{}\n", untimed(figures.clone())))?;
    }
    let mut worse = Vec::new();
    for (name, before) in &before {
        let compared = table::compare(before, &figures);
        println!("\nbeside {name}, {}\n\n{}", before["commit"], compared.text);
        worse.extend(
            compared
                .worse
                .into_iter()
                .map(|what| format!("{what} than {name}")),
        );
    }
    match worse.as_slice() {
        [] => Ok(()),
        worse => bail!("worse: {}", worse.join(", ")),
    }
}

/// Figures without times, which other machines and days have others of.
fn untimed(mut figures: Value) -> Value {
    let without_times = |part: &mut Value| {
        if let Some(part) = part.as_object_mut() {
            part.retain(|key, _| !key.ends_with("seconds"));
        }
    };
    for cell in figures["cells"].as_array_mut().into_iter().flatten() {
        without_times(&mut cell["simulation"]);
        without_times(cell);
    }
    figures
}

fn read(file: &Path) -> anyhow::Result<Value> {
    let text = fs::read_to_string(file).with_context(|| file.display().to_string())?;
    Ok(serde_json::from_str(&text)?)
}

fn build() -> anyhow::Result<String> {
    steps::run(&mut cargo(&format!("build --release --locked {PROGRAM}")))?;
    Ok("what measures surfaces".into())
}

/// What the example says of each file; without a flag, of its surface.
fn measured(flag: Option<&str>, files: &[PathBuf]) -> anyhow::Result<Vec<Value>> {
    let program = target_folder()?.join("release/examples/quality");
    let printed = output(Command::new(program).args(flag).args(files))?;
    let rows: Result<Vec<Value>, _> = printed.lines().map(serde_json::from_str).collect();
    let mut rows = rows?;
    for (row, file) in rows.iter_mut().zip(files) {
        row["file"] = json!(file.file_name().unwrap_or_default().to_string_lossy());
    }
    Ok(rows)
}
