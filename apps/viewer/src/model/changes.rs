//! Which edits are in a session's file, and which would be lost.

/// Numbers what a session keeps: a number for each document, which an undo brings back, and one for what cannot be
/// undone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Changes {
    made: u64,
    now: [u64; 2],
    saved: [u64; 2],
}

impl Changes {
    /// Notes an edit of the document.
    pub(crate) fn note(&mut self) {
        self.made += 1;
        self.now[0] = self.made;
    }

    /// Notes a change that cannot be undone.
    pub(crate) fn note_lasting(&mut self) {
        self.made += 1;
        self.now[1] = self.made;
    }

    /// Notes that the document is that of a number again.
    pub(crate) fn note_return(&mut self, to: u64) {
        if self.now[0] != to {
            self.made += 1;
            self.now[0] = to;
        }
    }

    /// The number of the document.
    pub(crate) fn document(&self) -> u64 {
        self.now[0]
    }

    /// Notes that the session has all edits.
    pub(crate) fn note_saved(&mut self) {
        self.saved = self.now;
    }

    /// Whether edits would be lost.
    pub fn unsaved(&self) -> bool {
        self.now != self.saved
    }

    /// Number of changes that were made: another one after each.
    pub(crate) fn made(&self) -> u64 {
        self.made
    }
}

#[cfg(test)]
mod tests {
    use crate::model::command::{Command, Edit, FilePurpose};
    use crate::model::document::{Neuron, SourceId};
    use crate::model::settings::Settings;
    use crate::model::state::{Dialog, Effect, State};
    use std::path::PathBuf;

    fn state() -> State {
        let mut state = State::new(Settings::default());
        let neuron = Neuron::new(SourceId(0), "n".into());
        state.document.neurons.push(neuron);
        state
    }

    fn asks(state: &mut State, command: Command) -> bool {
        state.layout.dialog = Dialog::Nothing;
        state.effects.clear();
        state.run(command);
        let asks = matches!(state.layout.dialog, Dialog::Unsaved(_));
        assert_eq!(asks, state.effects.is_empty());
        asks
    }

    #[test]
    fn what_is_only_opened_and_selected_is_left_without_a_question() {
        let mut state = state();
        state.run(Edit::Select(vec![0], false));
        state.run(Edit::SetReport(Some("report.h5".into())));
        state.run(Command::AskFiles(FilePurpose::Open));
        assert!(!state.changes.unsaved() && !asks(&mut state, Command::Quit));
        assert_eq!(state.effects, [Effect::Quit]);
    }

    #[test]
    fn edits_are_left_after_a_question_until_they_are_saved() {
        let mut state = state();
        state.run(Edit::SetGrid(true));
        assert!(asks(&mut state, Command::Quit));
        let session = vec![PathBuf::from("other.neurotess")];
        assert!(asks(&mut state, Command::Open(session.clone())));
        // Tracings are added to what is there.
        assert!(!asks(&mut state, Command::Open(vec!["cell.swc".into()])));
        for (command, effect) in [
            (Command::Quit, Effect::Quit),
            (Command::Open(session.clone()), Effect::Load(session)),
        ] {
            state.effects.clear();
            state.run(Command::Unasked(Box::new(command)));
            assert_eq!(state.effects, [effect]);
        }
        state.changes.note_saved();
        assert!(!asks(&mut state, Command::Quit));
        state.run(Command::Undo);
        assert!(
            asks(&mut state, Command::Quit),
            "the file has it the other way"
        );
        state.run(Command::Redo);
        assert!(!asks(&mut state, Command::Quit), "as it is in the file");
        state.run(Edit::Select(vec![0], false));
        state.run(Command::Undo);
        assert!(!asks(&mut state, Command::Quit), "a selection is no work");
        state.run(Command::AddKeyView);
        assert!(asks(&mut state, Command::Quit));
    }

    #[test]
    fn what_is_being_written_is_left_after_a_question() {
        let mut state = state();
        state.writing = true;
        assert!(asks(&mut state, Command::Quit));
    }
}
