//! Messages from the background tasks, and requests to them.

use super::Viewer;
use neurotess::generate::Generated;

use crate::io::worker::Message;
use crate::model::command::Edit;
use crate::model::document::{SomaEdit, SourceId};
use crate::model::markers::MarkerSource;

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
                    self.state.status = format!("{} was read again", source.name);
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
            Message::Soma(id, edit, generated) => self.remeshed(id, edit, *generated),
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

    fn remeshed(&mut self, id: SourceId, edit: SomaEdit, generated: Result<Generated, String>) {
        let empty = "this soma leaves nothing to draw: choose another method";
        let drawn = generated.and_then(|generated| match generated.mesh.patches.is_empty() {
            true => Err(empty.to_owned()),
            false => Ok(generated),
        });
        let name = self.state.sources.get(id).map(|s| s.name.clone());
        let (generated, why) = match drawn {
            Ok(generated) => (Some(generated), None),
            Err(why) => (None, Some(why)),
        };
        // A soma that failed is not generated again until its edit changes.
        self.state.sources.set_soma(id, edit, generated);
        if let Some(why) = why {
            self.state.problem(name.unwrap_or_default(), why);
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
        if self.somata_checked == Some(key) {
            return;
        }
        let mut used = document.neurons.sources().iter();
        let due = used.find_map(|&id| {
            let source = self.state.sources.get(id)?;
            let edit = document.soma(id);
            (source.soma != edit).then(|| (id, source.morphology.clone(), edit))
        });
        match due {
            Some((id, morphology, edit)) => self.worker.remesh(id, morphology, edit),
            None => self.somata_checked = Some(key),
        }
    }
}
