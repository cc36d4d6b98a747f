//! Tables of placed cells, the simplest scene: CSV, or TSV.
//!
//! ```text
//! file,x,y,z,rotation_x,rotation_y,rotation_z,layer
//! pyramidal.swc,0,100,0,0,90,0,L5
//! basket.swc,30,80,5,,,,L2
//! ```
//!
//! `file` (relative to the table), `x`, `y` and `z` (µm) are needed. These are understood: `id` or
//! `node_id`; angles `rotation_x`, `rotation_y`, `rotation_z` in degrees (R = Rx Ry Rz), or with
//! `rotation_w` a quaternion, as `neurotess nodes` writes it; `scale`; `recenter` (true or false).
//! All other columns are attributes: numbers if all their cells are, else text. A row with neither a file nor a place
//! is a node that shows nothing, such as `neurotess nodes` writes of virtual ones.

use std::collections::BTreeMap;
use std::path::Path;

use glam::{DQuat, DVec3};
use neurotess_formats::read_regular;

use crate::listed::{self, Cell};
use crate::sonata::{folder_of, orientation};
use crate::table;
use crate::{Attribute, Circuit, CircuitError, Fault, Warning};

/// Opens a table. What is wrong with one row does not keep the others from showing.
pub(crate) fn open(path: &Path) -> Result<Circuit, CircuitError> {
    let bytes = read_regular(path).map_err(|e| CircuitError::io(path, e))?;
    read(path, &bytes)
}

fn read(path: &Path, bytes: &[u8]) -> Result<Circuit, CircuitError> {
    let file = path.display().to_string();
    let mut reader = table::reader(path, bytes);
    let headers = reader.headers().map_err(|e| table::broken(&file, &e))?;
    let columns = Columns::new(&file, headers)?;
    let mut cells = Vec::new();
    let mut failures = Vec::new();
    for record in reader.records() {
        let cell = record
            .map_err(|e| table::broken(&file, &e))
            .and_then(|record| columns.cell(&file, &record, cells.len() as u64, folder_of(path)));
        match cell {
            Ok(cell) => cells.push(cell),
            Err(e) => failures.push(e),
        }
    }
    if cells.is_empty() {
        let none = CircuitError::new(&file, "column file", Fault::Missing);
        return Err(failures.into_iter().next().unwrap_or(none));
    }
    let mut warnings = Vec::new();
    let nowhere = |cell: &&Cell| !cell.placement.0.is_finite();
    let count = cells.iter().filter(nowhere).count() as u64;
    if count > 0 {
        let message = format!("{count} rows have neither a file nor a place: they show nothing");
        let warning = Warning::new(&file, "column file", "row_without_cell", message);
        warnings.push(warning.times(count));
    }
    let mut circuit = listed::circuit(path, "table", &cells, warnings, failures);
    for attribute in circuit.populations[0].attributes.values_mut() {
        if let Some(numbers) = numbers(attribute) {
            *attribute = numbers;
        }
    }
    Ok(circuit)
}

/// Where the columns are that mean something.
struct Columns {
    file: usize,
    position: [usize; 3],
    id: Option<usize>,
    angles: [Option<usize>; 3],
    /// The quaternion's first component; the others are `angles`.
    real: Option<usize>,
    scale: Option<usize>,
    recenter: Option<usize>,
    /// Attributes: name and place.
    others: Vec<(String, usize)>,
}

