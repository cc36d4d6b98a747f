//! The list of neurons, with a revision for each thing that others derive from it.

use std::ops::Deref;

use neurotess::render::Placement;

use super::Neuron;
use crate::model::ids::SourceId;
use crate::model::index_set::IndexSet;
use crate::model::revision::Revision;
use crate::model::shared_list::SharedList;

/// Neurons in the order of the list. They are read as a `SharedList`, and changed by methods that keep
/// revisions and counts up to date.
///
/// The history has a copy for each edit. Copies share what is equal, so that one of 100,000 neurons takes a few kB.
#[derive(Clone, Debug, Default)]
pub struct Neurons {
    list: SharedList<Neuron>,
    hidden: IndexSet,
    selected: IndexSet,
    clamped: IndexSet,
    sources: IndexSet,
    selected_sources: IndexSet,
    revisions: NeuronRevisions,
}

/// How a neuron shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NeuronState {
    /// Whether it is hidden.
    pub hidden: bool,
    /// Whether it is selected.
    pub selected: bool,
    /// Whether it is clamped: fine whatever the mode, also while the camera moves.
    pub clamped: bool,
}

/// Revisions of the list of neurons.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NeuronRevisions {
    /// Of the neurons, their order and their placements.
    pub members: Revision,
    /// Of which neurons are hidden.
    pub hidden: Revision,
    /// Of which neurons are selected.
    pub selection: Revision,
    /// Of which neurons are clamped.
    pub clamped: Revision,
}

impl Deref for Neurons {
    type Target = SharedList<Neuron>;

    fn deref(&self) -> &SharedList<Neuron> {
        &self.list
    }
}

impl PartialEq for Neurons {
    fn eq(&self, other: &Self) -> bool {
        let states = |of: &Self| [&of.hidden, &of.selected, &of.clamped].map(IndexSet::clone);
        self.revisions == other.revisions
            || (states(self) == states(other) && self.list == other.list)
    }
}

impl FromIterator<Neuron> for Neurons {
    fn from_iter<I: IntoIterator<Item = Neuron>>(neurons: I) -> Self {
        let mut list = Self::default();
        neurons.into_iter().for_each(|neuron| list.push(neuron));
        list
    }
}

impl Neurons {
    /// The current revisions.
    pub fn revisions(&self) -> NeuronRevisions {
        self.revisions
    }

    /// The hidden neurons.
    pub fn hidden(&self) -> &IndexSet {
        &self.hidden
    }

    /// The selected neurons.
    pub fn selected(&self) -> &IndexSet {
        &self.selected
    }

    /// The clamped neurons.
    pub fn clamped(&self) -> &IndexSet {
        &self.clamped
    }

    /// Whether there is a neuron of this index that is not hidden.
    pub fn shows(&self, index: usize) -> bool {
        index < self.len() && !self.hidden.contains(index)
    }

    /// How a neuron shows.
    pub fn state(&self, index: usize) -> NeuronState {
        NeuronState {
            hidden: self.hidden.contains(index),
            selected: self.selected.contains(index),
            clamped: self.clamped.contains(index),
        }
    }

    /// Whether all selected neurons are clamped; false without a selection.
    pub fn clamps_selected(&self) -> bool {
        !self.selected.is_empty() && self.clamped.has_all(&self.selected)
    }

    /// Clamps the selected neurons, or no longer.
    pub fn clamp_selected(&mut self, clamped: bool) {
        self.set_clamped(match clamped {
            true => self.clamped.with(&self.selected),
            false => self.clamped.without(&self.selected),
        });
    }

    /// Clamps no neuron any more.
    pub fn unclamp_all(&mut self) {
        self.set_clamped(IndexSet::default());
    }

    fn set_clamped(&mut self, clamped: IndexSet) {
        if self.clamped != clamped {
            self.clamped = clamped;
            self.revisions.clamped = Revision::next();
        }
    }

