//! The arrays that Python has of a cell's points.

use neurotess::morphology::{Attachment, Morphology};

/// Positions (µm) in the coordinates of the file.
pub(super) fn points(cell: &Morphology) -> Vec<[f64; 3]> {
    let points = cell.points.iter();
    points
        .map(|p| (cell.origin + p.position.as_dvec3()).to_array())
        .collect()
}

/// Radii (µm).
pub(super) fn radii(cell: &Morphology) -> Vec<f64> {
    cell.points.iter().map(|p| f64::from(p.radius)).collect()
}

/// The SWC type of each point.
pub(super) fn types(cell: &Morphology) -> Vec<i32> {
    let mut types = vec![0; cell.points.len()];
    for section in &cell.sections {
        types[section.range()].fill(section.kind.0);
    }
    types
}

/// The index of the point that each point hangs on; −1 where a neurite begins.
pub(super) fn parents(cell: &Morphology) -> Vec<i64> {
    let mut parents: Vec<i64> = (-1..).take(cell.points.len()).collect();
    for section in &cell.sections {
        parents[section.first as usize] = match section.attachment {
            Attachment::Section(parent) => i64::from(cell.sections[parent.index()].end) - 1,
            Attachment::Soma { .. } | Attachment::Free => -1,
        };
    }
    parents
}
