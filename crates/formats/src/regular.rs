//! Files that may be read whole: regular ones. A device has no end, and a pipe that nobody writes to
//! keeps whoever opens it waiting for ever.

use std::fs::{self, FileType};
use std::io;
use std::path::Path;

/// Reads a file whole.
///
/// # Errors
/// Those of the system; one that says so if it is no regular file, nor a link to one.
pub fn read_regular(path: &Path) -> io::Result<Vec<u8>> {
    regular(path)?;
    fs::read(path)
}

/// Whether a file can be read: it is there and regular, or a link to such a file.
///
/// # Errors
/// As [`read_regular`].
pub fn regular(path: &Path) -> io::Result<()> {
    let kind = fs::metadata(path)?.file_type();
    if kind.is_file() {
        // What the system does not give has its own remedy: readers of HDF5 would say that the file is broken.
        return fs::File::open(path).map(drop);
    }
    let what = what(kind);
    let message = format!("it is {what}, not a regular file; standard input is given as -");
    Err(io::Error::other(message))
}

#[cfg(unix)]
fn what(kind: FileType) -> &'static str {
    use std::os::unix::fs::FileTypeExt;
    match () {
        () if kind.is_dir() => "a folder",
        () if kind.is_fifo() => "a pipe",
        () if kind.is_socket() => "a socket",
        () => "a device",
    }
}

#[cfg(not(unix))]
fn what(kind: FileType) -> &'static str {
    if kind.is_dir() {
        "a folder"
    } else {
        "a device"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_and_devices_are_not_read() {
        let folder = tempfile::tempdir().expect("a folder");
        let error = read_regular(folder.path()).expect_err("a folder");
        assert!(error.to_string().starts_with("it is a folder"), "{error}");
        let missing = read_regular(&folder.path().join("missing")).expect_err("missing");
        assert_eq!(missing.kind(), io::ErrorKind::NotFound);
        let file = folder.path().join("a.swc");
        fs::write(&file, "text").expect("written");
        assert_eq!(read_regular(&file).expect("read"), b"text");
    }

    #[cfg(unix)]
    #[test]
    fn what_has_no_end_is_not_read_even_through_a_link() {
        let folder = tempfile::tempdir().expect("a folder");
        let link = folder.path().join("cell.swc");
        std::os::unix::fs::symlink("/dev/zero", &link).expect("linked");
        let error = read_regular(&link).expect_err("a device");
        assert!(error.to_string().starts_with("it is a device"), "{error}");
    }
}
