//! Values of a simulation on the membrane: those of a report at a time, or spikes that fade.
//!
//! Words are places among an instance's values, so that cells of one morphology share it and each has
//! its own values. The first cell that has any says where elements are; another cell of the same
//! morphology that was cut otherwise takes the nearest element of the same section.

use std::collections::HashMap;
use std::path::Path;

use neurotess::circuit::{
    Circuit, Compartment, Instance, NodeRef, Place, Recording, Report, SectionOrder, Spikes,
};
use neurotess::mesh::Role;
use neurotess::morphology::shape;
use neurotess::render::{InstanceValues, category};

use super::args::RenderArgs;
use super::cells::Cell;
use super::colouring::{Colouring, Paint, depths};
use crate::report::Reporter;

/// After this time (ms) a flash has a third of its light.
const DECAY: f64 = 5.0;

/// What a circuit shows, cell by cell as they stand.
pub(crate) struct Shown {
    pub(crate) circuit: Circuit,
    /// As many as places.
    pub(crate) instances: Vec<Instance>,
}

/// Values of the cells that stand somewhere.
struct Values {
    /// By cell and tracing point.
    words: Vec<Vec<u32>>,
    /// By place; none: it has no values.
    of_place: Vec<Option<Vec<f32>>>,
    unit: String,
    /// Of the scale, if the values' own range is not what it shows.
    range: Option<[f32; 2]>,
}

/// Colours by the values in the file that `--report` names.
pub(crate) fn colouring(
    (cells, shown): (&[&Cell], &Shown),
    places: &[usize],
    path: &Path,
    (args, paint): (&RenderArgs, &Paint),
    reporter: &Reporter,
) -> anyhow::Result<Colouring> {
    let found = match Recording::open(path).map_err(told)? {
        Recording::Report(report) => of_report(&report, cells, shown, places, args.time)?,
        Recording::Spikes(spikes) => of_spikes(&spikes, cells, shown, args.time)?,
    };
    let without = found.of_place.iter().filter(|v| v.is_none()).count();
    if without > 0 {
        let (all, file) = (places.len(), path.display());
        reporter.warning(&format!(
            "{file}: no values for {without} of {all} cells: drawn grey"
        ));
    }
    let [low, high] = args
        .range
        .or(found.range)
        .unwrap_or_else(|| range(&found.of_place));
    let mut values = InstanceValues::default();
    for own in &found.of_place {
        let share = |value: &f32| (value - low) / (high - low);
        let own: Vec<f32> = own.iter().flatten().map(share).collect();
        values.push(&own);
    }
    let title = path.file_stem().unwrap_or_default().to_string_lossy();
    let mut colouring = paint.scaled(
        found.words,
        &title.replace('_', " "),
        &found.unit,
        [low, high],
    );
    colouring.table.values = values;
    Ok(colouring)
}

/// The whole message is the error's own: its source would be told twice.
fn told(error: impl std::fmt::Display) -> anyhow::Error {
    anyhow::anyhow!("{error}")
}

/// Least and greatest of all values, apart.
fn range(of_place: &[Option<Vec<f32>>]) -> [f32; 2] {
    let all = of_place
        .iter()
        .flatten()
        .flatten()
        .filter(|v| v.is_finite());
    let (low, high) = all.fold((f32::MAX, f32::MIN), |(low, high), &v| {
        (low.min(v), high.max(v))
    });
    match (low <= high, low < high) {
        (false, _) => [0.0, 1.0],
        (true, false) => [low, low + 1.0],
        (true, true) => [low, high],
    }
}

fn of_report(
    report: &Report,
    cells: &[&Cell],
    shown: &Shown,
    places: &[usize],
    time: Option<f64>,
) -> anyhow::Result<Values> {
    let mut words: Vec<Option<(Vec<u32>, Vec<Compartment>)>> = vec![None; cells.len()];
    let mut of_place = vec![None; places.len()];
    let mut unit = String::new();
    for population in &report.populations {
        let nodes = population.nodes_in(&shown.circuit).map_err(told)?;
        let index: HashMap<NodeRef, usize> = nodes.into_iter().zip(0..).collect();
        let axis = &population.time;
        let time = time.unwrap_or(axis.start);
        let Some(frame) = axis.frame_at(time) else {
            let (file, end) = (report.path.display(), axis.time_of(axis.frames));
            anyhow::bail!(
                "{file}: has no values at {time} ms: choose a --time from {} to below {end}",
                axis.start
            );
        };
        unit.clone_from(&population.units);
        // All elements of all places, so that they are read together.
        let mut wanted = Vec::new();
        let mut spans = Vec::new();
        for (place, instance) in shown.instances.iter().enumerate() {
            let Some(&row) = index.get(&instance.node) else {
                continue;
            };
            let first = population.elements_of(row).start;
            let own = population.compartments(row).map_err(told)?;
            let cell = places[place];
            let (_, cut) =
                words[cell].get_or_insert_with(|| (on_cell(cells[cell], &own), own.clone()));
            let start = wanted.len();
            wanted.extend(matched(cut, &own).into_iter().map(|k| first + k as u64));
            spans.push((place, start..wanted.len()));
        }
        let values = population.values(frame, &wanted).map_err(told)?;
        for (place, span) in spans {
            of_place[place] = Some(values[span].to_vec());
        }
    }
    let words = cells.iter().zip(words);
    Ok(Values {
        words: words
            .map(|(cell, words)| words.map_or_else(|| none(cell), |(words, _)| words))
            .collect(),
        of_place,
        unit,
        range: None,
    })
}