impl Columns {
    fn new(file: &str, headers: &csv::StringRecord) -> Result<Self, CircuitError> {
        let place = |name: &str| {
            headers
                .iter()
                .position(|head| head.eq_ignore_ascii_case(name))
        };
        let needed = |name: &str| {
            let key = format!("column {name}");
            place(name).ok_or_else(|| CircuitError::at_line(file, 1, &key, Fault::Missing))
        };
        let columns = Self {
            file: needed("file")?,
            position: [needed("x")?, needed("y")?, needed("z")?],
            id: place("id").or_else(|| place("node_id")),
            angles: ["rotation_x", "rotation_y", "rotation_z"].map(place),
            real: place("rotation_w"),
            scale: place("scale"),
            recenter: place("recenter"),
            others: Vec::new(),
        };
        let known: Vec<usize> = [columns.file]
            .into_iter()
            .chain(columns.position)
            .chain(columns.angles.into_iter().flatten())
            .chain(
                [columns.id, columns.real, columns.scale, columns.recenter]
                    .into_iter()
                    .flatten(),
            )
            .collect();
        let others = headers.iter().zip(0..);
        let others = others.filter(|(name, place)| !name.is_empty() && !known.contains(place));
        Ok(Self {
            others: others
                .map(|(name, place)| (name.to_owned(), place))
                .collect(),
            ..columns
        })
    }

    fn cell(
        &self,
        file: &str,
        record: &csv::StringRecord,
        row: u64,
        folder: &Path,
    ) -> Result<Cell, CircuitError> {
        let line = record.position().map_or(1, csv::Position::line);
        let fault = |column: &str, fault| {
            CircuitError::at_line(file, line, &format!("column {column}"), fault)
        };
        let text = |place: usize| record.get(place).unwrap_or_default();
        let number = |place: Option<usize>, column: &str, default: f64| {
            let text = place.map_or("", text);
            if text.is_empty() {
                return Ok(default);
            }
            let parsed = text.parse().ok().filter(|n: &f64| n.is_finite());
            parsed.ok_or_else(|| fault(column, not(text, "a number")))
        };
        let mut position = DVec3::ZERO;
        let name = text(self.file);
        let nothing = name.is_empty() && self.position.iter().all(|&place| text(place).is_empty());
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            position[axis] = number(Some(self.position[axis]), name, f64::NAN)?;
            if position[axis].is_nan() && !nothing {
                return Err(fault(name, Fault::Missing));
            }
        }
        let mut turned = [0.0; 3];
        for (axis, name) in ["rotation_x", "rotation_y", "rotation_z"]
            .into_iter()
            .enumerate()
        {
            turned[axis] = number(self.angles[axis], name, 0.0)?;
        }
        let rotation: Option<DQuat> = match self.real {
            Some(place) => {
                let [x, y, z] = turned;
                let none = turned == [0.0; 3] && text(place).is_empty();
                let w = number(Some(place), "rotation_w", f64::from(u8::from(none)))?;
                orientation::from_components([w, x, y, z])
            }
            None => orientation::from_angles(turned.map(f64::to_radians)),
        };
        let rotation = rotation.ok_or_else(|| fault("rotation_w", Fault::Transform))?;
        let scale = number(self.scale, "scale", 1.0)?;
        if scale <= 0.0 {
            return Err(fault("scale", Fault::Transform));
        }
        let id = match self.id.map_or("", text) {
            "" => row,
            id => id
                .parse()
                .map_err(|_| fault("id", not(id, "a whole number")))?,
        };
        let recentered = match self.recenter.map_or("", text).to_ascii_lowercase().as_str() {
            "" | "false" | "0" | "no" => false,
            "true" | "1" | "yes" => true,
            other => return Err(fault("recenter", not(other, "true or false"))),
        };
        let others = self.others.iter();
        let attributes: BTreeMap<String, String> = others
            .filter(|(_, place)| !text(*place).is_empty())
            .map(|(name, place)| (name.clone(), text(*place).to_owned()))
            .collect();
        Ok(Cell {
            id,
            placement: (position, rotation, scale),
            recentered,
            file: (!name.is_empty()).then(|| folder.join(name)),
            attributes,
        })
    }
}

fn not(text: &str, expected: &'static str) -> Fault {
    Fault::NotANumber {
        expected,
        text: text.into(),
    }
}

