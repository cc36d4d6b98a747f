//! Numbers of sections and samples as NEURON, MorphIO and meshes have them.

use neurotess::morphology::{Morphology, Program, SectionId, SectionNumbers, SectionPlace, shape};
use numpy::PyArray1;
use pyo3::prelude::*;

use crate::arrays;

/// An array of one dimension.
pub(super) type Column<T> = Py<PyArray1<T>>;

/// Numbers in meshes of the points, and of the samples of each soma.
pub(super) fn sample_labels(
    py: Python<'_>,
    cell: &Morphology,
) -> PyResult<(Column<i64>, Vec<Column<i64>>)> {
    let labels = cell.sample_labels();
    let points = (0..cell.points.len()).map(|point| i64::from(labels.of_point(point)));
    let of_soma = |soma: usize| {
        let samples = 0..cell.somata[soma].samples.len();
        let all = samples.map(|sample| i64::from(labels.of_soma(soma, sample)));
        arrays::column(py, all.collect())
    };
    let somata: PyResult<_> = (0..cell.somata.len()).map(of_soma).collect();
    Ok((arrays::column(py, points.collect())?, somata?))
}

/// Of places along sections that NEURON numbers: the sections as meshes count them, 0 for the soma and −1 for none that
/// the cell has, and the places along these.
pub(super) fn neuron_places(
    py: Python<'_>,
    cell: &Morphology,
    numbers: &[i64],
    along: &[f32],
) -> PyResult<(Column<i64>, Column<f32>)> {
    let of_cell = SectionNumbers::of(cell, Program::Neuron);
    let place = |(&number, &along): (&i64, &f32)| {
        let number = u64::try_from(number).ok();
        match number.and_then(|number| of_cell.place(number, along)) {
            None => (-1, along),
            Some(SectionPlace::Soma) => (0, along),
            Some(SectionPlace::Section(section, along)) => (1 + i64::from(section.0), along),
        }
    };
    let (sections, along) = numbers.iter().zip(along).map(place).unzip();
    Ok((arrays::column(py, sections)?, arrays::column(py, along)?))
}

/// The other way round: of places along sections as meshes count them, 0 for the soma, NEURON's numbers and the places along
/// what has them; −1 for what is no section of the cell.
pub(super) fn neuron_numbers(
    py: Python<'_>,
    cell: &Morphology,
    sections: &[i64],
    along: &[f64],
) -> PyResult<(Column<i64>, Column<f64>)> {
    let of_cell = SectionNumbers::of(cell, Program::Neuron);
    let lengths = shape::section_lengths(cell);
    let number = |(&section, &along): (&i64, &f64)| {
        let index = usize::try_from(section - 1).ok();
        match index.filter(|&index| index < lengths.len()) {
            None if section == 0 => (0, along),
            None => (-1, along),
            Some(index) => {
                let (number, share) = of_cell.at(SectionId(index as u32), along * lengths[index]);
                (number as i64, f64::from(share))
            }
        }
    };
    let (numbers, along) = sections.iter().zip(along).map(number).unzip();
    Ok((arrays::column(py, numbers)?, arrays::column(py, along)?))
}

/// The number that a program gives the file's section with which each section begins.
pub(super) fn section_numbers(cell: &Morphology, program: Program) -> Vec<i64> {
    let numbers = SectionNumbers::of(cell, program).of_sections();
    numbers.into_iter().map(|number| number as i64).collect()
}
