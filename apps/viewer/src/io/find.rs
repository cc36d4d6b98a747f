//! What is behind the paths that somebody opens: tracings below folders, cells of circuits, reports.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use neurotess::circuit::{Circuit, is_circuit, is_recording, soma_center};
use neurotess::formats;
use neurotess::render::Placement;
use walkdir::WalkDir;

use crate::model::circuits::Opened;
use crate::model::document::SomaEdit;
use crate::model::session::Session;
use crate::model::sources::{SAMPLE, Source};

/// A cell of a circuit: which of its files, where it stands, its number.
#[derive(Clone, Debug)]
pub(crate) struct CircuitCell {
    /// Among the files that were found.
    pub(crate) file: usize,
    /// Among the circuits that were found.
    pub(crate) circuit: usize,
    /// The instance, for its place once the soma is known.
    pub(crate) instance: neurotess::circuit::Instance,
}

/// What somebody opens.
#[derive(Clone, Debug, Default)]
pub(crate) struct OpenRequest {
    /// Files, folders, circuits with their cells.
    pub(crate) paths: Vec<PathBuf>,
    /// Circuits whose cells are among the files.
    pub(crate) circuits: Vec<PathBuf>,
    /// How somata are made of files where it is not as usual.
    pub(crate) somata: Vec<(PathBuf, SomaEdit)>,
    /// How those of the others are made.
    pub(crate) usual: SomaEdit,
}

impl OpenRequest {
    /// What is to be read for a session.
    pub(crate) fn of_session(session: &Session) -> Self {
        let files = &session.file;
        Self {
            paths: files.iter().map(|f| f.path.clone()).collect(),
            circuits: session.circuit.iter().map(|c| c.path.clone()).collect(),
            somata: files
                .iter()
                .filter_map(|f| Some((f.path.clone(), f.soma.clone()?)))
                .collect(),
            usual: SomaEdit::default(),
        }
    }
}

/// What is to be read.
#[derive(Clone, Debug, Default)]
pub(crate) struct Found {
    /// Files, each once.
    pub(crate) files: Vec<PathBuf>,
    /// Circuits.
    pub(crate) circuits: Vec<Opened>,
    /// Reports and spikes.
    pub(crate) reports: Vec<PathBuf>,
    /// Cells of circuits; files that no cell stands for are shown where they were traced.
    pub(crate) cells: Vec<CircuitCell>,
    /// What could not be searched or opened: file and reason.
    pub(crate) failures: Vec<(PathBuf, String)>,
}

/// Files below folders, cells of circuits.
pub(crate) fn find(request: &OpenRequest) -> Found {
    let mut found = Found::default();
    for path in &request.circuits {
        match Circuit::open(path) {
            Ok(circuit) => found.circuits.push((path.clone(), Arc::new(circuit))),
            Err(e) => found.failures.push((path.clone(), e.to_string())),
        }
    }
    for path in &request.paths {
        if is_sample(path) {
            found.files.push(path.clone());
        } else if is_circuit(path) {
            find_circuit(path, &mut found);
        } else if path.is_dir() {
            find_folder(path, &mut found);
        } else if is_hdf5(path) && is_recording(path) {
            found.reports.push(path.clone());
        } else {
            found.files.push(path.clone());
        }
    }
    found
}

fn find_folder(folder: &Path, found: &mut Found) {
    let before = found.files.len();
    for entry in WalkDir::new(folder).follow_links(true).sort_by_file_name() {
        match entry {
            Ok(entry) if entry.file_type().is_file() && is_readable(entry.path()) => {
                // Reports and tables of nodes are HDF5 too.
                if !formats::h5::is_other(entry.path()) {
                    found.files.push(entry.into_path());
                }
            }
            Ok(_) => {}
            Err(e) => {
                let at = e.path().unwrap_or(folder).to_path_buf();
                let why = "cannot be searched: check links and permissions";
                found.failures.push((at, why.into()));
            }
        }
    }
    if found.files.len() == before {
        let known = formats::EXTENSIONS.join(", .");
        let why = format!("no tracing in this folder: it needs files named .{known}");
        found.failures.push((folder.to_path_buf(), why));
    }
}

/// Whether a file is named as a tracing is.
pub(crate) fn is_readable(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default();
    let extension = path.extension().unwrap_or_default().to_string_lossy();
    let mut known = formats::EXTENSIONS.iter();
    !name.as_encoded_bytes().starts_with(b".") && known.any(|k| extension.eq_ignore_ascii_case(k))
}

/// Whether a file is named as HDF5 is: a morphology, a report, spikes.
pub(crate) fn is_hdf5(path: &Path) -> bool {
    let extension = path.extension().unwrap_or_default();
    extension.eq_ignore_ascii_case("h5") || extension.eq_ignore_ascii_case("hdf5")
}

fn find_circuit(path: &Path, found: &mut Found) {
    let circuit = match Circuit::open(path) {
        Ok(circuit) => circuit,
        Err(e) => {
            found.failures.push((path.to_path_buf(), e.to_string()));
            return;
        }
    };
    for failure in &circuit.failures {
        found
            .failures
            .push((path.to_path_buf(), failure.to_string()));
    }
    let nodes: Vec<_> = circuit.nodes().collect();
    let instances = circuit.instances(&nodes, None);
    if instances.len() < nodes.len() {
        let left_out = nodes.len() - instances.len();
        let why = format!(
            "{left_out} of {} cells have no morphology: not shown",
            nodes.len()
        );
        found.failures.push((path.to_path_buf(), why));
    }
    let mut files = std::collections::BTreeMap::new();
    let number = found.circuits.len();
    for instance in instances {
        let template = &circuit.templates[instance.template.index()].path;
        let next = found.files.len();
        let file = *files.entry(template.clone()).or_insert_with(|| {
            found.files.push(template.clone());
            next
        });
        found.cells.push(CircuitCell {
            file,
            circuit: number,
            instance,
        });
    }
    found.circuits.push((path.to_path_buf(), Arc::new(circuit)));
}

impl CircuitCell {
    /// Name and place of the cell, once its tracing is read.
    pub(crate) fn place(&self, source: &Source) -> (String, Placement) {
        let instance = &self.instance;
        let center = soma_center(&source.morphology);
        let placement = Placement {
            rotation: instance.rotation,
            scale: instance.scale,
            translation: instance.world_from_cell(center).translation,
        };
        (format!("{} {}", instance.id, source.name), placement)
    }
}

fn is_sample(path: &Path) -> bool {
    path.to_string_lossy().starts_with(SAMPLE)
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn folders_are_searched_and_empty_ones_told_of() {
        let folder = tempfile::tempdir().expect("a folder");
        let root = folder.path();
        let request = OpenRequest {
            paths: vec![root.to_path_buf()],
            ..OpenRequest::default()
        };
        let empty = find(&request);
        assert_eq!((empty.files.len(), empty.failures.len()), (0, 1));
        for name in ["b.swc", "a.SWC", "note.txt", ".c.swc"] {
            fs::write(root.join(name), "1 1 0 0 0 5 -1\n").expect("written");
        }
        assert_eq!(find(&request).files.len(), 2);
    }
}
