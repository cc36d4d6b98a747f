//! The record of what a folder's files were made from, by which a later run knows which are up to
//! date.
//!
//! ```text
//! .neurotess-made   {"out":"sub/a.ply","is":{…},"options":"9f3c…","of":{…}}   one line per file, appended
//! ```
//!
//! **Theory.** A file is up to date if it is the one that was recorded (length and time), was made
//! with the same options (the hash of a [`Key`]), and its inputs are those that were read (names, lengths and times).
//!
//! **Practice.** The line is appended before the file gets its name: a run that is killed between
//! the two leaves a line without a file, never a file with a line of other options. Lines of
//! several runs and shards share one file; the one that matches counts. Incomplete lines are
//! skipped.
//!
//! **Why not** within the mesh files: not all formats have room for it, and equal meshes of
//! different inputs would differ.

use std::collections::HashMap;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use neurotess_output::{OutputError, append_own, own_file};
use serde::{Deserialize, Serialize};

use crate::key::Key;
use crate::stamp::Stamp;
use crate::targets::Job;

/// Name of the record.
const NAME: &str = ".neurotess-made";
/// What every line begins with.
const BEGIN: &[u8] = b"{\"out\":";

/// A line of the record.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Line {
    out: String,
    is: Stamp,
    options: String,
    of: Stamp,
    /// Of the inputs after the first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    further: Vec<Stamp>,
    /// The files that were written instead of it, if it was written in parts: `is` is of all of them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    parts: Vec<String>,
}

impl Line {
    /// Whether the output was made of these inputs.
    fn is_of(&self, inputs: &[Stamp]) -> bool {
        inputs.split_first() == Some((&self.of, &self.further[..]))
    }
}

/// What is known of an output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum OutputState {
    /// It does not exist.
    Missing,
    /// It is up to date.
    Right,
    /// It is up to date, but what belongs beside it is missing.
    Incomplete,
    /// It was made with other options.
    OtherOptions,
    /// Its input has changed.
    OtherInput,
    /// It has no record; it is newer than its input.
    Newer,
    /// It has no record; it is older than its input.
    Older,
}

impl OutputState {
    /// Whether it need not be made.
    pub fn stays(self) -> bool {
        matches!(self, Self::Right | Self::Newer)
    }

    /// Whether we made it and it may be replaced.
    pub fn is_ours(self) -> bool {
        matches!(
            self,
            Self::Incomplete | Self::OtherOptions | Self::OtherInput
        )
    }
}

/// The record of a folder.
pub(crate) struct OutputRecord {
    folder: PathBuf,
    /// Options that files depend on.
    key: Key,
    known: Mutex<HashMap<String, Vec<Line>>>,
    /// The file, which is opened when the first line is written.
    file: Mutex<Option<File>>,
}

impl OutputRecord {
    /// Reads the record, if there is one. `key`: all that files depend on.
    pub(crate) fn open(folder: &Path, key: Key) -> Self {
        let record = Self {
            folder: folder.to_path_buf(),
            key,
            known: Mutex::default(),
            file: Mutex::default(),
        };
        record.read();
        record
    }

    /// Reads it again, with the lines that other runs have added.
    pub(crate) fn read(&self) {
        let path = self.folder.join(NAME);
        let ours = matches!(own_file(&path), Ok(Some(_)));
        let text = if ours {
            fs::read(path).unwrap_or_default()
        } else {
            Vec::new()
        };
        let mut known: HashMap<String, Vec<Line>> = HashMap::new();
        let lines = text.split(|&byte| byte == b'\n');
        for line in lines.filter_map(|line| serde_json::from_slice::<Line>(line).ok()) {
            known.entry(line.out.clone()).or_default().push(line);
        }
        *self.known.lock().unwrap_or_else(PoisonError::into_inner) = known;
    }

    /// Whether an output is up to date, as far as is known.
    pub(crate) fn state_of(&self, job: &Job) -> OutputState {
        let is = Stamp::of(&job.out);
        if is.is_none() && !job.parts {
            return OutputState::Missing;
        }
        let of = Stamp::of_inputs(job);
        let known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        let lines = known.get(&self.name(&job.out)).into_iter().flatten();
        let is_that = |line: &&Line| match job.parts {
            true => {
                let parts = line.parts.iter().map(|part| self.folder.join(part));
                !line.parts.is_empty() && Stamp::of_all(&parts.collect::<Vec<_>>()) == Some(line.is)
            }
            false => line.parts.is_empty() && Some(line.is) == is,
        };
        let incomplete = job.beside.as_ref().is_some_and(|beside| !beside.exists());
        match lines.rev().find(is_that) {
            Some(line) if line.options != self.key.hash(job) => OutputState::OtherOptions,
            Some(line) if !of.as_ref().is_some_and(|of| line.is_of(of)) => OutputState::OtherInput,
            Some(_) if incomplete => OutputState::Incomplete,
            Some(_) => OutputState::Right,
            None if job.parts => OutputState::Missing,
            None if of
                .zip(is)
                .is_some_and(|(of, is)| of.iter().all(|input| is.modified >= input.modified)) =>
            {
                OutputState::Newer
            }
            None => OutputState::Older,
        }
    }

