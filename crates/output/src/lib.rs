//! Files that are there whole or not at all.
//!
//! What is written goes to `.NAME.neurotess-part` beside the final name and is renamed at the end.
//! The name is always the same, so that a run that was killed leaves nothing that the next one
//! does not use up; a lock on the file keeps two runs from writing one file at a time.
//!
//! Only regular files are ever replaced. Where the name is a link, its target is written, and the link
//! stays; a device, a pipe or a folder is left alone. Files that nobody named, records and caches, follow no link
//! ([`append_own`], [`Output::create_own`]). [`Output::standard`] is for standard output: it
//! gets the whole or nothing too.
//!
//! A program that is interrupted calls [`remove_unfinished`] and leaves. **Why not** a flag that
//! everything polls: a long read or solve would answer late. Instead every temporary file is known
//! here, and no file gets its final name but under the same lock.
#![forbid(unsafe_code)]

mod error;
mod existing;
mod output;
mod own;
mod part;

use std::fs::File;
use std::io::{self, BufWriter};
use std::path::Path;

pub use error::OutputError;
pub use existing::Existing;
pub use output::{Output, temporary_folder};
pub use own::{append_own, own_file};
pub use part::{Ended, remove_unfinished};

/// Writes a file from beginning to end.
///
/// # Errors
/// What is in the way, or what `write` says.
pub fn write_whole(
    path: &Path,
    existing: Existing,
    write: impl FnOnce(&mut BufWriter<&mut File>) -> io::Result<()>,
) -> Result<(), OutputError> {
    write_into(Output::create(path, existing)?, path, write)
}

