//! Parts of messages.

/// Text without control characters: names of files may contain escape sequences for terminals.
pub(super) fn plain(text: &str) -> String {
    let safe = |c: char| !c.is_control() || c == '\n' || c == '\t';
    text.chars()
        .map(|c| if safe(c) { c } else { ' ' })
        .collect()
}

/// `FILE:LINE:`, or `FILE:` if there is no line.
pub(crate) fn place(file: &str, line: Option<u64>) -> String {
    match line {
        Some(line) => format!("{file}:{line}:"),
        None => format!("{file}:"),
    }
}

/// A number of things as text: `1 cell`, `3 cells`.
pub(crate) fn count(number: usize, thing: &str) -> String {
    let plural = if number == 1 { "" } else { "s" };
    format!("{number} {thing}{plural}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn terminals_get_no_orders() {
        assert_eq!(plain("a\x1b[31mb\u{9b}2Jc\r\nd\te"), "a [31mb 2Jc \nd\te");
    }
}
