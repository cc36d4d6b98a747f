//! `--values`: a table with values of one's own for samples or sections, in one column or one for each time.

use std::collections::HashMap;
use std::path::Path;

use neurotess::coloring::Cell;
use neurotess::formats::read_regular;
use neurotess::mesh::{Role, TracingPoint};
use neurotess::render::color::category;
use neurotess::web::PageRecording;

/// What rows of a table are of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Of {
    Sample,
    Section,
}

/// Values by row.
#[derive(Debug, PartialEq)]
struct Table {
    of: Of,
    /// Names of the columns of values.
    columns: Vec<String>,
    /// Row by sample or section.
    rows: HashMap<i64, usize>,
    /// By column, then by row.
    values: Vec<Vec<f32>>,
}

/// Reads a table of values of a cell. `range`: numbers at both ends of the scale, if they are not the least and the
/// greatest.
///
/// # Errors
/// The file is no such table, or has values of nothing that is there.
pub(super) fn read(
    path: &Path,
    range: Option<[f32; 2]>,
    cells: &[Cell<'_>],
) -> anyhow::Result<PageRecording> {
    let file = path.display();
    let [cell] = cells else {
        anyhow::bail!(
            "{file}: has values of one cell, and there are {}: give one",
            cells.len()
        );
    };
    let text = read_regular(path).map_err(|e| anyhow::anyhow!("{file}: cannot be read: {e}"))?;
    let table = Table::parse(&text).map_err(|e| anyhow::anyhow!("{file}:{e}"))?;
    let keys: Vec<u32> = cell
        .mesh
        .tracing
        .iter()
        .map(|point| table.key(point))
        .collect();
    if keys.iter().all(|&key| key == category(0)) {
        let of = if table.of == Of::Sample {
            "samples"
        } else {
            "sections"
        };
        anyhow::bail!("{file}: has no value of any of the cell's {of}: check their numbers");
    }
    let times: Option<Vec<f64>> = table.columns.iter().map(|name| name.parse().ok()).collect();
    let times = times.filter(|times| times.len() > 1);
    if times.is_none() && table.columns.len() > 1 {
        anyhow::bail!("{file}:1: several columns of values are times: name them by numbers (ms)");
    }
    let finite = || {
        table
            .values
            .iter()
            .flatten()
            .filter(|value| value.is_finite())
    };
    let [low, high] = range.unwrap_or_else(|| {
        [
            finite().copied().fold(f32::MAX, f32::min),
            finite().copied().fold(f32::MIN, f32::max),
        ]
    });
    let named = path.file_stem().unwrap_or_default().to_string_lossy();
    Ok(PageRecording {
        title: match &times {
            Some(_) => named.replace('_', " "),
            None => table.columns[0].clone(),
        },
        unit: String::new(),
        times: times.unwrap_or_default(),
        range: [low, if high > low { high } else { low + 1.0 }],
        color_keys: vec![keys],
        frames: table
            .values
            .into_iter()
            .map(|values| vec![values])
            .collect(),
    })
}

impl Table {
    /// # Errors
    /// Line and fault.
    fn parse(text: &[u8]) -> Result<Self, String> {
        let first = text.split(|&byte| byte == b'\n').next().unwrap_or_default();
        let delimiter = if first.contains(&b'\t') { b'\t' } else { b',' };
        let mut reader = csv::ReaderBuilder::new()
            .delimiter(delimiter)
            .trim(csv::Trim::All)
            .from_reader(text);
        let header = reader.headers().map_err(|e| format!("1: {e}"))?.clone();
        let of = match header.get(0) {
            Some("sample") => Of::Sample,
            Some("section") => Of::Section,
            _ => return Err("1: the first column must be named sample or section".into()),
        };
        let columns: Vec<String> = header.iter().skip(1).map(str::to_owned).collect();
        if columns.is_empty() {
            return Err("1: there is no column of values: add one".into());
        }
        let mut rows = HashMap::new();
        let mut values = vec![Vec::new(); columns.len()];
        for record in reader.records() {
            let record = record.map_err(|e| match e.position() {
                Some(at) => format!("{}: {e}", at.line()),
                None => format!(" {e}"),
            })?;
            let line = record.position().map_or(0, csv::Position::line);
            let number = record[0].parse();
            let number =
                number.map_err(|_| format!("{line}: '{}' is no whole number", &record[0]))?;
            rows.insert(number, values[0].len());
            for (column, field) in values.iter_mut().zip(record.iter().skip(1)) {
                let value = match field {
                    "" => Ok(f32::NAN),
                    text => text.parse(),
                };
                column.push(value.map_err(|_| format!("{line}: '{field}' is no number"))?);
            }
        }
        Ok(Self {
            of,
            columns,
            rows,
            values,
        })
    }

    /// The color key of a point: the index of its row, or that of nothing.
    fn key(&self, point: &TracingPoint) -> u32 {
        let number = match self.of {
            Of::Sample => Some(i64::from(point.sample.0)),
            Of::Section => point.section.index().map(|section| section as i64),
        };
        let row = number
            .filter(|_| self.of == Of::Sample || point.role != Role::Soma)
            .and_then(|number| self.rows.get(&number));
        row.map_or(category(0), |&row| row as u32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_name_what_they_are_of_and_their_lines() {
        let table = Table::parse(b"section,0,0.5\n3,1.5,2\n4,,1e3\n").expect("a table");
        assert_eq!(
            (table.of, &table.columns[..]),
            (Of::Section, &["0".into(), "0.5".into()][..])
        );
        assert_eq!((table.rows[&4], table.values[1][1]), (1, 1000.0));
        assert!(table.values[0][1].is_nan());
        let fault = |text: &[u8]| Table::parse(text).expect_err("a fault");
        assert!(fault(b"x,y\n").starts_with("1: the first column"));
        assert!(fault(b"sample\tv\n1\ta\n").starts_with("2: 'a' is no number"));
        assert!(
            fault(b"sample,v\n1\n").starts_with("2: "),
            "{}",
            fault(b"sample,v\n1\n")
        );
    }
}
