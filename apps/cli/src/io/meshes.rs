//! What is wrong with a file of a mesh.

use neurotess::mesh::{FilePosition, ReadError};

use crate::report::place;

/// `FILE:LINE: what: what to do`
pub(crate) fn named(file: &str, error: &ReadError) -> String {
    match error.place() {
        FilePosition::Line(line) => {
            let text = error.to_string();
            let what = text
                .strip_prefix(&format!("line {line}: "))
                .unwrap_or(&text);
            format!("{} {what}", place(file, Some(line as u64)))
        }
        FilePosition::Byte(_) | FilePosition::File => match error {
            ReadError::Io(e) => {
                format!("{file}: cannot be read ({e}): check the path and its permissions")
            }
            other => {
                let text = other.to_string();
                format!("{file}: {}", text.strip_prefix("file: ").unwrap_or(&text))
            }
        },
    }
}
