//! Inputs: files, folders searched recursively, globs, standard input (`-`).

use std::collections::BTreeSet;
use std::fs;
use std::path::{Component, Path, PathBuf};

use neurotess_formats as formats;
use rayon::prelude::*;
use walkdir::WalkDir;

use crate::standard::is_standard;

/// A file to read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Input {
    /// The file; `-` for standard input.
    pub path: PathBuf,
    /// Its path below the folder (or the constant part of the glob) that it was found in; the bare
    /// name of a file that was named itself.
    pub relative: PathBuf,
}

/// Where nothing was found: `PATH: what: what to do`.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}: {what}", path.display())]
pub struct NotFound {
    /// The folder, or the glob.
    pub path: PathBuf,
    /// What is wrong, and what to do.
    pub what: String,
}

/// All inputs of some work.
#[derive(Clone, Debug, Default)]
pub struct Inputs {
    /// Files in the order of the arguments, those of a folder or a glob sorted. No file twice.
    pub files: Vec<Input>,
    /// Arguments without any file, and folders that could not be searched.
    pub not_found: Vec<NotFound>,
    /// Whether one file, and no folder or glob, was named.
    pub one_file: bool,
    /// Number of HDF5 files in folders that are not morphologies.
    pub others: usize,
}

impl Inputs {
    /// Finds the files. In folders only files with one of the extensions count; files that are
    /// named, and what a glob matches, count whatever their name.
    pub fn find(arguments: &[PathBuf], extensions: &[&str]) -> Self {
        let mut search = Search {
            extensions,
            seen: BTreeSet::new(),
            found: Self::default(),
        };
        for argument in arguments {
            search.argument(argument);
        }
        search.found.one_file = match arguments {
            [one] => !one.is_dir() && (one.exists() || !is_pattern(one)),
            _ => false,
        };
        search.found
    }
}

struct Search<'a> {
    extensions: &'a [&'a str],
    seen: BTreeSet<PathBuf>,
    found: Inputs,
}

impl Search<'_> {
    fn argument(&mut self, argument: &Path) {
        if is_standard(argument) {
            self.add(argument.to_path_buf(), PathBuf::from("stdin"));
        } else if self.skeletons(argument) {
            // All of a folder of neuroglancer's.
        } else if argument.is_dir() {
            if self.folder(argument, argument) == 0 {
                let known = self.extensions.join(", .");
                self.fail(
                    argument,
                    &format!("no file to read in this folder: it needs files named .{known}"),
                );
            }
        } else if let (_, Some(member)) = formats::member(argument) {
            let member = member.trim_matches('/').replace('/', "_");
            self.add(
                argument.to_path_buf(),
                PathBuf::from(format!("{member}.h5")),
            );
        } else if argument.exists() || !is_pattern(argument) {
            let name = argument.file_name().unwrap_or(argument.as_os_str());
            // A missing file is an error of the reader, with the system's reason.
            self.add(argument.to_path_buf(), PathBuf::from(name));
        } else {
            self.pattern(argument);
        }
    }

    /// Adds the skeletons of neuroglancer's precomputed data, if it is a folder of them.
    #[cfg(feature = "json")]
    fn skeletons(&mut self, folder: &Path) -> bool {
        let all = match formats::precomputed::Skeletons::open(folder) {
            Ok(Some(skeletons)) => skeletons.ids().map(|ids| (skeletons, ids)),
            Ok(None) => return false,
            Err(e) => Err(e),
        };
        match all {
            Ok((skeletons, ids)) => {
                for id in ids {
                    let name = id.to_string();
                    self.add(skeletons.folder().join(&name), PathBuf::from(name));
                }
            }
            Err(e) => self.found.not_found.push(NotFound {
                path: e.file.clone().into(),
                what: e.fault.to_string(),
            }),
        }
        true
    }

    /// This build reads none.
    #[cfg(not(feature = "json"))]
    fn skeletons(&mut self, _folder: &Path) -> bool {
        false
    }

    /// Adds what is below a folder; returns how many files there are.
    fn folder(&mut self, folder: &Path, base: &Path) -> usize {
        let mut paths = Vec::new();
        for entry in WalkDir::new(folder).follow_links(true) {
            match entry {
                Ok(entry) if entry.file_type().is_dir() || !self.is_readable(entry.path()) => {}
                // Entries that are not files, such as links to devices, are rejected by the reader.
                Ok(entry) => paths.push(entry.into_path()),
                Err(e) => {
                    let at = e.path().unwrap_or(folder).to_path_buf();
                    self.fail(&at, "cannot be searched: check links and permissions");
                }
            }
        }
        let all = paths.len();
        paths = paths
            .into_par_iter()
            .filter(|path| !is_other(path))
            .collect();
        self.found.others += all - paths.len();
        paths.sort();
        let count = paths.len();
        for path in paths {
            let relative = path.strip_prefix(base).unwrap_or(&path).to_path_buf();
            self.add(path, relative);
        }
        count
    }

    fn pattern(&mut self, pattern: &Path) {
        let matches = match glob::glob(&pattern.to_string_lossy()) {
            Ok(matches) => matches,
            Err(e) => return self.fail(pattern, &format!("not a glob ({e}): quote or correct it")),
        };
        let base = constant_part(pattern);
        let mut paths: Vec<PathBuf> = matches.flatten().collect();
        paths.sort();
        let mut count = 0;
        for path in paths {
            if path.is_dir() {
                count += self.folder(&path, &base);
            } else {
                let relative = path.strip_prefix(&base).unwrap_or(&path).to_path_buf();
                self.add(path, relative);
                count += 1;
            }
        }
        if count == 0 {
            self.fail(pattern, "no file matches: correct the path or the glob");
        }
    }

    fn is_readable(&self, path: &Path) -> bool {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let name = name.to_ascii_lowercase();
        // Of files packed by gzip, the extension is two words.
        let ends = |known: &&str| {
            let stem = name.strip_suffix(*known);
            stem.is_some_and(|stem| stem.ends_with('.'))
        };
        !name.starts_with('.') && self.extensions.iter().any(ends)
    }

    fn add(&mut self, path: PathBuf, relative: PathBuf) {
        let identity = fs::canonicalize(&path).unwrap_or_else(|_| path.clone());
        if self.seen.insert(identity) {
            self.found.files.push(Input { path, relative });
        }
    }

    fn fail(&mut self, path: &Path, what: &str) {
        self.found.not_found.push(NotFound {
            path: path.to_path_buf(),
            what: what.to_owned(),
        });
    }
}

