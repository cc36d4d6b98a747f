//! Synapses and gap junctions of Snudda's networks: tables of whole numbers.
//!
//! ```text
//! /network/synapses        n × 13: source, destination, voxel x, y, z, hypervoxel, model of the channel,
//!                          distances (µm) from both somata, segment of the destination and place along it
//!                          (thousandths), conductance (pS), parameters
//! /network/gap_junctions   n × 11: source, destination, segments of both, places along them (thousandths),
//!                          voxel x, y, z, hypervoxel, conductance (pS)
//! /meta/voxel_size, simulation_origo    meters: what voxels are, and where the first one is
//! ```
//!
//! Before version 2 names were written `gapJunctions`, `voxelSize`, `simulationOrigo`: both are read. A place is
//! that of Snudda's own `load.py`: voxel · size + origin. It is the voxel in which axon and dendrite meet, so there
//! is one for both sides.

use std::path::Path;

use glam::DVec3;

use super::{Edges, NEURONS, Synapses};
use crate::hdf5::Store;
use crate::{CircuitError, Fault};

/// Rows that are read at once.
const BLOCK: u64 = 100_000;
/// Micrometers of a meter.
const UM: f64 = 1e6;

/// A table of connections: what its columns are.
struct Table {
    name: &'static str,
    /// Its dataset, today and before version 2.
    paths: [&'static str; 2],
    /// Columns that it must have.
    width: u64,
    /// The first of the three columns of its voxel.
    voxel: usize,
    /// Name, column and factor of its numbers.
    numbers: &'static [(&'static str, usize, f64)],
}

const TABLES: [Table; 2] = [
    Table {
        name: "synapses",
        paths: ["network/synapses"; 2],
        width: 13,
        voxel: 2,
        numbers: &[
            ("channel_model_id", 6, 1.0),
            ("conductance", 11, 1.0),
            ("dest_dend_soma_dist", 8, 1.0),
            ("dest_seg_id", 9, 1.0),
            ("dest_seg_x", 10, 1e-3),
            ("hyper_voxel_id", 5, 1.0),
            ("parameter_id", 12, 1.0),
            ("source_axon_soma_dist", 7, 1.0),
        ],
    },
    Table {
        name: "gap_junctions",
        paths: ["network/gap_junctions", "network/gapJunctions"],
        width: 11,
        voxel: 6,
        numbers: &[
            ("conductance", 10, 1.0),
            ("dest_seg_id", 3, 1.0),
            ("dest_seg_x", 5, 1e-3),
            ("hyper_voxel_id", 9, 1.0),
            ("source_seg_id", 2, 1.0),
            ("source_seg_x", 4, 1e-3),
        ],
    },
];

/// The connections of a network, those tables that have any.
pub(crate) fn of_network(file: &Path, store: &Store) -> Result<Vec<Edges>, CircuitError> {
    let mut all = Vec::new();
    for table in &TABLES {
        let Some(path) = table.path(store) else {
            continue;
        };
        match store.shape(&path)?[..] {
            [0, ..] => {}
            [count, width] if width >= table.width => all.push(Edges {
                name: table.name.into(),
                file: file.to_path_buf(),
                source: NEURONS.into(),
                target: NEURONS.into(),
                count,
            }),
            ref other => {
                let (found, expected) = (other.to_vec(), table.shape("n"));
                return Err(store.fault(&path, Fault::Shape { found, expected }));
            }
        }
    }
    Ok(all)
}

