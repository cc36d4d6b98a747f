//! Networks of Snudda: `network-synapses.hdf5`, or `network-neuron-positions.hdf5` before synapses are placed.
//!
//! Hjorth et al., Predicting synaptic connectivity for large-scale microcircuit simulations using Snudda,
//! 2021; the layout is that of its `place.py`, `prune.py` and `load.py`:
//!
//! ```text
//! /network/neurons/neuron_id             n
//!                 /name                  n, like dSPN_0: the part before the first _ is the type
//!                 /position              n × 3, meters
//!                 /rotation              n × 9, row by row, from the morphology's axes to the network's
//!                 /morphology            n, like $SNUDDA_DATA/neurons/…/cell.swc
//!                 /volume_id, population_unit_id, parameter_key, …
//! /network/synapses, gap_junctions       see `edges/snudda.rs`
//! /meta/snudda_data                      the folder that $SNUDDA_DATA stands for
//! ```
//!
//! Before version 2 names were written `neuronID`, `volumeID`, `snuddaData`: both are read. The root of each
//! morphology is its origin (Snudda refuses others), so nothing is moved before a cell is turned.

mod morphologies;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use glam::{DQuat, DVec3};

use crate::edges;
use crate::hdf5::{Column, Store};
use crate::template::{Template, TemplateId};
use crate::{Attribute, Circuit, CircuitError, Fault, NodeSets, Population, Warning, transform};
use morphologies::Finder;

/// Micrometers of a meter.
const UM: f64 = 1e6;
const NEURONS: &str = "network/neurons";
/// Names of a network in its folder, the one that knows more first.
const FILES: [&str; 2] = ["network-synapses.hdf5", "network-neuron-positions.hdf5"];
/// Attributes of neurons by their names today and before version 2.
const ATTRIBUTES: [[&str; 2]; 13] = [
    ["name", "name"],
    ["morphology", "morphology"],
    ["neuron_path", "neuronPath"],
    ["hoc", "hoc"],
    ["volume_id", "volumeID"],
    ["population_unit_id", "populationUnitID"],
    ["virtual_neuron", "virtualNeuron"],
    ["parameter_key", "parameterKey"],
    ["morphology_key", "morphologyKey"],
    ["modulation_key", "modulationKey"],
    ["parameter_id", "parameterID"],
    ["morphology_id", "morphologyID"],
    ["modulation_id", "modulationID"],
];

/// Whether a file is a network: by its name, so that a broken one is told of, or by its content.
pub(crate) fn is_network(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    is_hdf5(path)
        && (FILES.contains(&&*name)
            || Store::open(path).is_ok_and(|store| store.has_group(NEURONS)))
}

/// Whether a file has an extension of HDF5.
pub(crate) fn is_hdf5(path: &Path) -> bool {
    let extension = path.extension().unwrap_or_default();
    ["h5", "hdf5"]
        .iter()
        .any(|known| extension.eq_ignore_ascii_case(known))
}

/// The network of a folder.
pub(crate) fn find(folder: &Path) -> Option<PathBuf> {
    let mut paths = FILES.iter().map(|name| folder.join(name));
    paths.find(|path| path.is_file())
}

/// Opens a network.
pub(crate) fn open(path: &Path) -> Result<Circuit, CircuitError> {
    let store = Store::open_whole(path)?;
    if !store.has_group(NEURONS) {
        return Err(store.fault(NEURONS, Fault::NotANetwork));
    }
    let mut failures = Vec::new();
    let mut warnings = Vec::new();
    let mut population = placed(&store, &mut failures)?;
    population.attributes = attributes(&store, population.len(), &mut warnings);
    let templates = morphologies(path, &store, &mut population, &mut warnings);
    warn_of_axons(&store, &mut warnings);
    let edges = edges::of_network(path, &store).unwrap_or_else(|e| {
        failures.push(e);
        vec![]
    });
    Ok(Circuit {
        file: path.display().to_string(),
        format: "snudda",
        populations: vec![population],
        templates,
        node_sets: NodeSets::default(),
        edges,
        reports: BTreeMap::new(),
        compartment_sets: BTreeMap::new(),
        declared_reports: Vec::new(),
        warnings,
        failures,
    })
}

