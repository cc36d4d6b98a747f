//! Tables of node types: rows of fields apart by blanks, the first with the columns' names.

use std::collections::HashMap;
use std::path::Path;

use neurotess_formats::read_regular;

use crate::sonata::blanks::{self, Field, Row};
use crate::{CircuitError, Fault, Warning};

/// Attributes of node types.
#[derive(Debug, Default)]
pub(crate) struct Types {
    columns: Vec<String>,
    /// Fields by type; `None` for no value.
    rows: HashMap<i64, Vec<Field>>,
}

const ID: &str = "node_type_id";

impl Types {
    /// Reads the types of a population.
    pub(crate) fn open(
        path: &Path,
        population: &str,
        warnings: &mut Vec<Warning>,
    ) -> Result<Self, CircuitError> {
        let bytes = read_regular(path).map_err(|e| CircuitError::io(path, e))?;
        let text = String::from_utf8_lossy(&bytes);
        Self::parse(&path.display().to_string(), &text, population, warnings)
    }

    /// Reads a table. Rows of other populations are left out; where two have one id, the last wins.
    pub(crate) fn parse(
        file: &str,
        text: &str,
        population: &str,
        warnings: &mut Vec<Warning>,
    ) -> Result<Self, CircuitError> {
        let all = blanks::rows(text.trim_start_matches('\u{feff}'));
        let fault = |line, key: &str, fault| CircuitError::at_line(file, line, key, fault);
        let id_key = format!("column {ID}");
        let Some((header, rows)) = all.split_first() else {
            return Ok(Self::default());
        };
        let reading = Reading::of(header, rows);
        let columns = reading.header(header);
        let place = |name: &str| columns.iter().position(|column| column == name);
        let id_column = place(ID);
        let id_column = id_column.ok_or_else(|| fault(header.line, &id_key, Fault::Missing))?;
        let of_population = place("population");
        let mut types = HashMap::new();
        let mut short: Vec<u64> = Vec::new();
        for row in rows {
            let mut fields = reading.fields(row, columns.len());
            if fields.len() > columns.len() {
                let (found, expected) = (fields.len(), columns.len());
                let wrong = Fault::Fields { found, expected };
                return Err(fault(row.line, "", wrong));
            }
            if fields.len() < columns.len() {
                short.push(row.line);
                fields.resize(columns.len(), None);
            }
            let other = of_population.and_then(|p| fields[p].as_deref());
            if other.is_some_and(|other| other != population) {
                continue;
            }
            let text = fields[id_column].clone().unwrap_or_default();
            let Some(id) = whole(&text) else {
                let expected = "a whole number";
                let wrong = Fault::NotANumber { expected, text };
                return Err(fault(row.line, &id_key, wrong));
            };
            types.insert(id, fields);
        }
        if let Some(first) = short.first() {
            let message = format!(
                "{} rows have fewer fields than there are columns, the first in line {first}: the last columns \
                 are taken as empty there",
                short.len()
            );
            let warning = Warning::new(file, "", "fields_missing", message);
            warnings.push(warning.times(short.len() as u64));
        }
        Ok(Self {
            columns,
            rows: types,
        })
    }

    /// Whether there is no type.
    pub(crate) fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Names of the attributes: all columns but the type's id and the population, and those without a name.
    pub(crate) fn attributes(&self) -> impl Iterator<Item = &str> {
        let names = self.columns.iter().map(String::as_str);
        names.filter(|&name| name != ID && name != "population" && !name.is_empty())
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

/// A type's id. Where one is missing, pandas writes all as real numbers.
fn whole(text: &str) -> Option<i64> {
    text.parse().ok().or_else(|| {
        let real: f64 = text.parse().ok()?;
        // Up to 2⁵³ a real number is exact.
        let exact = real.fract() == 0.0 && real.abs() <= 9_007_199_254_740_992.0;
        exact.then_some(real as i64)
    })
}

/// How blanks are meant in a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Reading {
    /// Each ends a field, as pandas has it.
    Each,
    /// Several are one, in a table aligned by hand.
    Aligned,
}

impl Reading {
    /// The reading that gives each row as many fields as there are columns. Where both do, it is pandas', unless
    /// columns without a name stand between others, which no program writes.
    fn of(header: &Row, rows: &[Row]) -> Self {
        let bare = |reading: Self| reading.header(header);
        let fits = |reading: Self| {
            let names = bare(reading);
            let id = names.iter().position(|name| name == ID);
            rows.iter().all(|row| {
                let fields = reading.fields(row, names.len());
                let id = id.map_or(Some(""), |id| fields.get(id)?.as_deref());
                fields.len() == names.len() && id.is_some_and(|id| whole(id).is_some())
            })
        };
        let each = bare(Self::Each);
        let inner = each.get(1..each.len().saturating_sub(1));
        let is_aligned = inner.is_some_and(|inner| inner.iter().any(String::is_empty));
        let preferred = match is_aligned {
            true => [Self::Aligned, Self::Each],
            false => [Self::Each, Self::Aligned],
        };
        preferred
            .into_iter()
            .find(|&reading| fits(reading))
            .unwrap_or(preferred[0])
    }

