//! Cells that are moved, turned and copied in the window; and the presentation.

use glam::DVec3;
use neurotess::render::Placement;

use super::{Effect, State};
use crate::model::command::Edit;
use crate::model::placing::{self, Drag, Handle, PlaceNumbers, Placing};
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
        self.tools.placing.as_ref()?;
        self.middle_of_selected()
    }

    /// The middle (µm) of the somata of the selected cells; none side by side, where cells cannot be moved.
    fn middle_of_selected(&self) -> Option<DVec3> {
        if self.document.grid {
            return None;
        }
        let places = self.document.selected().filter_map(|n| self.middle_of(n));
        let (sum, count) = places.fold((DVec3::ZERO, 0), |(sum, n), place| (sum + place, n + 1));
        (count > 0).then(|| sum / f64::from(count))
    }

    /// Where the selected cells are, in numbers; none if there are none, or they cannot be moved.
    pub fn place_numbers(&self) -> Option<PlaceNumbers> {
        let position = self.middle_of_selected()?;
        let first = self.document.neurons.selected().first()?;
        let rotation = self.document.neurons.get(first)?.placement.rotation;
        // One rotation has many angles: those that were typed stay.
        let typed = self.tools.typed_angles;
        let typed = typed.filter(|&typed| placing::rotation(typed).angle_between(rotation) < 1e-6);
        Some(PlaceNumbers {
            position,
            rotation: typed.unwrap_or_else(|| placing::degrees(rotation)),
        })
    }

    /// What moves and turns the selected cells, together, to where they are by other numbers.
    pub(crate) fn placed_at(&mut self, numbers: PlaceNumbers) -> Option<Edit> {
        let now = self.place_numbers()?;
        self.tools.typed_angles = Some(numbers.rotation);
        let turn = placing::rotation(numbers.rotation) * placing::rotation(now.rotation).inverse();
        let turns = numbers.rotation != now.rotation;
        let neurons = &self.document.neurons;
        let places = neurons.selected().iter().map(|neuron| {
            let before = neurons[neuron].placement;
            let mut place = match turns {
                true => placing::turned(&before, now.position, turn),
                false => before,
            };
            place.translation += numbers.position - now.position;
            (neuron, place)
        });
        Some(Edit::Place(places.collect()))
    }

    /// Shows or hides the handles.
    pub(super) fn set_placing(&mut self, on: bool) {
        // Side by side it would do nothing.
        let possible = on && !self.document.grid;
        self.tools.placing = possible.then(Placing::default);
        if possible {
            self.tools.measuring = None;
        }
        let any = !self.document.neurons.selected().is_empty();
        self.messages.status = match (on, self.document.grid, any) {
            (false, ..) => "Cells stay where they are".into(),
            (true, true, _) => {
                "Side by side, cells cannot be moved: G places them as traced".into()
            }
            (true, false, false) => "Select the cells to move or turn".into(),
            (true, false, true) => "Drag an arrow to move, a ring to turn".into(),
        };
    }

    /// Begins to drag a handle.
    pub(crate) fn begin_placing(&mut self, handle: Handle, from: [f64; 2], size: [f64; 2]) {
        let (Some(pivot), view) = (self.pivot(), self.view) else {
            return;
        };
        let neurons = &self.document.neurons;
        let before = neurons.selected().iter().map(|i| (i, neurons[i].placement));
        let drag = Drag {
            handle,
            from,
            size,
            view,
            pivot,
            before: before.collect(),
        };
        if let Some(placing) = &mut self.tools.placing {
            placing.drag = Some(drag);
        }
    }

    /// Copies the selected cells beside them.
    pub(super) fn duplicate(&mut self) {
        let count = self.document.neurons.selected().len();
        if count == 0 {
            self.messages.status = "Select the cells to copy".into();
            return;
        }
        let (low, high) = extent(&self.outline(|i| self.document.neurons.selected().contains(i)));
        let width = BESIDE * (high - low).x.max(0.0);
        self.run(Edit::Duplicate(DVec3::X * width));
        self.messages.status = match count {
            _ if self.document.grid => "Copied; G places cells as traced, then P moves them".into(),
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
            .map(|i| (i, neurons[i].traced))
            .filter(|&(i, traced)| neurons[i].placement != traced)
            .collect();
        self.messages.status = match back.len() {
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
        (self.layout.presenting, self.views.turning) = (on, on);
        self.fill_screen(on);
    }

    /// Fills the screen, or leaves it.
    pub(super) fn fill_screen(&mut self, on: bool) {
        if self.layout.full_screen != on {
            self.layout.full_screen = on;
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
    fn numbers_place_cells_about_their_somata() {
        let mut state = state();
        let begin = state.place_numbers().expect("one is selected");
        assert_eq!(begin.rotation, DVec3::ZERO);
        let to = PlaceNumbers {
            position: DVec3::new(100.0, -20.0, 5.0),
            // Beyond a quarter turn about y, where angles are not those that a rotation gives back.
            rotation: DVec3::new(30.0, 120.0, -45.0),
        };
        let edit = state.placed_at(to).expect("an edit");
        state.run(edit);
        let now = state.place_numbers().expect("numbers");
        assert!(now.position.distance(to.position) < 1e-9, "{now:?}");
        assert_eq!(now.rotation, to.rotation);
        assert_eq!(state.document.neurons[0].placement, Placement::default());
        // Two together: their distance stays.
        state.run(Edit::SelectAll);
        let apart = |state: &State| {
            let [a, b] = [0, 1].map(|n| state.middle_of(n).expect("a soma"));
            a.distance(b)
        };
        let before = (apart(&state), state.place_numbers().expect("numbers"));
        let edit = state.placed_at(PlaceNumbers {
            rotation: DVec3::new(0.0, 0.0, 90.0),
            ..before.1
        });
        state.run(edit.expect("an edit"));
        assert!((apart(&state) - before.0).abs() < 1e-9);
        let now = state.place_numbers().expect("numbers");
        assert!(now.position.distance(before.1.position) < 1e-9);
        let x = state.document.neurons[0].placement.rotation * DVec3::X;
        assert!(x.distance(DVec3::Y) < 1e-9, "{x}");
        // Side by side, nothing is placed.
        state.run(Edit::SetGrid(true));
        assert_eq!(state.place_numbers(), None);
    }

    #[test]
    fn copies_are_beside_selected_and_undone() {
        let mut state = state();
        state.run(Command::Duplicate);
        let neurons = &state.document.neurons;
        assert_eq!((neurons.len(), neurons.selected().only()), (3, Some(2)));
        assert_eq!(neurons[2].name, "two (copy)");
        assert!(neurons[2].placement.translation.x > 10.0);
        assert_eq!(neurons[2].source, neurons[1].source);
        let all = state.outline(|i| i == 1);
        let right = extent(&all).1.x;
        let left = extent(&state.outline(|i| i == 2)).0.x;
        assert!(left > right, "they do not overlap: {left} {right}");
        state.run(Command::Undo);
        assert_eq!(state.document.neurons.len(), 2);
        state.run(Edit::SelectNone);
        state.run(Command::Duplicate);
        assert_eq!(state.document.neurons.len(), 2);
    }

    #[test]
    fn side_by_side_and_copies_are_in_the_picture() {
        for fitted in [true, false] {
            for command in [Command::Duplicate, Edit::SetGrid(true).into()] {
                let mut state = state();
                state.view = state.fit(neurotess::render::Side::Front);
                state.views.fitted = fitted.then_some(neurotess::render::Side::Front);
                state.run(command.clone());
                let [Effect::Go(view)] = state.effects[..] else {
                    panic!("{command:?} does not fit the camera");
                };
                let (low, high) = extent(&state.outline(|_| true));
                let middle = (low + high) / 2.0;
                let away = view.camera().target().distance(middle);
                assert!(away < 0.1 * (high - low).length(), "{command:?}: {away}");
                assert_eq!(state.views.fitted.is_some(), fitted);
            }
        }
    }

    #[test]
    fn handles_are_refused_side_by_side_and_do_not_wait() {
        let mut state = state();
        state.run(Edit::SetGrid(true));
        state.run(Command::SetPlacing(true));
        assert!(state.tools.placing.is_none() && state.messages.status.contains("cannot be moved"));
        state.run(Command::Duplicate);
        assert!(
            !state.messages.status.contains("P moves and"),
            "{}",
            state.messages.status
        );
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
        assert!(state.messages.status.starts_with("None"));
    }
}
