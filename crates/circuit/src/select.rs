//! Which nodes are meant: by id, by node set, within a box, a sample of them.

use std::collections::HashMap;

use glam::DVec3;

use crate::{Circuit, CircuitError, Fault, NodeRef};

/// A choice of nodes. All parts that are given must hold; the sample is drawn last.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Selection {
    /// Only of the population of this name.
    pub population: Option<String>,
    /// Only nodes with these ids: ranges, both ends included. Each must be of a single population among those that have
    /// morphologies.
    pub ids: Option<Vec<(u64, u64)>>,
    /// Only these nodes, in any order.
    pub nodes: Option<Vec<NodeRef>>,
    /// Only nodes of the node set of this name.
    pub node_set: Option<String>,
    /// Only nodes with their place in this box (µm; both corners included).
    pub region: Option<(DVec3, DVec3)>,
    /// Only so many, drawn with the seed.
    pub sample: Option<(usize, u64)>,
}

impl Circuit {
    /// The nodes that are meant, in the circuit's order. Equal selections give equal nodes on every
    /// machine; smaller samples are parts of larger ones with the same seed.
    ///
    /// # Errors
    /// A population or node set that is not there; an id of several populations.
    pub fn select(&self, selection: &Selection) -> Result<Vec<NodeRef>, CircuitError> {
        if let Some(name) = &selection.population
            && !self.populations.iter().any(|p| p.name == *name)
        {
            let names: Vec<&str> = self.populations.iter().map(|p| p.name.as_str()).collect();
            let (name, there) = (name.clone(), names.join(", "));
            return Err(CircuitError::of_file(
                &self.file,
                Fault::NoPopulation { name, there },
            ));
        }
        let mut nodes = match &selection.node_set {
            Some(name) => self.node_sets.nodes(&self.populations, &self.file, name)?,
            None => self.nodes().collect(),
        };
        let ids = selection.ids.as_ref().map(|ranges| {
            let mut ranges = ranges.clone();
            ranges.sort_unstable();
            ranges
        });
        let listed = selection.nodes.as_ref().map(|nodes| {
            let mut nodes = nodes.clone();
            nodes.sort_unstable();
            nodes
        });
        nodes.retain(|node| {
            let population = &self.populations[node.population as usize];
            let row = node.row as usize;
            let named = selection.population.as_ref();
            let id_holds = ids.as_ref().is_none_or(|ranges| {
                let id = population.ids[row];
                ranges.iter().any(|&(from, to)| (from..=to).contains(&id))
            });
            let is_listed = |nodes: &Vec<NodeRef>| nodes.binary_search(node).is_ok();
            id_holds
                && listed.as_ref().is_none_or(is_listed)
                && named.is_none_or(|name| population.name == *name)
                && selection.region.is_none_or(|(min, max)| {
                    let place = population.positions[row];
                    place.cmpge(min).all() && place.cmple(max).all()
                })
        });
        if ids.is_some() {
            self.check_ids(&nodes)?;
        }
        if let Some((count, seed)) = selection.sample {
            // Nodes without a morphology would waste the sample.
            nodes.retain(|node| {
                let population = &self.populations[node.population as usize];
                population.templates[node.row as usize].is_some()
            });
            sample(&mut nodes, count, seed);
        }
        Ok(nodes)
    }

    /// Whether each id is of a single population, of what has a morphology: virtual nodes beside real ones are none that
    /// somebody means.
    fn check_ids(&self, nodes: &[NodeRef]) -> Result<(), CircuitError> {
        let mut of_id: HashMap<u64, u32> = HashMap::new();
        for node in nodes {
            let population = &self.populations[node.population as usize];
            let row = node.row as usize;
            if population.templates[row].is_none() {
                continue;
            }
            let id = population.ids[row];
            let first = *of_id.entry(id).or_insert(node.population);
            if first != node.population {
                let names = [first, node.population].map(|p| &self.populations[p as usize].name);
                let fault = Fault::AmbiguousId {
                    id,
                    populations: names.map(String::clone),
                };
                return Err(CircuitError::of_file(&self.file, fault));
            }
        }
        Ok(())
    }

    /// All nodes.
    pub fn nodes(&self) -> impl Iterator<Item = NodeRef> {
        let populations = self.populations.iter().zip(0..);
        populations.flat_map(|(population, index)| {
            let rows = 0..population.len() as u32;
            rows.map(move |row| NodeRef {
                population: index,
                row,
            })
        })
    }
}

/// Keeps the `count` nodes of the smallest hashes, in their order.
fn sample(nodes: &mut Vec<NodeRef>, count: usize, seed: u64) {
    if count >= nodes.len() {
        return;
    }
    let hash = |node: &NodeRef| {
        let id = u64::from(node.population) << 32 | u64::from(node.row);
        mix(mix(id ^ 0x9e37_79b9_7f4a_7c15) ^ mix(seed))
    };
    let mut hashed: Vec<(u64, NodeRef)> = nodes.iter().map(|node| (hash(node), *node)).collect();
    hashed.sort_unstable();
    hashed.truncate(count);
    *nodes = hashed.into_iter().map(|(_, node)| node).collect();
    nodes.sort_unstable();
}

/// Finalizer of SplitMix64 (G. Steele, D. Lea, C. Flood, 2014).
fn mix(mut z: u64) -> u64 {
    z = z.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
