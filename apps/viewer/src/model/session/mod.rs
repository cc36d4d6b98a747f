//! Sessions: a file that people can read and change.

mod entries;
mod opened;

use std::fs;
use std::path::{Path, PathBuf};

use neurotess::formats::read_regular;
use neurotess::output::{Existing, write_whole};
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::model::document::{
    Detail, Dimension, Look, MarkerOptions, MeshEntry, NeuronState, SavedView, SomaEdit, Trace,
};
use crate::model::ids::{CircuitId, CircuitNode};
use crate::model::playback::Pace;
use crate::model::split::Split;
use crate::model::state::State;
use crate::model::view::View;

pub use crate::model::session_name::{EXTENSION, is_session};
pub use entries::{CircuitEntry, FileEntry, NeuronEntry, NodeEntry};

/// Version of the file format.
const VERSION: u32 = 1;

/// Why a session cannot be read. Displays without the file's name, which the window shows beside
/// it.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{}{why}", .line.map_or(String::new(), |line| format!("line {line}: ")))]
pub struct SessionError {
    line: Option<usize>,
    why: String,
}

impl SessionError {
    /// `FILE:LINE: what: what to do`
    pub fn of(&self, file: &Path) -> String {
        let line = self.line.map_or(String::new(), |line| format!("{line}:"));
        format!("{}:{line} {}", file.display(), self.why)
    }
}

/// A session as it is stored in its file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Session {
    /// Version of the file format.
    pub version: u32,
    /// Whether neurons are side by side.
    #[serde(default)]
    pub grid: bool,
    /// Whether y points down.
    #[serde(default)]
    pub y_down: bool,
    /// The camera.
    #[serde(default)]
    pub view: View,
    /// The other one of two views side by side.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub split: Option<Split>,
    /// Colors and light.
    #[serde(default)]
    pub look: Look,
    /// The level of detail.
    #[serde(default)]
    pub detail: Detail,
    /// Views of a film.
    #[serde(default)]
    pub key_view: Vec<View>,
    /// Views with names.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub saved_view: Vec<SavedView>,
    /// The recording whose values can be shown.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub report: Option<PathBuf>,
    /// Synapses and points beside the cells.
    #[serde(default, skip_serializing_if = "is_default")]
    pub markers: MarkerOptions,
    /// Meshes beside the cells.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub mesh: Vec<MeshEntry>,
    /// Its time and speed.
    #[serde(default)]
    pub playback: Pace,
    /// Circuits that neurons belong to.
    #[serde(default)]
    pub circuit: Vec<CircuitEntry>,
    /// Tracings.
    #[serde(default)]
    pub file: Vec<FileEntry>,
    /// Neurons.
    #[serde(default)]
    pub neuron: Vec<NeuronEntry>,
    /// Dimensions on the picture; they name neurons by their index in the list, from 0.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub dimension: Vec<Dimension>,
    /// Compartments that are plotted over time, by neurons as dimensions.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub trace: Vec<Trace>,
}

fn is_default(markers: &MarkerOptions) -> bool {
    *markers == MarkerOptions::default()
}

