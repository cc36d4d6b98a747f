//! Configurations of SONATA circuits and simulations, the Allen Institute's and Blue Brain's.
//!
//! | | `circuit_config.json` (Allen) | `circuit_sonata.json` (Blue Brain) |
//! | --- | --- | --- |
//! | morphologies | `components.morphologies_dir` | per population, or `components` |
//! | node types | `node_types_file`, a table | none: all attributes are the nodes' |
//! | populations | all in the file | those listed |
//! | node sets | named by the simulation | `node_sets_file` |
//!
//! A simulation's configuration names the circuit (`network`), node sets, reports and spikes. Given a
//! circuit's configuration alone, simulations beside it whose `network` is that file are taken too,
//! whatever their names: `simulation_config.json`, bmtk's `config.simulation.json`. Of a folder that has
//! configurations of one circuit and of its simulations, the circuit's is meant.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use crate::json::{Document, Json};
use crate::manifest::Manifest;
use crate::{CircuitError, DeclaredReport, Fault};

/// What configurations say, all paths resolved.
#[derive(Debug, Default)]
pub(crate) struct Config {
    /// The circuit's configuration as it was named.
    pub(crate) file: String,
    pub(crate) nodes: Vec<NodeSource>,
    pub(crate) edges: Vec<EdgeSource>,
    /// Files of node sets, each with the file and the key that name it.
    pub(crate) node_sets: Vec<(String, String, PathBuf)>,
    /// Files of compartment sets, likewise.
    pub(crate) compartment_sets: Vec<(String, String, PathBuf)>,
    /// Report files by name, the simulation's spikes among them, each with the file and the key that
    /// name it; they need not exist.
    pub(crate) reports: BTreeMap<String, (String, String, PathBuf)>,
    /// What is said of these.
    pub(crate) declared_reports: Vec<DeclaredReport>,
    /// Simulations that could not be read, which does not keep the circuit from being opened.
    pub(crate) failures: Vec<CircuitError>,
}

/// A file of nodes.
#[derive(Debug)]
pub(crate) struct NodeSource {
    /// Key that names the file.
    pub(crate) key: String,
    pub(crate) file: PathBuf,
    pub(crate) types: Option<PathBuf>,
    /// Populations that are listed; `None` for all of the file.
    pub(crate) populations: Option<BTreeMap<String, PopulationSource>>,
    /// Where populations that are not listed have their morphologies.
    pub(crate) morphologies: MorphologyFolders,
}

/// A population that the configuration lists.
#[derive(Clone, Debug, Default)]
pub(crate) struct PopulationSource {
    pub(crate) kind: Option<String>,
    pub(crate) morphologies: MorphologyFolders,
}

/// Folders of morphologies by format.
#[derive(Clone, Debug, Default)]
pub(crate) struct MorphologyFolders {
    /// `morphologies_dir`: SWC.
    pub(crate) swc: Option<PathBuf>,
    /// `alternate_morphologies`: folders, each with the extension of its files.
    pub(crate) others: Vec<(&'static str, PathBuf)>,
}

/// A file of edges.
#[derive(Debug)]
pub(crate) struct EdgeSource {
    /// Key that names the file.
    pub(crate) key: String,
    pub(crate) file: PathBuf,
    /// Populations that are listed; `None` for all of the file.
    pub(crate) populations: Option<Vec<String>>,
}

/// The circuit that a simulation's `network` is, instead of a path: with nodes, or with `networks` that have them.
fn within<'a>(root: &Json<'a>) -> Option<Json<'a>> {
    let network = root.get("network")?;
    let is_circuit = network.get("nodes").is_some() || network.get("networks").is_some();
    is_circuit.then_some(network)
}

impl Config {
    /// Reads the configuration of a circuit or a simulation.
    pub(crate) fn open(path: &Path) -> Result<Self, CircuitError> {
        let document = Document::open(path)?;
        let root = document.root();
        let manifest = Manifest::read(&root, folder_of(path))?;
        if root.get("networks").is_some() {
            let mut config = Self::circuit(path, &root, &root, &manifest)?;
            config.simulations_beside(path);
            return Ok(config);
        }
        // arbor's SONATA has the circuit within the simulation.
        if let Some(network) = within(&root) {
            let mut config = Self::circuit(path, &network, &root, &manifest)?;
            config.simulation(&root, &manifest)?;
            return Ok(config);
        }
        // bmtk's config.json, which names both, and simulations.
        let network = match root.get("network") {
            Some(network) => manifest.path(&network)?,
            None if root.get("run").is_some() => circuit_beside(path),
            None => return Err(CircuitError::of_file(&name(path), Fault::NotACircuit)),
        };
        let inner = Document::open(&network)?;
        let inner_root = inner.root();
        if inner_root.get("networks").is_none() {
            return Err(CircuitError::of_file(&name(&network), Fault::NotACircuit));
        }
        let inner_manifest = Manifest::read(&inner_root, folder_of(&network))?;
        let mut config = Self::circuit(&network, &inner_root, &inner_root, &inner_manifest)?;
        match root.get("simulation") {
            Some(simulation) => {
                let simulation = manifest.path(&simulation)?;
                config.take_simulation(&simulation, None);
            }
            None => config.simulation(&root, &manifest)?,
        }
        Ok(config)
    }

