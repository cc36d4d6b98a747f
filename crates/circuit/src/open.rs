//! Which kind of circuit a file or a folder is.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use glam::DVec3;
use neurotess_formats::{is_json_tracing, regular};

use crate::{
    Circuit, CircuitError, Population, Warning, blue_config, nsol, placed, scene, snudda, sonata,
    table,
};

impl Circuit {
    /// Opens a circuit: a SONATA configuration (the circuit's or the simulation's), the folder that
    /// has one, a network of Snudda or its folder, nsol's XML scene, a scene of our own (`.scene.toml`,
    /// `.scene.json`), or a table of placed cells (`.csv`, `.tsv`). Morphologies are not read yet.
    ///
    /// # Errors
    /// What is wrong with the file, or with all populations. What is wrong with one of several is in
    /// [`Circuit::failures`].
    pub fn open(path: impl AsRef<Path>) -> Result<Self, CircuitError> {
        let mut circuit = Self::read(path.as_ref())?;
        let far = circuit
            .populations
            .iter()
            .filter_map(|p| far_away(&circuit.file, p));
        let far: Vec<Warning> = far.collect();
        circuit.warnings.extend(far);
        Ok(circuit)
    }

    fn read(path: &Path) -> Result<Self, CircuitError> {
        if path.is_dir() {
            return match (sonata::find(path), snudda::find(path)) {
                (Err(_), Some(network)) => snudda::open(&network),
                (config, _) => sonata::open(&config?),
            };
        }
        if snudda::is_hdf5(path) {
            return snudda::open(path);
        }
        if let Some(refusal) = blue_config::refusal(path) {
            return Err(refusal);
        }
        if scene::is_named_so(path) {
            return scene::open(path);
        }
        if table::is_named_so(path) {
            return placed::open(path);
        }
        if has_extension(path, "xml") {
            return nsol::open(path);
        }
        sonata::open(path)
    }
}

/// From this coordinate on (µm), 32 bits have steps of a micrometer, the thickness of a neurite: 17 m.
const FAR: f64 = (1_u64 << 24) as f64;

/// What is said of nodes so far away that numbers of 32 bits do not resolve their cells.
fn far_away(file: &str, population: &Population) -> Option<Warning> {
    let far = |place: &&DVec3| place.is_finite() && place.abs().max_element() >= FAR;
    let count = population.positions.iter().filter(far).count() as u64;
    let first = population.positions.iter().position(|place| far(&place))?;
    let message = format!(
        "{count} nodes are so far away that numbers of 32 bits do not resolve their cells, the first is {} at {} µm: \
         is the unit the micrometer?",
        population.ids[first], population.positions[first]
    );
    Some(Warning::new(file, population.name.clone(), "far_away", message).times(count))
}

/// Whether a file, or a folder, is to be opened as a circuit. A folder is if it has the configuration
/// of one; HDF5 is if it is a network of Snudda; any `.csv` and `.tsv` file is, since no morphology is, and any `.json`
/// file but neurons of MouseLight and skeletons of CATMAID: what is wrong with it, opening tells. So are configurations and cells of before SONATA, which opening refuses with a remedy.
pub fn is_circuit(path: &Path) -> bool {
    if path.is_dir() {
        return sonata::find(path).is_ok() || snudda::find(path).is_some();
    }
    if snudda::is_network(path)
        || blue_config::refusal(path).is_some()
        || scene::is_named_so(path)
        || table::is_named_so(path)
    {
        return true;
    }
    if has_extension(path, "xml") {
        return beginning(path, 1 << 12).is_some_and(|begin| nsol::looks_like(&begin));
    }
    has_extension(path, "json")
        && !beginning(path, 1 << 20).is_some_and(|begin| is_json_tracing(&begin))
}

/// The first bytes of a file, if it can be read.
fn beginning(path: &Path, most: u64) -> Option<Vec<u8>> {
    regular(path).ok()?;
    let mut begin = Vec::new();
    let read = File::open(path).and_then(|file| file.take(most).read_to_end(&mut begin));
    read.ok().map(|_| begin)
}

fn has_extension(path: &Path, extension: &str) -> bool {
    let own = path.extension().unwrap_or_default().to_string_lossy();
    own.eq_ignore_ascii_case(extension)
}
