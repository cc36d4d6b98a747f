//! The list of neurons, with a revision for each thing that others derive from it.

use std::ops::Deref;

use neurotess::render::Placement;

use super::Neuron;
use crate::model::ids::SourceId;
use crate::model::revision::Revision;

/// Neurons in the order of the list. They are read as a slice, and changed by methods that keep
/// revisions and counts up to date.
#[derive(Clone, Debug, Default)]
pub struct Neurons {
    list: Vec<Neuron>,
    selected: Vec<usize>,
    hidden: usize,
    clamped: Vec<usize>,
    sources: Vec<SourceId>,
    selected_sources: Vec<SourceId>,
    revisions: NeuronRevisions,
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
    type Target = [Neuron];

    fn deref(&self) -> &[Neuron] {
        &self.list
    }
}

impl PartialEq for Neurons {
    fn eq(&self, other: &Self) -> bool {
        self.revisions == other.revisions || self.list == other.list
    }
}

impl<'a> IntoIterator for &'a Neurons {
    type Item = &'a Neuron;
    type IntoIter = std::slice::Iter<'a, Neuron>;

    fn into_iter(self) -> Self::IntoIter {
        self.list.iter()
    }
}

impl FromIterator<Neuron> for Neurons {
    fn from_iter<I: IntoIterator<Item = Neuron>>(neurons: I) -> Self {
        let mut list = Self {
            list: neurons.into_iter().collect(),
            ..Self::default()
        };
        list.members_changed();
        list
    }
}

impl Neurons {
    /// The current revisions.
    pub fn revisions(&self) -> NeuronRevisions {
        self.revisions
    }

    /// Indices of the selected neurons, ascending.
    pub fn selected(&self) -> &[usize] {
        &self.selected
    }

    /// Number of hidden neurons.
    pub fn hidden(&self) -> usize {
        self.hidden
    }

    /// Indices of the clamped neurons, ascending.
    pub fn clamped(&self) -> &[usize] {
        &self.clamped
    }

    /// Whether all selected neurons are clamped; false without a selection.
    pub fn clamps_selected(&self) -> bool {
        !self.selected.is_empty() && self.selected.iter().all(|&i| self.list[i].clamped)
    }

    /// Clamps the selected neurons, or no longer.
    pub fn clamp_selected(&mut self, clamped: bool) {
        let mut changes = false;
        for &index in &self.selected {
            changes |= self.list[index].clamped != clamped;
            self.list[index].clamped = clamped;
        }
        if changes {
            self.find_clamped();
            self.revisions.clamped = Revision::next();
        }
    }

    /// Clamps no neuron any more.
    pub fn unclamp_all(&mut self) {
        if !self.clamped.is_empty() {
            self.list
                .iter_mut()
                .for_each(|neuron| neuron.clamped = false);
            self.clamped.clear();
            self.revisions.clamped = Revision::next();
        }
    }

    /// Tracings of the neurons, each once, sorted.
    pub fn sources(&self) -> &[SourceId] {
        &self.sources
    }

    /// Tracings of the selected neurons, each once, sorted.
    pub fn selected_sources(&self) -> &[SourceId] {
        &self.selected_sources
    }

    /// Adds a neuron at the end.
    pub fn push(&mut self, neuron: Neuron) {
        if let Err(at) = self.sources.binary_search(&neuron.source) {
            self.sources.insert(at, neuron.source);
        }
        if neuron.selected {
            self.selected.push(self.list.len());
            if let Err(at) = self.selected_sources.binary_search(&neuron.source) {
                self.selected_sources.insert(at, neuron.source);
            }
        }
        self.hidden += usize::from(neuron.hidden);
        if neuron.clamped {
            self.clamped.push(self.list.len());
        }
        self.list.push(neuron);
        self.stamp_all();
    }

    /// Keeps the neurons for which `keeps` is true.
    pub fn retain(&mut self, keeps: impl FnMut(&Neuron) -> bool) {
        let before = self.list.len();
        self.list.retain(keeps);
        if self.list.len() != before {
            self.members_changed();
        }
    }

    /// Moves and turns neurons, by their indices.
    pub fn place(&mut self, places: &[(usize, Placement)]) {
        let mut moved = false;
        for &(index, placement) in places {
            if let Some(neuron) = self.list.get_mut(index) {
                moved |= neuron.placement != placement;
                neuron.placement = placement;
            }
        }
        if moved {
            self.revisions.members = Revision::next();
        }
    }

