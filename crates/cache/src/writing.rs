//! What is new goes to a temporary file at once, so that it is not held in memory until all is there.

use std::collections::HashSet;
use std::io::{self, BufWriter};
use std::path::PathBuf;

use neurotess_output::{Output, OutputError};

use crate::OldFile;
use crate::file::FileWriter;
use crate::key::Key;

/// Largest file in which entries are kept that were not asked for; the oldest are left out.
const MAX_KEPT: u64 = 4 << 30;

/// New entries, and the file that they go to.
#[derive(Debug)]
pub(crate) struct Writing {
    /// Files that may be written, the best one first.
    targets: Vec<PathBuf>,
    least_points: usize,
    points: usize,
    keys: HashSet<Key>,
    /// New entries as long as there are too few to begin a file.
    pending: Vec<(Key, Vec<u8>)>,
    state: State,
}

#[derive(Debug)]
enum State {
    NotBegun,
    Begun(Box<FileWriter<BufWriter<Part>>>, PathBuf),
    Failed(OutputError),
}

/// The temporary file as what is written to.
#[derive(Debug)]
struct Part(Output);

impl io::Write for Part {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.file().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.file().flush()
    }
}

impl Writing {
    pub(crate) fn new(targets: Vec<PathBuf>, least_points: usize) -> Self {
        Self {
            targets,
            least_points,
            points: 0,
            keys: HashSet::new(),
            pending: Vec::new(),
            state: State::NotBegun,
        }
    }

    /// Writes as soon as meshes of so many points were missing.
    pub(crate) fn set_least_points(&mut self, points: usize) {
        self.least_points = self.least_points.min(points);
    }

    /// Writes however little is new, since what is there is damaged.
    pub(crate) fn insist(&mut self) {
        self.least_points = 0;
    }

    /// Takes a new entry; `points`: how much work it stands for.
    pub(crate) fn put(&mut self, key: Key, bytes: Vec<u8>, points: usize) {
        if matches!(self.state, State::Failed(_)) || !self.keys.insert(key) {
            return;
        }
        self.points += points;
        self.pending.push((key, bytes));
        if self.points >= self.least_points {
            self.flush();
        }
    }

    /// Writes what is pending.
    fn flush(&mut self) {
        if matches!(self.state, State::NotBegun) {
            self.state = begin(&self.targets);
        }
        let State::Begun(file, path) = &mut self.state else {
            self.pending.clear();
            return;
        };
        for (key, bytes) in self.pending.drain(..) {
            if let Err(e) = file.put(&key, &bytes) {
                self.state = State::Failed(OutputError::broken(path, e));
                break;
            }
        }
    }

    /// Ends the file, if one was begun, with what is kept of old ones.
    pub(crate) fn finish(
        mut self,
        files: Vec<OldFile>,
        used: &HashSet<Key>,
    ) -> Result<Option<PathBuf>, OutputError> {
        if self.points >= self.least_points && !self.pending.is_empty() {
            self.flush();
        }
        let (mut file, path) = match self.state {
            State::NotBegun => return Ok(None),
            State::Failed(why) => return Err(why),
            State::Begun(file, path) => (file, path),
        };
        let broken = |e: io::Error| OutputError::broken(&path, e);
        keep(&mut file, &files, &self.keys, used).map_err(broken)?;
        // Some systems do not replace a file that is open.
        drop(files);
        let part = file.end().map_err(broken)?;
        let part = part.into_inner().map_err(|e| broken(e.into_error()))?;
        part.0.finish()?;
        Ok(Some(path))
    }
}

/// The first file that can be begun.
fn begin(targets: &[PathBuf]) -> State {
    let mut first = None;
    for path in targets {
        let begun = Output::create_own(path).and_then(|output| {
            let writer = FileWriter::begin(BufWriter::new(Part(output)));
            writer.map_err(|e| OutputError::broken(path, e))
        });
        match begun {
            Ok(writer) => return State::Begun(Box::new(writer), path.clone()),
            // It can be written, and is: by another run.
            Err(taken @ OutputError::Taken { .. }) => return State::Failed(taken),
            Err(why) => first = first.or(Some(why)),
        }
    }
    match first {
        Some(why) => State::Failed(why),
        None => State::NotBegun,
    }
}

/// Copies entries of old files: those that were used, then the others as long as there is room.
fn keep(
    file: &mut FileWriter<BufWriter<Part>>,
    files: &[OldFile],
    new: &HashSet<Key>,
    used: &HashSet<Key>,
) -> io::Result<()> {
    let mut kept = new.clone();
    for of_now in [true, false] {
        for old in files.iter().filter_map(|file| file.content.as_ref()) {
            for key in old.keys() {
                let fits = old
                    .length(key)
                    .is_some_and(|length| file.place() + length <= MAX_KEPT);
                let due = used.contains(key) == of_now && (of_now || fits);
                if !due || !kept.insert(*key) {
                    continue;
                }
                // A damaged entry is left out.
                if let Some(Ok(bytes)) = old.get(key) {
                    file.put(key, &bytes)?;
                }
            }
        }
    }
    Ok(())
}
