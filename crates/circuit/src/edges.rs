//! Connections: how many there are, and where their synapses sit where the file says so.
//!
//! Blue Brain's files have `afferent_center_{x,y,z}` (on the target's axis) and
//! `afferent_surface_{x,y,z}` (on its membrane); the Allen Institute's may have `pos_{x,y,z}`.

use std::path::{Path, PathBuf};

use glam::DVec3;

use crate::hdf5::Store;
use crate::{CircuitError, Fault};

/// A population of connections.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Edges {
    /// Its name.
    pub name: String,
    /// Its file.
    pub file: PathBuf,
    /// Population that connections come from; empty if the file does not say.
    pub source: String,
    /// Population that they go to.
    pub target: String,
    /// How many there are.
    pub count: u64,
}

/// Synapses of a population of connections.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Synapses {
    /// Ids of the nodes that they come from.
    pub sources: Vec<u64>,
    /// Ids of the nodes that they go to.
    pub targets: Vec<u64>,
    /// Where they are (µm, in the circuit's coordinates); empty if the file does not say.
    pub positions: Vec<DVec3>,
}

/// Columns of places, the best first: on the membrane, on the axis.
const PLACES: [[&str; 3]; 4] = [
    [
        "afferent_surface_x",
        "afferent_surface_y",
        "afferent_surface_z",
    ],
    [
        "afferent_center_x",
        "afferent_center_y",
        "afferent_center_z",
    ],
    ["pos_x", "pos_y", "pos_z"],
    [
        "efferent_surface_x",
        "efferent_surface_y",
        "efferent_surface_z",
    ],
];

/// Counts the connections of a file.
pub(crate) fn open(file: &Path, listed: Option<&[String]>) -> Result<Vec<Edges>, CircuitError> {
    let store = Store::open(file)?;
    let there = store.groups("edges");
    if there.is_empty() {
        return Err(store.fault("edges", Fault::Missing));
    }
    let wanted: Vec<String> = listed.map_or_else(|| there.clone(), <[String]>::to_vec);
    let edges = wanted.into_iter().map(|name| {
        if !there.contains(&name) {
            let there = there.join(", ");
            return Err(store.fault("edges", Fault::NoPopulation { name, there }));
        }
        let path = |end: &str| format!("edges/{name}/{end}_node_id");
        let population = |end| store.text_attribute(&path(end), "node_population");
        Ok(Edges {
            file: file.to_path_buf(),
            source: population("source").unwrap_or_default(),
            target: population("target").unwrap_or_default(),
            count: edge_rows(&store, &path("target"))?,
            name,
        })
    });
    edges.collect()
}

/// Connections are more than nodes: their number is 64 bits wide.
fn edge_rows(store: &Store, path: &str) -> Result<u64, CircuitError> {
    match store.shape(path)?[..] {
        [rows] => Ok(rows),
        ref other => {
            let (found, expected) = (other.to_vec(), "one dimension".into());
            Err(store.fault(path, Fault::Shape { found, expected }))
        }
    }
}

impl Edges {
    /// Reads both ends and the place of each synapse. Needs 40 bytes for each.
    ///
    /// # Errors
    /// What is wrong with the file.
    pub fn synapses(&self) -> Result<Synapses, CircuitError> {
        let store = Store::open(&self.file)?;
        let path = format!("edges/{}", self.name);
        let sources = store.naturals(&format!("{path}/source_node_id"))?;
        let targets = store.naturals(&format!("{path}/target_node_id"))?;
        let group = format!("{path}/0");
        let full =
            |columns: &&[&str; 3]| columns.iter().all(|c| store.has(&format!("{group}/{c}")));
        let mut positions = Vec::new();
        if let Some(columns) = PLACES.iter().find(full) {
            let [x, y, z] = columns.map(|column| store.reals(&format!("{group}/{column}")));
            let axes = [x?, y?, z?];
            for (axis, name) in axes.iter().zip(columns) {
                if axis.len() != targets.len() {
                    let expected = format!("[{}], one row per edge", targets.len());
                    let found = vec![axis.len() as u64];
                    let key = format!("{group}/{name}");
                    return Err(store.fault(&key, Fault::Shape { found, expected }));
                }
            }
            let place = |row: usize| DVec3::new(axes[0][row], axes[1][row], axes[2][row]);
            positions = (0..targets.len()).map(place).collect();
        }
        if sources.len() != targets.len() {
            let (found, expected) = (
                vec![sources.len() as u64],
                format!("[{}], as many as targets", targets.len()),
            );
            let key = format!("{path}/source_node_id");
            return Err(store.fault(&key, Fault::Shape { found, expected }));
        }
        Ok(Synapses {
            sources,
            targets,
            positions,
        })
    }
}
