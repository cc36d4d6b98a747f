//! The picture at rest where the window's adapter is software: the processor draws it beside the window, in a tenth of the
//! time that the adapter would block the window for.

use std::sync::Arc;
use std::time::Duration;

use eframe::egui;
use neurotess::picture::{
    AdaptiveSettings, Image, MarkerSettings, PictureOptions, Viewpoint, Watch,
};
use neurotess::render::{DeviceError, ViewParams};

use super::cost_model::RestMode;
use super::{PictureInputs, RestPhase, Stage};
use crate::io::background::apart;
use crate::io::task::{Progress, Task};
use crate::model::document::{Detail, RestChoice};
use crate::model::state::State;
use crate::scene::content;
use crate::scene::markers::settings;
use crate::scene::painter::of_view;
use crate::scene::still_scene::StillScene;

/// Time between looks at whether the picture is there, beside being woken.
const CHECK_INTERVAL: Duration = Duration::from_millis(15);

impl Stage {
    /// Whether the processor draws the picture at rest: what the adapter, if it is software, would refine.
    pub(super) fn draws_by_processor(&self, params: &ViewParams, detail: Detail) -> bool {
        self.pace.rest_mode == RestMode::Refined && self.can_by_processor(params, detail)
    }

    /// Whether the processor draws in full what exploration mode has drawn, while that is shown.
    pub(super) fn completes(&self, params: &ViewParams, detail: Detail) -> bool {
        let explored = self.pace.rest_mode == RestMode::Explored;
        let asked = detail.at_rest == RestChoice::Automatic;
        explored && asked && self.can_by_processor(params, detail)
    }

    fn can_by_processor(&self, params: &ViewParams, detail: Detail) -> bool {
        // Levels of another camera, and patches that are left out, are the adapter's.
        let plain = params.frozen.is_none() && detail.smallest <= 0.0;
        // Colored anew, as it is by the adapter, something translucent has another grain, and a clamped neuron other
        // outlines; a recording is colored anew with every frame, and markers are as large as in its pixels.
        let mut meshes = self.meshes.shown().iter();
        let alike = meshes.all(|mesh| !mesh.look.is_translucent())
            && self.clamped.fine.is_empty()
            && self.content.recording.is_none()
            && self.markers.made().is_none();
        self.gpu.adapter.software && plain && alike
    }

    /// Whether the first draft of a scene is left out: its shaders would be compiled for a second or more, and the
    /// processor's picture is there sooner. They are compiled when something moves, or for what is under the cursor.
    pub(super) fn begins_without_draft(&mut self, inputs: &PictureInputs) -> bool {
        if self.drawn.is_some() || !self.progressive.is_new() {
            return false;
        }
        self.pace.rest_mode = self.select_rest_mode(&inputs.params, inputs.detail.at_rest);
        self.draws_by_processor(&inputs.params, inputs.detail)
    }

    /// Begins the picture on a thread.
    pub(super) fn begin_by_processor(
        &mut self,
        state: &State,
        (params, detail): (ViewParams, Detail),
        ctx: &egui::Context,
    ) -> RestPhase {
        self.set_rest_detail(&params, detail);
        let (content, markers, meshes) = self.saved_content(state);
        let scene = StillScene {
            told: state.told(),
            gpu: None,
            content,
            look: state.document.look.clone(),
            states: content::states(&state.document),
            spheres: Arc::default(),
            around: Vec::new(),
            meshes,
            markers,
            form: state.document.markers.form(),
            figures: Vec::new(),
        };
        let options = PictureOptions {
            size: params.size,
            background: Some(params.background),
            look: params.look,
            occlusion: params.occlusion,
            ..PictureOptions::default()
        };
        let refined = AdaptiveSettings {
            lod: detail.lod(),
            wireframe: params.look.wire > 0.0,
            ..AdaptiveSettings::default()
        };
        let view = Viewpoint {
            camera: params.camera,
            near: params.near,
        };
        let sub_pixels = options.sub_pixels(options.samples_in_sub_pixel());
        let most = MarkerSettings::default().most_triangles;
        let markers = settings(scene.form, f64::from(sub_pixels), None, most);
        let work = move |progress: &Progress| {
            let watch = Watch {
                tiles: Arc::clone(&progress.done),
                stopped: Arc::clone(&progress.canceled),
            };
            apart(|| of_view(&scene, &view, &options, (refined, markers), watch))
        };
        let ctx = ctx.clone();
        let progress = Progress::new("drawing", "bands", 0);
        let task = Task::start(progress, move || ctx.request_repaint(), work);
        self.resting = Some(task);
        RestPhase::Draws
    }

    /// Takes the picture once it is there; then what is under the cursor is found out, as for pictures of the adapter.
    pub(super) fn take_resting(
        &mut self,
        state: &mut State,
        (params, detail): (ViewParams, Detail),
        ctx: &egui::Context,
    ) -> Result<(), DeviceError> {
        let Some(task) = &self.resting else {
            if self.lacks_ids() {
                self.bring_what_shows()?;
                self.identify(&params)?;
            }
            self.pace.phase = RestPhase::Collects;
            return Ok(());
        };
        match task.take() {
            None => {
                ctx.request_repaint_after(CHECK_INTERVAL);
                return Ok(());
            }
            Some(Ok(image)) => {
                self.put(&params, &image)?;
                if self.pace.rest_mode == RestMode::Explored {
                    // What is under the cursor is known already.
                    self.pace.rest_mode = RestMode::Refined;
                    self.pace.phase = RestPhase::Done;
                }
            }
            Some(Err(why)) => {
                state.problem("drawing the picture", why);
                self.pace.phase = match self.pace.rest_mode {
                    RestMode::Explored => RestPhase::Done,
                    RestMode::Refined | RestMode::Coarser => self.begin(params, detail)?,
                };
            }
        }
        (self.resting, self.awaited) = (None, false);
        ctx.request_repaint();
        Ok(())
    }

    fn put(&mut self, params: &ViewParams, image: &Image) -> Result<(), DeviceError> {
        self.progressive.put(&self.gpu, params, image)
    }
}