impl Session {
    /// The session of the current state. `folder`: the folder that it will be saved in.
    pub fn of(state: &State, folder: &Path) -> Self {
        let document = &state.document;
        let mut used: Vec<_> = document.neurons.iter().map(|n| n.source).collect();
        used.sort_unstable();
        used.dedup();
        let file = used.iter().filter_map(|&id| {
            let source = state.sources.get(id)?;
            let soma = document.soma(id);
            Some(FileEntry {
                path: relative(&source.file, folder),
                soma: (soma != SomaEdit::default()).then_some(soma),
            })
        });
        let mut circuits: Vec<CircuitId> = document
            .neurons
            .iter()
            .filter_map(|neuron| Some(neuron.node?.circuit))
            .collect();
        circuits.sort_unstable();
        circuits.dedup();
        let node = |of: CircuitNode| {
            let population = &state.circuits.get(of.circuit)?.populations;
            let population = population.get(of.node.population as usize)?;
            Some(NodeEntry {
                circuit: circuits.binary_search(&of.circuit).ok()?,
                population: population.name.clone(),
                id: *population.ids.get(of.node.row as usize)?,
            })
        };
        let circuit = circuits.iter().filter_map(|&id| {
            let path = relative(state.circuits.file(id)?, folder);
            Some(CircuitEntry { path })
        });
        let neuron = document.neurons.iter().enumerate().map(|(index, neuron)| {
            let NeuronState {
                hidden,
                selected,
                clamped,
            } = document.neurons.state(index);
            NeuronEntry {
                node: neuron.node.and_then(node),
                name: neuron.name.clone(),
                file: used.binary_search(&neuron.source).unwrap_or(0),
                hidden,
                selected,
                clamped,
                place: (neuron.placement != Default::default()).then(|| neuron.placement.into()),
            }
        });
        Self {
            version: VERSION,
            grid: document.grid,
            y_down: document.y_down,
            view: state.view,
            split: state.views.split.map(Split::kept),
            look: document.look.clone(),
            detail: document.detail,
            key_view: state.views.key_views.clone(),
            saved_view: document.saved_views.clone(),
            report: document.report.as_ref().map(|file| relative(file, folder)),
            markers: MarkerOptions {
                points: document
                    .markers
                    .points
                    .as_ref()
                    .map(|file| relative(file, folder)),
                ..document.markers.clone()
            },
            mesh: document
                .meshes
                .iter()
                .map(|entry| MeshEntry {
                    file: relative(&entry.file, folder),
                    ..entry.clone()
                })
                .collect(),
            playback: state.playback.pace,
            circuit: circuit.collect(),
            file: file.collect(),
            neuron: neuron.collect(),
            dimension: document.dimensions.to_vec(),
            trace: document.traces.to_vec(),
        }
    }

    /// Reads a session. Its paths are made absolute, or relative to the working directory.
    ///
    /// # Errors
    /// The file cannot be read or is invalid: with the line, and what to do.
    pub fn read(path: &Path) -> Result<Self, SessionError> {
        let whole = |why: String| SessionError { line: None, why };
        let text = read_regular(path).map_err(|e| whole(format!("cannot be read: {e}")))?;
        let no_text = "not a session: it is no text; open the files themselves";
        let text = String::from_utf8(text).map_err(|_| whole(no_text.into()))?;
        let mut session: Self = toml::from_str(&text).map_err(|e| {
            let line = e.span().map(|s| text[..s.start].lines().count().max(1));
            let why = format!("{}: correct it, or open the files themselves", e.message());
            SessionError { line, why }
        })?;
        if session.version > VERSION {
            return Err(whole(format!(
                "it is of version {}, this program knows {VERSION}: get a newer one",
                session.version
            )));
        }
        let folder = path.parent().unwrap_or(Path::new(""));
        let files = session.file.iter_mut().map(|entry| &mut entry.path);
        let circuits = session.circuit.iter_mut().map(|entry| &mut entry.path);
        let shown = session.report.iter_mut().chain(&mut session.markers.points);
        let meshes = session.mesh.iter_mut().map(|entry| &mut entry.file);
        for path in files.chain(circuits).chain(shown).chain(meshes) {
            if path.is_relative() && !path.to_string_lossy().starts_with("sample:") {
                *path = folder.join(&*path);
            }
        }
        if let Some(neuron) = session.neuron.iter().find(|n| n.file >= session.file.len()) {
            return Err(whole(format!(
                "neuron '{}' is of file {}, but there are {}: correct it",
                neuron.name,
                neuron.file,
                session.file.len()
            )));
        }
        Ok(session)
    }

    /// The view of this name.
    ///
    /// # Errors
    /// There is none: a message that names those that there are.
    pub fn view_named(&self, name: &str) -> Result<View, SessionError> {
        let found = self.saved_view.iter().find(|saved| saved.name == name);
        found.map(|saved| saved.view).ok_or_else(|| {
            let names = self
                .saved_view
                .iter()
                .map(|saved| format!("'{}'", saved.name));
            let names: Vec<String> = names.collect();
            let instead = match names.is_empty() {
                true => "save one in the window (V)".to_owned(),
                false => format!("choose one of {}", names.join(", ")),
            };
            let why = format!("no view is saved as '{name}': {instead}");
            SessionError { line: None, why }
        })
    }

    /// Writes the session to a file.
    ///
    /// # Errors
    /// A message that says what went wrong and what to do.
    pub fn write(&self, path: &Path) -> Result<(), String> {
        let text = toml::to_string_pretty(self).map_err(|e| e.to_string())?;
        write_whole(path, Existing::Replace, |to| {
            use std::io::Write;
            writeln!(
                to,
                "# A session of neurotess: `neurotess view FILE` opens it. Lengths are µm."
            )?;
            to.write_all(text.as_bytes())
        })
        .map_err(|e| e.to_string())
    }
}