    /// Whether it was ever made, in whichever way.
    pub(crate) fn knows(&self, job: &Job) -> bool {
        let known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        known.contains_key(&self.name(&job.out))
    }

    /// Records a file that is about to get its name, or those of its parts. `inputs`: what it was made of, as that was
    /// before it was read; `made`: the names, and where the files are until then.
    pub(crate) fn add(
        &self,
        job: &Job,
        inputs: Option<&[Stamp]>,
        made: &[(&Path, &Path)],
    ) -> Result<(), OutputError> {
        let now: Vec<PathBuf> = made.iter().map(|(_, now)| now.to_path_buf()).collect();
        let (Some(is), Some([of, further @ ..])) = (Stamp::of_all(&now), inputs) else {
            return Ok(());
        };
        let parts = made.iter().filter(|_| job.parts);
        let line = Line {
            out: self.name(&job.out),
            is,
            options: self.key.hash(job),
            of: *of,
            further: further.to_vec(),
            parts: parts.map(|(out, _)| self.name(out)).collect(),
        };
        let failed = |e: io::Error| OutputError::broken(&self.folder.join(NAME), e);
        let mut text = serde_json::to_vec(&line).map_err(|e| failed(e.into()))?;
        text.push(b'\n');
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        if file.is_none() {
            let path = self.folder.join(NAME);
            // What begins otherwise somebody else has written.
            let begin = match own_file(&path)? {
                Some(_) => fs::read(&path).unwrap_or_default(),
                None => Vec::new(),
            };
            if !begin.is_empty() && !begin.starts_with(BEGIN) {
                let what = "of another kind";
                return Err(OutputError::NotOurs { path, what });
            }
            *file = Some(append_own(&path)?);
        }
        match &mut *file {
            // A single write, so that lines of several runs are not mixed.
            Some(file) => file.write_all(&text).map_err(failed),
            None => Ok(()),
        }
    }

    fn name(&self, out: &Path) -> String {
        let below = out.strip_prefix(&self.folder).unwrap_or(out);
        below.to_string_lossy().into_owned()
    }
}

#[cfg(test)]
mod tests {
    use neurotess_mesh::Format;
    use neurotess_recipe::{FileOptions, MeshOptions};

    use super::*;

    fn opened(folder: &Path, level: u32) -> OutputRecord {
        let options = MeshOptions::default().with_level(level);
        let key = Key::new(&options, &FileOptions::new(Format::Ply)).expect("a key");
        OutputRecord::open(folder, key)
    }

    #[test]
    fn a_file_is_right_only_as_it_was_recorded() {
        let folder = tempfile::tempdir().expect("a folder");
        let job = Job::new(folder.path().join("a.swc"), folder.path().join("a.ply"));
        fs::write(&job.input, "in").expect("written");
        let record = opened(folder.path(), 1);
        assert_eq!(record.state_of(&job), OutputState::Missing);
        fs::write(&job.out, "mesh").expect("written");
        assert_eq!(record.state_of(&job), OutputState::Newer);
        let inputs = Stamp::of_inputs(&job).expect("there");
        let made = [(&*job.out, &*job.out)];
        record.add(&job, Some(&inputs), &made).expect("recorded");
        // An incomplete line, and one of a run that was killed, do no harm.
        let mut file = fs::OpenOptions::new();
        let mut file = file
            .append(true)
            .open(folder.path().join(NAME))
            .expect("there");
        file.write_all(b"{\"out\":\"a.p\n").expect("written");
        record.read();
        assert_eq!(record.state_of(&job), OutputState::Right);
        let other = opened(folder.path(), 2);
        assert_eq!(other.state_of(&job), OutputState::OtherOptions);
        fs::write(&job.input, "another").expect("written");
        assert_eq!(record.state_of(&job), OutputState::OtherInput);
    }

    #[test]
    fn parts_are_right_together_and_with_what_is_beside_them() {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        let mut job = Job::new(at("a.swc"), at("a.obj"));
        (job.beside, job.parts) = (Some(at("a.mtl")), true);
        for name in ["a.swc", "a.mtl", "a_soma.obj", "a_axon.obj"] {
            fs::write(at(name), name).expect("written");
        }
        let record = opened(folder.path(), 1);
        assert_eq!(record.state_of(&job), OutputState::Missing);
        let parts = ["a_soma.obj", "a_axon.obj"].map(at);
        let made = parts.each_ref().map(|part| (&**part, &**part));
        let inputs = Stamp::of_inputs(&job).expect("there");
        record.add(&job, Some(&inputs), &made).expect("recorded");
        record.read();
        assert_eq!(record.state_of(&job), OutputState::Right);
        fs::remove_file(at("a.mtl")).expect("removed");
        assert_eq!(record.state_of(&job), OutputState::Incomplete);
        job.beside = None;
        assert_eq!(record.state_of(&job), OutputState::Right);
        fs::remove_file(at("a_axon.obj")).expect("removed");
        assert_eq!(record.state_of(&job), OutputState::Missing);
        // The whole is another file.
        job.parts = false;
        fs::write(&job.out, "whole").expect("written");
        assert_eq!(record.state_of(&job), OutputState::Newer);
    }
}
