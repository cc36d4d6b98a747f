//! The picture in the window: the scene on the device, drafts while something moves, the full
//! picture at rest, and what is under the cursor. Nothing is drawn when nothing changes.

mod building;
mod clamped;
mod cost_model;
mod drafts;
mod frames;
mod markers;
mod meshes;
mod pointing;
pub(crate) mod residency;
mod rest;
mod static_mode;

use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Instant;

use eframe::egui;
use egui_wgpu::RenderState;
use neurotess::coloring::{ColorBy, VisibleValues, coloring};
use neurotess::render::overlay::Legend;
use neurotess::render::{
    Adaptive, AdaptiveSettings, Camera, Clip, DeviceError, Gpu, ProgressiveRenderer, Scene,
    ViewParams,
};

use crate::io::frames::{FrameReader, FrameValues};
use crate::io::task::Task;
use crate::model::document::{Cut, Detail, Look};
use crate::model::revision::Revision;
use crate::model::state::{Draft, Rebuilds, SpheresKey, State};
use crate::scene::colors::{ColorInputs, color_scheme};
use crate::scene::content::{InstancesKey, SceneContent, StatesKey};
use crate::scene::explorer::Explorer;
use crate::scene::picks::Picks;
use building::Built;
use clamped::Clamped;
use cost_model::{CostModel, RestMode};
use markers::{MarkersKey, StageMarkers};
use meshes::{DrawnMeshes, StageMeshes};
pub(crate) use pointing::OUTLINES;
use pointing::{MaskKey, Resolver};
use residency::Residency;
use static_mode::StaticKey;

