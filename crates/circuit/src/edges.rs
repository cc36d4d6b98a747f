//! Connections: how many there are, and where their synapses sit where the file says so.
//!
//! Here are those of SONATA; `snudda.rs` has those of Snudda. Where a file has no coordinates, it may have the
//! section and the place along it.
//!
//! Blue Brain's files have `afferent_center_{x,y,z}` (on the target's axis) and
//! `afferent_surface_{x,y,z}` (on its membrane); the Allen Institute's may have `pos_{x,y,z}`.

mod snudda;

use std::path::{Path, PathBuf};

use glam::DVec3;

use crate::hdf5::Store;
use crate::{CircuitError, Compartment, Fault};

pub(crate) use snudda::of_network;

/// The one population of a network of Snudda.
pub(crate) const NEURONS: &str = "neurons";

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

/// The side of a synapse that is meant: where it sits on its target, or on its source.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SynapseSide {
    /// On the target, which it is an input of.
    #[default]
    Afferent,
    /// On the source, which it is an output of.
    Efferent,
}

/// Columns of places on targets, the best first: on the membrane, on the axis.
const AFFERENT: [[&str; 3]; 3] = [
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
];

/// Columns of places on sources.
const EFFERENT: [[&str; 3]; 2] = [
    [
        "efferent_surface_x",
        "efferent_surface_y",
        "efferent_surface_z",
    ],
    [
        "efferent_center_x",
        "efferent_center_y",
        "efferent_center_z",
    ],
];

/// Columns of sections, and of shares of their length: of Blue Brain's files and of the Allen Institute's.
const AFFERENT_SHARES: [[&str; 2]; 2] = [
    ["afferent_section_id", "afferent_section_pos"],
    ["sec_id", "sec_x"],
];
const EFFERENT_SHARES: [[&str; 2]; 1] = [["efferent_section_id", "efferent_section_pos"]];

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

/// Whether a file is SONATA's, not Snudda's.
fn is_sonata(store: &Store) -> bool {
    !store.has_group("network/neurons")
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
    /// Reads both ends and the place of each synapse: on its target, or else on its source. Needs 40 bytes
    /// for each.
    ///
    /// # Errors
    /// What is wrong with the file.
    pub fn synapses(&self) -> Result<Synapses, CircuitError> {
        self.read(&[&AFFERENT[..], &EFFERENT[..1]].concat())
    }

    /// The same with the places on one side. `positions` is empty if the file does not have them.
    ///
    /// # Errors
    /// What is wrong with the file.
    pub fn synapses_on(&self, side: SynapseSide) -> Result<Synapses, CircuitError> {
        self.read(match side {
            SynapseSide::Afferent => &AFFERENT,
            SynapseSide::Efferent => &EFFERENT,
        })
    }

    /// The section of each synapse on one side, and its place along it; empty if the file does not say.
    ///
    /// # Errors
    /// What is wrong with the file.
    pub fn shares_on(&self, side: SynapseSide) -> Result<Vec<Compartment>, CircuitError> {
        let store = Store::open(&self.file)?;
        let group = self.group();
        let columns: &[[&str; 2]] = match side {
            SynapseSide::Afferent => &AFFERENT_SHARES,
            SynapseSide::Efferent => &EFFERENT_SHARES,
        };
        let full =
            |columns: &&[&str; 2]| columns.iter().all(|c| store.has(&format!("{group}/{c}")));
        let Some([section, share]) = columns.iter().find(full) else {
            return Ok(Vec::new());
        };
        let [section, share] = [section, share].map(|column| format!("{group}/{column}"));
        let (sections, shares) = (store.naturals(&section)?, store.shares(&share)?);
        self.check_rows(&store, &section, sections.len())?;
        self.check_rows(&store, &share, shares.len())?;
        let compartment = |(&section, &share): (&u64, &f64)| Compartment {
            section,
            along: share as f32,
        };
        Ok(sections.iter().zip(&shares).map(compartment).collect())
    }

    /// Names of the numbers that the file has of each synapse, such as `delay` or `conductance`.
    ///
    /// # Errors
    /// What is wrong with the file.
    pub fn properties(&self) -> Result<Vec<String>, CircuitError> {
        let store = Store::open(&self.file)?;
        if is_sonata(&store) {
            Ok(self.columns(&store))
        } else {
            snudda::properties(self, &store)
        }
    }

    /// Datasets of the group, but for those that are places.
    fn columns(&self, store: &Store) -> Vec<String> {
        let mut names = store.datasets(&self.group());
        let is_place = |name: &String| {
            let columns = AFFERENT.iter().chain(&EFFERENT).flatten();
            columns.into_iter().any(|column| name == column)
        };
        names.retain(|name| !is_place(name));
        names.sort_unstable();
        names
    }

    /// One number of each synapse, in the order of [`Edges::synapses`].
    ///
    /// # Errors
    /// There is none of this name; what is wrong with the file.
    pub fn property(&self, name: &str) -> Result<Vec<f64>, CircuitError> {
        let store = Store::open(&self.file)?;
        if !is_sonata(&store) {
            return snudda::property(self, &store, name);
        }
        let key = format!("{}/{name}", self.group());
        let values = store.reals(&key)?;
        self.check_rows(&store, &key, values.len())?;
        Ok(values)
    }

    fn read(&self, places: &[[&str; 3]]) -> Result<Synapses, CircuitError> {
        let store = Store::open(&self.file)?;
        if !is_sonata(&store) {
            return snudda::synapses(self, &store);
        }
        let path = format!("edges/{}", self.name);
        let ends = ["source", "target"].map(|end| {
            let key = format!("{path}/{end}_node_id");
            let ids = store.naturals(&key)?;
            self.check_rows(&store, &key, ids.len())?;
            Ok(ids)
        });
        let [sources, targets] = ends;
        let group = self.group();
        let full =
            |columns: &&[&str; 3]| columns.iter().all(|c| store.has(&format!("{group}/{c}")));
        let mut positions = Vec::new();
        if let Some(columns) = places.iter().find(full) {
            let axes = columns.map(|column| {
                let key = format!("{group}/{column}");
                let axis = store.reals(&key)?;
                self.check_rows(&store, &key, axis.len())?;
                Ok(axis)
            });
            let [x, y, z] = axes;
            let (x, y, z) = (x?, y?, z?);
            let place = |((x, y), z): ((&f64, &f64), &f64)| DVec3::new(*x, *y, *z);
            positions = x.iter().zip(&y).zip(&z).map(place).collect();
        }
        Ok(Synapses {
            sources: sources?,
            targets: targets?,
            positions,
        })
    }

    fn group(&self) -> String {
        format!("edges/{}/0", self.name)
    }

    fn check_rows(&self, store: &Store, key: &str, rows: usize) -> Result<(), CircuitError> {
        if rows as u64 == self.count {
            return Ok(());
        }
        let expected = format!("[{}], one row per edge", self.count);
        let found = vec![rows as u64];
        Err(store.fault(key, Fault::Shape { found, expected }))
    }
}
