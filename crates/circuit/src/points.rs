//! Tables of points: places in the circuit's coordinates, with numbers.
//!
//! ```text
//! x,y,z,conductance
//! 103.2,88.0,-4.1,0.8
//! ```
//!
//! `x`, `y` and `z` (µm) are needed. All other columns whose cells are numbers, or empty, are values.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use glam::DVec3;
use neurotess_formats::{read_regular, regular};

use crate::{CircuitError, Fault, table};

/// Bytes of a file within which the names of its columns are.
const HEAD: u64 = 64 * 1024;

/// Points of a CSV or TSV file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PointTable {
    /// Where they are (µm).
    pub positions: Vec<DVec3>,
    /// Name and numbers of each further column that has numbers only; NaN where a cell is empty.
    pub columns: Vec<(String, Vec<f64>)>,
}

impl PointTable {
    /// Reads a table.
    ///
    /// # Errors
    /// What is wrong with the file, and in which line.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, CircuitError> {
        let path = path.as_ref();
        let bytes = read_regular(path).map_err(|e| CircuitError::io(path, e))?;
        Self::of_bytes(path, &bytes)
    }

    pub(crate) fn of_bytes(path: &Path, bytes: &[u8]) -> Result<Self, CircuitError> {
        let file = path.display().to_string();
        let mut reader = table::reader(path, bytes);
        let headers = reader.headers().map_err(|e| table::broken(&file, &e))?;
        let headers: Vec<String> = headers.iter().map(str::to_owned).collect();
        let axes = ["x", "y", "z"].map(|name| {
            let mut heads = headers.iter();
            let key = format!("column {name}");
            let place = heads.position(|head| head.eq_ignore_ascii_case(name));
            place.ok_or_else(|| CircuitError::at_line(&file, 1, &key, Fault::Missing))
        });
        let [x, y, z] = axes;
        let axes = [x?, y?, z?];
        let mut positions = Vec::new();
        let others = (0..headers.len()).filter(|place| !axes.contains(place));
        let mut columns: Vec<(usize, Option<Vec<f64>>)> =
            others.map(|place| (place, Some(Vec::new()))).collect();
        for record in reader.records() {
            let record = record.map_err(|e| table::broken(&file, &e))?;
            let line = record.position().map_or(1, csv::Position::line);
            let mut position = DVec3::ZERO;
            for (axis, &place) in axes.iter().enumerate() {
                let text = record.get(place).unwrap_or_default();
                let parsed = text.parse().ok().filter(|n: &f64| n.is_finite());
                position[axis] = parsed.ok_or_else(|| {
                    let key = format!("column {}", headers[place]);
                    let fault = Fault::NotANumber {
                        expected: "a number",
                        text: text.into(),
                    };
                    CircuitError::at_line(&file, line, &key, fault)
                })?;
            }
            positions.push(position);
            for (place, values) in &mut columns {
                let text = record.get(*place).unwrap_or_default();
                let value = match text {
                    "" => Some(f64::NAN),
                    text => text.parse().ok(),
                };
                // A column with anything but numbers is none of values.
                match (values.as_mut(), value) {
                    (Some(values), Some(value)) => values.push(value),
                    _ => *values = None,
                }
            }
        }
        if positions.is_empty() {
            return Err(CircuitError::new(&file, "rows", Fault::Missing));
        }
        let named =
            |(place, values): (usize, Option<Vec<f64>>)| Some((headers[place].clone(), values?));
        Ok(Self {
            positions,
            columns: columns.into_iter().filter_map(named).collect(),
        })
    }
}

/// Whether a file is a table of points by its name and its columns: it has `x`, `y` and `z`, but no `file` as a table
/// of cells has.
pub fn is_point_table(path: impl AsRef<Path>) -> bool {
    let path = path.as_ref();
    let mut begin = Vec::new();
    let read = regular(path).and_then(|()| File::open(path));
    let read = read.and_then(|file| file.take(HEAD).read_to_end(&mut begin));
    table::is_named_so(path) && read.is_ok() && has_columns(path, &begin)
}

fn has_columns(path: &Path, begin: &[u8]) -> bool {
    let mut reader = table::reader(path, begin);
    let Ok(headers) = reader.headers() else {
        return false;
    };
    let has = |name: &str| headers.iter().any(|head| head.eq_ignore_ascii_case(name));
    ["x", "y", "z"].into_iter().all(has) && !has("file")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<PointTable, CircuitError> {
        PointTable::of_bytes(Path::new("points.csv"), text.as_bytes())
    }

    #[test]
    fn places_and_columns_of_numbers_are_read() {
        let table = read("name,X,y,z,weight\na,1,2,3,0.5\n# half\nb,4,5,6,\n").expect("a table");
        assert_eq!(
            table.positions,
            [DVec3::new(1.0, 2.0, 3.0), DVec3::new(4.0, 5.0, 6.0)]
        );
        let [(name, values)] = &table.columns[..] else {
            panic!("one column of numbers");
        };
        assert_eq!((name.as_str(), values[0]), ("weight", 0.5));
        assert!(values[1].is_nan());
    }

    #[test]
    fn faults_name_line_and_column() {
        let said = |text: &str| read(text).expect_err("a fault").to_string();
        assert!(said("x,y\n1,2\n").contains("column z"));
        let wrong = said("x,y,z\n1,2,3\n1,up,3\n");
        assert!(
            wrong.contains(":3") && wrong.contains("column y"),
            "{wrong}"
        );
        assert!(said("x,y,z\n").contains("rows"));
    }

    #[test]
    fn tables_of_cells_are_none_of_points() {
        let is = |text: &str| has_columns(Path::new("a.csv"), text.as_bytes());
        assert!(is("# mine\nX,y,z,weight\n1,2,3,4\n"));
        assert!(!is("file,x,y,z\na.swc,1,2,3\n"));
        assert!(!is("x,y\n1,2\n") && !is(""));
        assert!(!is_point_table("no such file.csv"));
    }
}