/// A path for a session's file: relative to its folder if it is inside, so that both can be moved.
fn relative(path: &Path, folder: &Path) -> PathBuf {
    if path.to_string_lossy().starts_with("sample:") {
        return path.to_path_buf();
    }
    let whole = fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
    let folder = fs::canonicalize(if folder.as_os_str().is_empty() {
        Path::new(".")
    } else {
        folder
    });
    let folder = folder.unwrap_or_default();
    whole
        .strip_prefix(&folder)
        .map(Path::to_path_buf)
        .unwrap_or(whole)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::load;
    use crate::model::command::{Command, Edit};
    use crate::model::document::{ColorBy, Cut, Lighting, Neuron};
    use crate::model::settings::Settings;
    use crate::model::sources;

    fn state() -> State {
        let mut state = State::new(Settings::default());
        let star = sources::sample(neurotess::synth::Kind::Star);
        let source = load::load(&star, SomaEdit::default(), None).expect("grown");
        let id = state.sources.add(source);
        for name in ["one", "two \"quoted\" µ"] {
            let mut neuron = Neuron::new(id, name.into());
            neuron.placement.translation.x = name.len() as f64;
            state.document.neurons.push(neuron);
        }
        state.run(Edit::Select(vec![1], false));
        state.run(Edit::SetHidden(0, true));
        let soma = SomaEdit {
            poisson: 0.12,
            octahedron: true,
            level: 3,
            ..SomaEdit::default()
        };
        state.run(Edit::SetSoma(vec![id], soma));
        state.run(Edit::SetRing(id, 0, Some(1.25)));
        state.run(Edit::SetRing(id, 3, Some(0.0)));
        let mut look = state.document.look.clone();
        look.color_by = ColorBy::PathDistance;
        look.light = Lighting::From {
            right: 30.0,
            up: -10.5,
        };
        look.cut = Some(Cut {
            axis: 2,
            place: 0.25,
            flipped: true,
        });
        state.run(Edit::SetLook(Box::new(look)));
        state.run(Command::AddKeyView);
        state.view.orthographic = true;
        state.run(Command::SetLinked(true));
        state.run(Command::SaveView);
        state.run(Edit::RenameView(0, "of the \"tuft\"".into()));
        state
    }

    #[test]
    fn a_session_comes_back_as_it_was() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("a.neurotess");
        let session = Session::of(&state(), folder.path());
        session.write(&file).expect("written");
        let read = Session::read(&file).expect("read");
        assert_eq!(read, session);
        assert!(is_session(&file) && read.view.orthographic);
        assert_eq!(read.view_named("of the \"tuft\""), Ok(read.view));
        let error = read.view_named("tuft").expect_err("none").to_string();
        assert!(error.contains("choose one of 'of the"), "{error}");
    }

    #[test]
    fn broken_sessions_have_a_line_and_a_reason() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("a.neurotess");
        for (text, said) in [
            ("version = 1\ngrid = 7\n", "line 2"),
            ("version = 1\nunknown = 7\n", "unknown"),
            ("version = 99\n", "newer"),
            ("not a session", "line 1"),
            ("version = 1\n[[neuron]]\nname = 'a'\nfile = 3\n", "file 3"),
            (
                "version = 1\n[[file]]\npath = 'a'\nsoma.rings = [{ neurite = 1, position = 3 }]",
                "from 0 to 2",
            ),
            (
                "version = 1\n[[file]]\npath = 'a'\nsoma.rings = [{ neurite = 0, position = 1 }]",
                "from 1",
            ),
        ] {
            fs::write(&file, text).expect("written");
            let error = Session::read(&file).expect_err("broken").to_string();
            assert!(error.contains(said), "{error}");
        }
        assert!(Session::read(&folder.path().join("none.neurotess")).is_err());
    }

    #[test]
    fn files_beside_the_session_are_named_relatively() {
        let folder = tempfile::tempdir().expect("a folder");
        let cell = folder.path().join("cell.swc");
        fs::write(&cell, "").expect("written");
        assert_eq!(relative(&cell, folder.path()), PathBuf::from("cell.swc"));
        assert_eq!(
            relative(Path::new("sample:star"), folder.path()),
            PathBuf::from("sample:star")
        );
    }
}