/// The dataset of neurons that is there by one of two names; the first if neither is.
fn named(store: &Store, names: [&str; 2]) -> String {
    let paths = names.map(|name| format!("{NEURONS}/{name}"));
    let there = store.first_of(&paths);
    let [first, _] = paths;
    there.unwrap_or(first)
}

/// Ids, places and rotations. Neurons without a finite place or a rotation are left out of pictures.
fn placed(store: &Store, failures: &mut Vec<CircuitError>) -> Result<Population, CircuitError> {
    let id_path = named(store, ["neuron_id", "neuronID"]);
    let [places, turns] = ["position", "rotation"].map(|name| format!("{NEURONS}/{name}"));
    let needed = [&id_path, &places, &turns];
    if let Some(path) = needed.into_iter().find(|path| store.dataset(path).is_err()) {
        return Err(store.fault(path, Fault::Missing));
    }
    let ids = store.naturals(&id_path)?;
    let n = ids.len() as u64;
    let meters = store.matrix(&places, n, 3)?;
    let matrices = store.matrix(&turns, n, 9)?;
    let mut positions: Vec<DVec3> = meters
        .chunks_exact(3)
        .map(|p| DVec3::new(p[0], p[1], p[2]) * UM)
        .collect();
    let rotations: Vec<Option<DQuat>> = matrices.chunks_exact(9).map(rotation).collect();
    let faulty = |is: &dyn Fn(usize) -> bool| {
        let mut rows = (0..ids.len()).filter(|&row| is(row));
        let first = rows.next();
        first.map(|first| (first, 1 + rows.count() as u64))
    };
    if let Some((row, count)) = faulty(&|row| !positions[row].is_finite()) {
        let mut axes = positions[row].to_array().into_iter();
        let value = axes.find(|v| !v.is_finite()).unwrap_or(f64::NAN);
        let row = row as u64;
        failures.push(store.fault(&places, Fault::NotFinite { row, value, count }));
    }
    if let Some((row, count)) = faulty(&|row| rotations[row].is_none()) {
        let row = row as u64;
        failures.push(store.fault(&turns, Fault::NotARotation { row, count }));
    }
    for (position, rotation) in positions.iter_mut().zip(&rotations) {
        if !position.is_finite() || rotation.is_none() {
            *position = DVec3::NAN;
        }
    }
    Ok(Population {
        name: edges::NEURONS.into(),
        templates: vec![None; ids.len()],
        recentered: vec![false; ids.len()],
        rotations: rotations
            .into_iter()
            .map(Option::unwrap_or_default)
            .collect(),
        positions,
        ids,
        ..Population::default()
    })
}

/// The rotation of nine numbers, row by row.
fn rotation(rows: &[f64]) -> Option<DQuat> {
    let mut all = [0.0; 16];
    for (row, numbers) in rows.chunks_exact(3).enumerate() {
        all[4 * row..4 * row + 3].copy_from_slice(numbers);
    }
    all[15] = 1.0;
    let (_, rotation, scale) = transform::rigid(all)?;
    ((scale - 1.0).abs() < transform::TOLERANCE).then_some(rotation)
}

/// What else the file says of its neurons. What cannot be read does not keep them from showing.
fn attributes(store: &Store, n: usize, warnings: &mut Vec<Warning>) -> BTreeMap<String, Attribute> {
    let mut all = BTreeMap::new();
    for names in ATTRIBUTES {
        let path = named(store, names);
        if !store.has(&path) {
            continue;
        }
        match store.column(&path, "") {
            Ok(column) if rows(&column) == n => drop(all.insert(names[0].into(), values(column))),
            Ok(column) => {
                let (found, expected) = (vec![rows(&column) as u64], format!("[{n}]"));
                warnings.push(left_out(store, path, &Fault::Shape { found, expected }));
            }
            Err(e) => warnings.push(left_out(store, path, &e.fault)),
        }
    }
    if let Some(Attribute::Text { library, indices }) = all.get("name") {
        let kind = |name: &String| name.split('_').next().unwrap_or_default().to_owned();
        let kinds: Vec<String> = library.iter().map(kind).collect();
        all.insert("type".into(), distinct(&kinds, indices));
    }
    all
}

