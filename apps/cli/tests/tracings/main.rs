//! Tracings mended, compared and measured on the command line: `convert` with edits, `diff`, packed files,
//! tables of `info`.
//! Nothing here needs the features of pictures and windows.

mod compare;
mod mend;
mod neurom;
mod packed;
mod page;
mod table;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use serde_json::Value;
use tempfile::TempDir;

/// A soma with an axon and a forked dendrite.
const SMALL: &str = "# a small cell
1 1 0 0 0 5 -1
2 2 0 -9 0 1 1
3 2 0 -30 2 0.8 2
4 3 0 9 0 1.2 1
5 3 2 25 0 1 4
6 3 12 40 3 0.7 5
7 3 -9 42 -4 0.7 5
";

/// A folder to work in.
struct Work(TempDir);

impl Work {
    fn new() -> Self {
        Self(tempfile::tempdir().expect("a folder"))
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn file(&self, name: &str, content: impl AsRef<[u8]>) {
        let path = self.path(name);
        fs::create_dir_all(path.parent().expect("a parent")).expect("folders");
        fs::write(path, content).expect("written");
    }

    fn text(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).expect("there")
    }

    /// Names in the folder, sorted.
    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.0.path()).expect("a folder");
        let name = |entry: std::io::Result<fs::DirEntry>| entry.expect("an entry").file_name();
        let mut names: Vec<String> = entries
            .map(|entry| name(entry).to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }

    /// Runs the command in the folder; arguments are separated by blanks.
    fn run(&self, arguments: &str) -> Run {
        let output = Command::new(env!("CARGO_BIN_EXE_neurotess"))
            .args(arguments.split_whitespace())
            .current_dir(self.0.path())
            .stdin(Stdio::null())
            .output();
        Run(output.expect("it runs"))
    }
}

/// What a run left.
struct Run(Output);

impl Run {
    /// Asserts the exit code.
    fn exits(self, code: i32) -> Self {
        let found = self.0.status.code();
        assert_eq!(found, Some(code), "{}{}", self.stdout(), self.stderr());
        self
    }

    fn stdout(&self) -> String {
        String::from_utf8_lossy(&self.0.stdout).into_owned()
    }

    fn stderr(&self) -> String {
        String::from_utf8_lossy(&self.0.stderr).into_owned()
    }

    fn json(&self) -> Value {
        serde_json::from_slice(&self.0.stdout).expect("exactly one JSON document")
    }
}

/// The path of a sample of the repository.
fn sample(name: &str) -> String {
    let samples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples");
    samples.join(name).display().to_string()
}

neurotess_testing::main!();