    /// Tracings of the neurons, each once, sorted.
    pub fn sources(&self) -> impl Iterator<Item = SourceId> {
        ids(&self.sources)
    }

    /// Tracings of the selected neurons, each once, sorted.
    pub fn selected_sources(&self) -> impl Iterator<Item = SourceId> {
        ids(&self.selected_sources)
    }

    /// Tracings that edits of cells are about: those of the selected neurons, or all if none is selected.
    pub fn meant_sources(&self) -> Vec<SourceId> {
        match self.selected.is_empty() {
            true => self.sources().collect(),
            false => self.selected_sources().collect(),
        }
    }

    /// Adds a neuron at the end.
    pub fn push(&mut self, neuron: Neuron) {
        self.push_as(neuron, NeuronState::default());
    }

    /// Adds a neuron at the end, hidden, selected or clamped.
    pub fn push_as(&mut self, neuron: Neuron, state: NeuronState) {
        let index = self.len();
        let source = neuron.source.0 as usize;
        self.sources.insert(source);
        if state.selected {
            self.selected.insert(index);
            self.selected_sources.insert(source);
        }
        if state.hidden {
            self.hidden.insert(index);
        }
        if state.clamped {
            self.clamped.insert(index);
        }
        self.list.push(neuron);
        self.stamp_all();
    }

    /// Adds other neurons at the end, as they are. Lists that have the same ones share them.
    pub fn append(&mut self, others: &Self) {
        if others.is_empty() {
            return;
        }
        let count = self.len();
        for (own, other) in [
            (&mut self.hidden, &others.hidden),
            (&mut self.selected, &others.selected),
            (&mut self.clamped, &others.clamped),
        ] {
            *own = own.with(&other.moved(count));
        }
        self.sources = self.sources.with(&others.sources);
        self.selected_sources = self.selected_sources.with(&others.selected_sources);
        self.list.append(&others.list);
        self.stamp_all();
    }

    /// Removes neurons.
    pub fn remove(&mut self, which: &IndexSet) {
        if which.first().is_none_or(|first| first >= self.len()) {
            return;
        }
        self.list = self.list.without(|index| which.contains(index));
        for set in [&mut self.hidden, &mut self.selected, &mut self.clamped] {
            *set = set.after_removal(which);
        }
        self.sources = self.list.iter().map(|n| n.source.0 as usize).collect();
        self.find_selected_sources();
        self.stamp_all();
    }

    /// Moves and turns neurons, by their indices.
    pub fn place(&mut self, places: &[(usize, Placement)]) {
        let mut moved = false;
        for &(index, placement) in places {
            // Those that stay are not copied.
            if self
                .list
                .get(index)
                .is_some_and(|n| n.placement != placement)
                && let Some(neuron) = self.list.get_mut(index)
            {
                neuron.placement = placement;
                moved = true;
            }
        }
        if moved {
            self.revisions.members = Revision::next();
        }
    }

    /// Hides these neurons only, and selects those only.
    pub(crate) fn set_states(&mut self, hidden: IndexSet, selected: IndexSet) {
        if self.hidden != hidden {
            self.hidden = hidden;
            self.revisions.hidden = Revision::next();
        }
        self.select(selected);
    }

    /// Selects these neurons only.
    pub fn select(&mut self, selected: IndexSet) {
        if self.selected != selected {
            self.selected = selected;
            self.find_selected_sources();
            self.revisions.selection = Revision::next();
        }
    }

    fn find_selected_sources(&mut self) {
        let selected = self.selected.iter().filter_map(|i| self.list.get(i));
        self.selected_sources = selected.map(|n| n.source.0 as usize).collect();
    }

    fn stamp_all(&mut self) {
        self.revisions = NeuronRevisions {
            members: Revision::next(),
            hidden: Revision::next(),
            selection: Revision::next(),
            clamped: Revision::next(),
        };
    }
}

