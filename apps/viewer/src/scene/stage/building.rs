//! Brings the scene on the device up to date: at once if that is quick, else in the background.

use std::sync::Arc;
use std::time::Duration;

use eframe::egui;
use neurotess::coloring::Coloring;
use neurotess::generate::Generated;
use neurotess::render::{DeviceError, Scene, Template, TemplateId, Templates};

use super::residency::Residency;
use super::{Checked, Stage};
use crate::io::task::{Progress, Task};
use crate::model::state::State;
use crate::scene::colors::{ColorInputs, ColorRequest};
use crate::scene::content::{self, BuildError, InstancesKey, SceneContent};
use crate::scene::templates::{self, SceneTemplate};

/// Greatest number of cells at which a changed soma is rebuilt at once; with more, in the
/// background.
const QUICK: usize = 24;

pub(super) type Built = Result<BuiltScene, DeviceError>;

/// What was built in the background.
pub(super) struct BuiltScene {
    /// Templates on the device; none if meshes and color keys are unchanged and only colors differ.
    templates: Option<Templates>,
    /// Which of them are there, if not all fit.
    residency: Option<Residency>,
    content: SceneContent,
    colors: ColorInputs,
    /// Key of the instances, apart from the content's revision.
    instances: InstancesKey,
    problem: Option<(String, String)>,
}

impl Stage {
    pub(super) fn take_built(
        &mut self,
        state: &mut State,
        ctx: &egui::Context,
    ) -> Result<(), DeviceError> {
        let Some((_, task)) = &self.building else {
            return Ok(());
        };
        let Some(result) = task.take() else {
            ctx.request_repaint_after(Duration::from_millis(15));
            return Ok(());
        };
        let of = self.building.take().map(|(of, _)| of);
        let built = match result {
            Ok(built) => built?,
            Err(why) => {
                // Not tried again: the same content would fail again.
                self.on_device.checked = of;
                state.problem("preparing the picture", why);
                return Ok(());
            }
        };
        self.rebuilds.colors += 1;
        match built.templates {
            Some(templates) => {
                let instances = content::device_instances(&built.content.instances);
                let scene = Scene::new(templates, instances);
                self.adaptive.set_scene(scene.unwrap_or_default());
                self.room.residency = built.residency;
                self.rebuilds.templates += 1;
                let instances = built.instances.of_content(built.content.revision);
                self.content = built.content;
                self.instances_are(instances);
            }
            None => self.content.recolor(built.content),
        }
        self.set_colors();
        self.on_device.colors = Some(built.colors);
        self.on_device.checked = None;
        self.drawn = None;
        self.recording(state, ctx);
        if let Some((what, why)) = built.problem {
            state.problem(what, why);
        }
        Ok(())
    }

    /// Brings templates and colors on the device up to date: at once if that is quick, else in the
    /// background.
    pub(super) fn update_templates(
        &mut self,
        state: &mut State,
        ctx: &egui::Context,
    ) -> Result<(), DeviceError> {
        if self.building.is_some() {
            return Ok(());
        }
        let checked = checked(state);
        if self.on_device.checked.as_ref() == Some(&checked) {
            return Ok(());
        }
        let colors = checked.2.clone();
        let sources = templates::templates(state);
        let same_sources = sources.len() == self.content.sources.len()
            && sources
                .iter()
                .zip(&self.content.sources)
                .all(|(a, b)| a.id == b.id);
        let changed: Vec<usize> = if same_sources {
            let pairs = sources.iter().zip(&self.content.sources).enumerate();
            pairs
                .filter(|(_, (a, b))| !a.same_as(b))
                .map(|(i, _)| i)
                .collect()
        } else {
            Vec::new()
        };
        let recolored = self.on_device.colors.as_ref() != Some(&colors);
        if same_sources && !recolored && changed.is_empty() {
            self.on_device.checked = Some(checked);
            return Ok(());
        }
        let records = self.content.recording.is_some();
        let same_subject =
            self.on_device.colors.as_ref().map(|c| &c.subject) == Some(&colors.subject);
        if same_sources && records && same_subject && changed.is_empty() {
            self.restyle_values(state, colors);
            self.on_device.checked = Some(checked);
            return Ok(());
        }
        let as_traced = sources.iter().all(SceneTemplate::is_as_traced);
        if same_sources && !recolored && !records && as_traced && sources.len() <= QUICK {
            let request = ColorRequest::new(state, &sources);
            self.on_device.checked = Some(checked);
            return self.replace(sources, &changed, &request);
        }
        self.build(state, sources, checked, ctx);
        Ok(())
    }

