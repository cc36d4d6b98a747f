//! Showing cells as a picture shows them: one of options, or of a file that tells how it was drawn.

use std::path::Path;

use neurotess::drawing::picture_of_png;
use neurotess::options::Picture;
use neurotess::options::words::{Color, Time};

use super::Viewer;
use crate::model::command::{Command, Edit};
use crate::model::picture::{Looked, NOT_TAKEN, looked, soma};
use crate::model::state::Effect;

/// Whether a file is a picture that may tell how it was drawn.
pub(super) fn is_picture(path: &Path) -> bool {
    let extension = path.extension().unwrap_or_default();
    extension.eq_ignore_ascii_case("png")
}

impl Viewer {
    /// Shows cells as a picture does, in its options of these names. Somata and the camera are those of cells that are
    /// opened afterwards. None of it is remembered for the next start.
    pub fn show_as(&mut self, picture: &Picture, given: &[String]) {
        let has = |name: &str| given.iter().any(|given| given == name);
        let shown = self.state.told().picture.with(picture, given);
        let kept = self.state.settings.look.clone();
        self.state.run(Edit::TakePicture(Box::new(shown)));
        self.state.keep_look(kept);
        if has("size") {
            self.state.save.picture.size = picture.look.size.0;
        }
        if has("soma") || has("ring") {
            self.soma = soma(&picture.shape);
        }
        if let (true, Some(Time::At(time))) = (has("time"), picture.camera.time) {
            self.state.playback.pace.time = time;
        }
        let camera = ["view", "eye", "target", "up", "fov", "orthographic"];
        if camera.into_iter().any(has) {
            let view = &mut self.state.view;
            view.fov = picture.camera.fov;
            view.orthographic = picture.camera.orthographic.is_some();
            self.looked = Some(picture.camera.clone());
        }
    }

    /// Shows cells as the picture of a file does, from where it was drawn.
    pub(super) fn show_like(&mut self, file: &Path) {
        let recipe = match picture_of_png(file) {
            Ok(recipe) => recipe,
            Err(why) => return self.state.problem("picture", why.to_string()),
        };
        if let Some(warning) = recipe.warning(file) {
            self.state.problem("picture", warning);
        }
        let all = Picture::keywords().into_iter().map(|(name, _)| name);
        let taken = all.filter(|name| NOT_TAKEN.iter().all(|(not, _)| not != name));
        let mut picture = recipe.picture.clone();
        picture.colors.background = picture.background().map(Color);
        self.show_as(&picture, &taken.collect::<Vec<_>>());
        self.state.messages.status = format!("As in {}", file.display());
        if !self.state.document.neurons.is_empty() {
            self.home();
            self.looked = None;
        }
    }

    /// Looks at everything, from where the cells that are opened first are to be seen.
    pub(super) fn home(&mut self) {
        let looked = self.looked.as_ref().map(looked);
        self.state.run(match looked {
            Some(Looked::At(view)) => Command::Go(view),
            Some(Looked::From(side)) => Command::Look(side),
            None => Command::Home,
        });
        for effect in std::mem::take(&mut self.state.effects) {
            match effect {
                // Nothing was shown before, so there is nothing to fly from.
                Effect::Go(view) => self.motion.jump(&mut self.state, view),
                other => self.effect(other),
            }
        }
    }
}
