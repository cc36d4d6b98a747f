//! Files that are there whole or not at all.

use std::fs::{self, File};
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};

/// Writes a file beside its final name and renames it. `replace`: whether it may exist.
///
/// # Errors
/// What went wrong and what to do.
pub(crate) fn write_whole(
    path: &Path,
    replace: bool,
    write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<(), String> {
    if !replace && path.exists() {
        return Err(format!(
            "{} exists: allow it to be replaced",
            path.display()
        ));
    }
    let part = part_of(path)?;
    let broken = |e: io::Error| {
        format!(
            "{} cannot be written ({e}): check space and permissions",
            path.display()
        )
    };
    if let Some(folder) = path.parent().filter(|f| !f.as_os_str().is_empty()) {
        fs::create_dir_all(folder).map_err(broken)?;
    }
    let done = File::create(&part).and_then(|file| {
        let mut file = BufWriter::new(file);
        write(&mut file)?;
        file.into_inner().map_err(io::IntoInnerError::into_error)?;
        fs::rename(&part, path)
    });
    done.map_err(|e| {
        drop(fs::remove_file(&part));
        broken(e)
    })
}

/// Where a file is written before it is whole.
pub(crate) fn part_of(path: &Path) -> Result<PathBuf, String> {
    let name = path.file_name();
    let name = name.ok_or_else(|| format!("{} is no file's name: add one", path.display()))?;
    let mut part = std::ffi::OsString::from(".");
    part.push(name);
    part.push(".neurotess-part");
    Ok(path.with_file_name(part))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    #[test]
    fn files_are_there_whole_or_not_at_all() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("new/a.txt");
        write_whole(&path, false, |to| to.write_all(b"one")).expect("written");
        assert!(write_whole(&path, false, |to| to.write_all(b"two")).is_err());
        let broken = write_whole(&path, true, |to| {
            to.write_all(b"half")?;
            Err(io::Error::other("no space"))
        });
        assert!(broken.expect_err("broken").contains("no space"));
        assert_eq!(fs::read(&path).expect("there"), b"one");
        assert_eq!(
            fs::read_dir(path.parent().expect("one"))
                .expect("there")
                .count(),
            1
        );
    }
}
