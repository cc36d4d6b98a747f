//! Which compartment of a report each tracing point of a cell shows.

use std::collections::HashMap;

use neurotess_circuit::Compartment;
use neurotess_mesh::Role;
use neurotess_morphology::{Program, SectionId, SectionNumbers, SectionPlace, shape};
use neurotess_picture::color::category;

use crate::path_distance::path_distances;
use crate::scheme::Cell;

/// For each compartment of `cut`, the nearest one of `own`, in which the same cell is cut
/// otherwise.
pub(super) fn matched(cut: &[Compartment], own: &[Compartment]) -> Vec<usize> {
    if cut == own {
        return (0..own.len()).collect();
    }
    let nearest = |compartment: &Compartment| {
        let far = |other: &Compartment| {
            let sections = other.section.abs_diff(compartment.section) as f32;
            2.0 * sections + (other.along - compartment.along).abs()
        };
        let all = own.iter().enumerate();
        all.min_by(|a, b| far(a.1).total_cmp(&far(b.1)))
            .map_or(0, |(k, _)| k)
    };
    cut.iter().map(nearest).collect()
}

/// The nearest compartment of every tracing point, in the section of the file that the point is from.
pub(super) fn on_cell(cell: &Cell<'_>, compartments: &[Compartment]) -> Vec<u32> {
    let morphology = cell.morphology;
    let numbers = SectionNumbers::of(morphology, Program::Neuron);
    let mut soma = None;
    let mut of_section: HashMap<u64, Vec<(f32, u32)>> = HashMap::new();
    for (compartment, number) in compartments.iter().zip(0..) {
        match compartment.place(&numbers) {
            Some(SectionPlace::Soma) => soma = soma.or(Some(number)),
            Some(SectionPlace::Section(..)) => {
                let all = of_section.entry(compartment.section).or_default();
                all.push((compartment.along, number));
            }
            None => {}
        }
    }
    let (ends, lengths) = (
        shape::path_lengths(morphology),
        shape::section_lengths(morphology),
    );
    let nearest = |section: SectionId, distance: f32| {
        let begins = ends[section.index()] - lengths[section.index()];
        let (number, along) = numbers.at(section, f64::from(distance) - begins);
        let far = |compartment: &&(f32, u32)| (compartment.0 - along).abs();
        let all = of_section.get(&number)?.iter();
        all.min_by(|a, b| far(a).total_cmp(&far(b)))
            .map(|&(_, number)| number)
    };
    let points = cell.mesh.tracing.iter().zip(path_distances(cell));
    points
        .map(|(point, distance)| {
            let section = point.section.index();
            let section = section.filter(|&section| section < lengths.len());
            let compartment = match (point.role, section, distance) {
                (Role::Soma, ..) => soma,
                (_, Some(section), Some(distance)) => nearest(SectionId(section as u32), distance),
                _ => None,
            };
            compartment.unwrap_or(category(0))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_cut_otherwise_take_the_nearest_compartment_of_the_section() {
        let at = |section, along| Compartment { section, along };
        let cut = [at(0, 0.5), at(1, 0.25), at(1, 0.75), at(2, 0.5)];
        assert_eq!(matched(&cut, &cut), [0, 1, 2, 3]);
        let coarse = [at(0, 0.5), at(1, 0.5), at(2, 0.2), at(2, 0.6)];
        assert_eq!(matched(&cut, &coarse), [0, 1, 1, 3]);
    }

    #[test]
    fn points_take_the_nearest_compartment_of_their_section() {
        // A soma, an axon of 40 µm second in the file and first in the report, a dendrite of 100
        // µm.
        let dendrite = (1..=10).map(|i| format!("{} 3 0 {} 0 1 {i}\n", i + 1, 5 + 10 * i));
        let axon = (1..=4).map(|i| {
            let parent = if i == 1 { 1 } else { 10 + i };
            format!("{} 2 0 {} 0 0.5 {parent}\n", 11 + i, -5 - 10 * i)
        });
        let text: String = ["1 1 0 0 0 5 -1\n".into()]
            .into_iter()
            .chain(dendrite)
            .chain(axon)
            .collect();
        let read = neurotess_formats::swc::read_bytes(text.as_bytes(), "cell", &Default::default());
        let morphology = read.expect("a cell").morphology;
        let mesh = neurotess_generate::generate(&morphology, &Default::default())
            .expect("meshed")
            .mesh;
        let cell = Cell {
            name: "",
            morphology: &morphology,
            mesh: &mesh,
            radius_factor: 1.0,
        };
        let at = |section, along| Compartment { section, along };
        let compartments = [at(0, 0.5), at(1, 0.5), at(2, 0.25), at(2, 0.75)];
        let color_keys = on_cell(&cell, &compartments);
        let mut seen = [0; 4];
        for (point, color_key) in cell.mesh.tracing.iter().zip(color_keys) {
            let expected = match (point.role, point.kind.0) {
                (Role::Soma, _) => 0,
                (_, 2) => 1,
                (_, _) if point.center.y < 55.0 => 2,
                _ => 3,
            };
            seen[expected as usize] += 1;
            // The middle between both compartments belongs to either.
            assert!(
                color_key == expected || (point.center.y - 60.0).abs() < 6.0,
                "{point:?}: {color_key}"
            );
        }
        assert!(seen.iter().all(|&n| n > 1), "{seen:?}");
    }
}
