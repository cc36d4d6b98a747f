//! The vertex source that refines as it draws: a scene and how it is refined.

pub(crate) mod batch;
pub(crate) mod cull;
pub(crate) mod expand;
pub(crate) mod grids;
pub(crate) mod layouts;
pub(crate) mod passes;
pub(crate) mod readback;
pub(crate) mod refiner;
pub(crate) mod resolver;
pub(crate) mod settings;
pub(crate) mod work;

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use neurotess_refine::wgsl::{ShaderParts, WgslFile};

use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;
use crate::gpu::shader;
use crate::scene::Scene;
use crate::sources::adaptive::batch::FramePlan;
use crate::sources::adaptive::readback::FrameStats;
use crate::sources::adaptive::refiner::Refiner;
use crate::sources::adaptive::resolver::PickResolver;
use crate::sources::{SourceKey, VertexSource};
use neurotess_picture::BoundingSphere;
use neurotess_picture::Frame;
use neurotess_picture::bounds::any_shows;
use neurotess_picture::{AdaptiveSettings, CullView};

/// A scene that is refined as it is drawn. Memory does not depend on the level.
#[derive(Debug)]
pub struct Adaptive {
    refiner: Refiner,
    scene: Scene,
    settings: AdaptiveSettings,
    sub_pixels: f64,
    plan: FramePlan,
    bounds: Option<Vec<BoundingSphere>>,
    keeps: bool,
    /// The view and settings that the lists on the device are for, and whether they are for shaders
    /// that look color keys up; while they are kept.
    kept: Option<(CullView, AdaptiveSettings, bool)>,
    /// Whether those lists are still to be written.
    stale: AtomicBool,
}

impl Adaptive {
    /// `sub_pixels`: number of sub-pixels along a pixel's side. Levels and culling by size go by
    /// whole pixels.
    ///
    /// # Errors
    /// The device reports an error.
    pub fn new(
        gpu: &Gpu,
        scene: Scene,
        settings: AdaptiveSettings,
        sub_pixels: u32,
    ) -> Result<Self, DeviceError> {
        Ok(Self {
            refiner: Refiner::new(gpu)?,
            scene,
            settings,
            sub_pixels: f64::from(sub_pixels.max(1)),
            plan: FramePlan::default(),
            bounds: None,
            keeps: false,
            kept: None,
            stale: AtomicBool::new(true),
        })
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Other settings, from the next frame on.
    pub fn set_settings(&mut self, settings: AdaptiveSettings) {
        self.settings = settings;
    }

    /// Draws these instances only, from the next frame on: their indices; none: all of them.
    pub fn set_only(&mut self, only: Option<Arc<[usize]>>) {
        if self.refiner.only() != only.as_deref() {
            self.refiner.set_only(only);
            self.kept = None;
        }
    }

    /// Bounding spheres that hold all that the scene shows (µm, in the world). Tiles of a picture
    /// that none of them reaches are not drawn. [`bounds`](crate::bounds::bounds) computes them
    /// from a mesh.
    pub fn set_bounds(&mut self, spheres: Vec<BoundingSphere>) {
        self.bounds = Some(spheres);
    }

    /// Another scene, from the next frame on.
    pub fn set_scene(&mut self, scene: Scene) {
        self.scene = scene;
        self.bounds = None;
        self.plan = FramePlan::default();
        self.kept = None;
    }

    /// Whether the selection is kept while the view stays the same: for windows, where a picture is
    /// drawn in several steps. Scenes of more than a million patches in view keep none: they are
    /// selected and drawn batch by batch.
    pub fn set_keeping(&mut self, keeps: bool) {
        self.keeps = keeps;
        self.kept = None;
    }

    /// Takes the scene out, to be changed and set again; until then the source draws nothing.
    pub fn take_scene(&mut self) -> Scene {
        self.plan = FramePlan::default();
        self.bounds = None;
        self.kept = None;
        std::mem::take(&mut self.scene)
    }

    /// Resolves the ids of the frame that was prepared last.
    pub fn resolver(&self) -> PickResolver {
        PickResolver::new(&self.plan, &self.scene)
    }

    /// What the frame that was prepared last draws. Selects once more and waits for the device: for
    /// statistics, not for every frame.
    ///
    /// # Errors
    /// The device reports an error.
    pub fn stats(&self, gpu: &Gpu) -> Result<FrameStats, DeviceError> {
        let mut stats = FrameStats::new(self.plan.patches);
        for round in 0..self.plan.batches.len() {
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            self.select(round, &mut encoder, None);
            gpu.queue.submit([encoder.finish()]);
            let batch = &self.plan.batches[round];
            let selected = self.refiner.read_selected(gpu, &self.scene, batch)?;
            stats.add(&selected, self.settings.caps);
        }
        Ok(stats)
    }

    /// Bytes on the device by the name of the buffer: those of templates first.
    pub fn bytes(&self) -> Vec<(&'static str, u64)> {
        let mut bytes = self.scene.templates().bytes();
        bytes.extend(self.refiner.bytes());
        bytes
    }

    /// Bytes of templates per tracing point outside somata. They do not depend on the level.
    pub fn bytes_per_point(&self) -> f64 {
        self.scene.templates().bytes_per_point()
    }

    fn prepare_lists(
        &mut self,
        gpu: &Gpu,
        frame: &Frame,
        keyed: bool,
    ) -> Result<usize, DeviceError> {
        let view = CullView {
            eye: frame.camera.eye(),
            forward: -frame.camera.axes()[2],
            planes: frame.frustum(),
            pixel: frame.pixel().times(self.sub_pixels),
            near: frame.near,
        };
        let requested = Some((view, self.settings, keyed));
        if self.kept != requested {
            self.kept = None;
            self.refiner.set_keyed(keyed);
            self.plan = self
                .refiner
                .prepare(gpu, &self.scene, &view, &self.settings)?;
            *self.stale.get_mut() = true;
            let keeps = self.keeps && self.plan.batches.len() == 1;
            self.kept = requested.filter(|_| keeps);
        }
        Ok(self.plan.batches.len())
    }
}

impl VertexSource for Adaptive {
    fn shows(&self, frame: &Frame) -> bool {
        let spheres = self.bounds.as_ref();
        spheres.is_none_or(|spheres| any_shows(spheres, frame))
    }

