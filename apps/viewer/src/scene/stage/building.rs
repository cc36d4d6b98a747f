//! What stands on the device, brought up to date: at once where that is quick, else beside.

use std::sync::Arc;
use std::sync::mpsc::channel;
use std::time::Duration;

use eframe::egui;
use neurotess::render::{DeviceError, Scene, Template, TemplateId, Templates};

use super::Stage;
use crate::model::state::State;
use crate::scene::colors::{ColorInputs, ColorRequest};
use crate::scene::content::{self, BuildError, SceneContent};
use crate::scene::templates::{self, SceneTemplate};

/// Cells up to which a soma is changed at once; with more, all colors are made anew beside.
const QUICK: usize = 24;

pub(super) type Built = Result<BuiltScene, DeviceError>;

/// What was made beside: the scene, what shows, what could not be colored.
pub(super) struct BuiltScene {
    templates: Templates,
    content: SceneContent,
    key: ColorInputs,
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
        let built = built?;
        let scene = Scene::new(
            built.templates,
            content::device_instances(&built.content.instances),
        );
        self.adaptive.set_scene(scene.unwrap_or_default());
        self.progressive.set_colors(built.content.table.clone());
        self.content = built.content;
        self.colors = Some(built.key);
        self.drawn = None;
        self.recording(state, ctx);
        if let Some((what, why)) = built.problem {
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
        let colors = ColorInputs::new(&state.document);
        let same_sources = sources.len() == self.content.sources.len()
            && sources
                .iter()
                .zip(&self.content.sources)
                .all(|(a, b)| a.id == b.id);
        let changed: Vec<usize> = if same_sources {
            let pairs = sources.iter().zip(&self.content.sources).enumerate();
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
        let replays = self.content.recording.is_some();
        let same_matter = self.colors.as_ref().map(|c| &c.subject) == Some(&colors.subject);
        if same_sources && replays && same_matter && changed.is_empty() {
            self.restyle_values(state, colors);
            return Ok(());
        }
        if same_sources && !recolored && !replays && sources.len() <= QUICK {
            let request = ColorRequest::new(state, &sources);
            return self.replace(sources, &changed, &request);
        }
        self.build(state, sources, colors, ctx);
        Ok(())
    }

    pub(super) fn replace(
        &mut self,
        sources: Vec<SceneTemplate>,
        changed: &[usize],
        request: &ColorRequest,
    ) -> Result<(), DeviceError> {
        let colored = request.colors(&sources);
        let color_keys = &colored.coloring.color_keys;
        let mut scene = self.adaptive.take_scene();
        let mut replaced = Ok(());
        for &place in changed {
            let template = Template {
                mesh: &sources[place].generated.mesh,
                color_keys: &color_keys[place],
                values: &[],
            };
            let id = TemplateId(place as u32);
            replaced = replaced.and_then(|()| scene.replace(&self.gpu, id, &template));
        }
        self.adaptive.set_scene(scene);
        let instances = std::mem::take(&mut self.content.instances);
        self.content = SceneContent::new(sources, instances, colored);
        self.progressive.set_colors(self.content.table.clone());
        self.drawn = None;
        replaced
    }

    pub(super) fn build(
        &mut self,
        state: &State,
        sources: Vec<SceneTemplate>,
        key: ColorInputs,
        ctx: &egui::Context,
    ) {
        let (sender, receiver) = channel();
        let (gpu, ctx) = (Arc::clone(&self.gpu), ctx.clone());
        let request = ColorRequest::new(state, &sources);
        let instances = content::instances(state, &sources);
        self.building = Some(receiver);
        std::thread::spawn(move || {
            let sources = request.cut(sources);
            let mut colored = request.colors(&sources);
            let problem = colored.problem.take();
            let content = SceneContent::new(sources, instances, colored);
            let templates = content::templates(&gpu, &content.sources, &content.coloring);
            let built = templates.map(|templates| BuiltScene {
                templates,
                content,
                key,
                problem,
            });
            // Nobody waits for it if the window is closed.
            let _ = sender.send(built);
            ctx.request_repaint();
        });
    }
}

impl From<BuildError> for String {
    fn from(error: BuildError) -> Self {
        error.to_string()
    }
}
