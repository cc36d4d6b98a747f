//! The copy of the sources in which numbers can be changed.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, bail};
use serde_json::Value;
use walkdir::WalkDir;

use super::super::PROGRAM;
use super::rewrite::{Excluded, Knob, Rewritten, Sources, rewrite};
use crate::steps::{self, output, root};

/// Where it is built.
pub(super) const FOLDER: &str = "target/sweep";
/// Crates whose numbers are swept.
const CRATES: [&str; 2] = ["generate", "union"];

/// A program that measures, and the numbers that it can change.
pub(super) struct Program {
    pub(super) file: PathBuf,
    pub(super) knobs: Vec<Knob>,
    pub(super) excluded: Excluded,
}

/// Copies, rewrites and builds; what does not compile stays as it is.
pub(super) fn program() -> anyhow::Result<Program> {
    let folder = root().join(FOLDER);
    let (copy, build) = (folder.join("sources"), folder.join("build"));
    copy_sources(&copy)?;
    let crates: Vec<Sources> = CRATES
        .iter()
        .map(|name| sources(name))
        .collect::<Result<_, _>>()?;
    let mut excluded = Excluded::new();
    loop {
        let mut knobs = Vec::new();
        let mut rewritten = Vec::new();
        for (name, sources) in CRATES.iter().zip(&crates) {
            let with = rewrite(sources, &excluded, knobs.len());
            write(&copy, name, sources, &with)?;
            knobs.extend(with.knobs.iter().cloned());
            rewritten.push(with);
        }
        let mut cargo = Command::new(env!("CARGO"));
        cargo.current_dir(&copy).env("CARGO_TARGET_DIR", &build);
        let mut check = Command::new(env!("CARGO"));
        check.current_dir(&copy).env("CARGO_TARGET_DIR", &build);
        check.args(
            "check --locked -p neurotess-generate -p neurotess-union --message-format=json"
                .split(' '),
        );
        let said = check.output()?;
        if said.status.success() {
            cargo
                .args("build --release --locked".split(' '))
                .args(PROGRAM.split(' '));
            steps::run(&mut cargo)?;
            return Ok(Program {
                file: build.join("release/examples/quality"),
                knobs,
                excluded,
            });
        }
        let messages = String::from_utf8_lossy(&said.stdout).into_owned();
        let known = excluded.len();
        for place in errors(&messages) {
            excluded.extend(at(&crates, &rewritten, &place));
        }
        if excluded.len() == known {
            bail!(
                "the copy in {} does not compile: {}",
                copy.display(),
                rendered(&messages)
            );
        }
    }
}

/// A crate's files.
fn sources(name: &str) -> anyhow::Result<Sources> {
    let folder = root().join("crates").join(name).join("src");
    let mut files = Vec::new();
    for entry in WalkDir::new(&folder).sort_by_file_name() {
        let path = entry?.into_path();
        let is_code = path.extension().is_some_and(|extension| extension == "rs");
        if is_code && !path.ends_with("tests.rs") {
            let module = path.strip_prefix(&folder)?.with_extension("");
            let text = fs::read_to_string(&path)?;
            files.push((format!("{name}/{}", module.display()), text));
        }
    }
    Ok(Sources { files })
}

fn file(copy: &Path, module: &str) -> PathBuf {
    let (name, module) = module.split_once('/').unwrap_or_default();
    copy.join("crates")
        .join(name)
        .join("src")
        .join(module)
        .with_extension("rs")
}

fn write(copy: &Path, name: &str, sources: &Sources, with: &Rewritten) -> anyhow::Result<()> {
    for ((module, _), text) in sources.files.iter().zip(&with.texts) {
        let text = match module.ends_with("/lib") {
            true => format!("{text}mod knob;\n"),
            false => text.clone(),
        };
        update(&file(copy, module), text.as_bytes())?;
    }
    update(
        &file(copy, &format!("{name}/knob")),
        include_bytes!("knob.rs"),
    )
}

/// Files and lines (from 0) of errors.
fn errors(messages: &str) -> Vec<(String, std::ops::Range<usize>)> {
    let messages = messages
        .lines()
        .filter_map(|line| serde_json::from_str::<Value>(line).ok());
    let errors = messages.filter(|message| message["message"]["level"] == "error");
    let mut places = Vec::new();
    for error in errors {
        for span in error["message"]["spans"].as_array().into_iter().flatten() {
            let [from, to] =
                ["line_start", "line_end"].map(|key| span[key].as_u64().unwrap_or(1) as usize);
            places.push((
                span["file_name"].as_str().unwrap_or_default().to_owned(),
                from - 1..to,
            ));
        }
    }
    places
}

fn rendered(messages: &str) -> String {
    let messages = messages
        .lines()
        .filter_map(|line| serde_json::from_str::<Value>(line).ok());
    let texts =
        messages.filter_map(|message| message["message"]["rendered"].as_str().map(str::to_owned));
    texts.collect()
}

/// What is to be excluded because of an error.
fn at(
    crates: &[Sources],
    rewritten: &[Rewritten],
    (name, range): &(String, std::ops::Range<usize>),
) -> Vec<String> {
    let mut found = Vec::new();
    for (sources, with) in crates.iter().zip(rewritten) {
        for ((module, _), at) in sources.files.iter().zip(&with.at) {
            if file(Path::new(""), module) == Path::new(name) {
                found.extend(
                    range
                        .clone()
                        .filter_map(|line| at.get(&line))
                        .flatten()
                        .cloned(),
                );
            }
        }
    }
    found
}

/// Copies what git knows or would add, but for what is rewritten; files that are the same stay untouched, so that little is
/// built again.
fn copy_sources(to: &Path) -> anyhow::Result<()> {
    let mut list = Command::new("git");
    list.current_dir(root())
        .args(["ls-files", "--cached", "--others", "--exclude-standard"]);
    let is_swept = |file: &str| {
        let mut folders = CRATES.iter().map(|name| format!("crates/{name}/src/"));
        folders.any(|folder| file.starts_with(&folder)) && !file.ends_with("tests.rs")
    };
    for file in output(&mut list)?.lines().filter(|file| !is_swept(file)) {
        let Ok(bytes) = fs::read(root().join(file)) else {
            continue; // removed, and not yet committed
        };
        update(&to.join(file), &bytes)?;
    }
    Ok(())
}

/// Writes a file where it differs.
fn update(file: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    if fs::read(file).is_ok_and(|there| there == bytes) {
        return Ok(());
    }
    fs::create_dir_all(file.parent().context("a file is in a folder")?)?;
    Ok(fs::write(file, bytes)?)
}
