//! Views: of everything, of the selection, and saved ones, with their commands in the menus.

use neurotess::render::Side;

use super::{CellPart, Effect, State};
use crate::model::command::{Command, Edit, Listed, listed};
use crate::model::document::SavedView;
use crate::model::picture::ToldPicture;
use crate::model::sources::extent;
use crate::model::split::Split;
use crate::model::view::View;

/// Views beside the current one, and how it came to be.
#[derive(Clone, Debug)]
pub struct Views {
    /// The side from which the view shows everything, until it is moved by hand.
    pub fitted: Option<Side>,
    /// The other one of two views side by side.
    pub split: Option<Split>,
    /// Views of a film.
    pub key_views: Vec<View>,
    /// The view that levels are frozen for.
    pub frozen: Option<View>,
    /// Whether the scene turns slowly.
    pub turning: bool,
    /// Width by height of the picture.
    pub aspect: f64,
}

impl Default for Views {
    fn default() -> Self {
        Self {
            fitted: None,
            split: None,
            key_views: Vec::new(),
            frozen: None,
            turning: false,
            aspect: 1.0,
        }
    }
}

impl State {
    /// The view of everything from a side.
    pub(super) fn fit(&self, side: Side) -> View {
        let mut spheres = self.outline(|_| true);
        spheres.extend(self.sphere_of_points());
        spheres.extend(self.mesh_points(false));
        self.view
            .fitted(side, self.document.y_down, self.views.aspect, &spheres)
    }

    /// Adapts the view to another aspect ratio, so that the same things stay in the picture.
    /// Returns the view if it has changed.
    pub(crate) fn reshape(&mut self, aspect: f64) -> Option<View> {
        let before = std::mem::replace(&mut self.views.aspect, aspect);
        if before == aspect || self.document.neurons.is_empty() {
            return None;
        }
        Some(match self.views.fitted {
            Some(side) => self.fit(side),
            None => self.view.reshaped(before, aspect),
        })
    }

    /// Looks at everything, from where the camera is: cells are elsewhere now.
    pub(super) fn show_all(&mut self) {
        if let Some(side) = self.views.fitted {
            self.effects.push(Effect::Go(self.fit(side)));
            return;
        }
        let spheres = self.outline(|_| true);
        if !spheres.is_empty() {
            let (low, high) = extent(&spheres);
            let sphere = ((low + high) / 2.0, (high - low).length() / 2.0);
            self.effects.push(Effect::Go(self.view.focused(sphere)));
        }
    }

    /// What is shown, in the words of options.
    pub(crate) fn told(&self) -> ToldPicture {
        // With y downwards, other sides show the same.
        let fitted = self.views.fitted.filter(|_| !self.document.y_down);
        ToldPicture {
            fitted: fitted.map(|side| (side, self.view)),
            ..ToldPicture::of(&self.document)
        }
    }

    /// Looks at the selection, or at everything if nothing is selected. A soma that was clicked is what is selected
    /// of its cell; a click on a neurite selects the whole cell.
    pub(super) fn focus(&mut self) {
        let soma = self.pointing.picked.filter(|picked| {
            let only = self.document.neurons.selected().only() == Some(picked.neuron);
            only && picked.part == CellPart::Soma
        });
        if let Some(sphere) = soma.and_then(|soma| self.part_sphere(soma)) {
            self.run(Command::Go(self.view.focused(sphere)));
            return;
        }
        let selected = self.document.neurons.selected();
        let spheres = self.outline(|i| selected.is_empty() || selected.contains(i));
        let (low, high) = extent(&spheres);
        if !spheres.is_empty() {
            let sphere = ((low + high) / 2.0, (high - low).length() / 2.0);
            self.run(Command::Go(self.view.focused(sphere)));
        }
    }

    /// Saves the current view under a name of its own.
    pub(super) fn save_view(&mut self) {
        let saved = SavedView::new(self.view, &self.document.saved_views);
        let name = saved.name.clone();
        self.run(Edit::SaveView(saved));
        self.messages.status = format!("Saved as '{name}' (Look, View)");
    }

    /// Goes to a saved view.
    pub(super) fn go_to_saved(&mut self, index: usize) {
        match self.document.saved_views.get(index) {
            Some(saved) => {
                self.messages.status = format!("View '{}'", saved.name);
                self.effects.push(Effect::Go(saved.view));
                self.views.fitted = None;
            }
            None => self.messages.status = "No view is saved there: V saves this one".into(),
        }
    }

    /// All commands that need no further input, by menu, with the saved views by their names.
    pub fn menus(&self) -> Vec<(&'static str, Vec<Listed>)> {
        let mut menus = listed(&self.toggles());
        for (_, items) in &mut menus {
            let is_saved = |item: &Listed| matches!(item.command, Command::GoSaved(_));
            let Some(first) = items.iter().position(is_saved) else {
                continue;
            };
            let keys: Vec<_> = items.extract_if(.., |item| is_saved(item)).collect();
            let views = self.document.saved_views.iter().enumerate();
            let views = views.map(|(index, saved)| Listed {
                title: format!("{} (saved view)", saved.name).into(),
                words: "",
                keys: keys.get(index).and_then(|item| item.keys),
                command: Command::GoSaved(index),
                begins: index == 0,
            });
            items.splice(first..first, views);
        }
        menus
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::model::settings::Settings;

    fn saved(state: &State) -> Vec<(String, bool)> {
        let menus = state.menus().into_iter().flat_map(|(_, items)| items);
        let saved = menus.filter(|item| matches!(item.command, Command::GoSaved(_)));
        saved
            .map(|item| (item.title.into_owned(), item.keys.is_some()))
            .collect()
    }

    #[test]
    fn views_are_saved_named_found_and_forgotten() {
        let mut state = State::new(Settings::default());
        assert_eq!(saved(&state), []);
        let first = state.view;
        state.run(Command::SaveView);
        state.view = first.orbited(1.0, 0.2, DVec3::Y);
        state.view.orthographic = true;
        state.run(Command::SaveView);
        for name in ["T", "Tu", "Tuft"] {
            state.run(Edit::RenameView(1, name.into()));
        }
        let titles = ["View 1 (saved view)", "Tuft (saved view)"];
        assert_eq!(saved(&state), titles.map(|title| (title.to_owned(), true)));
        let there = state.view;
        state.view = first;
        state.run(Command::GoSaved(1));
        assert_eq!(state.effects.pop(), Some(Effect::Go(there)));
        state.run(Command::GoSaved(7));
        assert!(state.effects.is_empty() && state.messages.status.contains("No view"));
        // A name that was typed is undone at once; then a saved view of the same name comes back.
        state.run(Command::Undo);
        assert_eq!(state.document.saved_views[1].name, "View 2");
        state.run(Edit::RemoveView(0));
        state.run(Command::SaveView);
        let names: Vec<_> = state
            .document
            .saved_views
            .iter()
            .map(|v| &*v.name)
            .collect();
        assert_eq!(names, ["View 2", "View 1"]);
        // The keys are those of the first five.
        (0..6).for_each(|_| state.run(Command::SaveView));
        let keys: Vec<bool> = saved(&state).into_iter().map(|(_, keys)| keys).collect();
        assert_eq!(keys, [true, true, true, true, true, false, false, false]);
    }
}