/// Both ends and the place of each.
pub(super) fn synapses(edges: &Edges, store: &Store) -> Result<Synapses, CircuitError> {
    let table = table(edges, store)?;
    let voxel = only(store, ["meta/voxel_size", "meta/voxelSize"], 1)?[0];
    let origin = only(store, ["meta/simulation_origo", "meta/simulationOrigo"], 3)?;
    let origin = DVec3::new(origin[0], origin[1], origin[2]);
    let mut synapses = Synapses::default();
    table.rows(edges, store, |row, cells| {
        let id = |column: usize| {
            u64::try_from(cells[column]).map_err(|_| Fault::Range {
                row,
                value: cells[column],
                limit: edges.count,
            })
        };
        synapses.sources.push(id(0)?);
        synapses.targets.push(id(1)?);
        let at = [0, 1, 2].map(|axis| cells[table.voxel + axis] as f64);
        let place = (DVec3::from_array(at) * voxel + origin) * UM;
        synapses.positions.push(place);
        Ok(())
    })?;
    Ok(synapses)
}

/// Names of the numbers that each has.
pub(super) fn properties(edges: &Edges, store: &Store) -> Result<Vec<String>, CircuitError> {
    let numbers = table(edges, store)?.numbers.iter();
    Ok(numbers.map(|(name, ..)| (*name).to_owned()).collect())
}

/// One number of each.
pub(super) fn property(edges: &Edges, store: &Store, name: &str) -> Result<Vec<f64>, CircuitError> {
    let table = table(edges, store)?;
    let number = table.numbers.iter().find(|(known, ..)| *known == name);
    let Some(&(_, column, factor)) = number else {
        return Err(store.fault(&format!("network/{}/{name}", edges.name), Fault::Missing));
    };
    let mut values = Vec::new();
    table.rows(edges, store, |_, cells| {
        values.push(cells[column] as f64 * factor);
        Ok(())
    })?;
    Ok(values)
}

fn table(edges: &Edges, store: &Store) -> Result<&'static Table, CircuitError> {
    let table = TABLES.iter().find(|table| table.name == edges.name);
    table.ok_or_else(|| store.fault(&format!("network/{}", edges.name), Fault::Missing))
}

impl Table {
    fn path(&self, store: &Store) -> Option<String> {
        store.first_of(&self.paths.map(String::from))
    }

    fn shape(&self, rows: impl std::fmt::Display) -> String {
        format!("[{rows}, {}]", self.width)
    }

    /// Visits each row with its number.
    fn rows(
        &self,
        edges: &Edges,
        store: &Store,
        mut visit: impl FnMut(u64, &[i64]) -> Result<(), Fault>,
    ) -> Result<(), CircuitError> {
        let path = self.path(store).unwrap_or_else(|| self.paths[0].into());
        store.believe(&path)?;
        let width = match store.shape(&path)?[..] {
            [rows, width] if rows == edges.count && width >= self.width => width as usize,
            ref other => {
                let (found, expected) = (other.to_vec(), self.shape(edges.count));
                return Err(store.fault(&path, Fault::Shape { found, expected }));
            }
        };
        for from in (0..edges.count).step_by(BLOCK as usize) {
            let block = store.wholes_of(&path, (from, BLOCK.min(edges.count - from)), width)?;
            for (row, cells) in (from..).zip(block.chunks_exact(width)) {
                visit(row, cells).map_err(|fault| store.fault(&path, fault))?;
            }
        }
        Ok(())
    }
}

/// The numbers of a small dataset that has one of two names.
fn only(store: &Store, names: [&str; 2], count: u64) -> Result<Vec<f64>, CircuitError> {
    let path = store.first_of(&names.map(String::from));
    let path = path.unwrap_or_else(|| names[0].into());
    if !store.has(&path) {
        return Err(store.fault(&path, Fault::Missing));
    }
    let shape = store.shape(&path)?;
    if shape.iter().product::<u64>() != count {
        let (found, expected) = (shape, format!("{count} in all"));
        return Err(store.fault(&path, Fault::Shape { found, expected }));
    }
    let values = store.reals_of(&path, 0, count)?;
    match values.iter().position(|v| !v.is_finite()) {
        None => Ok(values),
        Some(row) => {
            let expected = "a finite number";
            let text = values[row].to_string();
            Err(store.fault(&path, Fault::NotANumber { expected, text }))
        }
    }
}