    /// `root`: what has `networks`, or is that itself; `outer`: where components are otherwise.
    fn circuit(
        path: &Path,
        root: &Json,
        outer: &Json,
        manifest: &Manifest,
    ) -> Result<Self, CircuitError> {
        let mut config = Self {
            file: name(path),
            ..Self::default()
        };
        let components = match root.get("components").or_else(|| outer.get("components")) {
            Some(components) => MorphologyFolders::read(&components, manifest)?,
            None => MorphologyFolders::default(),
        };
        let networks = match root.get("nodes") {
            Some(_) => root.clone(),
            None => root.need("networks")?,
        };
        for source in networks.need("nodes")?.items()? {
            let file = source.need("nodes_file")?;
            let types = source.get("node_types_file");
            let populations = match source.get("populations") {
                Some(list) => Some(populations(&list, manifest, &components)?),
                None => None,
            };
            config.nodes.push(NodeSource {
                file: manifest.path(&file)?,
                types: types.map(|types| manifest.path(&types)).transpose()?,
                key: file.key,
                populations,
                morphologies: components.clone(),
            });
        }
        for source in networks.get("edges").map_or(Ok(vec![]), |e| e.items())? {
            let listed = source.get("populations").map(|list| list.entries());
            let names = |list: Vec<(&str, Json)>| list.iter().map(|&(n, _)| n.into()).collect();
            let file = source.need("edges_file")?;
            config.edges.push(EdgeSource {
                file: manifest.path(&file)?,
                key: file.key,
                populations: listed.transpose()?.map(names),
            });
        }
        config.take_node_sets(root, manifest)?;
        Ok(config)
    }

    fn take_node_sets(&mut self, root: &Json, manifest: &Manifest) -> Result<(), CircuitError> {
        if let Some(file) = root.get("compartment_sets_file") {
            let path = manifest.path(&file)?;
            if !self
                .compartment_sets
                .iter()
                .any(|(_, _, known)| *known == path)
            {
                self.compartment_sets
                    .push((file.file.into(), file.key, path));
            }
        }
        if let Some(file) = root.get("node_sets_file") {
            let path = manifest.path(&file)?;
            if !self.node_sets.iter().any(|(_, _, known)| *known == path) {
                self.node_sets.push((file.file.into(), file.key, path));
            }
        }
        Ok(())
    }

    /// What a simulation adds: node sets, reports, spikes.
    fn simulation(&mut self, root: &Json, manifest: &Manifest) -> Result<(), CircuitError> {
        self.take_node_sets(root, manifest)?;
        let output = root.get("output");
        let folder = output.as_ref().and_then(|o| o.get("output_dir"));
        let folder = folder.as_ref();
        if let Some(output) = output {
            let file = match output.get("spikes_file") {
                Some(file) => manifest.expand(&file)?,
                None => "out.h5".into(),
            };
            let path = manifest.path_in(folder, &file)?;
            let named = (root.file.into(), "output.spikes_file".into(), path);
            self.reports.insert("spikes".into(), named);
        }
        for (name, report) in root.get("reports").map_or(Ok(vec![]), |r| r.entries())? {
            if report.get("enabled").is_some_and(|e| e.value == false) {
                continue;
            }
            let mut file = match report.get("file_name") {
                Some(file) => manifest.expand(&file)?,
                None => name.into(),
            };
            if Path::new(&file).extension().is_none_or(|e| e != "h5") {
                file.push_str(".h5");
            }
            let path = manifest.path_in(folder, &file)?;
            self.declared_reports
                .push(DeclaredReport::of(&report, &path));
            let named = (root.file.into(), report.key, path);
            self.reports.insert(name.into(), named);
        }
        Ok(())
    }

    fn simulations_beside(&mut self, circuit: &Path) {
        let entries = fs::read_dir(folder_of(circuit));
        let paths = entries.into_iter().flatten().flatten().map(|e| e.path());
        let is_simulation = |path: &PathBuf| {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let named_so = || name.starts_with("simulation") || names(path) == Named::Simulation;
            name.ends_with(".json") && named_so()
        };
        let mut simulations: Vec<PathBuf> = paths.filter(is_simulation).collect();
        simulations.sort();
        for simulation in simulations {
            self.take_simulation(&simulation, Some(circuit));
        }
    }

