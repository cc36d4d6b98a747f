//! What was taken although it is odd.

use std::fmt;

/// Something odd in a circuit that could be read all the same.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// The file as it was named.
    pub file: String,
    /// Key or dataset; empty if it is about the whole file.
    pub key: String,
    /// Name for machines, like `morphology_missing`.
    pub code: &'static str,
    /// For people; tells the count if it is more than one.
    pub message: String,
    /// How many nodes, files or rows are so.
    pub count: u64,
}

impl Warning {
    pub(crate) fn new(
        file: &str,
        key: impl Into<String>,
        code: &'static str,
        message: impl Into<String>,
    ) -> Self {
        Self {
            file: file.into(),
            key: key.into(),
            code,
            message: message.into(),
            count: 1,
        }
    }

    pub(crate) fn times(mut self, count: u64) -> Self {
        self.count = count;
        self
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            file,
            key,
            code,
            message,
            ..
        } = self;
        if key.is_empty() {
            write!(f, "{file}: {message} ({code})")
        } else {
            write!(f, "{file}: '{key}': {message} ({code})")
        }
    }
}
