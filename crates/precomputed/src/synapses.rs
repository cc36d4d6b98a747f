//! Synapses of a circuit as annotations, related to the cells before and behind them.

use std::collections::{BTreeSet, HashMap};

use glam::DVec3;
use neurotess_circuit::{Circuit, Edges, Instance};

use crate::annotations::{PointValues, Points, write_points};
use crate::error::ExportError;
use crate::folder::Folder;
use crate::properties::number_name;
use crate::skeleton::NM;

/// Folder of the annotations.
pub(crate) const FOLDER: &str = "synapses";

/// Writes the synapses of some populations of connections that have an end among the cells; returns how many. All of a
/// population are in memory at once.
///
/// # Errors
/// A population has no places of synapses, or cannot be read; a file cannot be written.
pub(crate) fn write(
    folder: &Folder,
    circuit: &Circuit,
    instances: &[Instance],
    ids: &[u64],
    edges: &[Edges],
) -> Result<usize, ExportError> {
    let of_node = |(instance, &id): (&Instance, &u64)| {
        let population = circuit.populations[instance.node.population as usize]
            .name
            .as_str();
        ((population, instance.id), id)
    };
    let segments: HashMap<(&str, u64), u64> = instances.iter().zip(ids).map(of_node).collect();
    let names = common_numbers(edges)?;
    let mut numbers: Vec<Vec<f32>> = vec![Vec::new(); names.len()];
    let mut places: Vec<DVec3> = Vec::new();
    let (mut pre, mut post, mut which) = (Vec::new(), Vec::new(), Vec::new());
    for (number, edges) in edges.iter().enumerate() {
        let synapses = edges.synapses()?;
        if synapses.positions.is_empty() && !synapses.targets.is_empty() {
            return Err(ExportError::NoPlaces(edges.name.clone()));
        }
        let segment = |population: &str, node: u64| {
            let found = segments.get(&(population, node));
            found.copied().unwrap_or(0)
        };
        let ends = synapses.sources.iter().zip(&synapses.targets);
        let mut shown = Vec::new();
        for (row, ((&source, &target), &place)) in ends.zip(&synapses.positions).enumerate() {
            let before = segment(&edges.source, source);
            let behind = segment(&edges.target, target);
            if (before > 0 || behind > 0) && place.is_finite() {
                shown.push(row);
                places.push(place * NM);
                pre.push(before);
                post.push(behind);
                which.push(u8::try_from(number).unwrap_or(u8::MAX));
            }
        }
        for (name, column) in names.iter().zip(&mut numbers) {
            let all = edges.property(name)?;
            column.extend(shown.iter().map(|&row| all[row] as f32));
        }
    }
    let count = places.len();
    if count > 0 {
        let texts = edges.iter().map(|edges| edges.name.clone()).collect();
        let own = ("edges".to_owned(), PointValues::Enum(which, texts));
        let named = names.iter().map(|name| plain(name)).zip(numbers);
        let numbers = named.map(|(name, column)| (name, PointValues::F32(column)));
        let points = Points {
            places,
            values: std::iter::once(own).chain(numbers).collect(),
            segments: vec![("pre".into(), pre), ("post".into(), post)],
        };
        write_points(folder, FOLDER, points)?;
    }
    Ok(count)
}

/// Numbers that all of the populations have of their synapses.
fn common_numbers(edges: &[Edges]) -> Result<BTreeSet<String>, ExportError> {
    let mut common: Option<BTreeSet<String>> = None;
    for edges in edges {
        let names: BTreeSet<String> = edges.properties()?.into_iter().collect();
        common = Some(match common {
            None => names,
            Some(common) => common.intersection(&names).cloned().collect(),
        });
    }
    Ok(common.unwrap_or_default())
}

/// A name as annotations have it: lower-case letters, digits and `_`, a letter first.
fn plain(name: &str) -> String {
    number_name(name).to_ascii_lowercase()
}
