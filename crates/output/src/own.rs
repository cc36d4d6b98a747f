//! Files that nobody named: they lie beside inputs and outputs under names of ours, where somebody else may have put
//! something. No link is followed there, so that nothing is written where nobody told us to.

use std::fs::{self, File, Metadata, OpenOptions};
use std::io;
use std::path::Path;

use crate::error::OutputError;

/// What is there under a name of ours; none if nothing is.
///
/// # Errors
/// [`OutputError::NotOurs`] for a link, a folder or a device; what the system says.
pub fn own_file(path: &Path) -> Result<Option<Metadata>, OutputError> {
    let data = match fs::symlink_metadata(path) {
        Ok(data) => data,
        Err(e) if e.kind() == io::ErrorKind::NotFound => return Ok(None),
        Err(e) => return Err(OutputError::broken(path, e)),
    };
    let what = match data.file_type() {
        kind if kind.is_file() => return Ok(Some(data)),
        kind if kind.is_symlink() => "a link",
        kind if kind.is_dir() => "a folder",
        _ => "a device or a pipe",
    };
    Err(OutputError::NotOurs {
        path: path.into(),
        what,
    })
}

/// Opens a file of ours that is appended to, and makes it if it is not there.
///
/// # Errors
/// As [`own_file`].
pub fn append_own(path: &Path) -> Result<File, OutputError> {
    open_own(path, OpenOptions::new().append(true))
}

/// Opens a file of ours, or makes it: one that is new is never made through a link.
pub(crate) fn open_own(path: &Path, options: &mut OpenOptions) -> Result<File, OutputError> {
    let broken = |e| OutputError::broken(path, e);
    let Some(there) = own_file(path)? else {
        return match options.create_new(true).open(path) {
            // Another run has made it meanwhile.
            Err(e) if e.kind() == io::ErrorKind::AlreadyExists => {
                own_file(path)?;
                options.create_new(false).open(path).map_err(broken)
            }
            opened => opened.map_err(broken),
        };
    };
    let file = options.open(path).map_err(broken)?;
    // A link may have taken its place between the two.
    match is_same(&there, &file.metadata().map_err(broken)?) {
        true => Ok(file),
        false => Err(OutputError::NotOurs {
            path: path.into(),
            what: "being replaced",
        }),
    }
}

#[cfg(unix)]
fn is_same(a: &Metadata, b: &Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    (a.dev(), a.ino()) == (b.dev(), b.ino())
}

#[cfg(not(unix))]
fn is_same(_: &Metadata, _: &Metadata) -> bool {
    true
}
