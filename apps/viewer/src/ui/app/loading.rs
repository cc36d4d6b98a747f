//! Loading of files into the list.

use std::path::{Path, PathBuf};

use super::Viewer;
use super::likeness::is_picture;
use crate::io::find::{Found, OpenRequest};
use crate::model::command::{Command, Edit};
use crate::model::document::{Neuron, Neurons, SourceId};
use crate::model::ids::{CircuitId, CircuitNode};
use crate::model::session::{self, Session};
use crate::model::sources::{Source, Stale};
use crate::model::state::{Dialog, Effect, State};

/// A loading: what was found, and its cells by file.
#[derive(Default)]
pub(super) struct Loading {
    found: Found,
    ids: Vec<Option<SourceId>>,
    circuits: Vec<CircuitId>,
    session: Option<Box<Session>>,
    failed: usize,
    /// Whether nothing was open before, so that the camera must show everything.
    first: bool,
}

impl Viewer {
    pub(super) fn load(&mut self, paths: Vec<PathBuf>) {
        let (pictures, paths): (Vec<_>, Vec<_>) =
            paths.into_iter().partition(|path| is_picture(path));
        if let Some(picture) = pictures.last() {
            self.show_like(picture);
            if paths.is_empty() {
                return;
            }
        }
        if self.loading.is_some() {
            self.waiting.extend(paths);
            return;
        }
        let (sessions, paths): (Vec<PathBuf>, Vec<PathBuf>) = paths
            .into_iter()
            .partition(|path| session::is_session(path));
        let session = match &sessions[..] {
            [] => None,
            [one] => match Session::read(one) {
                Ok(session) => Some((one.clone(), session)),
                Err(e) => {
                    let why = e.to_string();
                    self.state.problem(one.display().to_string(), why);
                    self.state.messages.status = "The session was not opened".into();
                    return;
                }
            },
            _ => {
                self.state
                    .problem("open", "one session at a time: open one of them");
                return;
            }
        };
        let mut loading = Loading {
            first: self.state.document.neurons.is_empty(),
            ..Loading::default()
        };
        let request = match session {
            Some((file, session)) => {
                self.take_session(&file, &session);
                // Cells beside those of the session come after them.
                self.waiting.extend(paths);
                let request = OpenRequest::of_session(&session);
                loading.session = Some(Box::new(session));
                request
            }
            None => {
                // The next cell, after others were removed.
                if loading.first && self.state.sources.iter().next().is_some() {
                    self.state.forget_look();
                }
                OpenRequest {
                    paths,
                    ..OpenRequest::default()
                }
            }
        };
        let request = OpenRequest {
            usual: std::mem::take(&mut self.soma),
            without_caches: self.without_caches || !self.state.settings.caches,
            ..request
        };
        self.loading = Some(loading);
        self.worker.load(request);
    }

    /// Takes all of a session but its cells.
    fn take_session(&mut self, file: &Path, session: &Session) {
        let state = &mut self.state;
        let settings = std::mem::take(&mut state.settings);
        let (adapter, aspect) = (state.drawing.adapter.clone(), state.views.aspect);
        let mut changes = state.changes;
        // What is being read belongs to circuits that are closed now.
        self.worker.stop_markers();
        self.worker.stop_mesh();
        self.plots.cancel();
        *state = State::new(settings);
        (state.drawing.adapter, state.views.aspect) = (adapter, aspect);
        state.document.y_down = session.y_down;
        state.document.look = session.look.clone();
        state.document.detail = session.detail;
        state.document.grid = session.grid;
        state.document.report = session.report.clone();
        state.document.markers = session.markers.clone();
        *state.document.meshes = session.mesh.clone();
        state.playback.pace = session.playback;
        (state.view, state.views.fitted) = (session.view, None);
        state.views.split = session.split;
        state.views.key_views = session.key_view.clone();
        state.document.saved_views = session.saved_view.clone();
        changes.note_saved();
        self.motion.stop();
        self.state.session = self.own_file(file);
        if self.state.session.is_none() {
            changes.note();
        }
        self.state.changes = changes;
    }

    pub(super) fn reload(&mut self) {
        let stale: Vec<_> = self
            .state
            .sources
            .iter()
            .filter(|(_, s)| s.stale == Some(Stale::Changed))
            .map(|(id, s)| (id, s.file.clone(), s.soma.clone()))
            .collect();
        if stale.is_empty() {
            self.state.messages.status = "No file has changed".into();
        }
        for (id, file, soma) in stale {
            self.worker.reload(id, file, soma);
        }
    }