/// Draws the picture in the window.
pub struct Stage {
    gpu: Arc<Gpu>,
    render: RenderState,
    progressive: ProgressiveRenderer,
    adaptive: Adaptive,
    explorer: Explorer,
    clamped: Clamped,
    /// Whether the last draft was drawn in exploration mode.
    explored: bool,
    texture: Option<(egui::TextureId, [u32; 2], bool)>,
    /// The scene on the device.
    content: SceneContent,
    colors: Option<ColorInputs>,
    /// The inputs that the templates on the device were last found to fit.
    checked: Option<Checked>,
    /// Key of the instances on the device.
    instances: Option<InstancesKey>,
    /// By instance: whether it is shown.
    shows: Arc<[bool]>,
    /// Key of the states on the device.
    states: Option<StatesKey>,
    /// Near planes of the picture's camera and of the camera of frozen levels.
    near: [Option<((Camera, SpheresKey), f64)>; 2],
    clip: Option<((Cut, SpheresKey), Option<Clip>)>,
    rebuilds: Rebuilds,
    /// Legend of the picture that was drawn last.
    legend: Legend,
    building: Option<(Checked, Task<Built>)>,
    /// Synapses and points.
    markers: StageMarkers,
    /// Meshes that are no cells.
    meshes: StageMeshes,
    /// Reads the recording.
    reader: Option<FrameReader>,
    values: Option<Arc<FrameValues>>,
    /// Where the recording has what shows in the static picture.
    visible: Option<Arc<VisibleValues>>,
    /// Whether values of the current frame are still to be read.
    values_due: bool,
    /// Whether values, or colors of markers, have changed since they were drawn.
    revalued: bool,
    drawn: Option<PictureInputs>,
    /// Whether the static picture is still to be colored anew.
    recolor_due: bool,
    /// Of the last draft: what its static picture depends on.
    shape: Option<StaticKey>,
    /// Whether a draft is what was drawn last.
    drafted: bool,
    moved: Instant,
    phase: RestPhase,
    coarser: f32,
    slices: u32,
    frames: VecDeque<f32>,
    picks: Option<Picks>,
    /// Whether `picks` belong to an earlier picture.
    picks_stale: bool,
    /// Whether they do not show what the current picture would, which has been passed over.
    picks_elsewhere: bool,
    resolver: Option<Resolver>,
    mask: Option<MaskKey>,
    /// Triangles and patches that the picture at rest draws, and all patches, once they are
    /// counted.
    counts: Option<[u64; 3]>,
    cost_model: CostModel,
    rest_mode: RestMode,
    /// Patches of the neurons in the picture, and their templates.
    patches: u64,
    in_view: Vec<usize>,
    /// Most bytes of templates on the device.
    memory: Option<u64>,
    /// Which templates refined pictures have, if not all fit.
    residency: Option<Residency>,
    /// In exploration mode: triangles drawn, and those needed for half a pixel, once they are
    /// known.
    surveyed: Option<[u64; 2]>,
    /// Whether the last work was a slice, whose time is measured.
    timed: bool,
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

/// Phases of the full picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum RestPhase {
    /// Waits, since something has just moved.
    Waits,
    /// Slices are being drawn.
    Slices,
    /// Everything is drawn in exploration mode; finds out what it left out.
    Surveys,
    /// The picture is made static.
    Collects,
    /// Everything is drawn.
    Done,
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
            explored: false,
            texture: None,
            content,
            colors: None,
            checked: None,
            instances: None,
            shows: Arc::default(),
            states: None,
            near: [None; 2],
            clip: None,
            rebuilds: Rebuilds::default(),
            legend,
            building: None,
            markers: StageMarkers::new(software),
            meshes: StageMeshes::default(),
            reader: None,
            values: None,
            visible: None,
            values_due: false,
            revalued: false,
            drawn: None,
            recolor_due: false,
            shape: None,
            drafted: false,
            moved: Instant::now(),
            phase: RestPhase::Done,
            coarser: if software { 4.0 } else { 1.0 },
            slices: if software { 2 } else { 1 },
            frames: VecDeque::new(),
            picks: None,
            picks_stale: false,
            picks_elsewhere: false,
            resolver: None,
            mask: None,
            counts: None,
            cost_model: CostModel::new(software),
            rest_mode: RestMode::Refined,
            patches: 0,
            in_view: Vec::new(),
            memory: None,
            residency: None,
            surveyed: None,
            timed: false,
        })
    }

    /// Another stage on the same device.
    ///
    /// # Errors
    /// The device reports an error.
    pub(crate) fn another(&self) -> Result<Self, DeviceError> {
        let mut another = Self::new(self.render.clone())?;
        another.limit_memory(self.memory);
        Ok(another)
    }

    /// Limits the memory (bytes) that tracings take on the device: one half for drafts, the other for refined pictures.
    /// Tracings that are opened from then on keep to it.
    pub fn limit_memory(&mut self, most: Option<u64>) {
        self.memory = most;
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
        let shown = match self.phase {
            RestPhase::Done => true,
            // Outlines and picking need ids.
            RestPhase::Collects => self.is_sharp() && self.can_pick(),
            _ => false,
        };
        let ids_due = self.resolver.is_some();
        let due = self.values_due || self.recolor_due || ids_due;
        shown && self.drawn.is_some() && !self.is_building() && !due
    }

    /// What is still to be done before everything is drawn, for messages of tests.
    pub fn unsettled(&self) -> String {
        format!(
            "{:?} {:?}, {} slices, {:?}; drawn {}, sharp {}, picking {}, building {}, values due {}, \
             recoloring due {}, ids due {}",
            self.rest_mode,
            self.phase,
            self.slices,
            self.cost_model,
            self.drawn.is_some(),
            self.is_sharp(),
            self.can_pick(),
            self.is_building(),
            self.values_due,
            self.recolor_due,
            self.resolver.is_some(),
        )
    }

    fn is_building(&self) -> bool {
        let beside = self.markers.is_making() || self.meshes.is_uploading();
        self.building.is_some() || beside
    }

    /// Whether the picture, perhaps a draft, shows the recording's current frame.
    pub fn shows_frame(&self) -> bool {
        !self.values_due && !self.revalued && self.drawn.is_some()
    }

    /// Whether the picture, perhaps a draft, shows the current neurons and colors.
    pub fn is_drawn(&self) -> bool {
        self.drawn.is_some()
    }

    /// Whether the full picture is shown, or at least its first step, and not a draft.
    pub fn is_sharp(&self) -> bool {
        !self.progressive.shows_draft()
    }

    /// Whether the picture that was drawn last, perhaps a draft, has this camera.
    pub fn is_from(&self, camera: &Camera) -> bool {
        self.drawn
            .as_ref()
            .is_some_and(|d| d.params.camera == *camera)
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
        self.picks_elsewhere = false;
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
        if self.building.is_some() && !self.is_in_order(state) {
            // Neurons were added or removed: the values do not belong to them yet.
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
        self.revalued |= self.take_values(state, ctx);
        // A draft may have been drawn while the static picture was made.
        let behind = self.is_static() && !self.is_sharp();
        let changed = behind || self.revalued || self.drawn.as_ref() != Some(&inputs);
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
        state.counters.bytes = self.bytes();
        let [triangles, patches, all] = self.counts.unwrap_or_default();
        (state.counters.triangles, state.counters.patches) = (triangles, [patches, all]);
        state.counters.rebuilds = self.rebuilds(state);
        state.counters.frames_ms = self.frames.iter().copied().collect();
        state.counters.draft = match self.explored {
            true => Draft::Budget(self.explorer.budget()),
            false => Draft::Error(self.coarser),
        };
        state.counters.markers = self.markers.shown();
        state.counters.lowered = self.lowered();
        state.counters.static_picture = self.static_figures();
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
        self.picks_elsewhere = before != Some((inputs.params, inputs.instances));
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
