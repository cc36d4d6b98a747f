//! A folder to work in, cells to work on, and the command.
#![cfg_attr(
    not(feature = "view"),
    allow(dead_code, reason = "the tests of pictures and windows use the rest")
)]

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;
use tempfile::TempDir;

/// A soma with an axon and a forked dendrite.
pub(crate) const SMALL: &str = "# a small cell
1 1 0 0 0 5 -1
2 2 0 -9 0 1 1
3 2 0 -30 2 0.8 2
4 3 0 9 0 1.2 1
5 3 2 25 0 1 4
6 3 12 40 3 0.7 5
7 3 -9 42 -4 0.7 5
";

/// A cell that cannot be read: line 2 has six columns.
pub(crate) const BROKEN: &str = "1 1 0 0 0 5 -1\n2 2 0 9 0 1\n";

/// The repository's folder.
pub(crate) fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The path of a sample of the repository.
pub(crate) fn sample(name: &str) -> String {
    root().join("samples").join(name).display().to_string()
}

/// A folder of its own.
pub(crate) struct Work(TempDir);

impl Work {
    pub(crate) fn new() -> Self {
        Self(tempfile::tempdir().expect("a folder"))
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Writes a file, making its folders.
    pub(crate) fn file(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path(name);
        fs::create_dir_all(path.parent().expect("a parent")).expect("folders");
        fs::write(&path, content).expect("written");
        path
    }

    /// The text of a file.
    pub(crate) fn text(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).expect("there")
    }

    /// The command in this folder, with arguments separated by blanks.
    pub(crate) fn command(&self, arguments: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_neurotess"));
        command
            .current_dir(self.0.path())
            .args(arguments.split_whitespace())
            .env_remove("NO_COLOR")
            // Mesa's layer that selects devices complains where there is no Wayland display.
            .env("NODEVICE_SELECT", "1");
        command
    }

    /// Runs it to its end.
    pub(crate) fn run(&self, arguments: &str) -> Run {
        Run(self.command(arguments).output().expect("it runs"))
    }

    /// All files below a folder with their content, without the record of what they were made of.
    pub(crate) fn files(&self, folder: &str) -> BTreeMap<PathBuf, Vec<u8>> {
        let mut files = BTreeMap::new();
        collect(&self.path(folder), &mut files);
        files
    }

    /// Names of the files directly in a folder.
    pub(crate) fn names(&self, folder: &str) -> Vec<String> {
        let name = |path: &PathBuf| path.file_name().map(|n| n.to_string_lossy().into_owned());
        self.files(folder).keys().filter_map(name).collect()
    }
}

fn collect(folder: &Path, files: &mut BTreeMap<PathBuf, Vec<u8>>) {
    let Ok(entries) = fs::read_dir(folder) else {
        return;
    };
    for entry in entries.flatten() {
        let path = entry.path();
        if path.is_dir() {
            collect(&path, files);
        } else if path
            .file_name()
            .is_none_or(|name| name != ".neurotess-made")
        {
            files.insert(path.clone(), fs::read(&path).expect("readable"));
        }
    }
}

/// What a run left.
pub(crate) struct Run(pub(crate) Output);

impl Run {
    pub(crate) fn code(&self) -> i32 {
        self.0.status.code().unwrap_or(-1)
    }

    pub(crate) fn stdout(&self) -> String {
        String::from_utf8_lossy(&self.0.stdout).into_owned()
    }

    pub(crate) fn stderr(&self) -> String {
        String::from_utf8_lossy(&self.0.stderr).into_owned()
    }

    /// Asserts the exit code; shows what was said otherwise.
    pub(crate) fn exits(self, code: i32) -> Self {
        assert_eq!(self.code(), code, "{}{}", self.stdout(), self.stderr());
        self
    }

    /// Standard output as the one JSON document that it must be.
    pub(crate) fn json(&self) -> Value {
        serde_json::from_slice(&self.0.stdout).expect("exactly one JSON document")
    }

    /// Lines of standard error that begin with `error:`.
    pub(crate) fn errors(&self) -> Vec<String> {
        let lines = self.stderr();
        let errors = lines.lines().filter(|line| line.starts_with("error:"));
        errors.map(str::to_owned).collect()
    }
}

/// A neurite of many points: takes long to mesh at high levels.
pub(crate) fn long_cell(points: usize) -> String {
    let mut text = String::from("1 1 0 0 0 5 -1\n");
    for i in 0..points {
        let (y, x) = (8.0 + 3.0 * i as f64, f64::from((i % 7) as u32) * 0.3);
        let parent = if i == 0 { 1 } else { i + 1 };
        let _ = writeln!(text, "{} 3 {x} {y} 0 1 {parent}", i + 2);
    }
    text
}