/// A column of texts as numbers, if all of them are.
fn numbers(attribute: &Attribute) -> Option<Attribute> {
    let Attribute::Text { library, indices } = attribute else {
        return None;
    };
    let parsed: Option<Vec<f64>> = library.iter().map(|text| text.parse().ok()).collect();
    let parsed = parsed?;
    let number = |&place: &u32| parsed.get(place as usize).copied().unwrap_or(f64::NAN);
    Some(Attribute::Numbers(indices.iter().map(number).collect()))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: &str = "\u{feff}file, x,y,z,id,rotation_y,layer,depth\n\
                         # by hand\n\
                         a.swc,1,2.5,3,,90,L5,10\n\
                         \"b,c.swc\",0,0,0,9,,,12.5\n";

    fn read_text(text: &str) -> Result<Circuit, CircuitError> {
        read(Path::new("cells.csv"), text.as_bytes())
    }

    #[test]
    fn rows_are_cells_and_other_columns_attributes() {
        let circuit = read_text(TABLE).expect("a table");
        let cells = &circuit.populations[0];
        assert_eq!((&cells.ids[..], circuit.failures.len()), (&[0, 9][..], 0));
        assert_eq!(cells.positions[0], DVec3::new(1.0, 2.5, 3.0));
        assert!((cells.rotations[0] * DVec3::Z).distance(DVec3::X) < 1e-12);
        assert_eq!(cells.rotations[1], DQuat::IDENTITY);
        assert_eq!(cells.attributes["layer"].text(0), Some("L5"));
        assert_eq!(cells.attributes["layer"].text(1), None);
        assert_eq!(cells.attributes["depth"].number(1), Some(12.5));
        // Neither file is there, which is one warning of both.
        assert_eq!(circuit.warnings.len(), 1);
    }

    #[test]
    fn rows_of_virtual_nodes_show_nothing() {
        let text = "file,node_id,x,y,z,layer\na.swc,3,1,2,3,L5\n,4,,,,L5\n,5,7,8,9,\n";
        let circuit = read_text(text).expect("a table");
        let cells = &circuit.populations[0];
        assert_eq!(
            (&cells.ids[..], circuit.failures.len()),
            (&[3, 4, 5][..], 0)
        );
        assert_eq!(
            (cells.position(1), cells.position(2)),
            (None, Some(DVec3::new(7.0, 8.0, 9.0)))
        );
        let codes: Vec<_> = circuit.warnings.iter().map(|w| (w.code, w.count)).collect();
        assert_eq!(codes, [("row_without_cell", 1), ("morphology_missing", 1)]);
        // A cell needs its place, and a place all of its numbers.
        let some = read_text("file,x,y,z\na,1,2,3\nb,,,\n,1,,\n").expect("one row");
        assert_eq!((some.populations[0].len(), some.failures.len()), (1, 2));
    }

    #[test]
    fn quaternions_and_tabs_are_read() {
        let text = "file\tx\ty\tz\trotation_w\trotation_x\trotation_y\trotation_z\tscale\n\
                    a.swc\t0\t0\t0\t0\t0\t2\t0\t2\n";
        let circuit = read(Path::new("cells.TSV"), text.as_bytes()).expect("a table");
        let cells = &circuit.populations[0];
        assert!((cells.rotations[0] * DVec3::X).distance(-DVec3::X) < 1e-12);
        assert_eq!(cells.scales, [2.0]);
    }

    #[test]
    fn faults_name_line_and_column_and_leave_other_rows() {
        let message = |text: &str| read_text(text).expect_err("an error").to_string();
        assert!(message("file,x,y\na,1,2\n").contains("cells.csv:1: 'column z': is missing"));
        let word = message("file,x,y,z\na,1,two,3\n");
        assert!(
            word.contains("cells.csv:2: 'column y': is not a number"),
            "{word}"
        );
        assert!(message("file,x,y,z\n").contains("'column file'"));
        let short = message("file,x,y,z\na,1,2\n");
        assert!(
            short.contains("cells.csv:2: 3 fields instead of 4"),
            "{short}"
        );
        let some = read_text("file,x,y,z\na,1,2,\nb,1,2,3\nc,inf,0,0\n").expect("one row");
        assert_eq!((some.populations[0].len(), some.failures.len()), (1, 2));
    }
}
