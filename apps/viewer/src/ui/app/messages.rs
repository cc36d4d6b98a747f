//! What comes back from the workers, and what they are asked for.

use super::Viewer;
use crate::io::tasks::Message;

impl Viewer {
    pub(super) fn take(&mut self, message: Message) {
        match message {
            Message::Found(found) => self.found(*found),
            Message::Loaded(index, loaded) => self.loaded(index, *loaded),
            Message::LoadingDone => self.end_loading(),
            Message::Reloaded(id, source) => match *source {
                Ok(source) => {
                    self.state.status = format!("{} was read again", source.name);
                    if let Some(there) = self.state.sources.get_mut(id) {
                        *there = source;
                    }
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
            Message::Soma(id, edit, generated) => {
                if let Some(source) = self.state.sources.get_mut(id)
                    && !generated.mesh.patches.is_empty()
                {
                    source.set_generated(*generated);
                    source.soma = edit;
                } else if let Some(source) = self.state.sources.get_mut(id) {
                    source.soma = edit;
                    let name = source.name.clone();
                    self.state.problem(
                        name,
                        "this soma leaves nothing to draw: choose another method",
                    );
                }
            }
            Message::Files(files) => {
                for (id, stale) in files {
                    if let Some(source) = self.state.sources.get_mut(id) {
                        source.stale = stale;
                    }
                }
            }
            Message::Saved(Ok(said)) => self.state.status = said,
            Message::Saved(Err(why)) => {
                self.state.status = format!("Not saved: {why}");
                self.state.problem("save", why);
            }
        }
    }

    /// Somata that are not as the document wants them are made again, one at a time, the newest wish.
    pub(super) fn want_somata(&mut self) {
        if self.worker.rebuilds_soma() {
            return;
        }
        let document = &self.state.document;
        let mut used = document.neurons.iter().map(|n| n.source);
        let wanted = used.find_map(|id| {
            let source = self.state.sources.get(id)?;
            let edit = document.soma(id);
            (source.soma != edit).then(|| (id, source.morphology.clone(), edit))
        });
        if let Some((id, morphology, edit)) = wanted {
            self.worker.soma(id, morphology, edit);
        }
    }
}
