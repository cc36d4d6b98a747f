//! What stands on the device, brought up to date: at once where that is quick, else beside.

use std::sync::Arc;
use std::sync::mpsc::channel;
use std::time::Duration;

use eframe::egui;
use neurotess::render::{
    ColourMap, DeviceError, Palette, Rgb, Scene, Template, TemplateId, Templates,
};

use super::Stage;
use crate::document::{ColourBy, Look};
use crate::scene::{self, BuildError, Shown, ShownSource};
use crate::state::State;

/// Cells up to which a soma is changed at once; with more, all colours are made anew beside.
const QUICK: usize = 24;

pub(super) type Built = Result<(Templates, Shown, ColourKey), DeviceError>;

/// What colours depend on.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ColourKey {
    by: ColourBy,
    palette: Palette,
    map: ColourMap,
    background: Rgb,
}

impl ColourKey {
    fn new(look: &Look) -> Self {
        Self {
            by: look.colour_by,
            palette: look.palette,
            map: look.colour_map,
            background: look.background,
        }
    }
}

impl Stage {
    pub(super) fn take_built(&mut self, ctx: &egui::Context) -> Result<(), DeviceError> {
        let Some(building) = &self.building else {
            return Ok(());
        };
        let Ok(built) = building.try_recv() else {
            ctx.request_repaint_after(Duration::from_millis(15));
            return Ok(());
        };
        self.building = None;
        let (templates, shown, colours) = built?;
        let scene = Scene::new(templates, scene::instances(&shown.instances));
        self.maker.set_scene(scene.unwrap_or_default());
        self.live.set_colours(shown.colouring.table.clone());
        self.shown = shown;
        self.colours = Some(colours);
        self.drawn = None;
        Ok(())
    }

    /// Brings sources and neurons on the device up to date: at once, or beside.
    pub(super) fn want_scene(
        &mut self,
        state: &State,
        ctx: &egui::Context,
    ) -> Result<(), DeviceError> {
        if self.building.is_some() {
            return Ok(());
        }
        let sources = scene::sources(state);
        let colours = ColourKey::new(&state.document.look);
        let same_sources = sources.len() == self.shown.sources.len()
            && sources
                .iter()
                .zip(&self.shown.sources)
                .all(|(a, b)| a.id == b.id);
        let changed: Vec<usize> = if same_sources {
            let pairs = sources.iter().zip(&self.shown.sources).enumerate();
            pairs
                .filter(|(_, (a, b))| !Arc::ptr_eq(&a.generated, &b.generated))
                .map(|(i, _)| i)
                .collect()
        } else {
            Vec::new()
        };
        let recoloured = self.colours.as_ref() != Some(&colours);
        if same_sources && !recoloured && changed.is_empty() {
            return Ok(());
        }
        if same_sources && !recoloured && sources.len() <= QUICK {
            return self.replace(sources, &changed, &state.document.look);
        }
        self.build(state, sources, colours, ctx);
        Ok(())
    }

    pub(super) fn replace(
        &mut self,
        sources: Vec<ShownSource>,
        changed: &[usize],
        look: &Look,
    ) -> Result<(), DeviceError> {
        let colouring = scene::colours(&sources, look);
        let mut scene = self.maker.take_scene();
        let mut replaced = Ok(());
        for &place in changed {
            let template = Template {
                mesh: &sources[place].generated.mesh,
                words: &colouring.words[place],
                values: &[],
            };
            let id = TemplateId(place as u32);
            replaced = replaced.and_then(|()| scene.replace(&self.gpu, id, &template));
        }
        self.maker.set_scene(scene);
        self.live.set_colours(colouring.table.clone());
        self.shown.sources = sources;
        self.shown.colouring = Arc::new(colouring);
        self.drawn = None;
        replaced
    }

    pub(super) fn build(
        &mut self,
        state: &State,
        sources: Vec<ShownSource>,
        key: ColourKey,
        ctx: &egui::Context,
    ) {
        let (sender, receiver) = channel();
        let (gpu, look, ctx) = (
            Arc::clone(&self.gpu),
            state.document.look.clone(),
            ctx.clone(),
        );
        let instances = scene::standing(state, &sources);
        self.building = Some(receiver);
        std::thread::spawn(move || {
            let colouring = Arc::new(scene::colours(&sources, &look));
            let templates = scene::templates(&gpu, &sources, &colouring);
            let shown = Shown {
                sources,
                instances,
                colouring,
            };
            // Nobody waits for it if the window is closed.
            let _ = sender.send(templates.map(|templates| (templates, shown, key)));
            ctx.request_repaint();
        });
    }
}

impl From<BuildError> for String {
    fn from(error: BuildError) -> Self {
        error.to_string()
    }
}