    fn header(self, row: &Row) -> Vec<String> {
        let fields = match self {
            // Words for none may be names.
            Self::Each => row.fields.clone(),
            Self::Aligned => row.aligned(),
        };
        let mut names: Vec<String> = fields.into_iter().map(Option::unwrap_or_default).collect();
        while names.last().is_some_and(String::is_empty) {
            names.pop();
        }
        names
    }

    /// The fields of a row below `columns` columns.
    fn fields(self, row: &Row, columns: usize) -> Vec<Field> {
        let mut fields = match self {
            Self::Each => row.values(),
            Self::Aligned => row.aligned(),
        };
        // A row with one field more has an index in front, which pandas' `to_csv` writes without a name; but blanks
        // at the end of a line are only that.
        while fields.len() > columns && fields.last().is_some_and(Option::is_none) {
            fields.pop();
        }
        if fields.len() == columns + 1 {
            fields.remove(0);
        }
        fields
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str, population: &str) -> Result<(Types, Vec<Warning>), CircuitError> {
        let mut warnings = Vec::new();
        let types = Types::parse("t.csv", text, population, &mut warnings)?;
        Ok((types, warnings))
    }

    /// Of each attribute the value that a type has.
    fn values(text: &str, id: i64) -> Vec<Option<String>> {
        let (types, warnings) = parse(text, "p").expect(text);
        assert!(warnings.is_empty(), "{warnings:?}");
        let value = |name: &str| types.values(name).get(&id).map(|text| (*text).to_owned());
        types.attributes().map(value).collect()
    }

    #[test]
    fn blanks_in_a_row_have_an_empty_field_between_them() {
        let some = |text: &str| Some(text.to_owned());
        let header = "node_type_id model params morphology\n";
        let of = |row: &str| values(&format!("{header}{row}\n"), 100);
        assert_eq!(of("100 bio  c.swc"), [some("bio"), None, some("c.swc")]);
        assert_eq!(of("100   c.swc"), [None, None, some("c.swc")]);
        assert_eq!(of("100 bio NULL "), [some("bio"), None, None]);
        assert_eq!(
            of("100 bio p c.swc "),
            [some("bio"), some("p"), some("c.swc")]
        );
        assert_eq!(of("100   "), [None, None, None]);
        // Indented, or with an index, as pandas would have it.
        assert_eq!(of(" 100 bio  c.swc"), [some("bio"), None, some("c.swc")]);
        assert_eq!(
            of("0 100 bio \"\" c.swc"),
            [some("bio"), None, some("c.swc")]
        );
        // The id may be any column, and the first may be empty.
        assert_eq!(values("a node_type_id b\n 7 x\n", 7), [None, some("x")]);
        assert_eq!(values(" node_type_id b\n0 7 x\n", 7), [some("x")]);
        assert_eq!(values("node_type_id b \n7 x \n", 7), [some("x")]);
        assert_eq!(values("b node_type_id\nx 7.0\n", 7), [some("x")]);
    }

    #[test]
    fn tables_aligned_by_hand_are_read() {
        let some = |text: &str| Some(text.to_owned());
        let text = "node_type_id  model       morphology\n\
                    100           bio         c.swc\n\
                    101           biophysical NULL\n";
        assert_eq!(values(text, 100), [some("bio"), some("c.swc")]);
        assert_eq!(values(text, 101), [some("biophysical"), None]);
        let tabs = "node_type_id\tmodel\tmorphology\n7\t\tc.swc\n";
        assert_eq!(values(tabs, 7), [None, some("c.swc")]);
    }

    #[test]
    fn quotes_blanks_and_null_are_understood() {
        let text = "node_type_id  population morphology name\r\n\
                    100 v1 \"a b\" 'it''s'\n\n\
                    101 lgn c d\n\
                    102 NULL NULL \"NULL\"\n";
        let (types, _) = parse(text, "v1").expect("a table");
        assert_eq!(
            types.attributes().collect::<Vec<_>>(),
            ["morphology", "name"]
        );
        assert_eq!(types.values("morphology"), HashMap::from([(100, "a b")]));
        assert_eq!(types.values("name"), HashMap::from([(100, "it's")]));
        assert!(
            types.knows(102) && !types.knows(101),
            "of another population"
        );
    }

    #[test]
    fn short_rows_are_filled_and_told() {
        let (types, warnings) = parse("node_type_id a b\n1 x\n2 x y\n", "p").expect("a table");
        assert_eq!(types.values("b"), HashMap::from([(2, "y")]));
        assert_eq!((warnings[0].code, warnings[0].count), ("fields_missing", 1));
    }

    #[test]
    fn faults_name_line_and_column() {
        let message = |text| parse(text, "p").err().map(|e| e.to_string());
        let long = message("node_type_id a\n1 x\n\n1 x y z\n").expect("too many");
        assert_eq!(long, "t.csv:4: 4 fields instead of 2: correct it");
        let id = message("node_type_id a\nx 1\n").expect("no number");
        assert!(id.contains("t.csv:2: 'column node_type_id'"), "{id}");
        assert!(message("a b\n1 2\n").is_some(), "no id column");
        assert!(message("").is_none() && message("node_type_id\n").is_none());
    }
}