    /// Adds a simulation, unless it says that it is of another circuit than `of`.
    fn take_simulation(&mut self, path: &Path, of: Option<&Path>) {
        let taken = Document::open(path).and_then(|document| {
            let root = document.root();
            let manifest = Manifest::read(&root, folder_of(path))?;
            if let (Some(network), Some(of)) = (root.get("network"), of) {
                let network = fs::canonicalize(manifest.path(&network)?);
                if !matches!((network, fs::canonicalize(of)), (Ok(a), Ok(b)) if a == b) {
                    return Ok(());
                }
            }
            self.simulation(&root, &manifest)
        });
        self.failures.extend(taken.err());
    }
}

impl MorphologyFolders {
    fn read(json: &Json, manifest: &Manifest) -> Result<Self, CircuitError> {
        let swc = json.get("morphologies_dir");
        let mut folders = Self {
            swc: swc.map(|dir| manifest.path(&dir)).transpose()?,
            others: vec![],
        };
        for (format, dir) in json
            .get("alternate_morphologies")
            .map_or(Ok(vec![]), |a| a.entries())?
        {
            let extension = match format {
                "h5v1" => "h5",
                "neurolucida-asc" => "asc",
                _ => continue,
            };
            folders.others.push((extension, manifest.path(&dir)?));
        }
        Ok(folders)
    }

    fn or(self, other: &Self) -> Self {
        if self.swc.is_none() && self.others.is_empty() {
            other.clone()
        } else {
            self
        }
    }
}

fn populations(
    list: &Json,
    manifest: &Manifest,
    components: &MorphologyFolders,
) -> Result<BTreeMap<String, PopulationSource>, CircuitError> {
    let one = |(name, json): (&str, Json)| {
        let kind = json.get("type").map(|kind| kind.text().map(str::to_owned));
        let source = PopulationSource {
            kind: kind.transpose()?,
            morphologies: MorphologyFolders::read(&json, manifest)?.or(components),
        };
        Ok((name.to_owned(), source))
    };
    list.entries()?.into_iter().map(one).collect()
}

/// The circuit of a simulation that names none: `circuit_config.json` by SONATA's guide, or the one that is there.
fn circuit_beside(simulation: &Path) -> PathBuf {
    let folder = folder_of(simulation);
    let usual = folder.join("circuit_config.json");
    let other = || find(folder).ok().filter(|path| path != simulation);
    match usual.is_file() {
        true => usual,
        false => other().unwrap_or(usual),
    }
}

/// The configuration that a folder is about.
///
/// # Errors
/// [`Fault::NoConfig`] if there is none, or several and none of the usual name.
pub(crate) fn find(folder: &Path) -> Result<PathBuf, CircuitError> {
    for usual in ["circuit_sonata.json", "circuit_config.json", "config.json"] {
        let path = folder.join(usual);
        if path.is_file() && (usual != "config.json" || names(&path) != Named::Nothing) {
            return Ok(path);
        }
    }
    let entries = fs::read_dir(folder).map_err(|e| CircuitError::io(folder, e))?;
    let paths = entries.flatten().map(|e| e.path());
    let is_json = |path: &PathBuf| path.extension().is_some_and(|e| e == "json");
    let all: Vec<(PathBuf, Named)> = paths
        .filter(is_json)
        .map(|path| {
            let named = names(&path);
            (path, named)
        })
        .collect();
    let of_kind = |kind: Named| {
        let wanted = all.iter().filter(|(_, named)| *named == kind);
        let mut paths: Vec<PathBuf> = wanted.map(|(path, _)| path.clone()).collect();
        paths.sort();
        paths
    };
    let circuits = of_kind(Named::Circuit);
    let simulations = of_kind(Named::Simulation);
    match (&circuits[..], &simulations[..]) {
        ([one], _) | ([], [one]) => Ok(one.clone()),
        _ => {
            let mut several = [circuits, simulations].concat();
            several.sort();
            let names: Vec<String> = several.iter().map(|p| name(p)).collect();
            let found = if names.is_empty() {
                "none".into()
            } else {
                names.join(", ")
            };
            Err(CircuitError::of_file(
                &name(folder),
                Fault::NoConfig { found },
            ))
        }
    }
}

/// What a JSON file is the configuration of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Named {
    Circuit,
    Simulation,
    Nothing,
}

fn names(path: &Path) -> Named {
    let Ok(document) = Document::open(path) else {
        return Named::Nothing;
    };
    let root = document.root();
    if root
        .get("networks")
        .is_some_and(|n| n.get("nodes").is_some())
    {
        return Named::Circuit;
    }
    if within(&root).is_some() {
        return Named::Circuit;
    }
    match root.get("network").filter(|n| n.value.is_string()) {
        Some(_) => Named::Simulation,
        None => Named::Nothing,
    }
}

fn name(path: &Path) -> String {
    path.display().to_string()
}

pub(crate) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}
