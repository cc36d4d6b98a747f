//! Tables of node types: blanks between fields, quotes around fields with blanks, `NULL` for none.

use std::collections::HashMap;
use std::path::Path;

use neurotess_formats::read_regular;

use crate::{CircuitError, Fault};

/// Attributes of node types.
#[derive(Debug, Default)]
pub(crate) struct Types {
    columns: Vec<String>,
    /// Fields by type; `None` for NULL.
    rows: HashMap<i64, Vec<Option<String>>>,
}

impl Types {
    /// Reads the types of a population.
    pub(crate) fn open(path: &Path, population: &str) -> Result<Self, CircuitError> {
        let bytes = read_regular(path).map_err(|e| CircuitError::io(path, e))?;
        let text = String::from_utf8_lossy(&bytes);
        Self::parse(&path.display().to_string(), &text, population)
    }

    /// Reads a table. Rows of other populations are left out; where two have one id, the last wins.
    pub(crate) fn parse(file: &str, text: &str, population: &str) -> Result<Self, CircuitError> {
        let text = text.trim_start_matches('\u{feff}');
        let lines = text
            .lines()
            .zip(1u64..)
            .filter(|(l, _)| !l.trim().is_empty());
        let mut lines = lines.map(|(line, number)| (fields(line), number));
        let fault = |line, key: &str, fault| CircuitError::at_line(file, line, key, fault);
        let id_key = "column node_type_id";
        let Some((header, first)) = lines.next() else {
            return Ok(Self::default());
        };
        let columns: Vec<String> = header.into_iter().map(Option::unwrap_or_default).collect();
        let place = |name: &str| columns.iter().position(|column| column == name);
        let id_column = place("node_type_id");
        let id_column = id_column.ok_or_else(|| fault(first, id_key, Fault::Missing))?;
        let of_population = place("population");
        let mut rows = HashMap::new();
        for (row, line) in lines {
            if row.len() != columns.len() {
                let (found, expected) = (row.len(), columns.len());
                let wrong = Fault::Fields { found, expected };
                return Err(fault(line, "", wrong));
            }
            let other = of_population.and_then(|p| row[p].as_deref());
            if other.is_some_and(|other| other != population) {
                continue;
            }
            let text = row[id_column].clone().unwrap_or_default();
            let Ok(id) = text.parse() else {
                let expected = "a whole number";
                let wrong = Fault::NotANumber { expected, text };
                return Err(fault(line, id_key, wrong));
            };
            rows.insert(id, row);
        }
        Ok(Self { columns, rows })
    }

    /// Whether there is no type.
    pub(crate) fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Names of the attributes: all columns but the type's id and the population.
    pub(crate) fn attributes(&self) -> impl Iterator<Item = &str> {
        let names = self.columns.iter().map(String::as_str);
        names.filter(|&name| name != "node_type_id" && name != "population")
    }

    pub(crate) fn has(&self, attribute: &str) -> bool {
        self.attributes().any(|name| name == attribute)
    }

    pub(crate) fn knows(&self, id: i64) -> bool {
        self.rows.contains_key(&id)
    }

    /// An attribute by type; types that have none are not there.
    pub(crate) fn values(&self, attribute: &str) -> HashMap<i64, &str> {
        let Some(column) = self.columns.iter().position(|c| c == attribute) else {
            return HashMap::new();
        };
        let rows = self.rows.iter();
        rows.filter_map(|(&id, row)| Some((id, row[column].as_deref()?)))
            .collect()
    }
}

/// Fields between blanks. A field in quotes may hold blanks; a quote within is written twice.
fn fields(line: &str) -> Vec<Option<String>> {
    let mut fields = Vec::new();
    let mut rest = line.trim();
    while let Some(first) = rest.chars().next() {
        let (field, quoted);
        (field, quoted, rest) = if first == '"' || first == '\'' {
            let (field, tail) = quoted_field(&rest[1..], first);
            (field, true, tail)
        } else {
            let end = rest.find(char::is_whitespace).unwrap_or(rest.len());
            (rest[..end].to_owned(), false, &rest[end..])
        };
        let none = !quoted && ["NULL", "NONE", "None", "NaN", "nan"].contains(&field.as_str());
        fields.push((!none).then_some(field));
        rest = rest.trim_start();
    }
    fields
}

/// The field up to the closing quote, and what follows it.
fn quoted_field(text: &str, quote: char) -> (String, &str) {
    let mut field = String::new();
    let mut rest = text;
    while let Some(end) = rest.find(quote) {
        field.push_str(&rest[..end]);
        rest = &rest[end + 1..];
        if !rest.starts_with(quote) {
            return (field, rest);
        }
        field.push(quote);
        rest = &rest[1..];
    }
    field.push_str(rest);
    (field, "")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quotes_blanks_and_null_are_understood() {
        let text = "node_type_id  population morphology name\r\n\
                    100 v1 \"a b\" 'it''s'\n\n\
                    101 lgn c d\n\
                    102 NULL NULL \"NULL\"\n";
        let types = Types::parse("t.csv", text, "v1").expect("a table");
        assert_eq!(
            types.attributes().collect::<Vec<_>>(),
            ["morphology", "name"]
        );
        assert_eq!(types.values("morphology"), HashMap::from([(100, "a b")]));
        let names = HashMap::from([(100, "it's"), (102, "NULL")]);
        assert_eq!(types.values("name"), names);
        assert!(!types.knows(101), "of another population");
    }

    #[test]
    fn faults_name_line_and_column() {
        let message = |text| {
            Types::parse("t.csv", text, "p")
                .err()
                .map(|e| e.to_string())
        };
        let short = message("node_type_id a\n1\n").expect("too few");
        assert_eq!(short, "t.csv:2: 1 fields instead of 2: correct it");
        let id = message("node_type_id a\nx 1\n").expect("no number");
        assert!(id.contains("t.csv:2: 'column node_type_id'"), "{id}");
        assert!(message("a b\n1 2\n").is_some(), "no id column");
        assert!(message("").is_none() && message("node_type_id\n").is_none());
    }
}
