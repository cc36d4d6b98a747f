//! Rows of a table whose fields are apart by blanks, as pandas reads it with `sep=' '`, which bmtk does.
//!
//! Each blank ends a field, so that two in a row have an empty one between them. Quotes are around fields with
//! blanks, line breaks or quotes, of which those within are written twice. Empty fields and pandas' words for none
//! have no value, in quotes or not. Lines without a field are left out.
//!
//! Three things are read that pandas does not: tabs as blanks, `'` as a quote where it ends a field again, and, by
//! [`Row::aligned`], tables aligned by hand with several blanks between fields.

/// A field, or none.
pub(crate) type Field = Option<String>;

/// A line of a table; with quoted line breaks, several.
#[derive(Debug)]
pub(crate) struct Row {
    /// Its first line, from 1 on.
    pub(crate) line: u64,
    pub(crate) fields: Vec<Field>,
    /// Whether a field was in quotes, which says that an empty one is meant.
    quoted: Vec<bool>,
}

/// What pandas takes for no value, and bmtk's own `NONE`.
const NONE: [&str; 19] = [
    "", "#N/A", "#N/A N/A", "#NA", "-1.#IND", "-1.#QNAN", "-NaN", "-nan", "1.#IND", "1.#QNAN",
    "<NA>", "N/A", "NA", "NULL", "NaN", "None", "NONE", "n/a", "nan",
];

impl Row {
    /// The fields if several blanks are one, and those at the ends none.
    pub(crate) fn aligned(&self) -> Vec<Field> {
        let fields = self.fields.iter().zip(&self.quoted);
        let there = fields.filter(|(field, quoted)| field.is_some() || **quoted);
        there.map(|(field, _)| value(field.clone())).collect()
    }

    /// The fields, words for none among them as `None`.
    pub(crate) fn values(&self) -> Vec<Field> {
        self.fields.iter().cloned().map(value).collect()
    }
}

fn value(field: Field) -> Field {
    field.filter(|text| !NONE.contains(&text.as_str()) && text != "null")
}

/// All rows of a text.
pub(crate) fn rows(text: &str) -> Vec<Row> {
    let mut rows = Vec::new();
    let mut line = 1;
    let mut rest = text;
    while !rest.is_empty() {
        let (row, tail) = row(rest, line);
        line += newlines(&rest[..rest.len() - tail.len()]);
        rest = tail;
        if row.fields.iter().any(Option::is_some) || row.quoted.contains(&true) {
            rows.push(row);
        }
    }
    rows
}

fn newlines(text: &str) -> u64 {
    memchr::memchr_iter(b'\n', text.as_bytes()).count() as u64
}

fn is_blank(c: char) -> bool {
    c == ' ' || c == '\t'
}

/// The first row, and what follows it.
fn row(text: &str, line: u64) -> (Row, &str) {
    let mut row = Row {
        line,
        fields: Vec::new(),
        quoted: Vec::new(),
    };
    let mut rest = text;
    loop {
        let (field, quoted, tail) = field(rest);
        row.fields.push((!field.is_empty()).then_some(field));
        row.quoted.push(quoted);
        rest = tail;
        let end = ["\r\n", "\n"].iter().find_map(|end| rest.strip_prefix(end));
        if let Some(after) = end {
            return (row, after);
        }
        match rest.chars().next() {
            Some(_) => rest = &rest[1..],
            None => return (row, rest),
        }
    }
}

/// The first field, whether it was in quotes, and what follows it, its end not taken.
fn field(text: &str) -> (String, bool, &str) {
    let plain = |text: &'_ str| {
        let end = text
            .find(|c| is_blank(c) || c == '\n')
            .unwrap_or(text.len());
        // A return before the line's end belongs to that.
        let line = text[end..].starts_with('\n');
        end - usize::from(line && text[..end].ends_with('\r'))
    };
    let quote = text.chars().next().filter(|&c| c == '"' || c == '\'');
    let quoted = quote.and_then(|quote| Some((quote, quoted(&text[1..], quote)?)));
    match quoted {
        Some(('"', (mut field, rest))) => {
            // What follows a closing quote at once is of the field.
            let end = plain(rest);
            field.push_str(&rest[..end]);
            (field, true, &rest[end..])
        }
        Some((_, (field, rest))) if plain(rest) == 0 => (field, true, rest),
        _ => {
            let end = plain(text);
            (text[..end].to_owned(), false, &text[end..])
        }
    }
}

/// The field up to the closing quote, and what follows it; none where no quote closes it.
fn quoted(text: &str, quote: char) -> Option<(String, &str)> {
    let mut field = String::new();
    let mut rest = text;
    loop {
        let end = rest.find(quote)?;
        field.push_str(&rest[..end]);
        rest = &rest[end + 1..];
        if !rest.starts_with(quote) {
            return Some((field, rest));
        }
        field.push(quote);
        rest = &rest[1..];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Vec<Vec<Field>> {
        rows(text).iter().map(Row::values).collect()
    }

    fn fields(all: &[&str]) -> Vec<Field> {
        let field = |text: &&str| (!text.is_empty()).then(|| (*text).to_owned());
        all.iter().map(field).collect()
    }

    #[test]
    fn each_blank_ends_a_field() {
        assert_eq!(
            read("a b\nc  d\n"),
            [fields(&["a", "b"]), fields(&["c", "", "d"])]
        );
        assert_eq!(
            read(" a\r\nb \r\n"),
            [fields(&["", "a"]), fields(&["b", ""])]
        );
        assert_eq!(read("a\t\tb"), [fields(&["a", "", "b"])]);
        assert_eq!(read("a\n\n  \n\r\nb"), [fields(&["a"]), fields(&["b"])]);
    }

    #[test]
    fn quotes_hold_blanks_and_lines_together() {
        let quoted = read("\"a \"\"b\"\"\" 'c d' \"\" \"e\nf\" g\n");
        assert_eq!(quoted, [fields(&["a \"b\"", "c d", "", "e\nf", "g"])]);
        // None of these is a quote that another ends.
        assert_eq!(
            read("5' 'tis a\"b c\"\n"),
            [fields(&["5'", "'tis", "a\"b", "c\""])]
        );
        assert_eq!(read("\"open a\n"), [fields(&["\"open", "a"])]);
        let lines: Vec<u64> = rows("\"a\nb\"\nc\n").iter().map(|row| row.line).collect();
        assert_eq!(lines, [1, 3]);
    }

    #[test]
    fn words_for_none_are_none() {
        let words = "NULL NA NaN nan None NONE N/A <NA> null \"NULL\" \"\" 0 Nan\n";
        let found = read(words).remove(0);
        let some: Vec<&str> = found.iter().flatten().map(String::as_str).collect();
        assert_eq!((found.len(), some), (13, vec!["0", "Nan"]));
    }
}
