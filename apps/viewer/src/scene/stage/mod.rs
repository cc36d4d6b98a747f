//! The picture in the window: the scene on the device, drafts while something moves, the full
//! picture at rest, and what is under the cursor. Nothing is drawn when nothing changes.

mod building;
mod by_processor;
mod clamped;
mod cost_model;
mod drafts;
mod frames;
mod markers;
mod meshes;
mod pace;
mod pointing;
pub(crate) mod residency;
mod rest;
mod static_mode;

use std::sync::Arc;

use eframe::egui;
use egui_wgpu::RenderState;
use neurotess::coloring::{ColorBy, coloring};
use neurotess::render::overlay::Legend;
use neurotess::render::{
    Adaptive, AdaptiveSettings, Camera, Clip, DeviceError, Gpu, Image, ProgressiveRenderer, Scene,
    ViewParams,
};

use crate::io::task::Task;
use crate::model::document::{Cut, Detail, Look};
use crate::model::revision::Revision;
use crate::model::state::{Draft, Rebuilds, SpheresKey, State};
use crate::scene::colors::{ColorInputs, color_scheme};
use crate::scene::content::{InstancesKey, SceneContent, StatesKey};
use crate::scene::explorer::Explorer;
use building::Built;
use clamped::Clamped;
use cost_model::RestMode;
use frames::RecordedValues;
use markers::{MarkersKey, StageMarkers};
use meshes::{DrawnMeshes, StageMeshes};
use pace::{Pace, RestPhase};
pub(crate) use pointing::OUTLINES;
use pointing::Pointing;
use residency::Room;
use static_mode::StaticKey;

/// Draws the picture in the window.
pub struct Stage {
    gpu: Arc<Gpu>,
    render: RenderState,
    progressive: ProgressiveRenderer,
    adaptive: Adaptive,
    explorer: Explorer,
    clamped: Clamped,
    texture: Option<(egui::TextureId, [u32; 2], bool)>,
    /// The scene on the device.
    content: SceneContent,
    /// What of the document the device has.
    on_device: OnDevice,
    rebuilds: Rebuilds,
    /// Legend of the picture that was drawn last.
    legend: Legend,
    building: Option<(Checked, Task<Built>)>,
    /// Synapses and points.
    markers: StageMarkers,
    /// Meshes that are no cells.
    meshes: StageMeshes,
    /// Values of the recording.
    recorded: RecordedValues,
    drawn: Option<PictureInputs>,
    /// The picture at rest that the processor draws.
    resting: Option<Task<Image>>,
    /// Whether nothing of this scene shows until that is there.
    awaited: bool,
    /// Whether the static picture is still to be colored anew.
    recolor_due: bool,
    /// Of the last draft: what its static picture depends on.
    shape: Option<StaticKey>,
    /// What is under the cursor.
    pointing: Pointing,
    /// How fast drawing is, and what is drawn at rest because of that.
    pace: Pace,
    /// Which tracings there is room for.
    room: Room,
}

/// What of the document the device has: what it was last found to fit.
#[derive(Default)]
struct OnDevice {
    colors: Option<ColorInputs>,
    /// The inputs of the templates.
    checked: Option<Checked>,
    /// Key of the instances.
    instances: Option<InstancesKey>,
    /// By instance: whether it is shown.
    shows: Arc<[bool]>,
    /// Key of the states.
    states: Option<StatesKey>,
    /// Near planes of the picture's camera and of the camera of frozen levels.
    near: [Option<((Camera, SpheresKey), f64)>; 2],
    clip: Option<((Cut, SpheresKey), Option<Clip>)>,
}

/// What templates on the device depend on: neurons, meshes, colors, the factor on radii.
type Checked = (Revision, Revision, ColorInputs, f64);

/// What a picture depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
struct PictureInputs {
    params: ViewParams,
    detail: Detail,
    states: StatesKey,
    instances: InstancesKey,
    clamped: Revision,
    markers: Option<MarkersKey>,
    meshes: Option<DrawnMeshes>,
}

