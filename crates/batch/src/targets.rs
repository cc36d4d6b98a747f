//! Which file each input becomes.
//!
//! A single file is written to the file OUT (or into OUT, if that is a folder). Several files, a
//! folder or a glob are written into the folder OUT, which repeats the structure below the input's
//! folder, so that files with equal names in different folders do not collide.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use neurotess_formats as formats;

use crate::inputs::{Input, Inputs};
use crate::standard::is_standard;

/// A file and what it becomes.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Job {
    /// The file to read.
    pub input: PathBuf,
    /// The file to write.
    pub out: PathBuf,
    /// The instance of a circuit with its placement, as text; empty for a file.
    pub placement: String,
    /// Files that it is made of besides `input`.
    pub further: Vec<PathBuf>,
    /// A file that is written beside it, without which it is not complete.
    pub beside: Option<PathBuf>,
    /// Whether `out` is not itself written, but files named after it, one for each type.
    pub parts: bool,
}

impl Job {
    /// One file becomes one file.
    pub fn new(input: PathBuf, out: PathBuf) -> Self {
        Self {
            input,
            out,
            placement: String::new(),
            further: Vec::new(),
            beside: None,
            parts: false,
        }
    }
}

/// Why inputs cannot become the files that are asked for.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TargetError {
    /// Several inputs for standard output.
    #[error("standard output takes one file, but there are several inputs: give a folder")]
    Standard,
    /// A file is where the folder is to be.
    #[error("{} is a file, but several inputs need a folder: give another OUT", .0.display())]
    NotAFolder(PathBuf),
    /// Two inputs would become one file.
    #[error(
        "{} and {} would both become {}: give their common folder, or run them apart",
        inputs[0].display(), inputs[1].display(), out.display()
    )]
    Collide {
        /// The inputs.
        inputs: [PathBuf; 2],
        /// The file.
        out: PathBuf,
    },
}

/// Whether OUT is a folder: for anything but a single file, and if it already is one.
pub fn is_folder(out: &Path, inputs: &Inputs) -> bool {
    !inputs.one_file || !is_standard(out) && (out.is_dir() || ends_in_separator(out))
}

/// One job per input; `extension` is that of files in a folder.
///
/// # Errors
/// Two inputs would become one file, or there is no folder for several.
pub fn plan(inputs: &Inputs, out: &Path, extension: &str) -> Result<Vec<Job>, TargetError> {
    let folder = is_folder(out, inputs);
    if folder && is_standard(out) {
        return Err(TargetError::Standard);
    }
    if folder && out.is_file() {
        return Err(TargetError::NotAFolder(out.to_path_buf()));
    }
    let mut taken: BTreeMap<PathBuf, &Path> = BTreeMap::new();
    let mut jobs = Vec::with_capacity(inputs.files.len());
    for Input { path, relative } in &inputs.files {
        let target = if folder {
            named(&out.join(relative), extension)
        } else {
            out.to_path_buf()
        };
        if let Some(other) = taken.insert(target.clone(), path) {
            return Err(TargetError::Collide {
                inputs: [other.to_path_buf(), path.clone()],
                out: target,
            });
        }
        jobs.push(Job::new(path.clone(), target));
    }
    Ok(jobs)
}

/// The path with this extension instead of its own, and of `.gz`; dots within the name stay.
fn named(path: &Path, extension: &str) -> PathBuf {
    formats::unpacked_name(path).with_extension(extension)
}

fn ends_in_separator(path: &Path) -> bool {
    let text = path.as_os_str().as_encoded_bytes();
    text.last()
        .is_some_and(|&byte| std::path::is_separator(char::from(byte)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn inputs(relatives: &[&str], one_file: bool) -> Inputs {
        let input = |relative: &&str| Input {
            path: Path::new("in").join(relative),
            relative: relative.into(),
        };
        Inputs {
            files: relatives.iter().map(input).collect(),
            not_found: vec![],
            one_file,
            others: 0,
        }
    }

    #[test]
    fn structure_is_repeated() {
        let files = inputs(&["a.CNG.swc", "sub/a.CNG.swc"], false);
        let jobs = plan(&files, Path::new("missing-out"), "ply").expect("a plan");
        let out: Vec<_> = jobs.iter().map(|job| job.out.clone()).collect();
        let expected =
            ["a.CNG.ply", "sub/a.CNG.ply"].map(|name| Path::new("missing-out").join(name));
        assert_eq!(out, expected);
    }

    #[test]
    fn one_file_becomes_one_file() {
        let jobs = plan(&inputs(&["a.swc"], true), Path::new("x/b.ply"), "ply").expect("a plan");
        assert_eq!(jobs[0].out, Path::new("x/b.ply"));
        let jobs = plan(&inputs(&["a.swc"], true), Path::new("x/"), "ply").expect("a plan");
        assert_eq!(jobs[0].out, Path::new("x/a.ply"));
        let jobs = plan(&inputs(&["a.swc.gz"], true), Path::new("x/"), "ply").expect("a plan");
        assert_eq!(jobs[0].out, Path::new("x/a.ply"));
    }

    #[test]
    fn equal_targets_are_wrong_usage() {
        let error = plan(
            &inputs(&["a.swc", "a.eswc"], false),
            Path::new("out"),
            "ply",
        );
        assert!(
            error
                .expect_err("they collide")
                .to_string()
                .contains("both become")
        );
    }
}
