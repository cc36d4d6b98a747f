//! Undo and redo: earlier and later documents. They are small, since meshes are not part of them, and what is equal in
//! two documents is shared by them.

use crate::model::document::{Dimension, Document, Neurons, Trace};

/// Most edits that are kept.
const MOST: usize = 200;

/// Documents before and after the current one.
#[derive(Debug, Default)]
pub struct History {
    before: Vec<Step>,
    after: Vec<Step>,
    joining: Option<&'static str>,
}

/// A document, with its number among all that there were, and the name of the edit beside it.
#[derive(Debug)]
struct Step {
    name: &'static str,
    document: Document,
    number: u64,
}

impl History {
    /// Keeps the document before an edit, with its number. Joining edits of the same name in a row count as one.
    pub fn keep(&mut self, name: &'static str, (document, number): (Document, u64), joins: bool) {
        self.after.clear();
        let goes_on = joins && self.joining == Some(name);
        self.joining = joins.then_some(name);
        if goes_on {
            return;
        }
        self.before.push(Step {
            name,
            document,
            number,
        });
        if self.before.len() > MOST {
            self.before.remove(0);
        }
    }

    /// The next edit does not join those before it, since a slider was released.
    pub fn end_joining(&mut self) {
        self.joining = None;
    }

    /// Replaces the document and its number by those before the last edit; returns the edit's name.
    pub fn undo(&mut self, document: &mut Document, number: &mut u64) -> Option<&'static str> {
        let mut step = self.before.pop()?;
        let name = step.exchange(document, number);
        self.after.push(step);
        Some(name)
    }

    /// Reverts the last undo; returns the edit's name.
    pub fn redo(&mut self, document: &mut Document, number: &mut u64) -> Option<&'static str> {
        let mut step = self.after.pop()?;
        let name = step.exchange(document, number);
        self.before.push(step);
        Some(name)
    }

    /// Names of the edits that an undo and a redo would concern.
    pub fn names(&self) -> [Option<&'static str>; 2] {
        [&self.before, &self.after].map(|list| list.last().map(|step| step.name))
    }

    /// Adds neurons that were opened to all documents, so that an undo does not close them.
    pub fn opened(&mut self, neurons: &Neurons) {
        for Step { document, .. } in self.before.iter_mut().chain(&mut self.after) {
            document.neurons.append(neurons);
        }
    }

    /// Adds traces of a session that was opened to all documents.
    pub fn opened_traces(&mut self, traces: &[Trace]) {
        for Step { document, .. } in self.before.iter_mut().chain(&mut self.after) {
            document.traces.extend_from_slice(traces);
        }
    }

    /// Adds dimensions of a session that was opened to all documents.
    pub fn opened_dimensions(&mut self, dimensions: &[Dimension]) {
        for Step { document, .. } in self.before.iter_mut().chain(&mut self.after) {
            document.dimensions.extend_from_slice(dimensions);
        }
    }
}

impl Step {
    /// Exchanges its document with the current one; returns the edit's name.
    fn exchange(&mut self, document: &mut Document, number: &mut u64) -> &'static str {
        std::mem::swap(&mut self.document, document);
        std::mem::swap(&mut self.number, number);
        self.name
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::command::{Command, Edit};
    use crate::model::document::{Neuron, SourceId};
    use crate::model::settings::Settings;
    use crate::model::state::State;

    #[test]
    fn drags_are_one_edit_and_opening_is_none() {
        let mut history = History::default();
        let (mut document, mut number) = (Document::default(), 7);
        for level in 1..5 {
            history.keep("Detail", (document.clone(), number), true);
            number += 1;
            document.detail.level = level;
        }
        history.end_joining();
        history.keep("Detail", (document.clone(), number), true);
        document.detail.level = 9;
        let neurons = Neurons::from_iter([Neuron::new(SourceId(0), "n".into())]);
        history.opened(&neurons);
        document.neurons.append(&neurons);
        assert_eq!(history.undo(&mut document, &mut number), Some("Detail"));
        assert_eq!((document.detail.level, document.neurons.len()), (4, 1));
        assert_eq!(history.undo(&mut document, &mut number), Some("Detail"));
        assert_eq!((document.detail, number), (Default::default(), 7));
        assert_eq!(history.undo(&mut document, &mut number), None);
        assert_eq!(history.names(), [None, Some("Detail")]);
        history.redo(&mut document, &mut number);
        history.redo(&mut document, &mut number);
        assert_eq!(document.detail.level, 9);
    }

    #[test]
    fn documents_that_differ_by_what_is_selected_share_their_neurons() {
        // Each had a copy of its own: 200 clicks beside 100,000 neurons took 4 GB.
        let neuron = |i: u32| Neuron::new(SourceId(i % 7), format!("n{i}"));
        let mut state = State::new(Settings::default());
        state.document.neurons = (0..1000).map(neuron).collect();
        for i in 0..MOST {
            state.run(Edit::Select(vec![i], false));
        }
        state.run(Edit::Hide);
        let shared = |state: &State| {
            let steps = state.history.before.iter().chain(&state.history.after);
            let lists = steps.map(|step| &step.document.neurons);
            let is_shared = |list: &&Neurons| list.is_shared_with(&state.document.neurons);
            lists.filter(is_shared).count()
        };
        assert_eq!(shared(&state), MOST);
        let opened: Neurons = (0..300).map(neuron).collect();
        state.history.opened(&opened);
        state.document.neurons.append(&opened);
        for i in (0..MOST).rev() {
            state.run(Command::Undo);
            let selected = state.document.neurons.selected().only();
            assert_eq!((selected, state.document.neurons.len()), (Some(i), 1300));
        }
    }
}
