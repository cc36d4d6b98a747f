//! SONATA circuits.
//!
//! Dai et al., The SONATA data format for efficient description of large-scale network models, 2020,
//! and its developer guide; what the Allen Institute's and Blue Brain's tools make of it where the two
//! differ, see `docs/circuits.md`.

mod blanks;
mod config;
mod finder;
mod nodes;
mod notes;
pub(crate) mod orientation;
mod places;
mod population;
mod types;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

pub(crate) use config::{find, folder_of};

use crate::compartment_sets;
use crate::edges;
use crate::hdf5::Store;
use crate::template::{Template, TemplateId};
use crate::{Circuit, CircuitError, Fault, NodeSets, Population, Warning};
use config::{Config, NodeSource};

/// Opens the circuit of a configuration, or of a simulation's.
pub(crate) fn open(path: &Path) -> Result<Circuit, CircuitError> {
    let config = Config::open(path)?;
    let mut reading = Reading::default();
    let mut populations: Vec<Population> = Vec::new();
    let mut seen: BTreeSet<PathBuf> = BTreeSet::new();
    for source in &config.nodes {
        // Brion's example names one file twice.
        let identity = source.file.canonicalize();
        if !seen.insert(identity.unwrap_or_else(|_| source.file.clone())) {
            continue;
        }
        match reading.nodes(source, &config.file) {
            Ok(read) => populations.extend(read),
            Err(e) => reading.failures.push(e),
        }
    }
    let Reading {
        templates,
        mut warnings,
        mut failures,
        ..
    } = reading;
    failures.extend(config.failures);
    if populations.is_empty() {
        let nothing = || CircuitError::of_file(&config.file, Fault::NothingRead);
        return Err(if failures.is_empty() {
            nothing()
        } else {
            failures.swap_remove(0)
        });
    }
    // Cells show without what is not there of these; whether it is missed, the caller knows.
    let mut is_there = |path: &Path, file: &str, key: &str, code| {
        let there = path.is_file();
        if !there {
            let message = format!("{} does not exist: left out", path.display());
            warnings.push(Warning::new(file, key, code, message));
        }
        there
    };
    let mut edges = Vec::new();
    for source in &config.edges {
        if is_there(&source.file, &config.file, &source.key, "edges_missing") {
            match edges::open(&source.file, source.populations.as_deref()) {
                Ok(found) => edges.extend(found),
                Err(e) => failures.push(e),
            }
        }
    }
    let mut node_sets = NodeSets::default();
    for (file, key, path) in &config.node_sets {
        if is_there(path, file, key, "node_sets_missing") {
            failures.extend(node_sets.add_file(path).err());
        }
    }
    let mut compartment_sets = BTreeMap::new();
    let mut told = Vec::new();
    for (file, key, path) in &config.compartment_sets {
        if is_there(path, file, key, "compartment_sets_missing") {
            match compartment_sets::read(path) {
                Ok(sets) => {
                    let named = path.display().to_string();
                    told.extend(compartment_sets::missing(&sets, &named, &populations));
                    node_sets.add_compartment_sets(&sets, &named);
                    compartment_sets.extend(sets);
                }
                Err(e) => failures.push(e),
            }
        }
    }
    for report in &config.declared_reports {
        told.extend(report.unknown_set(&compartment_sets));
    }
    let mut reports = config.reports;
    reports.retain(|_, (file, key, path)| is_there(path, file, key, "report_missing"));
    warnings.extend(told);
    let reports = reports.into_iter().map(|(name, (_, _, path))| (name, path));
    Ok(Circuit {
        file: config.file,
        format: "sonata",
        populations,
        templates,
        node_sets,
        edges,
        reports: reports.collect(),
        compartment_sets,
        declared_reports: config.declared_reports,
        warnings,
        failures,
    })
}

/// What grows while files of nodes are read.
#[derive(Default)]
struct Reading {
    templates: Vec<Template>,
    ids: BTreeMap<PathBuf, TemplateId>,
    warnings: Vec<Warning>,
    failures: Vec<CircuitError>,
}

impl Reading {
    /// The populations of a file. One that fails is noted, and the others are read.
    fn nodes(
        &mut self,
        source: &NodeSource,
        config: &str,
    ) -> Result<Vec<Population>, CircuitError> {
        if !source.file.is_file() {
            let path = source.file.display().to_string();
            let fault = Fault::NoFile { path };
            return Err(CircuitError::new(config, source.key.clone(), fault));
        }
        let store = Store::open_whole(&source.file)?;
        let there = store.groups("nodes");
        if there.is_empty() {
            return Err(store.fault("nodes", Fault::Missing));
        }
        let wanted: Vec<String> = match &source.populations {
            Some(listed) => listed.keys().cloned().collect(),
            None => there.clone(),
        };
        let mut populations = Vec::new();
        for name in wanted {
            let read = if there.contains(&name) {
                self.population(&name, &store, source)
            } else {
                let there = there.join(", ");
                Err(store.fault("nodes", Fault::NoPopulation { name, there }))
            };
            match read {
                Ok(population) => populations.push(population),
                Err(e) => self.failures.push(e),
            }
        }
        Ok(populations)
    }

    fn population(
        &mut self,
        name: &str,
        store: &Store,
        source: &NodeSource,
    ) -> Result<Population, CircuitError> {
        let types = match &source.types {
            Some(file) => types::Types::open(file, name, &mut self.warnings)?,
            None => types::Types::default(),
        };
        let table = nodes::Table::open(store, name, &types, &mut self.warnings)?;
        let (templates, ids) = (&mut self.templates, &mut self.ids);
        let mut template = |path: PathBuf| {
            *ids.entry(path).or_insert_with_key(|path| {
                templates.push(Template::new(path.clone()));
                TemplateId(templates.len() as u32 - 1)
            })
        };
        let mut notes = notes::Notes {
            warnings: &mut self.warnings,
            failures: &mut self.failures,
            template: &mut template,
        };
        population::read(name, store.name(), &table, source, &mut notes)
    }
}
