//! Properties of segments (`neuroglancer_segment_properties`): labels, tags and numbers, which neuroglancer searches.
//!
//! A gap in a column of numbers is the *text* `NaN`: `null` becomes 0, and without quotes all properties vanish. What is to
//! be found is a tag or a number, since other texts are shown and sorted only.

use std::io::{self, Write};

use serde::Serialize;

/// What a column has in a row, by the row's index.
pub type Of<'c, T> = Box<dyn Fn(usize) -> T + 'c>;

/// A column of the table: for each row, by its index.
pub enum Column<'c> {
    /// What the segment is called.
    Label(Of<'c, String>),
    /// Words that it is found by.
    Tags {
        /// All words, and what they mean.
        words: &'c [Tag],
        /// Indices in `words`, rising.
        of: Of<'c, Vec<u32>>,
    },
    /// A number, NaN where there is none.
    Number {
        /// Its name: letters, digits and `_`, a letter first.
        name: String,
        /// What it is, with its unit.
        description: String,
        /// The number.
        of: Of<'c, f64>,
    },
    /// A whole number that each segment has.
    Whole {
        /// Its name.
        name: String,
        /// What it is.
        description: String,
        /// The number.
        of: Of<'c, u32>,
    },
    /// A text that is shown.
    Text {
        /// Its name.
        name: String,
        /// The text.
        of: Of<'c, String>,
    },
}

/// A word that segments are found by.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tag {
    /// The word, without blanks.
    pub word: String,
    /// What it means.
    pub description: String,
}

/// A text as a tag: without blanks, which would end it in a query.
pub(crate) fn tag_word(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join("_")
}

/// A name as numbers may have it: letters, digits and `_`, a letter first.
pub(crate) fn number_name(text: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    let name: String = text.chars().map(plain).collect();
    match name.starts_with(|c: char| c.is_ascii_alphabetic()) {
        true => name,
        false => format!("n{name}"),
    }
}

/// Writes the `info` file, row by row of each column, so that no column is ever in memory.
///
/// # Errors
/// What the file system says.
pub fn write_properties(mut to: impl Write, ids: &[u64], columns: &[Column<'_>]) -> io::Result<()> {
    let rows = 0..ids.len();
    write!(
        to,
        r#"{{"@type":"neuroglancer_segment_properties","inline":{{"ids":"#
    )?;
    // As texts: numbers of JSON lose digits from 2^53 on.
    list(&mut to, ids.iter().map(u64::to_string))?;
    write!(to, r#","properties":["#)?;
    for (index, column) in columns.iter().enumerate() {
        let begin = if index == 0 { "{" } else { ",{" };
        write!(to, "{begin}")?;
        match column {
            Column::Label(of) => {
                write!(to, r#""id":"label","type":"label","values":"#)?;
                list(&mut to, rows.clone().map(of))?;
            }
            Column::Tags { words, of } => {
                write!(to, r#""id":"tags","type":"tags","tags":"#)?;
                list(&mut to, words.iter().map(|tag| &tag.word))?;
                write!(to, r#","tag_descriptions":"#)?;
                list(&mut to, words.iter().map(|tag| &tag.description))?;
                write!(to, r#","values":"#)?;
                list(&mut to, rows.clone().map(of))?;
            }
            Column::Number {
                name,
                description,
                of,
            } => {
                head(&mut to, name, "number", Some(("float32", description)))?;
                list(&mut to, rows.clone().map(|row| Number::new(of(row))))?;
            }
            Column::Whole {
                name,
                description,
                of,
            } => {
                head(&mut to, name, "number", Some(("uint32", description)))?;
                list(&mut to, rows.clone().map(of))?;
            }
            Column::Text { name, of } => {
                head(&mut to, name, "string", None)?;
                list(&mut to, rows.clone().map(of))?;
            }
        }
        write!(to, "}}")?;
    }
    writeln!(to, "]}}}}")
}

/// What stands before the values of a column.
fn head(
    to: &mut impl Write,
    name: &str,
    kind: &str,
    number: Option<(&str, &str)>,
) -> io::Result<()> {
    write!(to, r#""id":"#)?;
    serde_json::to_writer(&mut *to, name)?;
    write!(to, r#","type":"{kind}""#)?;
    if let Some((data_type, description)) = number {
        write!(to, r#","data_type":"{data_type}","description":"#)?;
        serde_json::to_writer(&mut *to, description)?;
    }
    write!(to, r#","values":"#)
}

/// A list of JSON.
fn list<T: Serialize>(to: &mut impl Write, values: impl Iterator<Item = T>) -> io::Result<()> {
    to.write_all(b"[")?;
    for (index, value) in values.enumerate() {
        if index > 0 {
            to.write_all(b",")?;
        }
        serde_json::to_writer(&mut *to, &value)?;
    }
    to.write_all(b"]")
}

/// A number, or what stands for none.
#[derive(Serialize)]
#[serde(untagged)]
enum Number {
    Is(f32),
    Gap(&'static str),
}

impl Number {
    fn new(number: f64) -> Self {
        match number as f32 {
            number if number.is_finite() => Self::Is(number),
            _ => Self::Gap("NaN"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gap_is_a_text_and_ids_keep_their_digits() {
        let words = [("axon", "type 2"), ("CA1", "region")].map(|(word, description)| Tag {
            word: word.into(),
            description: description.into(),
        });
        let mut text = Vec::new();
        let columns = [
            Column::Label(Box::new(|row| format!("cell \"{row}\""))),
            Column::Tags {
                words: &words,
                of: Box::new(|row| (0..row as u32).collect()),
            },
            Column::Number {
                name: number_name("5 HT%"),
                description: "µm".into(),
                of: Box::new(|row| if row == 1 { f64::NAN } else { 0.1 }),
            },
            Column::Whole {
                name: "node_id".into(),
                description: String::new(),
                of: Box::new(|row| row as u32),
            },
            Column::Text {
                name: "file".into(),
                of: Box::new(|_| "a.swc".into()),
            },
        ];
        let ids = [1, 720_575_940_623_456_789, 3];
        write_properties(&mut text, &ids, &columns).expect("written");
        let text = String::from_utf8(text).expect("text");
        assert!(text.contains(r#""values":[0.1,"NaN",0.1]"#), "{text}");
        let json: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        let inline = &json["inline"];
        assert_eq!(inline["ids"][1], "720575940623456789");
        let kinds = ["label", "tags", "number", "number", "string"];
        for (property, kind) in inline["properties"]
            .as_array()
            .expect("a list")
            .iter()
            .zip(kinds)
        {
            assert_eq!(property["type"], kind);
            assert_eq!(property["values"].as_array().map(Vec::len), Some(3));
        }
        assert_eq!(inline["properties"][1]["values"][2][1], 1);
        assert_eq!(inline["properties"][2]["id"], "n5_HT_");
        assert_eq!(inline["properties"][2]["data_type"], "float32");
    }

    #[test]
    fn tags_have_no_blanks() {
        assert_eq!(tag_word(" layer  2/3 PC\n"), "layer_2/3_PC");
    }
}
