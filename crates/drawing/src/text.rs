//! Parts of messages.

/// A number of things as text: `1 cell`, `3 cells`.
pub(crate) fn count(number: usize, thing: &str) -> String {
    let plural = if number == 1 { "" } else { "s" };
    format!("{number} {thing}{plural}")
}