    fn parts(&self) -> usize {
        self.bounds.as_ref().map_or(1, Vec::len)
    }

    fn shaders(&self) -> usize {
        Refiner::SHADERS
    }

    fn key(&self) -> SourceKey {
        SourceKey {
            name: "adaptive",
            ..SourceKey::default()
        }
    }

    fn shader(&self, shader: usize) -> ShaderParts {
        Refiner::vertex_shader(shader)
    }

    fn id_shader(&self, _shader: usize) -> Option<WgslFile> {
        Some(shader::file("surface_id.wgsl"))
    }

    fn layout(&self, _shader: usize) -> &wgpu::BindGroupLayout {
        self.refiner.layout()
    }

    fn prepare(&mut self, gpu: &Gpu, frame: &Frame) -> Result<usize, DeviceError> {
        self.prepare_lists(gpu, frame, false)
    }

    fn key_shader(&self, _shader: usize) -> Option<WgslFile> {
        Some(shader::file("vertex_keys.wgsl"))
    }

    fn prepare_keyed(&mut self, gpu: &Gpu, frame: &Frame) -> Result<usize, DeviceError> {
        self.prepare_lists(gpu, frame, true)
    }

    fn select(
        &self,
        round: usize,
        encoder: &mut wgpu::CommandEncoder,
        timestamps: Option<wgpu::ComputePassTimestampWrites<'_>>,
    ) {
        let stale = self.stale.swap(false, Ordering::Relaxed) || self.kept.is_none();
        let batch = self.plan.batches.get(round).filter(|_| stale);
        self.refiner.select(&self.scene, encoder, batch, timestamps);
    }

    fn draw(&self, round: usize, shader: usize, pass: &mut wgpu::RenderPass<'_>) {
        if let Some(batch) = self.plan.batches.get(round) {
            self.refiner.draw(pass, batch, shader);
        }
    }
}
