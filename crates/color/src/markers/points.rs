//! Points of a table as markers.

use std::path::Path;

use neurotess_circuit::PointTable;
use neurotess_picture::color::category;
use neurotess_picture::markers::Marker;

use super::{MarkerError, MarkerRow, MarkerSet, by_name, by_number, listed};
use crate::scheme::ColorScheme;

/// Points of a table. `property`: the column that colors tell; none: all have one color.
///
/// # Errors
/// There is no such column of numbers.
pub fn points(
    file: &str,
    table: &PointTable,
    property: Option<&str>,
    scheme: &ColorScheme,
) -> Result<MarkerSet, MarkerError> {
    let marker = |&position| Marker {
        position,
        color_key: category(0),
        ..Marker::default()
    };
    let markers: Vec<Marker> = table.positions.iter().map(marker).collect();
    let rows = (0..markers.len() as u64).map(|row| MarkerRow { table: 0, row });
    let rows = rows.collect();
    let Some(name) = property else {
        let stem = Path::new(file).file_stem().unwrap_or_default();
        let names = vec![stem.to_string_lossy().into_owned()];
        return Ok(MarkerSet {
            rows,
            ..by_name(markers, names, scheme)
        });
    };
    let column = table.columns.iter().find(|(column, _)| column == name);
    let (_, values) = column.ok_or_else(|| MarkerError::NoNumbers {
        file: file.to_owned(),
        name: name.to_owned(),
        there: listed(table.columns.iter().map(|(name, _)| name.as_str())),
    })?;
    Ok(MarkerSet {
        rows,
        ..by_number(markers, values, name, scheme)
    })
}
