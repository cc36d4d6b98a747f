//! Cells that are moved, turned and copied in the window; and the presentation.

use glam::DVec3;
use neurotess::render::Placement;

use super::{Effect, State};
use crate::model::command::Edit;
use crate::model::placing::{Drag, Handle, Placing};
use crate::model::sources::extent;

/// Space between a copy and what it was copied of, as a share of their width.
const BESIDE: f64 = 1.1;

impl State {
    /// Where a neuron is (µm): its soma, or where its first neurite begins.
    pub fn middle_of(&self, neuron: usize) -> Option<DVec3> {
        let morphology = &self.source_of(neuron)?.morphology;
        let soma = morphology.soma().map(|soma| soma.center);
        let first = morphology.points.first().map(|point| point.position);
        let place = morphology.origin + soma.or(first).unwrap_or_default().as_dvec3();
        Some(self.placements().get(neuron)?.world_from_cell(place))
    }

    /// Where the handles of the selected cells are (µm): in the middle of their somata. None while they do not
    /// show.
    pub fn pivot(&self) -> Option<DVec3> {
        self.placing.as_ref()?;
        if self.document.grid {
            return None;
        }
        let places = self.document.selected().filter_map(|n| self.middle_of(n));
        let (sum, count) = places.fold((DVec3::ZERO, 0), |(sum, n), place| (sum + place, n + 1));
        (count > 0).then(|| sum / f64::from(count))
    }

    /// Shows or hides the handles.
    pub(super) fn set_placing(&mut self, on: bool) {
        self.placing = on.then(Placing::default);
        if on {
            self.measuring = None;
        }
        self.status = match (on, self.document.grid, self.document.neurons.selected()) {
            (false, ..) => "Cells stay where they are".into(),
            (true, true, _) => {
                "Side by side, cells cannot be moved: G places them as traced".into()
            }
            (true, false, []) => "Select the cells to move or turn".into(),
            (true, false, _) => "Drag an arrow to move, a ring to turn".into(),
        };
    }

    /// Begins to drag a handle.
    pub(crate) fn begin_placing(&mut self, handle: Handle, from: [f64; 2], size: [f64; 2]) {
        let (Some(pivot), view) = (self.pivot(), self.view) else {
            return;
        };
        let neurons = &self.document.neurons;
        let before = neurons
            .selected()
            .iter()
            .map(|&i| (i, neurons[i].placement));
        let drag = Drag {
            handle,
            from,
            size,
            view,
            pivot,
            before: before.collect(),
        };
        if let Some(placing) = &mut self.placing {
            placing.drag = Some(drag);
        }
    }

    /// Copies the selected cells beside them.
    pub(super) fn duplicate(&mut self) {
        let count = self.document.neurons.selected().len();
        if count == 0 {
            self.status = "Select the cells to copy".into();
            return;
        }
        let (low, high) = extent(&self.outline(|n| n.selected));
        let width = BESIDE * (high - low).x.max(0.0);
        self.run(Edit::Duplicate(DVec3::X * width));
        self.status = match count {
            1 => "A copy is beside it: P moves and turns it".into(),
            n => format!("{n} copies are beside them: P moves and turns them"),
        };
    }

    /// Puts the selected cells back.
    pub(super) fn put_back(&mut self) {
        let neurons = &self.document.neurons;
        let back: Vec<(usize, Placement)> = neurons
            .selected()
            .iter()
            .map(|&i| (i, neurons[i].traced))
            .filter(|&(i, traced)| neurons[i].placement != traced)
            .collect();
        self.status = match back.len() {
            0 => "None of the selected cells was moved".into(),
            n => format!("{n} put back"),
        };
        if !back.is_empty() {
            self.run(Edit::Place(back));
            self.history.end_joining();
        }
    }

    /// Begins or ends a presentation.
    pub(super) fn present(&mut self, on: bool) {
        (self.presenting, self.turning) = (on, on);
        self.fill_screen(on);
    }

    /// Fills the screen, or leaves it.
    pub(super) fn fill_screen(&mut self, on: bool) {
        if self.full_screen != on {
            self.full_screen = on;
            self.effects.push(Effect::FullScreen(on));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::load;
    use crate::model::command::Command;
    use crate::model::document::{Neuron, SomaEdit};
    use crate::model::settings::Settings;
    use crate::model::sources;

    fn state() -> State {
        let mut state = State::new(Settings::default());
        let star = sources::sample(neurotess::synth::Kind::Star);
        let source = load::load(&star, SomaEdit::default(), None).expect("grown");
        let id = state.sources.add(source);
        for name in ["one", "two"] {
            state.document.neurons.push(Neuron::new(id, name.into()));
        }
        state.run(Edit::Select(vec![1], false));
        state
    }

    #[test]
    fn copies_are_beside_selected_and_undone() {
        let mut state = state();
        state.run(Command::Duplicate);
        let neurons = &state.document.neurons;
        assert_eq!((neurons.len(), neurons.selected()), (3, &[2][..]));
        assert_eq!(neurons[2].name, "two (copy)");
        assert!(neurons[2].placement.translation.x > 10.0);
        assert_eq!(neurons[2].source, neurons[1].source);
        let all = state.outline(|n| n.name == "two");
        let right = extent(&all).1.x;
        let left = extent(&state.outline(|n| n.name == "two (copy)")).0.x;
        assert!(left > right, "they do not overlap: {left} {right}");
        state.run(Command::Undo);
        assert_eq!(state.document.neurons.len(), 2);
        state.run(Edit::SelectNone);
        state.run(Command::Duplicate);
        assert_eq!(state.document.neurons.len(), 2);
    }

    #[test]
    fn handles_show_at_the_selected_cells_only_where_they_were_traced() {
        let mut state = state();
        assert_eq!(state.pivot(), None);
        state.run(Command::SetPlacing(true));
        let soma = state.middle_of(1).expect("a soma");
        assert_eq!(state.pivot(), Some(soma));
        state.run(Edit::SetGrid(true));
        assert_eq!(state.pivot(), None);
        state.run(Edit::SetGrid(false));
        state.run(Edit::SelectNone);
        assert_eq!(state.pivot(), None);
    }

    #[test]
    fn cells_are_put_back_to_where_they_were_traced() {
        let mut state = state();
        let away = Placement {
            translation: DVec3::splat(7.0),
            ..Placement::default()
        };
        for x in [1.0, 2.0, 7.0] {
            let translation = DVec3::splat(x);
            let place = Placement {
                translation,
                ..away
            };
            state.run(Edit::Place(vec![(1, place)]));
        }
        assert_eq!(state.document.neurons[1].placement, away);
        state.history.end_joining();
        state.run(Command::PutBack);
        assert_eq!(state.document.neurons[1].placement, Placement::default());
        state.run(Command::Undo);
        assert_eq!(state.document.neurons[1].placement, away);
        // A drag is one edit.
        state.run(Command::Undo);
        assert_eq!(state.document.neurons[1].placement, Placement::default());
        state.run(Edit::SelectNone);
        state.run(Command::PutBack);
        assert!(state.status.starts_with("None"));
    }
}
