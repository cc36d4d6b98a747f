//! Edits that are not saved are kept in a file beside the settings, which the next start offers if the program ended
//! without asking: it was killed, or the machine went down.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime};

use eframe::egui;

use super::Viewer;
use crate::io::autosave::Slot;
use crate::model::session::Session;
use crate::model::state::Dialog;

/// How long edits wait until they are kept: what may be lost.
pub(crate) const EVERY: Duration = Duration::from_secs(60);

/// What is kept, and when.
pub(super) struct Autosave {
    slot: Slot,
    every: Duration,
    /// Number of edits that the file has.
    kept: u64,
    /// Since when there are edits that it does not have.
    since: Option<Instant>,
    /// When what an earlier window left was written, until the user has answered what to do with it.
    offered: Option<SystemTime>,
}

impl Viewer {
    /// Keeps edits that are not saved in a folder, this often. Offers what was left there.
    pub fn with_autosave(mut self, folder: &Path, every: Duration) -> Self {
        self.autosave = Slot::take(folder).map(|slot| Autosave {
            offered: slot.written(),
            slot,
            every,
            kept: self.state.changes.made(),
            since: None,
        });
        self
    }

    /// Keeps edits that are not saved, if it is time.
    pub(super) fn autosave(&mut self, ctx: &egui::Context) {
        let Some(autosave) = &mut self.autosave else {
            return;
        };
        if let Some(written) = autosave.offered {
            // Another dialog may have taken its place.
            if matches!(self.state.layout.dialog, Dialog::Nothing) {
                self.state.layout.dialog = Dialog::Recover(written);
                ctx.request_repaint();
            }
            return;
        }
        let changes = self.state.changes;
        if !changes.unsaved() {
            if autosave.since.take().is_some() || autosave.kept != changes.made() {
                autosave.slot.clear();
                autosave.kept = changes.made();
            }
            return;
        }
        // While files are read, the list is not whole.
        if autosave.kept == changes.made() || self.loading.is_some() {
            return;
        }
        let waited = autosave.since.get_or_insert_with(Instant::now).elapsed();
        if let Some(left) = autosave.every.checked_sub(waited).filter(|t| !t.is_zero()) {
            ctx.request_repaint_after(left);
            return;
        }
        let file = autosave.slot.file();
        let folder = file.parent().unwrap_or(Path::new(""));
        let written = Session::of(&self.state, folder).write(file);
        (autosave.kept, autosave.since) = (changes.made(), None);
        if let Err(why) = written {
            let why = format!("{why}: edits are not kept, save the session");
            self.state.problem("autosave", why);
        }
    }

    /// Opens what an earlier window left, or removes it.
    pub(super) fn recover(&mut self, open: bool) {
        let Some(autosave) = &mut self.autosave else {
            return;
        };
        autosave.offered = None;
        let file = autosave.slot.file().to_path_buf();
        match open {
            true => self.load(vec![file]),
            false => autosave.slot.clear(),
        }
    }

    /// The file that a session is saved to once it was opened: none if it was kept unsaved.
    pub(super) fn own_file(&self, opened: &Path) -> Option<PathBuf> {
        let kept = self.autosave.as_ref().map(|autosave| autosave.slot.file());
        (kept != Some(opened)).then(|| opened.to_path_buf())
    }

    /// Removes what was kept, since the user has left it.
    pub fn leave(&mut self) {
        // What was offered and not answered waits for the next start, and so does what an error ended.
        let left = self.autosave.take();
        let left = left.filter(|left| left.offered.is_none() && self.fatal.is_none());
        if let Some(left) = left {
            left.slot.clear();
        }
    }
}