fn ids(sources: &IndexSet) -> impl Iterator<Item = SourceId> {
    sources.iter().map(|id| SourceId(id as u32))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn neuron(i: u32) -> Neuron {
        Neuron::new(SourceId(i % 2), format!("n{i}"))
    }

    fn set(indices: &[usize]) -> IndexSet {
        indices.iter().copied().collect()
    }

    #[test]
    fn what_is_clamped_is_known_whatever_happens_to_the_list() {
        let mut neurons: Neurons = (0..4).map(neuron).collect();
        assert!(!neurons.clamps_selected());
        neurons.select(set(&[1, 3]));
        let before = neurons.revisions();
        neurons.clamp_selected(true);
        assert_eq!(neurons.clamped().to_vec(), [1, 3]);
        assert!(neurons.clamps_selected());
        let now = neurons.revisions();
        assert_ne!(now.clamped, before.clamped);
        assert_eq!(
            (now.members, now.selection),
            (before.members, before.selection)
        );
        neurons.clamp_selected(true);
        assert_eq!(neurons.revisions(), now, "nothing changed");
        neurons.select(set(&[0]));
        neurons.remove(&set(&[0]));
        let clamped = NeuronState {
            clamped: true,
            ..NeuronState::default()
        };
        neurons.push_as(neuron(9), clamped);
        assert_eq!(neurons.clamped().to_vec(), [0, 2, 3]);
        assert_eq!(neurons.state(3), clamped);
        neurons.unclamp_all();
        assert!(neurons.clamped().is_empty());
    }

    #[test]
    fn each_change_stamps_what_it_changes() {
        let mut neurons: Neurons = (0..4).map(neuron).collect();
        let before = neurons.clone();
        neurons.select(set(&[2]));
        let (old, now) = (before.revisions(), neurons.revisions());
        assert_eq!((old.members, old.hidden), (now.members, now.hidden));
        assert_ne!(old.selection, now.selection);
        assert_eq!(neurons.selected().only(), Some(2));
        assert_eq!(neurons.meant_sources(), [SourceId(0)]);
        neurons.set_states(set(&[2]), set(&[2]));
        assert_eq!(neurons.revisions().selection, now.selection);
        assert_ne!(neurons.revisions().hidden, now.hidden);
        assert!(neurons.hidden().len() == 1 && !neurons.shows(2) && !neurons.shows(4));
        let same = neurons.clone();
        neurons.set_states(set(&[2]), set(&[2]));
        assert_eq!(neurons.revisions(), same.revisions(), "nothing changed");
        neurons.remove(&set(&[2]));
        assert_eq!((neurons.len(), neurons.hidden().len()), (3, 0));
        assert!(neurons.selected().is_empty());
        assert_ne!(neurons.revisions().members, now.members);
        let before = neurons.revisions();
        let place = Placement {
            scale: 2.0,
            ..Placement::default()
        };
        neurons.place(&[(1, Placement::default()), (9, place)]);
        assert_eq!(neurons.revisions(), before, "it is there already");
        neurons.place(&[(1, place)]);
        assert_ne!(neurons.revisions().members, before.members);
        assert_eq!(neurons.revisions().hidden, before.hidden);
        neurons.push(neuron(7));
        assert_eq!(neurons.meant_sources(), [SourceId(0), SourceId(1)]);
    }

    #[test]
    fn appended_neurons_keep_how_they_show() {
        let all = NeuronState {
            hidden: true,
            selected: false,
            clamped: true,
        };
        let mut others = Neurons::default();
        others.push(neuron(5));
        others.push_as(neuron(6), all);
        let mut neurons: Neurons = (0..3).map(|i| neuron(2 * i)).collect();
        neurons.append(&others);
        assert_eq!((neurons.len(), neurons.state(4)), (5, all));
        assert_eq!(neurons.state(3), NeuronState::default());
        assert_eq!(neurons.sources().count(), 2);
    }
}
