//! Reports of simulations: values of compartments of neurons over time.
//!
//! **Theory.** SONATA's layout, and the older one without populations:
//!
//! ```text
//! /report/<population>/data                       frames × compartments, attribute units
//!                     /mapping/node_ids           (gids)
//!                             /index_pointers     (index_pointer) n or n + 1: a node's first compartment
//!                             /element_ids        (element_id) number of the section, 0 the soma
//!                             /element_pos        optional: place along the section, 0 to 1
//!                             /time               start, end (excluded), step
//! /data, /mapping/…                               the same, one population
//! ```
//!
//! **Practice.** Opening reads node ids and pointers. Elements and values are read when they are asked
//! for, only where they are: a frame of some compartments costs the chunks that hold them.

mod axis;
mod chunks;
mod contradictions;
mod elements;
mod spikes;

use std::collections::HashMap;
use std::ops::Range;
use std::path::{Path, PathBuf};

pub use axis::TimeAxis;
use contradictions::contradictions;
pub use spikes::{SpikePopulation, Spikes};

use crate::compartment_sets::CompartmentSet;
use crate::hdf5::Store;
use crate::sections::{Compartment, compartments};
use crate::{Circuit, CircuitError, Fault, NodeRef, Warning};
use chunks::Table;

/// A file that a simulation wrote.
#[derive(Debug)]
pub enum RecordingFile {
    /// Values of compartments or somata.
    Report(Report),
    /// Spikes.
    Spikes(Spikes),
}

impl RecordingFile {
    /// Opens a report or a file of spikes, whichever it is.
    ///
    /// # Errors
    /// What is wrong with the file.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, CircuitError> {
        let path = path.as_ref();
        let store = Store::open(path)?;
        if store.has_group("report") || store.has("data") {
            return Report::read(path, &store).map(Self::Report);
        }
        if store.has_group("spikes") {
            return Spikes::read(&store).map(Self::Spikes);
        }
        Err(CircuitError::of_file(store.name(), Fault::NotAReport))
    }
}

impl RecordingFile {
    /// What is odd in it, though it can be read.
    pub fn warnings(&self) -> &[Warning] {
        match self {
            Self::Report(report) => &report.warnings,
            Self::Spikes(_) => &[],
        }
    }
}

/// Whether an HDF5 file is to be opened as a recording and not, say, as a morphology.
pub fn is_recording(path: &Path) -> bool {
    Store::open(path).is_ok_and(|store| {
        store.has_group("report") || store.has("data") || store.has_group("spikes")
    })
}

/// Values of compartments or somata, open for reading.
#[derive(Debug)]
pub struct Report {
    /// The file.
    pub path: PathBuf,
    /// What it has for each population.
    pub populations: Vec<ReportPopulation>,
    /// What contradicts itself, though it can be read.
    pub warnings: Vec<Warning>,
}

/// Whether a report has the whole neurons or their somata.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReportKind {
    /// One compartment per node.
    Soma,
    /// Some nodes have several.
    Compartment,
}

/// Values of the nodes of a population.
pub struct ReportPopulation {
    /// Name of the population; empty in the old layout.
    pub name: String,
    /// Times of the frames.
    pub time: TimeAxis,
    /// Unit of the values, like `mV`; empty if the file does not say.
    pub units: String,
    /// Ids of the nodes, in the file's order.
    pub nodes: Vec<u64>,
    /// First compartment of each node, and the end of the last.
    pointers: Vec<u64>,
    rows: HashMap<u64, u32>,
    mapping: Store,
    /// Data sets of the times and of the nodes' ids.
    times: String,
    ids: String,
    compartments: String,
    positions: Option<String>,
    /// The set of compartments that it is of, if the file gives no positions.
    set: Option<CompartmentSet>,
    table: Table,
}

impl std::fmt::Debug for ReportPopulation {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ReportPopulation")
            .field("name", &self.name)
            .field("time", &self.time)
            .field("nodes", &self.nodes.len())
            .field("compartments", &self.compartment_count())
            .finish_non_exhaustive()
    }
}

