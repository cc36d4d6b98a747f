//! Commands that end what is not saved.

use super::{Effect, State};
use crate::model::command::Command;
use crate::model::session_name::is_session;

impl State {
    /// Whether a command would end what is not saved, or is being written.
    pub(super) fn loses_work(&self, command: &Command) -> bool {
        match command {
            Command::Quit => self.changes.unsaved() || self.writing,
            // A session takes the place of all that is open.
            Command::Open(paths) => {
                self.changes.unsaved() && paths.iter().any(|path| is_session(path))
            }
            _ => false,
        }
    }

    /// Runs a command without asking about what is not saved.
    pub(super) fn run_unasked(&mut self, command: Command) {
        match command {
            Command::Quit => self.effects.push(Effect::Quit),
            Command::Open(paths) => {
                self.settings.remember_files(&paths);
                self.effects.push(Effect::Load(paths));
            }
            other => self.run(other),
        }
    }
}
