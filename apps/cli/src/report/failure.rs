//! What goes wrong: usage, inputs, bugs.

use serde::Serialize;

/// Wrong usage: exit code 2.
#[derive(Debug)]
pub(crate) struct Usage(pub(crate) String);

impl std::fmt::Display for Usage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Usage {}

/// An error with its causes, each reason once: many errors tell that of their cause themselves.
pub(crate) fn told(error: &anyhow::Error) -> String {
    error
        .chain()
        .skip(1)
        .fold(error.to_string(), |text, cause| {
            let cause = cause.to_string();
            match text.contains(&cause) {
                true => text,
                false => format!("{text}: {cause}"),
            }
        })
}

/// Stops a function with a [`Usage`] error.
pub(crate) fn usage<T>(message: impl Into<String>) -> anyhow::Result<T> {
    Err(Usage(message.into()).into())
}

/// An input that failed: `FILE:LINE: what: what to do`.
#[derive(Clone, Debug)]
pub(crate) struct Failure(pub(crate) String);

impl From<neurotess::circuit::CircuitError> for Failure {
    fn from(error: neurotess::circuit::CircuitError) -> Self {
        Self(error.to_string())
    }
}

/// An input that failed, in the JSON list.
#[derive(Serialize)]
pub(crate) struct Failed {
    pub(crate) file: String,
    pub(crate) error: String,
}

/// The JSON list's entry for an input.
#[derive(Serialize)]
#[serde(untagged)]
pub(crate) enum Entry<T> {
    /// It is done.
    Done(T),
    /// It failed.
    Failed(Failed),
}

/// The failure for a panic.
pub(crate) fn bug(file: &str, panic: &str) -> Failure {
    Failure(format!(
        "{file}: a bug of neurotess ({panic}): please report it with the file"
    ))
}
