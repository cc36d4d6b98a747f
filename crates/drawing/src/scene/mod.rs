//! The scene: files in their own coordinates, cells of a circuit at their placements.

use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};

use itertools::Itertools;
use neurotess_cache::{Cache, Summary};
use neurotess_circuit::{Circuit, CircuitError, Compartment, Instance, soma_center};
use neurotess_color::cuts;
use neurotess_morphology::Morphology;
use neurotess_picture::Placement;
use rayon::prelude::*;

pub(crate) mod bounds;
pub(crate) mod cells;
mod circuit_instances;
pub(crate) mod markers;
pub(crate) mod meshes;

use crate::error::{DrawError, together};
use crate::host::Host;
use crate::meshed::{MeshedCell, Unread};
use crate::options::DrawOptions;
pub use circuit_instances::CircuitInstances;

/// What is drawn.
pub struct Scene {
    /// Distinct cells, and inputs that failed.
    pub entries: Vec<Result<MeshedCell, Unread>>,
    /// For each instance the index of its cell among those that did not fail, and its placement.
    pub placements: Vec<(usize, Placement)>,
    /// The circuit of the placements.
    pub instances: Option<CircuitInstances>,
    /// What the circuit's cache was good for.
    pub cache: Option<Summary>,
}

/// Reads and meshes files, each in its own coordinates.
///
/// # Errors
/// Options of circuits, or too little memory.
pub fn read_files(
    files: &[PathBuf],
    asked: &DrawOptions,
    host: &dyn Host,
) -> Result<Scene, DrawError> {
    check_of_cells(asked)?;
    let entries = cells::read(files, &HashMap::new(), asked, None, host)?;
    Ok(Scene::of_cells(entries))
}

/// Meshes cells that are in memory, with their names, each in its own coordinates.
///
/// # Errors
/// Options of circuits, or a cell that cannot be meshed.
pub fn of_memory(
    cells: &[(&str, &Morphology)],
    asked: &DrawOptions,
    host: &dyn Host,
) -> Result<Scene, DrawError> {
    check_of_cells(asked)?;
    let options = asked.picture.shape.generate();
    let stopped = host.stopped();
    let meshed = cells.par_iter().map(|&(name, morphology)| {
        let cell = cells::meshed(name.to_owned(), morphology.clone(), &options, stopped);
        cell.map(Ok).map_err(DrawError::Failed)
    });
    Ok(Scene::of_cells(meshed.collect::<Result<_, _>>()?))
}

impl Scene {
    /// Cells where they were traced.
    fn of_cells(entries: Vec<Result<MeshedCell, Unread>>) -> Self {
        let done = entries.iter().filter(|entry| entry.is_ok()).count();
        let placements = (0..done).map(|cell| (cell, Placement::default()));
        Self {
            placements: placements.collect(),
            entries,
            instances: None,
            cache: None,
        }
    }
}

/// Refuses options of circuits, of which there is none.
///
/// # Errors
/// What only circuits have.
fn check_of_cells(asked: &DrawOptions) -> Result<(), DrawError> {
    let picture = &asked.picture;
    if picture.cells.any() {
        return together("no input is a circuit: leave out what chooses cells of one");
    }
    if picture.colors.color_by_attribute.is_some() {
        return together("--color-by-attribute needs a circuit, whose cells have attributes");
    }
    if picture.colors.report.is_some() {
        return together("--report needs a circuit, whose cells have its values");
    }
    Ok(())
}

/// Opens a circuit, and reads and meshes the tracings of its selected cells. A circuit that cannot be opened is an entry
/// that failed.
///
/// # Errors
/// A report that is invalid, or too little memory.
pub fn read_circuit(path: &Path, asked: &DrawOptions, host: &dyn Host) -> Result<Scene, DrawError> {
    let opened = open(path, host).and_then(|circuit| {
        let nodes = asked.picture.cells.select(&circuit)?;
        Ok((circuit, nodes))
    });
    let (circuit, nodes) = match opened {
        Ok(opened) => opened,
        Err(error) => {
            let error = error.to_string();
            host.failure(&error);
            let file = path.display().to_string();
            return Ok(Scene::of_cells(vec![Err(Unread { file, error })]));
        }
    };
    let instances = circuit.instances(&nodes, None);
    if instances.len() < nodes.len() {
        host.warning(&format!(
            "{}: {} of {} chosen cells have no morphology or place: left out",
            circuit.file,
            nodes.len() - instances.len(),
            nodes.len()
        ));
    }
    if instances.is_empty() {
        host.failure(&format!(
            "{}: no cell to draw: choose others",
            path.display()
        ));
    }
    // Each morphology once, whatever the number of cells that show it.
    let mut of_template: BTreeMap<usize, usize> = BTreeMap::new();
    for instance in &instances {
        of_template.insert(instance.template.index(), 0);
    }
    let file = |&template: &usize| circuit.templates[template].path.clone();
    let files: Vec<PathBuf> = of_template.keys().map(file).collect();
    let cuts = match &asked.picture.colors.report {
        Some(report) => {
            let cell = |i: &Instance| (i.template.index(), i.node);
            let nodes: Vec<_> = instances.iter().map(cell).collect();
            cuts(report, &circuit, &nodes).map_err(DrawError::failed)?
        }
        None => HashMap::new(),
    };
    let of_path = |(template, cut): (usize, Vec<Compartment>)| {
        (circuit.templates[template].path.clone(), cut)
    };
    let cuts = cuts.into_iter().map(of_path).collect();
    let cache = (!asked.no_cache).then(|| Cache::open(Path::new(&circuit.file)));
    let entries = cells::read(&files, &cuts, asked, cache.as_ref(), host)?;
    let cache = cache.map(Cache::finish);
    for warning in cache.iter().flat_map(|summary| &summary.warnings) {
        host.warning(&warning.to_string());
    }
    // Indices of cells among those that did not fail; none for those that did.
    let mut centers = Vec::new();
    for (entry, index) in entries.iter().zip_eq(of_template.values_mut()) {
        *index = centers.len();
        match entry {
            Ok(cell) => centers.push(soma_center(&cell.morphology)),
            Err(_) => *index = usize::MAX,
        }
    }
    let mut placed = Vec::new();
    let placements = instances.iter().filter_map(|instance| {
        let cell = of_template[&instance.template.index()];
        let center = centers.get(cell)?;
        let placement = Placement {
            rotation: instance.rotation,
            scale: instance.scale,
            translation: instance.world_from_cell(*center).translation,
        };
        placed.push(*instance);
        Some((cell, placement))
    });
    Ok(Scene {
        placements: placements.collect(),
        entries,
        instances: Some(CircuitInstances {
            circuit,
            instances: placed,
        }),
        cache,
    })
}

/// Opens a circuit; tells of parts that could not be opened, and of warnings.
fn open(path: &Path, host: &dyn Host) -> Result<Circuit, CircuitError> {
    let circuit = Circuit::open(path)?;
    for failure in &circuit.failures {
        host.failure(&failure.to_string());
    }
    for warning in &circuit.warnings {
        host.warning(&warning.to_string());
    }
    Ok(circuit)
}