impl Report {
    /// Opens a report.
    ///
    /// # Errors
    /// What is wrong with the file.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, CircuitError> {
        let path = path.as_ref();
        Self::read(path, &Store::open(path)?)
    }

    fn read(path: &Path, store: &Store) -> Result<Self, CircuitError> {
        let names = store.groups("report");
        let populations = if store.has_group("report") {
            let one = |name: &String| {
                let root = format!("report/{name}/");
                ReportPopulation::open(path, Store::open(path)?, name, &root)
            };
            names.iter().map(one).collect::<Result<Vec<_>, _>>()?
        } else {
            vec![ReportPopulation::open(path, Store::open(path)?, "", "")?]
        };
        if populations.is_empty() {
            return Err(store.fault("report", Fault::Missing));
        }
        let warnings = populations.iter().flat_map(contradictions).collect();
        Ok(Self {
            path: path.to_path_buf(),
            populations,
            warnings,
        })
    }
}

impl ReportPopulation {
    fn open(path: &Path, store: Store, name: &str, root: &str) -> Result<Self, CircuitError> {
        let find = |names: &[&str]| {
            let paths: Vec<String> = names.iter().map(|n| format!("{root}mapping/{n}")).collect();
            let missing = || store.fault(&paths[0], Fault::Missing);
            store.first_of(&paths).ok_or_else(missing)
        };
        let data = format!("{root}data");
        let table = Table::open(&store, path, &data)?;
        let ids = find(&["node_ids", "gids"])?;
        let nodes = store.naturals(&ids)?;
        let pointers = pointers(
            &store,
            &find(&["index_pointers", "index_pointer"])?,
            nodes.len(),
            table.columns,
        )?;
        let compartments = find(&["element_ids", "element_id"])?;
        let positions = find(&["element_pos"]).ok();
        for mapped in [Some(&compartments), positions.as_ref()]
            .into_iter()
            .flatten()
        {
            let found = store.shape(mapped)?;
            if found != [table.columns] {
                let expected = format!("[{}], one per compartment", table.columns);
                return Err(store.fault(mapped, Fault::Shape { found, expected }));
            }
            // A row of the table has as many numbers.
            store.believe(mapped)?;
        }
        let times = find(&["time"])?;
        let time = time_axis(&store, &times, table.rows)?;
        let rows = nodes.iter().copied().zip(0..).collect();
        Ok(Self {
            name: name.into(),
            time,
            units: store.text_attribute(&data, "units").unwrap_or_default(),
            nodes,
            pointers,
            rows,
            times,
            ids,
            compartments,
            positions,
            set: None,
            table,
            mapping: store,
        })
    }

    /// How many compartments all nodes have.
    pub fn compartment_count(&self) -> u64 {
        self.table.columns
    }

    /// Whether it has one compartment per node.
    pub fn kind(&self) -> ReportKind {
        let one = |pair: &[u64]| pair[1] - pair[0] == 1;
        if self.pointers.windows(2).all(one) {
            ReportKind::Soma
        } else {
            ReportKind::Compartment
        }
    }

    /// Index of a node in [`Self::nodes`]; of one that is there several times the last.
    pub fn index_of(&self, node: u64) -> Option<usize> {
        self.rows.get(&node).map(|&row| row as usize)
    }

    /// Compartments of the node of this index.
    ///
    /// # Panics
    /// If the index is not below the number of nodes.
    pub fn compartment_range(&self, index: usize) -> Range<u64> {
        self.pointers[index]..self.pointers[index + 1]
    }

    /// Where on the neuron the compartments of a node are, in the order of [`Self::compartment_range`].
    ///
    /// # Errors
    /// What is wrong with the file.
    ///
    /// # Panics
    /// If the index is not below the number of nodes.
    pub fn compartments(&self, index: usize) -> Result<Vec<Compartment>, CircuitError> {
        let Range { start, end } = self.compartment_range(index);
        let sections = self
            .mapping
            .naturals_of(&self.compartments, start, end - start)?;
        let positions = match &self.positions {
            Some(path) => Some(self.mapping.reals_of(path, start, end - start)?),
            None => None,
        };
        let set = self.set.as_ref().filter(|_| positions.is_none());
        let of_node = set.map(|set| set.of_node(self.nodes[index]));
        // Where the set has others than the file, the file says more.
        let of_node = of_node.filter(|places| {
            places
                .iter()
                .map(|p| p.section)
                .eq(sections.iter().copied())
        });
        let offsets: Option<Vec<f64>> =
            of_node.map(|places| places.iter().map(|place| place.offset).collect());
        Ok(compartments(&sections, positions.or(offsets).as_deref()))
    }

