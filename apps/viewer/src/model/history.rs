//! Undo and redo: earlier and later documents. They are small, since meshes are not part of them.

use crate::model::document::{Dimension, Document, Neuron, Trace};

/// Most edits that are kept.
const MOST: usize = 200;

/// Documents before and after the current one.
#[derive(Debug, Default)]
pub struct History {
    before: Vec<(&'static str, Document)>,
    after: Vec<(&'static str, Document)>,
    joining: Option<&'static str>,
}

impl History {
    /// Keeps the document before an edit. Joining edits of the same name in a row count as one.
    pub fn keep(&mut self, name: &'static str, document: Document, joins: bool) {
        self.after.clear();
        let goes_on = joins && self.joining == Some(name);
        self.joining = joins.then_some(name);
        if goes_on {
            return;
        }
        self.before.push((name, document));
        if self.before.len() > MOST {
            self.before.remove(0);
        }
    }

    /// The next edit does not join those before it, since a slider was released.
    pub fn end_joining(&mut self) {
        self.joining = None;
    }

    /// Replaces the document by that before the last edit; returns the edit's name.
    pub fn undo(&mut self, document: &mut Document) -> Option<&'static str> {
        let (name, before) = self.before.pop()?;
        self.after.push((name, std::mem::replace(document, before)));
        Some(name)
    }

    /// Reverts the last undo; returns the edit's name.
    pub fn redo(&mut self, document: &mut Document) -> Option<&'static str> {
        let (name, after) = self.after.pop()?;
        self.before.push((name, std::mem::replace(document, after)));
        Some(name)
    }

    /// Names of the edits that an undo and a redo would concern.
    pub fn names(&self) -> [Option<&'static str>; 2] {
        [&self.before, &self.after].map(|list| list.last().map(|(name, _)| *name))
    }

    /// Adds a neuron that was opened to all documents, so that an undo does not close it.
    pub fn opened(&mut self, neuron: &Neuron) {
        for (_, document) in self.before.iter_mut().chain(&mut self.after) {
            document.neurons.push(neuron.clone());
        }
    }

    /// Adds traces of a session that was opened to all documents.
    pub fn opened_traces(&mut self, traces: &[Trace]) {
        for (_, document) in self.before.iter_mut().chain(&mut self.after) {
            document.traces.extend_from_slice(traces);
        }
    }

    /// Adds dimensions of a session that was opened to all documents.
    pub fn opened_dimensions(&mut self, dimensions: &[Dimension]) {
        for (_, document) in self.before.iter_mut().chain(&mut self.after) {
            document.dimensions.extend_from_slice(dimensions);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::document::SourceId;

    #[test]
    fn drags_are_one_edit_and_opening_is_none() {
        let mut history = History::default();
        let mut document = Document::default();
        for level in 1..5 {
            history.keep("Detail", document.clone(), true);
            document.detail.level = level;
        }
        history.end_joining();
        history.keep("Detail", document.clone(), true);
        document.detail.level = 9;
        let neuron = Neuron::new(SourceId(0), "n".into());
        history.opened(&neuron);
        document.neurons.push(neuron);
        assert_eq!(history.undo(&mut document), Some("Detail"));
        assert_eq!((document.detail.level, document.neurons.len()), (4, 1));
        assert_eq!(history.undo(&mut document), Some("Detail"));
        assert_eq!(document.detail, Default::default());
        assert_eq!(history.undo(&mut document), None);
        assert_eq!(history.names(), [None, Some("Detail")]);
        history.redo(&mut document);
        history.redo(&mut document);
        assert_eq!(document.detail.level, 9);
    }
}
