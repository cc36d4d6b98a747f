//! Why a file cannot be read, and what to do about it.

use std::fmt;
use std::io;

use thiserror::Error;

/// A file that cannot be read. Displays as `FILE:LINE: what: what to do`.
#[derive(Debug, Error)]
pub struct ReadError {
    /// The file as it was named.
    pub file: String,
    /// Line, from 1 on; `None` where the fault has none.
    pub line: Option<u64>,
    /// What is wrong.
    #[source]
    pub fault: Fault,
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            Some(line) => write!(f, "{}:{line}: {}", self.file, self.fault),
            None => write!(f, "{}: {}", self.file, self.fault),
        }
    }
}

/// What is wrong with a file. Displays as `what: what to do`.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Fault {
    /// The system would not read it.
    #[error("cannot be read ({0}): check the path and its permissions")]
    Io(io::Error),
    /// Neither name nor content tell the format.
    #[error("not a format known by its name or content: give an SWC file (.swc, .eswc)")]
    UnknownFormat,
    /// Not a byte.
    #[error("the file is empty: fetch or export it again")]
    Empty,
    /// Comments or blanks and nothing else.
    #[error("no sample in the file: check whether the export or the download was complete")]
    NoSample,
    /// Two bytes a letter.
    #[error("the text is UTF-16: save it as UTF-8 or plain ASCII")]
    Utf16,
    /// A NUL byte.
    #[error("the file is binary: SWC is plain text; check which format this is")]
    Binary,
    /// A web page.
    #[error("the file is a web page, not a morphology: the download failed, fetch it again")]
    Html,
    /// A row is too short.
    #[error(
        "{found} columns instead of 7 (number, type, x, y, z, radius, parent): \
         add the missing ones"
    )]
    Columns {
        /// How many there are.
        found: usize,
    },
    /// A field is not a number at all.
    #[error("{column} is not a number but {text:?}: correct it or remove the row")]
    NotANumber {
        /// Name of the column.
        column: &'static str,
        /// What stands there.
        text: String,
    },
    /// A field is a number but has no place in an integer column.
    #[error("{column} is not a whole number in range but {text:?}: number the samples anew")]
    NotWhole {
        /// Name of the column.
        column: &'static str,
        /// What stands there.
        text: String,
    },
    /// NaN, infinite, or beyond what the model holds.
    #[error("{column} is {text}, not finite or out of range: correct it or remove the row")]
    OutOfRange {
        /// Name of the column.
        column: &'static str,
        /// What stands there.
        text: String,
    },
    /// Commas within numbers.
    #[error("commas seem to be decimal marks: write numbers with points")]
    DecimalComma,
    /// Two samples have the same number.
    #[error("sample {id} stands in line {first_line} already: number the samples anew")]
    RepeatedId {
        /// The number.
        id: i64,
        /// Line of the first.
        first_line: u64,
    },
    /// The sample hangs on itself.
    #[error("sample {id} is its own parent: give its parent, or -1 for a root")]
    SelfParent {
        /// Its number.
        id: i64,
    },
    /// The parent is not in the file.
    #[error("sample {id} has parent {parent}, which is not in the file: add it, or use -1")]
    UnknownParent {
        /// Number of the child.
        id: i64,
        /// Number that no sample has.
        parent: i64,
    },
    /// The sample is its own ancestor.
    #[error("sample {id} is its own ancestor: break the cycle of parents")]
    Cycle {
        /// Number of the first sample in the cycle.
        id: i64,
    },
    /// More samples than 32 bits can count.
    #[error("more than 4 billion samples: split the file")]
    TooMany,
    /// A warning, read strictly.
    #[error("{message} ({code}): mend the file, or read without --strict")]
    Strict {
        /// The warning's code.
        code: &'static str,
        /// Its message.
        message: String,
    },
}