    /// Values of compartments in a frame, in the order that they are asked for. Reads what holds them and
    /// nothing else.
    ///
    /// # Errors
    /// [`Fault::Beyond`] for a frame or a compartment that does not exist; what is wrong with the file.
    pub fn values(&self, frame: u64, compartments: &[u64]) -> Result<Vec<f32>, CircuitError> {
        self.table.pick(frame, compartments)
    }

    /// Values of compartments in these frames, frame by frame. Reads what holds them and nothing else; of frames that are
    /// stored together, all at once ([`Self::frames_together`]).
    ///
    /// # Errors
    /// As [`Self::values`].
    pub fn series(
        &self,
        frames: Range<u64>,
        compartments: &[u64],
    ) -> Result<Vec<f32>, CircuitError> {
        self.table.pick_rows(frames, compartments)
    }

    /// How many frames are stored together: many calls of [`Self::series`] read everything once if each begins at a multiple
    /// of it.
    pub fn frames_together(&self) -> u64 {
        self.table.rows_together()
    }

    /// The nodes of a circuit that the report is about, in the order of [`Self::nodes`].
    ///
    /// # Errors
    /// [`Fault::OtherCircuit`] if the circuit does not have the population or some of the nodes.
    pub fn nodes_in(&self, circuit: &Circuit) -> Result<Vec<NodeRef>, CircuitError> {
        nodes_in(circuit, &self.name, &self.nodes)
            .map_err(|fault| self.mapping.fault(&self.compartments, fault))
    }
}

/// The nodes of these ids; the population without a name is the first.
fn nodes_in(circuit: &Circuit, name: &str, ids: &[u64]) -> Result<Vec<NodeRef>, Fault> {
    let named = |(_, p): &(u32, &crate::Population)| name.is_empty() || p.name == name;
    let found = (0..).zip(&circuit.populations).find(named);
    let other = |missing: usize, first: u64| Fault::OtherCircuit {
        population: name.into(),
        circuit: circuit.file.clone(),
        missing: missing as u64,
        first,
    };
    let Some((index, population)) = found else {
        return Err(other(ids.len(), ids.first().copied().unwrap_or(0)));
    };
    let mut rows: HashMap<u64, u32> = HashMap::with_capacity(population.len());
    for (&id, row) in population.ids.iter().zip(0..) {
        rows.entry(id).or_insert(row);
    }
    let missing: Vec<u64> = ids
        .iter()
        .copied()
        .filter(|id| !rows.contains_key(id))
        .collect();
    if let Some(&first) = missing.first() {
        return Err(other(missing.len(), first));
    }
    let node = |id: &u64| NodeRef {
        population: index,
        row: rows[id],
    };
    Ok(ids.iter().map(node).collect())
}

/// Checks pointers and adds the end where the layout leaves it out.
fn pointers(
    store: &Store,
    path: &str,
    nodes: usize,
    compartments: u64,
) -> Result<Vec<u64>, CircuitError> {
    let mut pointers = store.naturals(path)?;
    if pointers.len() == nodes {
        pointers.push(compartments);
    }
    if pointers.len() != nodes + 1 {
        let found = vec![pointers.len() as u64];
        let expected = format!("[{nodes}] or [{}], for the nodes", nodes + 1);
        return Err(store.fault(path, Fault::Shape { found, expected }));
    }
    let mut from = 0;
    for (index, &value) in (0..).zip(&pointers) {
        if value < from || value > compartments {
            let to = compartments;
            return Err(store.fault(
                path,
                Fault::Pointer {
                    index,
                    value,
                    from,
                    to,
                },
            ));
        }
        from = value;
    }
    Ok(pointers)
}

fn time_axis(store: &Store, path: &str, frames: u64) -> Result<TimeAxis, CircuitError> {
    let time = store.reals(path)?;
    let time: [f64; 3] = time.try_into().map_err(|other: Vec<f64>| {
        let (found, expected) = (vec![other.len() as u64], "[3]: start, end, step".into());
        store.fault(path, Fault::Shape { found, expected })
    })?;
    let in_seconds = store
        .text_attribute(path, "units")
        .is_some_and(|u| u == "s");
    let time = time.map(|t| if in_seconds { 1000.0 * t } else { t });
    TimeAxis::new(time, frames).map_err(|fault| store.fault(path, fault))
}
