//! `--table`: the numbers of all tracings in one file, as comma- or tab-separated values (RFC 4180).

use std::io::Write;
use std::path::{Path, PathBuf};

use super::rows::{Per, Row, Value, columns};
use crate::io::table;

/// Where a table goes, and what is between its fields.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Target {
    pub(super) path: PathBuf,
    delimiter: u8,
}

impl std::str::FromStr for Target {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let standard = |delimiter| Self {
            path: "-".into(),
            delimiter,
        };
        let path = Path::new(text);
        let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
        let file = |delimiter| Self {
            path: path.into(),
            delimiter,
        };
        match (text, &*extension.to_string_lossy()) {
            ("-" | "csv", _) => Ok(standard(b',')),
            ("tsv", _) => Ok(standard(b'\t')),
            (_, "csv") => Ok(file(b',')),
            (_, "tsv" | "tab") => Ok(file(b'\t')),
            _ => Err(
                "FILE.csv, FILE.tsv, or - is needed (csv and tsv alone go to standard output)"
                    .into(),
            ),
        }
    }
}

impl Target {
    /// Writes the rows of all files, whole or not at all. Spheres are `step` (µm) apart.
    pub(super) fn write(
        &self,
        files: &[(&str, &[Row])],
        per: Per,
        step: Option<f64>,
        force: bool,
    ) -> anyhow::Result<()> {
        table::write_to(&self.path, self.delimiter, force, |to| {
            fill(files, per, step, to)
        })
    }
}

fn fill(
    files: &[(&str, &[Row])],
    per: Per,
    step: Option<f64>,
    to: &mut csv::Writer<impl Write>,
) -> anyhow::Result<()> {
    let rows = || files.iter().flat_map(|(_, rows)| rows.iter());
    let spheres = rows()
        .filter_map(|row| Some(row.sholl.as_ref()?.len()))
        .max();
    let spheres = spheres.unwrap_or(0);
    let mut line: Vec<String> = vec!["file".into()];
    line.extend(columns(per).into_iter().map(str::to_owned));
    let step = step.unwrap_or_default();
    line.extend((1..=spheres).map(|k| format!("sholl_{}", k as f64 * step)));
    to.write_record(&line)?;
    for (file, rows) in files {
        for row in *rows {
            line.clear();
            line.push((*file).to_owned());
            line.extend(row.fields.iter().map(|(_, value)| text(value)));
            // Beyond the farthest point nothing crosses.
            let crossings = row.sholl.as_deref().unwrap_or_default();
            line.extend((0..spheres).map(|k| crossings.get(k).unwrap_or(&0).to_string()));
            to.write_record(&line)?;
        }
    }
    Ok(())
}

/// Nothing where there is no number.
fn text(value: &Value) -> String {
    match value {
        Value::Text(text) => text.clone(),
        Value::Count(count) => count.to_string(),
        Value::Number(number) => number.map_or(String::new(), |number| number.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_tell_the_delimiter() {
        let target = |text: &str| text.parse::<Target>().map(|t| (t.path, t.delimiter));
        assert_eq!(target("a/b.CSV"), Ok(("a/b.CSV".into(), b',')));
        assert_eq!(target("b.tsv"), Ok(("b.tsv".into(), b'\t')));
        assert_eq!(target("-"), Ok(("-".into(), b',')));
        assert_eq!(target("tsv"), Ok(("-".into(), b'\t')));
        assert!(target("b.xlsx").is_err());
    }

    #[test]
    fn fields_with_delimiters_are_quoted() {
        let row = Row {
            fields: vec![("a", Value::Number(Some(0.5))), ("b", Value::Number(None))],
            sholl: Some(vec![3]),
        };
        let rows = [row];
        let files: [(&str, &[Row]); 1] = [("my, \"cell\".swc", &rows)];
        // The row of this test has fewer fields than the heading.
        let mut writer = csv::WriterBuilder::new()
            .flexible(true)
            .from_writer(Vec::new());
        fill(&files, Per::Bar, Some(2.5), &mut writer).expect("memory takes it");
        let text = String::from_utf8(writer.into_inner().expect("memory")).expect("text");
        let mut lines = text.lines();
        assert!(
            lines
                .next()
                .is_some_and(|header| header.ends_with(",sholl_2.5")),
            "{text}"
        );
        assert_eq!(lines.next(), Some("\"my, \"\"cell\"\".swc\",0.5,,3"));
    }
}
