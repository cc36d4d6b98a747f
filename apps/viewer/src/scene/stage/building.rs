//! What stands on the device, brought up to date: at once where that is quick, else beside.

use std::sync::Arc;
use std::sync::mpsc::channel;
use std::time::Duration;

use eframe::egui;
use neurotess::render::{DeviceError, Scene, Template, TemplateId, Templates};

use super::Stage;
use crate::model::state::State;
use crate::scene::colors::{ColorKey, Wish};
use crate::scene::content::{self, BuildError, Shown};
use crate::scene::templates::{self, SceneTemplate};

/// Cells up to which a soma is changed at once; with more, all colors are made anew beside.
const QUICK: usize = 24;

pub(super) type Built = Result<Made, DeviceError>;

/// What was made beside: the scene, what shows, what could not be colored.
pub(super) struct Made {
    templates: Templates,
    shown: Shown,
    key: ColorKey,
    problem: Option<(String, String)>,
}

impl Stage {
    pub(super) fn take_built(
        &mut self,
        state: &mut State,
        ctx: &egui::Context,
    ) -> Result<(), DeviceError> {
        let Some(building) = &self.building else {
            return Ok(());
        };
        let Ok(built) = building.try_recv() else {
            ctx.request_repaint_after(Duration::from_millis(15));
            return Ok(());
        };
        self.building = None;
        let made = built?;
        let scene = Scene::new(made.templates, content::instances(&made.shown.instances));
        self.maker.set_scene(scene.unwrap_or_default());
        self.live.set_colors(made.shown.table.clone());
        self.shown = made.shown;
        self.colors = Some(made.key);
        self.drawn = None;
        self.replay(state, ctx);
        if let Some((what, why)) = made.problem {
            state.problem(what, why);
        }
        Ok(())
    }

    /// Brings sources and neurons on the device up to date: at once, or beside.
    pub(super) fn want_scene(
        &mut self,
        state: &mut State,
        ctx: &egui::Context,
    ) -> Result<(), DeviceError> {
        if self.building.is_some() {
            return Ok(());
        }
        let sources = templates::templates(state);
        let colors = ColorKey::new(&state.document);
        let same_sources = sources.len() == self.shown.sources.len()
            && sources
                .iter()
                .zip(&self.shown.sources)
                .all(|(a, b)| a.id == b.id);
        let changed: Vec<usize> = if same_sources {
            let pairs = sources.iter().zip(&self.shown.sources).enumerate();
            pairs
                .filter(|(_, (a, b))| !Arc::ptr_eq(&a.traced, &b.traced))
                .map(|(i, _)| i)
                .collect()
        } else {
            Vec::new()
        };
        let recolored = self.colors.as_ref() != Some(&colors);
        if same_sources && !recolored && changed.is_empty() {
            return Ok(());
        }
        let replays = self.shown.replay.is_some();
        let same_matter = self.colors.as_ref().map(|c| &c.matter) == Some(&colors.matter);
        if same_sources && replays && same_matter && changed.is_empty() {
            self.tint(state, colors);
            return Ok(());
        }
        if same_sources && !recolored && !replays && sources.len() <= QUICK {
            let wish = Wish::new(state, &sources);
            return self.replace(sources, &changed, &wish);
        }
        self.build(state, sources, colors, ctx);
        Ok(())
    }

    pub(super) fn replace(
        &mut self,
        sources: Vec<SceneTemplate>,
        changed: &[usize],
        wish: &Wish,
    ) -> Result<(), DeviceError> {
        let colored = wish.colors(&sources);
        let words = &colored.coloring.color_keys;
        let mut scene = self.maker.take_scene();
        let mut replaced = Ok(());
        for &place in changed {
            let template = Template {
                mesh: &sources[place].generated.mesh,
                color_keys: &words[place],
                values: &[],
            };
            let id = TemplateId(place as u32);
            replaced = replaced.and_then(|()| scene.replace(&self.gpu, id, &template));
        }
        self.maker.set_scene(scene);
        let standing = std::mem::take(&mut self.shown.instances);
        self.shown = Shown::new(sources, standing, colored);
        self.live.set_colors(self.shown.table.clone());
        self.drawn = None;
        replaced
    }

    pub(super) fn build(
        &mut self,
        state: &State,
        sources: Vec<SceneTemplate>,
        key: ColorKey,
        ctx: &egui::Context,
    ) {
        let (sender, receiver) = channel();
        let (gpu, ctx) = (Arc::clone(&self.gpu), ctx.clone());
        let wish = Wish::new(state, &sources);
        let instances = content::standing(state, &sources);
        self.building = Some(receiver);
        std::thread::spawn(move || {
            let sources = wish.cut(sources);
            let mut colored = wish.colors(&sources);
            let problem = colored.problem.take();
            let shown = Shown::new(sources, instances, colored);
            let templates = content::templates(&gpu, &shown.sources, &shown.coloring);
            let made = templates.map(|templates| Made {
                templates,
                shown,
                key,
                problem,
            });
            // Nobody waits for it if the window is closed.
            let _ = sender.send(made);
            ctx.request_repaint();
        });
    }
}

impl From<BuildError> for String {
    fn from(error: BuildError) -> Self {
        error.to_string()
    }
}
