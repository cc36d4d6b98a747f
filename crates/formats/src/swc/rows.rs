//! Lines to records: the raw content, nothing interpreted but numbers.

use glam::DVec3;
use neurotess_morphology::{Morphology, NeuriteKind, Node};

use super::number::{self, Class, class};
use crate::Fault;
use crate::text::{BOM, Located};
use crate::warning::Warnings;

/// The rows of a file.
#[derive(Default)]
pub(super) struct Records {
    /// The samples; their parents are still to be found.
    pub(super) nodes: Vec<Node>,
    /// Number of each one's parent.
    pub(super) parents: Vec<i64>,
    /// Line of each, from 1 on.
    pub(super) lines: Vec<u32>,
    /// Comments above the first row.
    pub(super) header: Vec<String>,
}

/// How rows are read.
#[derive(Clone, Copy, Default)]
pub(super) struct Reading {
    /// The file has columns of its own, which are passed over.
    pub(super) extended: bool,
    /// Radii that are no finite numbers are 0.
    pub(super) zero_for_bad_radii: bool,
    /// What NEURON makes of the file is told.
    pub(super) for_neuron: bool,
    /// The caller knows the unit.
    pub(super) unit_given: bool,
}

/// One row.
struct Row {
    node: Node,
    parent: i64,
    oddities: Oddities,
}

/// What warnings a row gives.
#[derive(Clone, Copy, Default)]
struct Oddities {
    /// Commas or semicolons.
    separators: bool,
    /// Whole numbers written as `1.0`.
    float_ids: bool,
    /// More than seven columns.
    extra_columns: bool,
    /// A radius that is no finite number, taken as 0.
    bad_radius: bool,
    any: bool,
}

/// All rows.
pub(super) fn records(bytes: &[u8], reading: Reading, warnings: &mut Warnings) -> Located<Records> {
    let mut records = Records::default();
    // 32 bytes is a short row: better one allocation too large than a dozen that are copied.
    let rows = bytes.len() / 32;
    records.nodes.reserve(rows);
    records.parents.reserve(rows);
    records.lines.reserve(rows);
    for (line, text) in lines(bytes) {
        let text = skip_blanks(text);
        match text.first() {
            None => {}
            Some(b'#') if records.nodes.is_empty() => records.header.push(comment(text)),
            Some(b'#') => {}
            Some(_) => {
                let row = row(text, reading).map_err(|fault| (line, fault))?;
                if row.oddities.any {
                    warn(row.oddities, line, reading.extended, warnings);
                }
                records.nodes.push(row.node);
                records.parents.push(row.parent);
                records
                    .lines
                    .push(u32::try_from(line).map_err(|_| (line, Fault::TooMany))?);
            }
        }
    }
    Ok(records)
}

/// Whether the first line that is neither blank nor comment is a row.
pub(super) fn first_is_sample(bytes: &[u8]) -> bool {
    let mut rows = lines(bytes).map(|(_, text)| skip_blanks(text));
    rows.find(|text| text.first().is_some_and(|&b| b != b'#'))
        .is_some_and(|t| row(t, Reading::default()).is_ok())
}

/// Lines with their numbers; they end with LF, CRLF or CR.
fn lines(bytes: &[u8]) -> impl Iterator<Item = (u64, &[u8])> {
    let mut rest = bytes.strip_prefix(BOM).unwrap_or(bytes);
    let mut number = 0;
    std::iter::from_fn(move || {
        if rest.is_empty() {
            return None;
        }
        number += 1;
        let end = memchr::memchr2(b'\n', b'\r', rest).unwrap_or(rest.len());
        let (line, after) = rest.split_at(end);
        let ending = if after.starts_with(b"\r\n") {
            2
        } else {
            after.len().min(1)
        };
        rest = &after[ending..];
        Some((number, line))
    })
}

fn skip_blanks(text: &[u8]) -> &[u8] {
    let start = text
        .iter()
        .position(|&b| class(b) != Class::Blank)
        .unwrap_or(text.len());
    &text[start..]
}

/// A comment without its sign and one blank; bytes that are no UTF-8 are taken as Latin-1.
fn comment(text: &[u8]) -> String {
    let text = &text[1..];
    let text = text.strip_prefix(b" ").unwrap_or(text);
    let decoded = match std::str::from_utf8(text) {
        Ok(text) => text.to_owned(),
        Err(_) => text.iter().map(|&b| char::from(b)).collect(),
    };
    decoded.trim_end().to_owned()
}

fn warn(oddities: Oddities, line: u64, extended: bool, warnings: &mut Warnings) {
    if oddities.separators {
        warnings.add(line, "separators", "commas or semicolons between columns");
    }
    if oddities.float_ids {
        warnings.add(
            line,
            "float_ids",
            "numbers, types or parents are written like 1.0",
        );
    }
    if oddities.extra_columns && !extended {
        warnings.add(
            line,
            "extra_columns",
            "more than 7 columns: the others are not read",
        );
    }
    if oddities.bad_radius {
        warnings.add(
            line,
            "radius_not_finite",
            "a radius is no finite number, or none at all: taken as 0",
        );
    }
}

