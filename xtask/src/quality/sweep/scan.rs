//! Lines of sources, constants and numbers in them, as rustfmt writes them.

/// A file's lines that are neither tests nor imports.
pub(super) struct Lines<'t> {
    lines: std::str::Lines<'t>,
    is_import: bool,
    is_over: bool,
}

#[derive(PartialEq)]
pub(super) enum Line<'t> {
    /// Code, and the comment after it.
    Code(&'t str, &'t str),
    Other(&'t str),
}

impl<'t> Iterator for Lines<'t> {
    type Item = Line<'t>;

    fn next(&mut self) -> Option<Line<'t>> {
        let line = self.lines.next()?;
        let start = line.trim_start();
        if line.starts_with("mod tests {") {
            self.is_over = true;
        }
        let begins =
            start.starts_with("use ") || start.starts_with("pub") && start.contains(" use ");
        self.is_import |= begins;
        let is_other = self.is_import || self.is_over || start.starts_with("#[");
        if line.trim_end().ends_with(';') {
            self.is_import = false;
        }
        let comment = line.find("//").unwrap_or(line.len());
        let (code, comment) = line.split_at(comment);
        Some(match is_other {
            true => Line::Other(line),
            false => Line::Code(code, comment),
        })
    }
}

pub(super) fn lines(text: &str) -> Lines<'_> {
    Lines {
        lines: text.lines(),
        is_import: false,
        is_over: false,
    }
}

/// A line without the word that says who sees it.
fn unseen(code: &str) -> &str {
    let rest = code.trim_start();
    match rest.strip_prefix("pub") {
        Some(rest) => rest.trim_start_matches(|c| c != ' ').trim_start(),
        None => rest,
    }
}

/// Whether a constant begins here.
pub(super) fn is_definition(code: &str) -> bool {
    let rest = unseen(code);
    let name = rest
        .strip_prefix("const ")
        .or_else(|| rest.strip_prefix("static "));
    name.is_some_and(|name| name.starts_with(char::is_uppercase))
}

/// A constant's name and type, if its line is one of numbers; the value follows the last `=`.
pub(super) fn constant(code: &str) -> Option<(&str, &str)> {
    let (name, rest) = unseen(code).strip_prefix("const ")?.split_once(": ")?;
    let kind = rest.split_once(" =").map_or(rest, |(kind, _)| kind);
    let words = kind
        .split(|c: char| !c.is_alphanumeric())
        .filter(|word| !word.is_empty());
    let of_numbers = |word: &str| {
        ["f32", "f64", "u8", "u32", "u64", "usize", "i32", "i64"].contains(&word)
            || word.parse::<u32>().is_ok()
    };
    let is_table = !is_scalar(kind) && !kind.contains('f');
    (words.clone().count() > 0 && words.clone().all(of_numbers) && !is_table)
        .then_some((name, kind))
}

pub(super) fn is_scalar(kind: &str) -> bool {
    !kind.starts_with(['[', '('])
}

/// Length of the number at the start of a text.
pub(super) fn number(text: &str) -> usize {
    let bytes = text.as_bytes();
    let byte = |at: usize| bytes.get(at).copied().unwrap_or(b' ');
    let word = |mut at: usize| {
        while byte(at).is_ascii_alphanumeric() || byte(at) == b'_' {
            at += 1;
        }
        at
    };
    let mut end = word(0);
    if byte(end) == b'.' && byte(end + 1) != b'.' && !byte(end + 1).is_ascii_alphabetic() {
        end = word(end + 1);
    }
    if text[..end].ends_with('e') && byte(end) == b'-' {
        end = word(end + 1);
    }
    end
}

/// Whether a number in code is no choice: ½, or a whole one up to 8, as in formulas.
pub(super) fn is_plain(digits: &str) -> bool {
    let digits = digits
        .split('f')
        .next()
        .unwrap_or_default()
        .replace('_', "");
    let is_plain = |value: f64| value == 0.5 || value.fract() == 0.0 && value <= 8.0;
    digits.parse().is_ok_and(is_plain)
}