fn left_out(store: &Store, path: String, fault: &Fault) -> Warning {
    Warning::new(store.name(), path, "attribute_left_out", fault.to_string())
}

fn rows(column: &Column) -> usize {
    match column {
        Column::Numbers(values) => values.len(),
        Column::Text { indices, .. } => indices.len(),
    }
}

fn values(column: Column) -> Attribute {
    match column {
        Column::Numbers(values) => Attribute::Numbers(values),
        Column::Text { library, indices } => distinct(&library, &indices),
    }
}

/// A column of texts that may be equal; an empty one is none.
fn distinct(texts: &[String], indices: &[u32]) -> Attribute {
    let mut library: Vec<String> = Vec::new();
    let mut places: BTreeMap<&str, u32> = BTreeMap::new();
    let renamed: Vec<u32> = texts
        .iter()
        .map(|text| match text.as_str() {
            "" => Attribute::NONE,
            text => *places.entry(text).or_insert_with(|| {
                library.push(text.into());
                library.len() as u32 - 1
            }),
        })
        .collect();
    let of = |&index: &u32| renamed.get(index as usize).copied();
    let indices = indices.iter().map(|i| of(i).unwrap_or(Attribute::NONE));
    Attribute::Text {
        indices: indices.collect(),
        library,
    }
}

/// Gives each neuron with a place its template.
fn morphologies(
    path: &Path,
    store: &Store,
    population: &mut Population,
    warnings: &mut Vec<Warning>,
) -> Vec<Template> {
    let Some(Attribute::Text { library, indices }) = population.attributes.get("morphology") else {
        let message = "no neuron names a morphology: none is shown";
        let key = format!("{NEURONS}/morphology");
        warnings.push(Warning::new(
            store.name(),
            key,
            "morphology_missing",
            message,
        ));
        return vec![];
    };
    let finder = Finder::new(path, store);
    let found: Vec<Option<PathBuf>> = library.iter().map(|name| finder.find(name)).collect();
    let mut templates = Vec::new();
    let mut ids: BTreeMap<&Path, TemplateId> = BTreeMap::new();
    let of_names: Vec<Option<TemplateId>> = found
        .iter()
        .map(|path| {
            let path = path.as_deref()?;
            Some(*ids.entry(path).or_insert_with(|| {
                templates.push(Template::new(path.to_path_buf()));
                TemplateId(templates.len() as u32 - 1)
            }))
        })
        .collect();
    let of = |index: u32| of_names.get(index as usize).copied().flatten();
    let mut missing = 0;
    for (row, &index) in indices.iter().enumerate() {
        missing += u64::from(index != Attribute::NONE && of(index).is_none());
        if population.positions[row].is_finite() {
            population.templates[row] = of(index);
        }
    }
    if let Some(first) = found.iter().position(Option::is_none) {
        let count = found.iter().filter(|path| path.is_none()).count();
        let message = format!(
            "{count} morphologies of {missing} neurons are not there, the first is {}: {}",
            library[first],
            finder.remedy(),
        );
        let key = format!("{NEURONS}/morphology");
        let warning = Warning::new(store.name(), key, "morphology_missing", message);
        warnings.push(warning.times(missing));
    }
    templates
}

/// Axons that a neuron has beside its morphology are told of, since they do not show.
fn warn_of_axons(store: &Store, warnings: &mut Vec<Warning>) {
    let groups = ["extra_axons", "extraAxons"].map(|name| format!("{NEURONS}/{name}/morphology"));
    let count = store
        .first_of(&groups)
        .and_then(|path| store.rows(&path).ok());
    if let Some(count) = count.filter(|&count| count > 0) {
        let message =
            format!("{count} axons that neurons have in files of their own are not shown");
        let key = format!("{NEURONS}/extra_axons");
        let warning = Warning::new(store.name(), key, "extra_axons", message);
        warnings.push(warning.times(count));
    }
}