/// One row, from its first field on.
fn row(text: &[u8], reading: Reading) -> Result<Row, Fault> {
    const LIMIT: f64 = Morphology::MAX_COORDINATE;
    let mut fields = Fields {
        rest: text,
        found: 0,
        comma: false,
        split: false,
        row: Oddities::default(),
    };
    let id = fields.whole("the sample's number")?;
    let kind = fields.whole("the type")?;
    let x = fields.float("x", LIMIT)?;
    let y = fields.float("y", LIMIT)?;
    let z = fields.float("z", LIMIT)?;
    let radius = match reading.zero_for_bad_radii {
        true => fields.float_or_zero("the radius", LIMIT)?,
        false => fields.float("the radius", LIMIT)?,
    };
    let parent = fields.whole("the parent's number")?;
    let oddities = fields.finish()?;
    if id < 0 {
        let text = id.to_string();
        return Err(Fault::NotWhole {
            column: "the sample's number",
            text,
        });
    }
    let Ok(kind) = i32::try_from(kind) else {
        return Err(Fault::NotWhole {
            column: "the type",
            text: kind.to_string(),
        });
    };
    let position = DVec3::new(x, y, z);
    let node = Node {
        id,
        kind: NeuriteKind(kind),
        position,
        radius,
        parent: None,
        section: None,
    };
    Ok(Row {
        node,
        parent,
        oddities,
    })
}

/// What tables have where there is no number.
const NO_NUMBER: [&[u8]; 6] = [b"na", b"n/a", b"none", b"null", b"nil", b"<na>"];

/// Takes a row apart.
struct Fields<'a> {
    rest: &'a [u8],
    found: usize,
    /// A comma without a blank beside it separates two fields.
    comma: bool,
    /// Something else does.
    split: bool,
    row: Oddities,
}

impl Fields<'_> {
    fn whole(&mut self, column: &'static str) -> Result<i64, Fault> {
        self.next_field(column)?;
        let (value, length, float) = number::whole(self.rest, column)?;
        self.row.float_ids |= float;
        self.row.any |= float;
        self.rest = &self.rest[length..];
        Ok(value)
    }

    fn float(&mut self, column: &'static str, limit: f64) -> Result<f64, Fault> {
        self.next_field(column)?;
        let (value, length) = number::float(self.rest, column, limit)?;
        self.rest = &self.rest[length..];
        Ok(value)
    }

    /// A number, or 0 where it is not finite or out of range.
    fn float_or_zero(&mut self, column: &'static str, limit: f64) -> Result<f64, Fault> {
        self.next_field(column)?;
        let none = number::token(self.rest);
        let (value, length) = match NO_NUMBER.iter().any(|no| none.eq_ignore_ascii_case(no)) {
            true => (f64::NAN, none.len()),
            false => number::any_float(self.rest, column)?,
        };
        self.rest = &self.rest[length..];
        let good = value.abs() <= limit;
        self.row.bad_radius |= !good;
        self.row.any |= !good;
        Ok(if good { value } else { 0.0 })
    }

    /// Goes to the start of the next field.
    #[inline]
    fn next_field(&mut self, column: &'static str) -> Result<(), Fault> {
        // Nearly always there are blanks and nothing else.
        let mut blanks = 0;
        while let Some(&byte) = self.rest.get(blanks)
            && class(byte) == Class::Blank
        {
            blanks += 1;
        }
        self.rest = &self.rest[blanks..];
        if blanks > 0
            && self
                .rest
                .first()
                .is_some_and(|&b| class(b) == Class::Letter)
        {
            self.split |= self.found > 0;
            self.found += 1;
            return Ok(());
        }
        self.separator(column, blanks)
    }

    /// Like [`next_field`](Self::next_field), whatever there is after the blanks.
    fn separator(&mut self, column: &'static str, mut blanks: usize) -> Result<(), Fault> {
        let (mut commas, mut semicolons) = (0, 0);
        while let Some((&byte, after)) = self.rest.split_first() {
            match class(byte) {
                Class::Blank => blanks += 1,
                Class::Comma => commas += 1,
                Class::Semicolon => semicolons += 1,
                Class::Letter | Class::Hash => break,
            }
            self.rest = after;
        }
        if self.rest.first().is_none_or(|&b| class(b) == Class::Hash) {
            return Err(Fault::Columns { found: self.found });
        }
        if commas + semicolons > usize::from(self.found > 0) {
            return Err(Fault::NotANumber {
                column,
                text: String::new(),
            });
        }
        if self.found > 0 {
            self.comma |= commas == 1 && blanks == 0;
            self.split |= commas == 0;
            self.row.separators |= commas + semicolons > 0;
            self.row.any |= self.row.separators;
        }
        self.found += 1;
        Ok(())
    }

    /// What comes after the last field: nothing, a comment, or other columns.
    fn finish(mut self) -> Result<Oddities, Fault> {
        if self.comma && self.split {
            return Err(Fault::DecimalComma);
        }
        let extra = self
            .rest
            .iter()
            .find(|&&b| matches!(class(b), Class::Letter | Class::Hash));
        if extra.is_some_and(|&b| class(b) == Class::Letter) {
            self.row.extra_columns = true;
            self.row.any = true;
        }
        Ok(self.row)
    }
}