impl Stage {
    /// A stage on the window's device.
    ///
    /// # Errors
    /// The device reports an error.
    pub fn new(render: RenderState) -> Result<Self, DeviceError> {
        let gpu = Gpu::share(&render.adapter, render.device.clone(), render.queue.clone());
        let progressive = ProgressiveRenderer::new(&gpu);
        let mut adaptive = Adaptive::new(&gpu, Scene::default(), AdaptiveSettings::default(), 1)?;
        let no_colors = coloring(&[], ColorBy::Type, &color_scheme(&Look::default()));
        let content = SceneContent::new(Vec::new(), Vec::new(), no_colors.into());
        let legend = content.legend.clone();
        adaptive.set_keeping(true);
        let software = gpu.adapter.software;
        Ok(Self {
            gpu: Arc::new(gpu),
            render,
            progressive,
            adaptive,
            explorer: Explorer::default(),
            clamped: Clamped::default(),
            texture: None,
            content,
            on_device: OnDevice::default(),
            rebuilds: Rebuilds::default(),
            legend,
            building: None,
            markers: StageMarkers::new(software),
            meshes: StageMeshes::default(),
            recorded: RecordedValues::default(),
            drawn: None,
            resting: None,
            awaited: false,
            recolor_due: false,
            shape: None,
            pointing: Pointing::default(),
            pace: Pace::new(software),
            room: Room::default(),
        })
    }

    /// Another stage on the same device.
    ///
    /// # Errors
    /// The device reports an error.
    pub(crate) fn another(&self) -> Result<Self, DeviceError> {
        let mut another = Self::new(self.render.clone())?;
        another.limit_memory(self.room.memory);
        Ok(another)
    }

    /// Limits the memory (bytes) that tracings take on the device: one half for drafts, the other for refined pictures.
    /// Tracings that are opened from then on keep to it.
    pub fn limit_memory(&mut self, most: Option<u64>) {
        self.room.memory = most;
        self.explorer.memory = most.map(|most| most / 2);
    }

    /// Gives its picture back to egui, which must not show it any more.
    pub(crate) fn free(mut self) {
        if let Some((id, ..)) = self.texture.take() {
            self.render.renderer.write().free_texture(&id);
        }
    }

    /// The device.
    pub fn gpu(&self) -> &Arc<Gpu> {
        &self.gpu
    }

    /// The scene on the device.
    pub(crate) fn content(&self) -> &SceneContent {
        &self.content
    }

    /// The legend of the picture that is shown, also while other colors are being computed.
    pub fn legend(&self) -> &Legend {
        &self.legend
    }

    /// Whether everything is drawn.
    pub fn is_settled(&self) -> bool {
        let shown = match self.pace.phase {
            RestPhase::Done => true,
            // Outlines and picking need ids.
            RestPhase::Collects => self.is_sharp() && self.can_pick(),
            _ => false,
        };
        let ids_due = self.pointing.resolver.is_some();
        let due = self.recorded.due || self.recolor_due || ids_due;
        shown && self.drawn.is_some() && !self.is_building() && !due
    }

    /// What is still to be done before everything is drawn, for messages of tests.
    pub fn unsettled(&self) -> String {
        format!(
            "{:?} {:?}, {} slices, {:?}; drawn {}, sharp {}, picking {}, building {}, values due {}, \
             recoloring due {}, ids due {}",
            self.pace.rest_mode,
            self.pace.phase,
            self.pace.slices,
            self.pace.cost_model,
            self.drawn.is_some(),
            self.is_sharp(),
            self.can_pick(),
            self.is_building(),
            self.recorded.due,
            self.recolor_due,
            self.pointing.resolver.is_some(),
        )
    }

    fn is_building(&self) -> bool {
        let beside = self.markers.is_making() || self.meshes.is_uploading();
        self.building.is_some() || beside
    }

    /// Whether the picture, perhaps a draft, shows the recording's current frame.
    pub fn shows_frame(&self) -> bool {
        !self.recorded.due && !self.recorded.changed && self.is_drawn()
    }

    /// Whether the picture, perhaps a draft, shows the current neurons and colors.
    pub fn is_drawn(&self) -> bool {
        self.drawn.is_some() && !self.awaited
    }

    /// Whether the full picture is shown, or at least its first step, and not a draft.
    pub fn is_sharp(&self) -> bool {
        !self.awaited && !self.progressive.shows_draft()
    }

    /// Whether the picture that was drawn last, perhaps a draft, has this camera.
    pub fn is_from(&self, camera: &Camera) -> bool {
        let drawn = self.drawn.as_ref().filter(|_| !self.awaited);
        drawn.is_some_and(|d| d.params.camera == *camera)
    }

    /// Height (pixels) of the picture.
    pub fn height(&self) -> f64 {
        self.drawn
            .as_ref()
            .map_or(800.0, |d| f64::from(d.params.size[1]))
    }

    /// Share of the full picture that has been drawn, while it is under way.
    pub fn progress(&self) -> Option<f32> {
        self.progressive.progress()
    }