    pub(super) fn found(&mut self, found: Found) {
        for (file, why) in &found.failures {
            self.state.problem(file.display().to_string(), why);
            self.state.settings.forget_file(file);
        }
        if let [.., report] = &found.reports[..] {
            self.state.run(Edit::SetReport(Some(report.clone())));
            self.state.messages.status = format!("{} is shown", report.display());
            for other in &found.reports[..found.reports.len() - 1] {
                let why = "one report shows at a time: open it alone";
                self.state.problem(other.display().to_string(), why);
            }
        }
        if let [.., points] = &found.points[..] {
            self.state.run(Command::OpenPoints(points.clone()));
            for other in &found.points[..found.points.len() - 1] {
                let why = "one table of points shows at a time: open it alone";
                self.state.problem(other.display().to_string(), why);
            }
        }
        if !found.meshes.is_empty() {
            self.state.run(Command::OpenMeshes(found.meshes.clone()));
        }
        if let Some(loading) = &mut self.loading {
            let circuits = found.circuits.iter().cloned();
            let add = |opened| self.state.circuits.add(opened);
            loading.circuits = circuits.map(add).collect();
            loading.ids = vec![None; found.files.len()];
            loading.failed += found.failures.len();
            loading.found = found;
        }
    }

    pub(super) fn loaded(&mut self, index: usize, loaded: Result<Source, (PathBuf, String)>) {
        let source = match loaded {
            Ok(source) => source,
            Err((file, why)) => {
                self.state.problem(file.display().to_string(), why);
                self.state.settings.forget_file(&file);
                if let Some(loading) = &mut self.loading {
                    loading.failed += 1;
                }
                return;
            }
        };
        let soma = source.soma.clone();
        let name = source.name.clone();
        let id = self.state.sources.add(source);
        self.state.document.set_soma(id, soma);
        let Some(loading) = &mut self.loading else {
            return;
        };
        if let Some(place) = loading.ids.get_mut(index) {
            *place = Some(id);
        }
        // Cells of circuits and sessions are added together, in their order, when all files are
        // read.
        let stands =
            loading.session.is_some() || loading.found.cells.iter().any(|cell| cell.file == index);
        if !stands {
            let first = loading.first;
            self.open(&Neurons::from_iter([Neuron::new(id, name)]));
            if first && self.state.document.neurons.len() == 1 {
                self.home();
            }
        }
    }

    fn open(&mut self, neurons: &Neurons) {
        self.state.history.opened(neurons);
        self.state.document.neurons.append(neurons);
    }

    pub(super) fn end_loading(&mut self) {
        let Some(loading) = self.loading.take() else {
            return;
        };
        match &loading.session {
            Some(session) => {
                let (neurons, opened) = session.neurons_of(&loading.ids, &self.state);
                self.open(&neurons);
                let dimensions = session.dimensions(&opened);
                if !dimensions.is_empty() {
                    self.state.history.opened_dimensions(&dimensions);
                    self.state.document.dimensions.extend(dimensions);
                }
                let traces = session.traces(&opened);
                if !traces.is_empty() {
                    self.state.history.opened_traces(&traces);
                    self.state.document.traces.extend(traces);
                    self.state.traces.open = true;
                }
            }
            None => {
                let mut neurons = Neurons::default();
                for cell in &loading.found.cells {
                    let id = loading.ids.get(cell.file).copied().flatten();
                    if let Some((id, source)) =
                        id.and_then(|id| Some((id, self.state.sources.get(id)?)))
                    {
                        let (name, placement) = cell.place(source);
                        let circuit = loading.circuits.get(cell.circuit);
                        let node = circuit.map(|&circuit| CircuitNode {
                            circuit,
                            node: cell.instance.node,
                        });
                        neurons.push(Neuron {
                            placement,
                            traced: placement,
                            node,
                            ..Neuron::new(id, name)
                        });
                    }
                }
                self.open(&neurons);
                if loading.first {
                    self.home();
                    // More files are seen beside these.
                    self.looked = None;
                }
            }
        }
        let waiting = std::mem::take(&mut self.waiting);
        if !waiting.is_empty() {
            self.state.effects.push(Effect::Load(waiting));
        }
        let found = &loading.found;
        let with_cells = !found.points.is_empty() || !found.meshes.is_empty();
        let beside = !found.reports.is_empty() || with_cells;
        if found.files.is_empty() && beside {
            if self.state.document.neurons.is_empty() && with_cells {
                self.state.messages.status =
                    "Points and meshes show beside cells: open these, too".into();
            }
            return;
        }
        let read = loading.ids.iter().flatten().count();
        let failed = match loading.failed {
            0 => String::new(),
            n => format!(", {n} failed"),
        };
        if read == 0 && loading.failed > 0 && matches!(self.state.layout.dialog, Dialog::Nothing) {
            // Nothing else would say why nothing came.
            self.state.layout.dialog = Dialog::Problems;
        }
        let neurons = self.state.document.neurons.len();
        self.state.messages.status = format!("{read} read{failed}; {neurons} in the list");
        self.watch();
    }

    pub(super) fn watch(&mut self) {
        let files = self.state.sources.iter();
        let files = files.filter(|(_, s)| s.written.is_some());
        self.worker.watch(
            files
                .map(|(id, s)| (id, s.file.clone(), s.written))
                .collect(),
        );
    }
}