/// Whether it is HDF5 of another kind, which a build without HDF5 does not tell.
#[cfg(feature = "h5")]
fn is_other(path: &Path) -> bool {
    formats::h5::is_other(path)
}

#[cfg(not(feature = "h5"))]
fn is_other(_: &Path) -> bool {
    false
}

fn is_pattern(path: &Path) -> bool {
    path.to_string_lossy().contains(['*', '?', '['])
}

/// The folders of a glob before its first wildcard.
fn constant_part(pattern: &Path) -> PathBuf {
    let constant = |part: &Component<'_>| !is_pattern(Path::new(part.as_os_str()));
    pattern.components().take_while(constant).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(inputs: &Inputs) -> Vec<String> {
        let slashes = |input: &Input| input.relative.to_string_lossy().replace('\\', "/");
        inputs.files.iter().map(slashes).collect()
    }

    #[test]
    fn folders_globs_and_files_are_found_once() {
        let folder = tempfile::tempdir().expect("a folder");
        let root = folder.path();
        fs::create_dir(root.join("sub")).expect("made");
        for name in [
            "b.swc",
            "a.SWC",
            "note.txt",
            "sub/c.swc",
            ".hidden.swc",
            "d.swc.gz",
        ] {
            fs::write(root.join(name), "").expect("written");
        }
        let find = |arguments: &[PathBuf]| Inputs::find(arguments, &["swc"]);

        let all = find(&[root.to_path_buf(), root.join("b.swc")]);
        assert_eq!(names(&all), ["a.SWC", "b.swc", "sub/c.swc"]);
        let deep = find(&[root.join("**/*.swc")]);
        assert!(names(&deep).contains(&"sub/c.swc".to_owned()) && !deep.one_file);
        let one = find(&[root.join("note.txt")]);
        assert!(one.one_file && names(&one) == ["note.txt"]);
    }

    #[test]
    fn nothing_found_is_a_failure() {
        let folder = tempfile::tempdir().expect("a folder");
        let root = folder.path();
        let inputs = Inputs::find(&[root.to_path_buf(), root.join("*.swc")], &["swc"]);
        assert!(inputs.files.is_empty());
        assert_eq!(inputs.not_found.len(), 2);
    }
}