    /// Draws what has changed; requests another frame while there is more to draw.
    ///
    /// # Errors
    /// The device reports an error.
    pub fn update(
        &mut self,
        state: &mut State,
        size: [u32; 2],
        ctx: &egui::Context,
    ) -> Result<Option<egui::TextureId>, DeviceError> {
        self.pointing.elsewhere = false;
        self.take_built(state, ctx)?;
        self.update_templates(state, ctx)?;
        self.update_markers(state, ctx)?;
        self.update_meshes(state, ctx)?;
        if let Some(why) = self.explorer.update(&self.gpu, &self.content, ctx) {
            state.problem("preparing drafts", why);
        }
        if size.contains(&0) {
            return Ok(None);
        }
        let nothing_yet = self.drawn.is_none() && self.content.sources.is_empty();
        if self.building.is_some() && (nothing_yet || !self.is_in_order(state)) {
            // There is nothing to draw yet. Or neurons were added or removed: the values do not belong to them yet.
            return Ok(self.texture_id());
        }
        let inputs = self.inputs(state, size, ctx.pixels_per_point());
        self.update_clamped(state, inputs.instances)?;
        if self
            .shape
            .is_some_and(|shape| shape != StaticKey::new(&inputs))
        {
            self.leave_static();
        }
        self.recorded.changed |= self.take_values(state, ctx);
        // A draft may have been drawn while the static picture was made.
        let behind = self.is_static() && !self.is_sharp();
        let changed = behind || self.recorded.changed || self.drawn.as_ref() != Some(&inputs);
        self.recolor_due = changed && self.recolors(&inputs);
        if self.recolor_due {
            self.recolor(state, inputs, ctx)?;
        } else if changed && !self.goes_on(&inputs) {
            self.draft(state, inputs, ctx)?;
        } else {
            self.refine(state, ctx)?;
        }
        self.take_ids(ctx)?;
        self.outline(state);
        state.drawing.counters.bytes = self.bytes();
        let [triangles, patches, all] = self.pace.counts.unwrap_or_default();
        (
            state.drawing.counters.triangles,
            state.drawing.counters.patches,
        ) = (triangles, [patches, all]);
        state.drawing.counters.rebuilds = self.rebuilds(state);
        state.drawing.counters.frames_ms = self.pace.frames.iter().copied().collect();
        state.drawing.counters.draft = match self.pace.explored {
            true => Draft::Budget(self.explorer.budget()),
            false => Draft::Error(self.pace.coarser),
        };
        state.drawing.counters.markers = self.markers.shown();
        state.drawing.counters.lowered = self.lowered();
        state.drawing.counters.completes =
            self.resting.is_some() && self.pace.rest_mode == RestMode::Explored;
        state.drawing.counters.static_picture = self.static_figures();
        self.gpu.check()?;
        Ok(self.texture_id())
    }

    /// Draws nothing, since more events of the same frame are still to be handled: the picture after the last of them
    /// is drawn. What changes only the selection leaves valid what is under the cursor.
    pub(crate) fn pass_over(
        &mut self,
        state: &State,
        size: [u32; 2],
        pixels_per_point: f32,
    ) -> Option<egui::TextureId> {
        let inputs = self.inputs(state, size, pixels_per_point);
        let before = self.drawn.map(|d| (d.params, d.instances));
        self.pointing.elsewhere = before != Some((inputs.params, inputs.instances));
        self.texture_id()
    }

    fn rebuilds(&self, state: &State) -> Rebuilds {
        let [placements, spheres] = state.derivations();
        Rebuilds {
            placements,
            spheres,
            proxies: self.explorer.builds(),
            ..self.rebuilds
        }
    }

    /// Bytes on the device: of cells, and of pictures.
    fn bytes(&self) -> [u64; 2] {
        let cells: u64 = self.adaptive.bytes().iter().map(|(_, bytes)| bytes).sum();
        let beside = self.explorer.bytes() + self.markers.bytes() + self.meshes.bytes();
        [cells + beside, self.progressive.bytes()]
    }

    /// The picture's texture for egui; its id stays the same as long as the texture does.
    fn texture_id(&mut self) -> Option<egui::TextureId> {
        let texture = self.progressive.texture()?;
        let key = (
            [texture.width(), texture.height()],
            self.progressive.shows_draft(),
        );
        if let Some((id, size, draft)) = self.texture
            && (size, draft) == key
        {
            return Some(id);
        }
        let view = texture.create_view(&Default::default());
        let mut renderer = self.render.renderer.write();
        // Drafts may have fewer pixels than the window, and are scaled up.
        let filter = match key.1 {
            true => wgpu::FilterMode::Linear,
            false => wgpu::FilterMode::Nearest,
        };
        let id = match self.texture {
            Some((id, ..)) => {
                let device = &self.render.device;
                renderer.update_egui_texture_from_wgpu_texture(device, &view, filter, id);
                id
            }
            None => renderer.register_native_texture(&self.render.device, &view, filter),
        };
        self.texture = Some((id, key.0, key.1));
        Some(id)
    }
}
