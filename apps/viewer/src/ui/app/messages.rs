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
            Message::Soma(id, edit, generated) => {
                let draws = !generated.mesh.patches.is_empty();
                let name = self.state.sources.get(id).map(|s| s.name.clone());
                self.state
                    .sources
                    .set_soma(id, edit, draws.then_some(*generated));
                if !draws {
                    let why = "this soma leaves nothing to draw: choose another method";
                    self.state.problem(name.unwrap_or_default(), why);
                }
            }
            Message::Files(files) => {
                for (id, stale) in files {
                    self.state.sources.set_stale(id, stale);
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
            Some((id, morphology, edit)) => self.worker.soma(id, morphology, edit),
            None => self.somata_checked = Some(key),
        }
    }
}