/// Writes what has been begun from beginning to end; `path` is what errors call it.
///
/// # Errors
/// What `write` or the file system says.
pub fn write_into(
    mut output: Output,
    path: &Path,
    write: impl FnOnce(&mut BufWriter<&mut File>) -> io::Result<()>,
) -> Result<(), OutputError> {
    let mut file = BufWriter::new(output.file());
    let written = write(&mut file).and_then(|()| {
        file.into_inner()
            .map_err(io::IntoInnerError::into_error)
            .map(drop)
    });
    written.map_err(|e| OutputError::broken(path, e))?;
    output.finish()
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::io::Write;

    use super::*;

    const REFUSE: Existing = Existing::Refuse("choose another name");

    #[test]
    fn files_appear_whole_or_not_at_all() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("sub/cell.ply");
        let mut output = Output::create(&path, REFUSE).expect("begun");
        output.file().write_all(b"half").expect("written");
        assert!(Output::create(&path, REFUSE).is_err(), "locked");
        drop(output);
        assert_eq!(
            fs::read_dir(folder.path().join("sub"))
                .expect("read")
                .count(),
            0
        );

        let mut output = Output::create(&path, REFUSE).expect("begun");
        output.file().write_all(b"whole").expect("written");
        output.finish().expect("finished");
        assert_eq!(fs::read(&path).expect("there"), b"whole");
        let refused = Output::create(&path, REFUSE).expect_err("there");
        assert!(refused.to_string().ends_with("exists: choose another name"));
        assert!(Output::create(&path, Existing::Replace).is_ok());
        assert_eq!(fs::read(&path).expect("still there"), b"whole");
    }

    #[test]
    fn a_write_that_fails_leaves_what_was_there() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("new/a.txt");
        write_whole(&path, REFUSE, |to| to.write_all(b"one")).expect("written");
        let broken = write_whole(&path, Existing::Replace, |to| {
            to.write_all(b"half")?;
            Err(io::Error::other("no space"))
        });
        assert!(broken.expect_err("broken").to_string().contains("no space"));
        assert_eq!(fs::read(&path).expect("there"), b"one");
        let files = fs::read_dir(path.parent().expect("one")).expect("there");
        assert_eq!(files.count(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_and_its_target_is_written() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().expect("a folder");
        let (target, link) = (
            folder.path().join("sub/real.ply"),
            folder.path().join("a.ply"),
        );
        fs::create_dir(folder.path().join("sub")).expect("made");
        fs::write(&target, "old").expect("written");
        symlink("sub/real.ply", &link).expect("linked");
        assert!(write_whole(&link, REFUSE, |to| to.write_all(b"new")).is_err());
        write_whole(&link, Existing::Replace, |to| to.write_all(b"new")).expect("written");
        assert!(link.is_symlink());
        assert_eq!(fs::read(&target).expect("there"), b"new");
        // One that leads to nothing yet.
        fs::remove_file(&target).expect("removed");
        write_whole(&link, Existing::Replace, |to| to.write_all(b"again")).expect("written");
        assert!(link.is_symlink());
        assert_eq!(fs::read(&target).expect("there"), b"again");
        // One that leads to itself.
        symlink("b.ply", folder.path().join("b.ply")).expect("linked");
        let circle = write_whole(&folder.path().join("b.ply"), Existing::Replace, |_| Ok(()));
        assert!(
            matches!(circle, Err(OutputError::Link { .. })),
            "{circle:?}"
        );
    }

    #[cfg(unix)]
    #[test]
    fn files_of_our_own_follow_no_link() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        fs::write(at("precious"), "theirs").expect("written");
        symlink("precious", at("link")).expect("linked");
        symlink("nothing", at("dangling")).expect("linked");
        fs::create_dir(at("folder")).expect("made");
        for name in ["link", "dangling", "folder"] {
            let refused = append_own(&at(name)).map(drop);
            assert!(
                matches!(refused, Err(OutputError::NotOurs { .. })),
                "{refused:?}"
            );
            let refused = Output::create_own(&at(name)).map(drop);
            assert!(
                matches!(refused, Err(OutputError::NotOurs { .. })),
                "{refused:?}"
            );
            assert!(own_file(&at(name)).is_err());
        }
        assert_eq!(fs::read(at("precious")).expect("there"), b"theirs");
        assert!(!at("nothing").exists());
        // A temporary file that is a link is none of ours, either.
        symlink("nothing", at(".a.ply.neurotess-part")).expect("linked");
        assert!(Output::create(&at("a.ply"), REFUSE).is_err());
        assert!(!at("nothing").exists());
        for text in [b"one", b"two"] {
            let mut file = append_own(&at("own")).expect("opened");
            file.write_all(text).expect("written");
        }
        assert_eq!(fs::read(at("own")).expect("there"), b"onetwo");
        let mut output = Output::create_own(&at("own")).expect("begun");
        output.file().write_all(b"new").expect("written");
        output.finish().expect("finished");
        assert_eq!(fs::read(at("own")).expect("there"), b"new");
    }

    #[cfg(unix)]
    #[test]
    fn devices_are_never_replaced() {
        use std::os::unix::fs::{FileTypeExt, symlink};
        let folder = tempfile::tempdir().expect("a folder");
        let link = folder.path().join("a.ply");
        symlink("/dev/null", &link).expect("linked");
        for path in [link.as_path(), Path::new("/dev/null"), folder.path()] {
            let refused = write_whole(path, Existing::Replace, |to| to.write_all(b"new"));
            assert!(
                matches!(refused, Err(OutputError::NotAFile { .. })),
                "{refused:?}"
            );
        }
        assert!(link.is_symlink());
        let null = fs::metadata("/dev/null").expect("there").file_type();
        assert!(null.is_char_device());
    }

    #[test]
    fn leavings_of_a_killed_run_are_used_up() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("cell.ply");
        let leavings = folder.path().join(".cell.ply.neurotess-part");
        fs::write(leavings, "long leavings").expect("made");
        write_whole(&path, REFUSE, |to| to.write_all(b"new")).expect("written");
        assert_eq!(fs::read(&path).expect("there"), b"new");
        assert_eq!(fs::read_dir(folder.path()).expect("read").count(), 1);
    }
}
