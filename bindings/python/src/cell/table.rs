//! Tables of samples, as SWC has them, into morphologies and back.

use std::fmt::Write;

use neurotess::formats::{Read, ReadError, ReadOptions, swc};
use neurotess::morphology::{Attachment, Morphology};

/// Columns of a table; all have a value for each sample.
pub(super) struct Columns<'a> {
    /// Numbers, types and parents of the samples.
    pub(super) integers: [&'a [i64]; 3],
    /// x, y, z and radius (µm).
    pub(super) numbers: [&'a [f64]; 4],
}

impl Columns<'_> {
    /// Reads the table as the SWC file that it would be: the same rules, and its rows are the lines of
    /// warnings and errors.
    pub(super) fn read(&self, name: &str, options: &ReadOptions) -> Result<Read, ReadError> {
        let [ids, types, parents] = self.integers;
        let [x, y, z, radii] = self.numbers;
        let mut text = String::with_capacity(64 * ids.len());
        for row in 0..ids.len() {
            let (id, kind, parent) = (ids[row], types[row], parents[row]);
            // Writing to a string cannot fail.
            let _: Result<(), std::fmt::Error> = writeln!(
                text,
                "{id} {kind} {} {} {} {} {parent}",
                x[row], y[row], z[row], radii[row]
            );
        }
        swc::read_bytes(text.as_bytes(), name, options)
    }
}

/// A table of samples.
#[derive(Default)]
pub(super) struct Rows {
    pub(super) ids: Vec<i64>,
    pub(super) types: Vec<i64>,
    pub(super) positions: Vec<[f64; 3]>,
    pub(super) radii: Vec<f64>,
    pub(super) parents: Vec<i64>,
}

/// The samples of a cell: those of its somata, then the points. They keep their numbers, and are numbered
/// from 1 on where these repeat.
pub(super) fn rows(cell: &Morphology) -> Rows {
    let mut rows = Rows::default();
    let at = |p: glam::Vec3| (cell.origin + p.as_dvec3()).to_array();
    // Parents by their rows; numbers when all are known.
    let mut first_of_soma = Vec::with_capacity(cell.somata.len());
    let mut parents: Vec<Option<usize>> = Vec::new();
    for soma in &cell.somata {
        let first = rows.ids.len();
        first_of_soma.push(first);
        for sample in &soma.samples {
            rows.ids.push(sample.id);
            rows.types.push(1);
            rows.positions.push(at(sample.position));
            rows.radii.push(f64::from(sample.radius));
            parents.push(sample.parent.map(|parent| first + parent as usize));
        }
    }
    let first_point = rows.ids.len();
    rows.ids.extend(&cell.sample_ids);
    for section in &cell.sections {
        for index in section.range() {
            let point = cell.points[index];
            rows.types.push(i64::from(section.kind.0));
            rows.positions.push(at(point.position));
            rows.radii.push(f64::from(point.radius));
            parents.push(match section.attachment {
                _ if index > section.first as usize => Some(first_point + index - 1),
                Attachment::Section(parent) => {
                    Some(first_point + cell.sections[parent.index()].end as usize - 1)
                }
                Attachment::Soma { soma, sample } => {
                    Some(first_of_soma[soma as usize] + sample as usize)
                }
                Attachment::Free => None,
            });
        }
    }
    if !are_numbers(&rows.ids, parents.len()) {
        rows.ids = (1..).take(parents.len()).collect();
    }
    let number = |row: &Option<usize>| row.map_or(-1, |row| rows.ids[row]);
    rows.parents = parents.iter().map(number).collect();
    rows
}

/// Whether each of these samples has a number that no other has.
fn are_numbers(ids: &[i64], samples: usize) -> bool {
    let mut sorted = ids.to_vec();
    sorted.sort_unstable();
    sorted.len() == samples
        && sorted.windows(2).all(|pair| pair[0] < pair[1])
        && sorted.first().is_none_or(|&least| least >= 0)
}
