//! A file that is being written.

use std::fs::{self, File};
use std::io::{self, Seek, Write};
use std::path::{Path, PathBuf};

use crate::error::OutputError;
use crate::existing::{Existing, target};
use crate::own::own_file;
use crate::part::{lock, open_part, part_of, settle};

/// A file being written; dropped before it is finished, it was never there.
#[derive(Debug)]
pub struct Output {
    file: Option<File>,
    to: To,
}

/// Where a file goes.
#[derive(Debug)]
enum To {
    /// Its final name, as it was named and with links followed.
    Path {
        part: PathBuf,
        path: PathBuf,
        target: PathBuf,
        existing: Existing,
    },
    /// Standard output.
    Standard,
}

impl Output {
    /// Begins a file, in a folder that is made if need be.
    ///
    /// # Errors
    /// What is in the way.
    pub fn create(path: &Path, existing: Existing) -> Result<Self, OutputError> {
        existing.check(path)?;
        let target = target(path)?;
        let part = part_of(&target)?;
        let folder = part.parent().filter(|p| !p.as_os_str().is_empty());
        if let Some(folder) = folder {
            fs::create_dir_all(folder).map_err(|source| OutputError::Folder {
                path: folder.into(),
                source,
            })?;
        }
        let mut unfinished = lock();
        let file = open_part(&part, path)?;
        unfinished.insert(part.clone());
        drop(unfinished);
        Ok(Self {
            file: Some(file),
            to: To::Path {
                part,
                path: path.to_path_buf(),
                target,
                existing,
            },
        })
    }

    /// Begins a file of ours that nobody named, in place of the one that is there.
    ///
    /// # Errors
    /// [`OutputError::NotOurs`] if there is something else than a file; what is in the way.
    pub fn create_own(path: &Path) -> Result<Self, OutputError> {
        own_file(path)?;
        Self::create(path, Existing::Replace)
    }

    /// Begins what standard output gets as a whole at the end, since some formats are not written from
    /// the beginning to the end.
    ///
    /// # Errors
    /// No file without a name can be made for it.
    pub fn standard() -> Result<Self, OutputError> {
        let file = tempfile::tempfile().map_err(|source| OutputError::Standard { source })?;
        Ok(Self {
            file: Some(file),
            to: To::Standard,
        })
    }

    /// The file that another program writes to, before it has its name; `-` for standard output.
    pub fn part(&self) -> &Path {
        match &self.to {
            To::Path { part, .. } => part,
            To::Standard => Path::new("-"),
        }
    }

    /// Where to write.
    pub fn file(&mut self) -> &mut File {
        self.file.as_mut().expect("open until it is finished")
    }

    /// Gives the file its name, or standard output what it holds. A reader that has gone away is no
    /// error.
    ///
    /// # Errors
    /// Another file has got this name meanwhile, or the file system refuses.
    pub fn finish(mut self) -> Result<(), OutputError> {
        let To::Path {
            part,
            path,
            target,
            existing,
        } = &self.to
        else {
            let copied = self.file.take().map_or(Ok(()), copy_to_standard);
            return match copied {
                Err(e) if e.kind() == io::ErrorKind::BrokenPipe => Ok(()),
                copied => copied.map_err(|source| OutputError::Standard { source }),
            };
        };
        existing.check(path)?;
        let renamed = settle(part, || fs::rename(part, target));
        // The lock ends here, after the renaming.
        self.file = None;
        renamed.map_err(|e| {
            drop(fs::remove_file(part));
            OutputError::broken(path, e)
        })
    }
}

/// The folder in which what standard output gets at the end is until then.
pub fn temporary_folder() -> PathBuf {
    tempfile::env::temp_dir()
}

fn copy_to_standard(mut file: File) -> io::Result<()> {
    file.rewind()?;
    let mut out = io::stdout().lock();
    io::copy(&mut file, &mut out)?;
    out.flush()
}

impl Drop for Output {
    fn drop(&mut self) {
        if let (Some(_), To::Path { part, .. }) = (&self.file, &self.to) {
            drop(settle(part, || fs::remove_file(part)));
        }
    }
}
