//! Spikes: `/spikes/<population>/{timestamps,node_ids}`, and the old `/spikes/{timestamps,gids}`.

use std::collections::HashMap;
use std::path::Path;

use super::nodes_in;
use crate::hdf5::Store;
use crate::{Circuit, CircuitError, Fault, NodeRef};

/// Spikes of all populations, whole in memory.
#[derive(Clone, Debug, PartialEq)]
pub struct Spikes {
    /// The file as it was named.
    pub file: String,
    /// What it has for each population.
    pub populations: Vec<SpikePopulation>,
}

/// Spikes of a population, sorted by time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SpikePopulation {
    /// Name of the population; empty in the old layout.
    pub name: String,
    /// Times (ms), ascending.
    pub times: Vec<f64>,
    /// Ids of the nodes that fire, as many.
    pub nodes: Vec<u64>,
}

impl Spikes {
    /// Opens a file of spikes.
    ///
    /// # Errors
    /// What is wrong with the file.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, CircuitError> {
        Self::read(&Store::open(path.as_ref())?)
    }

    pub(crate) fn read(store: &Store) -> Result<Self, CircuitError> {
        let mut roots: Vec<(String, String)> = store
            .groups("spikes")
            .into_iter()
            .map(|name| (format!("spikes/{name}"), name))
            .collect();
        if store.has("spikes/timestamps") {
            roots.push(("spikes".into(), String::new()));
        }
        if roots.is_empty() {
            return Err(store.fault("spikes", Fault::Missing));
        }
        let one = |(root, name): (String, String)| SpikePopulation::read(store, &root, name);
        let populations = roots.into_iter().map(one);
        Ok(Self {
            file: store.name().into(),
            populations: populations.collect::<Result<_, _>>()?,
        })
    }
}

impl SpikePopulation {
    fn read(store: &Store, root: &str, name: String) -> Result<Self, CircuitError> {
        let path = format!("{root}/timestamps");
        let times = store.reals(&path)?;
        let seconds = store
            .text_attribute(&path, "units")
            .is_some_and(|u| u == "s");
        let ids = ["node_ids", "gids"].map(|name| format!("{root}/{name}"));
        let missing = || store.fault(&ids[0], Fault::Missing);
        let ids = store.first_of(&ids).ok_or_else(missing)?;
        let nodes = store.naturals(&ids)?;
        if nodes.len() != times.len() {
            let expected = format!("[{}], one per time", times.len());
            let found = vec![nodes.len() as u64];
            return Err(store.fault(&ids, Fault::Shape { found, expected }));
        }
        let faulty = |(_, t): &(u64, &f64)| !t.is_finite();
        if let Some((row, &value)) = (0..).zip(&times).find(faulty) {
            let count = times.iter().filter(|t| !t.is_finite()).count() as u64;
            return Err(store.fault(&path, Fault::NotFinite { row, value, count }));
        }
        let factor = if seconds { 1000.0 } else { 1.0 };
        let times = times.into_iter().map(|t| t * factor);
        let mut spikes: Vec<(f64, u64)> = times.zip(nodes).collect();
        // What the file says of its order is not relied on.
        if !spikes.is_sorted_by(|a, b| a.0 <= b.0) {
            spikes.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        }
        let (times, nodes) = spikes.into_iter().unzip();
        Ok(Self { name, times, nodes })
    }

    /// How bright nodes flash at a time (ms): 1 when they fire, then e^(−age / decay), with `decay` in
    /// ms. Nodes that last fired more than seven decays ago (0.001) are left out; the order is that
    /// of the ids. Takes time for the spikes of those seven decays.
    pub fn flashes(&self, time: f64, decay: f64) -> Vec<(u64, f32)> {
        let end = self.times.partition_point(|&t| t <= time);
        let start = self.times.partition_point(|&t| t < time - 7.0 * decay);
        let mut last: HashMap<u64, f64> = HashMap::new();
        for i in start..end.max(start) {
            // Ascending: the last spike stays.
            last.insert(self.nodes[i], self.times[i]);
        }
        let flash = |(node, fired): (u64, f64)| (node, (-(time - fired) / decay).exp() as f32);
        let mut flashes: Vec<(u64, f32)> = last.into_iter().map(flash).collect();
        flashes.sort_by_key(|&(node, _)| node);
        flashes
    }

    /// The nodes of a circuit that fire, one per spike.
    ///
    /// # Errors
    /// [`Fault::OtherCircuit`] if the circuit does not have the population or some of the nodes.
    pub fn nodes_in(&self, circuit: &Circuit, file: &str) -> Result<Vec<NodeRef>, CircuitError> {
        nodes_in(circuit, &self.name, &self.nodes)
            .map_err(|fault| CircuitError::new(file, format!("spikes/{}", self.name), fault))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flashes_decay_from_the_last_spike() {
        let spikes = SpikePopulation {
            name: "p".into(),
            times: vec![1.0, 5.0, 6.0, 20.0],
            nodes: vec![4, 2, 4, 2],
        };
        assert_eq!(spikes.flashes(0.5, 2.0), []);
        assert_eq!(spikes.flashes(1.0, 2.0), [(4, 1.0)]);
        let flashes = spikes.flashes(8.0, 2.0);
        assert_eq!(
            flashes,
            [(2, (-1.5f64).exp() as f32), (4, (-1f64).exp() as f32)]
        );
        assert_eq!(spikes.flashes(20.0, 1.0), [(2, 1.0)]);
    }
}