/// For each element of a cell that is cut in one way the nearest one of a cell cut in another.
fn matched(cut: &[Compartment], own: &[Compartment]) -> Vec<usize> {
    if cut == own {
        return (0..own.len()).collect();
    }
    let nearest = |element: &Compartment| {
        let far = |other: &Compartment| {
            let sections = other.section.abs_diff(element.section) as f32;
            2.0 * sections + (other.along - element.along).abs()
        };
        let all = own.iter().enumerate();
        all.min_by(|a, b| far(a.1).total_cmp(&far(b.1)))
            .map_or(0, |(k, _)| k)
    };
    cut.iter().map(nearest).collect()
}

/// The nearest element of every tracing point, in the point's own section.
fn on_cell(cell: &Cell, elements: &[Compartment]) -> Vec<u32> {
    let morphology = &cell.morphology;
    let order = SectionOrder::of(morphology);
    let mut soma = None;
    let mut of_section: Vec<Vec<(f32, u32)>> = vec![Vec::new(); morphology.sections.len()];
    for (element, number) in elements.iter().zip(0..) {
        match order.place(*element) {
            Some(Place::Soma) => soma = soma.or(Some(number)),
            Some(Place::Section(section, along)) => {
                of_section[section.index()].push((along, number));
            }
            None => {}
        }
    }
    let (ends, lengths) = (
        shape::path_lengths(morphology),
        shape::section_lengths(morphology),
    );
    let nearest = |section: usize, way: f32| {
        let length = lengths[section].max(1e-9);
        let along = ((f64::from(way) - (ends[section] - length)) / length) as f32;
        let far = |element: &&(f32, u32)| (element.0 - along).abs();
        let all = of_section[section].iter();
        all.min_by(|a, b| far(a).total_cmp(&far(b)))
            .map(|&(_, number)| number)
    };
    let points = cell.mesh.tracing.iter().zip(depths(cell));
    points
        .map(|(point, way)| {
            let section = usize::try_from(point.section - 1).ok();
            let section = section.filter(|&section| section < of_section.len());
            let element = match (point.role, section, way) {
                (Role::Soma, ..) => soma,
                (_, Some(section), Some(way)) => nearest(section, way),
                _ => None,
            };
            element.unwrap_or(category(0))
        })
        .collect()
}

fn none(cell: &Cell) -> Vec<u32> {
    vec![category(0); cell.mesh.tracing.len()]
}

/// One value for a whole cell: 1 when it fires, fading.
fn of_spikes(
    spikes: &Spikes,
    cells: &[&Cell],
    shown: &Shown,
    time: Option<f64>,
) -> anyhow::Result<Values> {
    let Some(time) = time else {
        anyhow::bail!(
            "{}: spikes flash at a time: choose one with --time",
            spikes.file
        );
    };
    let mut flashes: HashMap<NodeRef, f32> = HashMap::new();
    let mut known = Vec::new();
    for population in &spikes.populations {
        let fired: HashMap<u64, f32> = population.flashes(time, DECAY).into_iter().collect();
        let nodes = population
            .nodes_in(&shown.circuit, &spikes.file)
            .map_err(told)?;
        for (node, id) in nodes.into_iter().zip(&population.nodes) {
            known.push(node.population);
            if let Some(&flash) = fired.get(id) {
                flashes.insert(node, flash);
            }
        }
    }
    known.sort_unstable();
    known.dedup();
    let of_place = shown.instances.iter().map(|instance| {
        let silent = known.contains(&instance.node.population).then_some(0.0);
        flashes
            .get(&instance.node)
            .copied()
            .or(silent)
            .map(|flash| vec![flash])
    });
    Ok(Values {
        words: cells
            .iter()
            .map(|cell| vec![0; cell.mesh.tracing.len()])
            .collect(),
        of_place: of_place.collect(),
        unit: String::new(),
        range: Some([0.0, 1.0]),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_cut_otherwise_take_the_nearest_element_of_the_section() {
        let at = |section, along| Compartment { section, along };
        let cut = [at(0, 0.5), at(1, 0.25), at(1, 0.75), at(2, 0.5)];
        assert_eq!(matched(&cut, &cut), [0, 1, 2, 3]);
        let coarse = [at(0, 0.5), at(1, 0.5), at(2, 0.2), at(2, 0.6)];
        assert_eq!(matched(&cut, &coarse), [0, 1, 1, 3]);
    }

    #[test]
    fn points_take_the_nearest_element_of_their_section() {
        // A soma, an axon of 40 µm second in the file and first in the report, a dendrite of 100 µm.
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
        let read =
            neurotess::formats::swc::read_bytes(text.as_bytes(), "cell", &Default::default());
        let cell = Cell::of(read.expect("a cell").morphology);
        let at = |section, along| Compartment { section, along };
        let elements = [at(0, 0.5), at(1, 0.5), at(2, 0.25), at(2, 0.75)];
        let words = on_cell(&cell, &elements);
        let mut seen = [0; 4];
        for (point, word) in cell.mesh.tracing.iter().zip(words) {
            let expected = match (point.role, point.kind) {
                (Role::Soma, _) => 0,
                (_, 2) => 1,
                (_, _) if point.center.y < 55.0 => 2,
                _ => 3,
            };
            seen[expected as usize] += 1;
            // The middle between both elements belongs to either.
            assert!(
                word == expected || (point.center.y - 60.0).abs() < 6.0,
                "{point:?}: {word}"
            );
        }
        assert!(seen.iter().all(|&n| n > 1), "{seen:?}");
    }

    #[test]
    fn ranges_are_never_empty() {
        assert_eq!(range(&[]), [0.0, 1.0]);
        assert_eq!(range(&[None, Some(vec![2.0, f32::NAN])]), [2.0, 3.0]);
        assert_eq!(range(&[Some(vec![-65.0, 20.0]), None]), [-65.0, 20.0]);
    }
}