    /// Hides and selects neurons: `state` returns for each whether it is hidden and whether it is
    /// selected.
    pub fn set_states(&mut self, mut state: impl FnMut(usize, &Neuron) -> (bool, bool)) {
        let (mut hides, mut selects) = (false, false);
        for (i, neuron) in self.list.iter_mut().enumerate() {
            let (hidden, selected) = state(i, neuron);
            hides |= neuron.hidden != hidden;
            selects |= neuron.selected != selected;
            (neuron.hidden, neuron.selected) = (hidden, selected);
        }
        if hides {
            self.hidden = self.list.iter().filter(|n| n.hidden).count();
            self.revisions.hidden = Revision::next();
        }
        if selects {
            self.find_selected();
            self.revisions.selection = Revision::next();
        }
    }

    fn members_changed(&mut self) {
        self.hidden = self.list.iter().filter(|n| n.hidden).count();
        self.sources = distinct(self.list.iter());
        self.find_selected();
        self.find_clamped();
        self.stamp_all();
    }

    fn find_clamped(&mut self) {
        let neurons = self.list.iter().enumerate();
        let clamped = neurons.filter(|(_, n)| n.clamped).map(|(i, _)| i);
        self.clamped = clamped.collect();
    }

    fn find_selected(&mut self) {
        let neurons = self.list.iter().enumerate();
        self.selected = neurons
            .filter(|(_, n)| n.selected)
            .map(|(i, _)| i)
            .collect();
        self.selected_sources = distinct(self.list.iter().filter(|n| n.selected));
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

fn distinct<'a>(neurons: impl Iterator<Item = &'a Neuron>) -> Vec<SourceId> {
    let mut sources: Vec<SourceId> = neurons.map(|n| n.source).collect();
    sources.sort_unstable();
    sources.dedup();
    sources
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_clamped_is_known_whatever_happens_to_the_list() {
        let neuron = |i: u32| Neuron::new(SourceId(i), format!("n{i}"));
        let mut neurons: Neurons = (0..4).map(neuron).collect();
        assert!(!neurons.clamps_selected());
        neurons.set_states(|i, n| (n.hidden, i % 2 == 1));
        let before = neurons.revisions();
        neurons.clamp_selected(true);
        assert_eq!(
            (neurons.clamped(), neurons.clamps_selected()),
            (&[1, 3][..], true)
        );
        let now = neurons.revisions();
        assert_ne!(now.clamped, before.clamped);
        assert_eq!(
            (now.members, now.selection),
            (before.members, before.selection)
        );
        neurons.clamp_selected(true);
        assert_eq!(neurons.revisions(), now, "nothing changed");
        neurons.set_states(|i, n| (n.hidden, i == 0));
        neurons.retain(|n| !n.selected);
        neurons.push(Neuron {
            clamped: true,
            ..neuron(9)
        });
        assert_eq!(neurons.clamped(), [0, 2, 3]);
        neurons.unclamp_all();
        assert!(neurons.clamped().is_empty() && neurons.iter().all(|n| !n.clamped));
    }

    #[test]
    fn each_change_stamps_what_it_changes() {
        let neuron = |i: u32| Neuron::new(SourceId(i % 2), format!("n{i}"));
        let mut neurons: Neurons = (0..4).map(neuron).collect();
        let before = neurons.clone();
        neurons.set_states(|i, n| (n.hidden, i == 2));
        let (old, now) = (before.revisions(), neurons.revisions());
        assert_eq!((old.members, old.hidden), (now.members, now.hidden));
        assert_ne!(old.selection, now.selection);
        assert_eq!(
            (neurons.selected(), neurons.selected_sources()),
            (&[2][..], &[SourceId(0)][..])
        );
        neurons.set_states(|i, n| (i == 2, n.selected));
        assert_eq!(neurons.revisions().selection, now.selection);
        assert_ne!(neurons.revisions().hidden, now.hidden);
        assert_eq!(neurons.hidden(), 1);
        let same = neurons.clone();
        neurons.set_states(|_, n| (n.hidden, n.selected));
        assert_eq!(neurons.revisions(), same.revisions(), "nothing changed");
        neurons.retain(|n| !n.selected);
        assert_eq!(
            (neurons.len(), neurons.hidden(), neurons.selected().len()),
            (3, 0, 0)
        );
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
        assert_eq!(neurons.sources(), [SourceId(0), SourceId(1)]);
    }
}
