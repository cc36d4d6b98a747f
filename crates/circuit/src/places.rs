//! Tables of places on one cell, as of its synapses: coordinates, or shares of sections.
//!
//! ```text
//! section,position
//! 12,0.25
//! ```
//!
//! `x`, `y` and `z` (µm) are those of a table of points. `section` counts sections as reports do
//! ([`SectionNumbers`](neurotess_morphology::SectionNumbers)), 0 is the soma; `position` is from 0 at its start to 1 at its end.

use std::path::Path;

use glam::DVec3;
use neurotess_formats::read_regular;

use crate::{CircuitError, Compartment, Fault, PointTable, table};

/// Places of a CSV or TSV file.
#[derive(Clone, Debug, PartialEq)]
pub enum PlaceTable {
    /// Coordinates (µm).
    Points(Vec<DVec3>),
    /// Shares of sections.
    Along(Vec<Compartment>),
}

impl PlaceTable {
    /// Reads a table.
    ///
    /// # Errors
    /// What is wrong with the file, and in which line.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, CircuitError> {
        let path = path.as_ref();
        let bytes = read_regular(path).map_err(|e| CircuitError::io(path, e))?;
        Self::of_bytes(path, &bytes)
    }

    fn of_bytes(path: &Path, bytes: &[u8]) -> Result<Self, CircuitError> {
        let file = path.display().to_string();
        let mut reader = table::reader(path, bytes);
        let headers = reader.headers().map_err(|e| table::broken(&file, &e))?;
        let column = |name: &str| {
            let mut heads = headers.iter();
            heads.position(|head| head.eq_ignore_ascii_case(name))
        };
        let (Some(section), Some(position)) = (column("section"), column("position")) else {
            let table = PointTable::of_bytes(path, bytes)?;
            return Ok(Self::Points(table.positions));
        };
        let mut places = Vec::new();
        for record in reader.records() {
            let record = record.map_err(|e| table::broken(&file, &e))?;
            let line = record.position().map_or(1, csv::Position::line);
            let text = |place: usize| record.get(place).unwrap_or_default();
            let wrong = |name: &str, expected, text: &str| {
                let key = format!("column {name}");
                let text = text.into();
                CircuitError::at_line(&file, line, &key, Fault::NotANumber { expected, text })
            };
            let along = text(position).parse().ok();
            let along = along.filter(|along| (0.0..=1.0).contains(along));
            places.push(Compartment {
                section: text(section)
                    .parse()
                    .map_err(|_| wrong("section", "a section's number", text(section)))?,
                along: along
                    .ok_or_else(|| wrong("position", "a number from 0 to 1", text(position)))?,
            });
        }
        match places.is_empty() {
            true => Err(CircuitError::new(&file, "rows", Fault::Missing)),
            false => Ok(Self::Along(places)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<PlaceTable, CircuitError> {
        PlaceTable::of_bytes(Path::new("places.csv"), text.as_bytes())
    }

    #[test]
    fn places_are_points_or_shares_of_sections() {
        let points = read("x,y,z\n1,2,3\n").expect("points");
        assert_eq!(points, PlaceTable::Points(vec![DVec3::new(1.0, 2.0, 3.0)]));
        let along = read("id,Section,position\n7,3,0.25\n8,0,1\n").expect("places");
        let at = |section, along| Compartment { section, along };
        assert_eq!(along, PlaceTable::Along(vec![at(3, 0.25), at(0, 1.0)]));
    }

    #[test]
    fn faults_name_line_and_column() {
        let said = |text: &str| read(text).expect_err("a fault").to_string();
        let wrong = said("section,position\n1,0.5\n1,1.5\n");
        assert!(
            wrong.contains(":3") && wrong.contains("column position"),
            "{wrong}"
        );
        assert!(said("section,position\n-1,0.5\n").contains("column section"));
        assert!(said("section,position\n").contains("rows"));
        assert!(said("section\n1\n").contains("column x"));
    }
}
