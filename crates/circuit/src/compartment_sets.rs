//! Named places on neurons, as SONATA's `compartment_sets_file` has them.
//!
//! ```json
//! {"tuft": {"population": "cortex", "compartment_set": [[0, 4, 0.25], [0, 4, 0.75], [7, 2, 0.5]]}}
//! ```
//!
//! A place is a node's id, a section as NEURON numbers it, and an offset from 0 at the section's start to 1 at its end.
//! Places ascend, and none is there twice, as libsonata 0.2.2 asks for. Unlike it, what a set names and is not there is told
//! here.

use std::collections::{BTreeMap, HashSet};
use std::path::Path;

use crate::json::{Document, Json};
use crate::{CircuitError, Fault, Population, Warning};

/// Places on the neurons of a population.
#[derive(Clone, Debug, PartialEq)]
pub struct CompartmentSet {
    /// Name of the population.
    pub population: String,
    /// The places, ascending.
    pub places: Vec<SetPlace>,
}

/// A place of a set.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct SetPlace {
    /// Id of the node.
    pub node: u64,
    /// Number of the section.
    pub section: u64,
    /// From 0 at the section's start to 1 at its end.
    pub offset: f64,
}

impl CompartmentSet {
    /// Ids of its nodes, each once.
    pub fn nodes(&self) -> Vec<u64> {
        let mut ids: Vec<u64> = self.places.iter().map(|place| place.node).collect();
        ids.dedup();
        ids
    }

    /// The places of a node.
    pub fn of_node(&self, node: u64) -> &[SetPlace] {
        let begin = self.places.partition_point(|place| place.node < node);
        let end = self.places.partition_point(|place| place.node <= node);
        &self.places[begin..end]
    }
}

/// Reads the sets of a file.
pub(crate) fn read(path: &Path) -> Result<BTreeMap<String, CompartmentSet>, CircuitError> {
    let document = Document::open(path)?;
    let entries = document.root().entries()?.into_iter();
    let set = |(name, set): (&str, Json<'_>)| Ok((name.to_owned(), one(&set)?));
    entries.map(set).collect()
}

fn one(set: &Json<'_>) -> Result<CompartmentSet, CircuitError> {
    let population = set.need("population")?.text()?.to_owned();
    let mut places: Vec<SetPlace> = Vec::new();
    for item in set.need("compartment_set")?.items()? {
        let [node, section, offset] = &item.items()?[..] else {
            return Err(item.fault(Fault::Type {
                found: item.value.to_string(),
                expected: "a list of node, section and offset",
            }));
        };
        let place = SetPlace {
            node: node.natural()?,
            section: section.natural()?,
            offset: offset.real()?,
        };
        if !(0.0..=1.0).contains(&place.offset) {
            return Err(offset.fault(Fault::Type {
                found: place.offset.to_string(),
                expected: "an offset from 0 to 1",
            }));
        }
        if places.last().is_some_and(|last| *last >= place) {
            return Err(item.fault(Fault::Type {
                found: item.value.to_string(),
                expected: "a place beyond the one before it: places ascend, and none is there twice",
            }));
        }
        places.push(place);
    }
    Ok(CompartmentSet { population, places })
}

/// What sets name and is not there.
pub(crate) fn missing(
    sets: &BTreeMap<String, CompartmentSet>,
    file: &str,
    populations: &[Population],
) -> Vec<Warning> {
    let of_set = |(name, set): (&String, &CompartmentSet)| {
        let known = populations
            .iter()
            .find(|population| population.name == set.population);
        let Some(population) = known else {
            let message = format!("the circuit has no population {}", set.population);
            let key = format!("{name}.population");
            return Some(Warning::new(
                file,
                key,
                "compartment_set_population",
                message,
            ));
        };
        let ids: HashSet<u64> = population.ids.iter().copied().collect();
        let nodes = set.nodes();
        let lost: Vec<u64> = nodes.into_iter().filter(|id| !ids.contains(id)).collect();
        let message = format!(
            "{} of its nodes are not in {}, the first is {}",
            lost.len(),
            population.name,
            lost.first()?
        );
        let key = format!("{name}.compartment_set");
        let warning = Warning::new(file, key, "compartment_set_nodes", message);
        Some(warning.times(lost.len() as u64))
    };
    sets.iter().filter_map(of_set).collect()
}