    /// Whether meshes and colors are those of the document, or never will be because preparing them failed.
    pub(crate) fn is_prepared(&self, state: &State) -> bool {
        !self.is_building() && self.on_device.checked.as_ref() == Some(&checked(state))
    }

    fn replace(
        &mut self,
        sources: Vec<SceneTemplate>,
        changed: &[usize],
        request: &ColorRequest,
    ) -> Result<(), DeviceError> {
        let colored = request.colors(&sources);
        let color_keys = &colored.coloring.color_keys;
        let mut scene = self.adaptive.take_scene();
        let mut replaced = Ok(());
        for &index in changed {
            let template = Template {
                mesh: &sources[index].generated.mesh,
                color_keys: &color_keys[index],
                values: &[],
            };
            let id = TemplateId(index as u32);
            replaced = replaced.and_then(|()| scene.replace(&self.gpu, id, &template));
        }
        self.adaptive.set_scene(scene);
        let instances = std::mem::take(&mut self.content.instances);
        self.content = SceneContent::new(sources, instances, colored);
        // The instances are the same, with other meshes.
        let revision = self.content.revision;
        self.on_device.instances = self.on_device.instances.map(|key| key.of_content(revision));
        self.set_colors();
        self.rebuilds.templates += 1;
        self.rebuilds.colors += 1;
        self.drawn = None;
        replaced
    }

    fn build(
        &mut self,
        state: &State,
        sources: Vec<SceneTemplate>,
        of: Checked,
        ctx: &egui::Context,
    ) {
        let (gpu, ctx) = (Arc::clone(&self.gpu), ctx.clone());
        let request = ColorRequest::new(state, &sources);
        let instances = content::instances(state, &sources);
        let instances_key = InstancesKey::new(state, self.content.revision);
        let before = Before::of(&self.content);
        let colors = of.2.clone();
        let drawn = self.content.sources.clone();
        let memory = self.room.memory.map(|most| most / 2);
        let work = move |_: &Progress| {
            let sources = request.meshed(sources, &drawn);
            let mut colored = request.colors(&sources);
            let problem = colored.problem.take();
            let content = SceneContent::new(sources, instances, colored);
            let residency = Residency::new(&content.sources, memory);
            let templates = match before.fits(&content) {
                true => Ok(None),
                false => {
                    let empty = residency.is_some();
                    content::templates(&gpu, &content.sources, &content.coloring, empty).map(Some)
                }
            };
            let built = templates.map(|templates| BuiltScene {
                templates,
                residency,
                content,
                colors,
                instances: instances_key,
                problem,
            });
            Ok(built)
        };
        let progress = Progress::new("preparing the picture", "cells", 0);
        let task = Task::start(progress, move || ctx.request_repaint(), work);
        self.building = Some((of, task));
    }
}

/// What the templates on the device depend on.
fn checked(state: &State) -> Checked {
    (
        state.document.neurons.revisions().members,
        state.sources.geometry(),
        ColorInputs::new(&state.document),
        state.document.look.radius_factor(),
    )
}

/// Meshes and color keys that are on the device.
struct Before {
    meshes: Vec<Arc<Generated>>,
    coloring: Arc<Coloring>,
}

impl Before {
    fn of(content: &SceneContent) -> Self {
        let meshes = content.sources.iter().map(|s| Arc::clone(&s.generated));
        Self {
            meshes: meshes.collect(),
            coloring: Arc::clone(&content.coloring),
        }
    }

    /// Whether other content has the same meshes and color keys.
    fn fits(&self, other: &SceneContent) -> bool {
        let mut pairs = self.meshes.iter().zip(&other.sources);
        self.meshes.len() == other.sources.len()
            && pairs.all(|(mesh, source)| Arc::ptr_eq(mesh, &source.generated))
            && self.coloring.color_keys == other.coloring.color_keys
    }
}

impl From<BuildError> for String {
    fn from(error: BuildError) -> Self {
        error.to_string()
    }
}
