//! Messages from the background tasks, and requests to them.

use std::sync::Arc;

use super::Viewer;
use crate::io::remesh::MeshRequest;
use crate::io::worker::Message;
use crate::model::command::Edit;
use crate::model::markers::MarkerSource;
use crate::model::sources::Meshed;

impl Viewer {
    pub(super) fn take(&mut self, message: Message) {
        match message {
            Message::Found(found) => self.found(*found),
            Message::Loaded(index, loaded) => self.loaded(index, *loaded),
            Message::LoadingDone(result) => {
                self.end_loading();
                if let Err(why) = result {
                    self.state.problem("reading", why);
                }
            }
            Message::Cache(why) => self.state.problem("cache", why),
            Message::Reloaded(id, source) => match *source {
                Ok(source) => {
                    self.state.messages.status = format!("{} was read again", source.name);
                    self.state.sources.replace(id, source);
                    self.watch();
                }
                Err(why) => {
                    let file = self
                        .state
                        .sources
                        .get(id)
                        .map(|s| s.file.display().to_string());
                    let kept = format!("{why}: what was read before still shows");
                    self.state.problem(file.unwrap_or_default(), kept);
                }
            },
            Message::Meshed(request, meshed) => self.remeshed(request, *meshed),
            Message::Markers(source, content) => self.state.set_markers(source, *content),
            Message::Mesh(file, read) => self.state.set_mesh(file, *read),
            Message::Files(files) => {
                for (id, stale) in files {
                    self.state.sources.set_stale(id, stale);
                }
            }
            Message::NotWatched(why) => self.state.problem("watching files", why),
            Message::Saved(result) => self.state.note_saved(result),
        }
    }

    fn remeshed(&mut self, request: MeshRequest, meshed: Result<Meshed, String>) {
        let empty = "this soma leaves nothing to draw: choose another method";
        let drawn = meshed.and_then(|meshed| match meshed.generated.mesh.patches.is_empty() {
            true => Err(empty.to_owned()),
            false => Ok(meshed),
        });
        let (id, spines) = (request.id, request.spines);
        let name = self.state.sources.get(id).map(|s| s.name.clone());
        let name = name.unwrap_or_default();
        let (meshed, why) = match drawn {
            Ok(meshed) => (Some(meshed), None),
            Err(why) => (None, Some(why)),
        };
        let left = meshed
            .as_ref()
            .and_then(|meshed| Some(meshed.grown.as_ref()?.left));
        // What failed is not made again until its edit changes.
        let edit = (request.soma, spines);
        self.state.sources.set_meshed(id, edit, meshed);
        if let (Some(left), Some(_), Some(source)) = (left, spines, self.state.sources.get(id)) {
            let grown = format!("{name}: {} spines", source.spine_count());
            self.state.messages.status = match left {
                0 => grown,
                left => format!("{grown}, {left} without room on a dendrite"),
            };
        }
        if let Some(why) = why {
            self.state.problem(name, why);
        }
    }

    /// Requests synapses and points that are to be shown and were not read yet: one after the other.
    pub(super) fn request_markers(&mut self) {
        // Cells of circuits join the list when all files are read.
        if self.worker.reads_markers() || self.loading.is_some() {
            return;
        }
        let Some(source) = self.state.markers_due() else {
            return;
        };
        let circuits = match &source {
            MarkerSource::Synapses(key) => key.circuits.as_slice(),
            MarkerSource::Points(_) => &[],
        };
        let shared = |&id| Some((id, self.state.circuits.shared(id)?));
        let circuits = circuits.iter().filter_map(shared).collect();
        self.worker.read_markers(source, circuits);
    }

    /// Requests meshes that are to be shown and were not read yet: one after the other.
    pub(super) fn request_meshes(&mut self) {
        if self.worker.reads_mesh() || self.loading.is_some() {
            return;
        }
        if let Some(file) = self.state.mesh_due() {
            self.worker.read_mesh(file);
        }
    }

    /// Stops reading synapses or points: they are not shown then.
    pub(super) fn stop_markers(&mut self) {
        match self.worker.stop_markers() {
            Some(MarkerSource::Synapses(_)) => self.run(Edit::ShowSynapses(false).into()),
            Some(MarkerSource::Points(_)) => self.run(Edit::SetPoints(None).into()),
            None => {}
        }
    }

    /// Requests somata that differ from the document's edits: one at a time, by the newest edit of
    /// each.
    pub(super) fn request_somata(&mut self) {
        if self.worker.is_remeshing() {
            return;
        }
        let document = &self.state.document;
        let members = document.neurons.revisions().members;
        let key = [
            members,
            document.somata.revision(),
            self.state.sources.geometry(),
        ];
        let key = (key, document.report.is_some());
        if self.somata_checked == Some(key) {
            return;
        }
        let mut used = document.neurons.sources();
        let due = used.find_map(|id| {
            let source = self.state.sources.get(id)?;
            let (soma, spines) = (document.soma(id), document.drawn_spines(id));
            let same_spines = source.spines == spines;
            (source.soma != soma || !same_spines).then(|| MeshRequest {
                id,
                traced: Arc::clone(&source.traced),
                drawn: Arc::clone(&source.morphology),
                node: self.state.node_of(id),
                soma,
                spines,
                same_spines,
            })
        });
        match due {
            Some(request) => self.worker.remesh(request),
            None => self.somata_checked = Some(key),
        }
    }
}
