//! The maker of vertices that refines on the fly: a scene and how it is refined.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::bounds::any_shows;
use crate::device::Gpu;
use crate::error::DeviceError;
use crate::frame::Frame;
use crate::framing::Ball;
use crate::maker::VertexMaker;
use crate::named::Namer;
use crate::readback::FrameStats;
use crate::refiner::{FramePlan, Refiner};
use crate::refining::{Refining, Sight};
use crate::scene::Scene;

/// A scene that is refined as it is drawn. Memory does not depend on the level.
#[derive(Debug)]
pub struct Adaptive {
    refiner: Refiner,
    scene: Scene,
    refining: Refining,
    sub_pixels: f64,
    plan: FramePlan,
    bounds: Option<Vec<Ball>>,
    keeps: bool,
    /// What the lists on the device are chosen for, while they hold.
    kept: Option<(Sight, Refining)>,
    /// Whether they are yet to be chosen.
    stale: AtomicBool,
}

impl Adaptive {
    /// `sub_pixels`: of a pixel, along a side. Levels, and what is left out, are counted in pixels.
    ///
    /// # Errors
    /// The device refuses.
    pub fn new(
        gpu: &Gpu,
        scene: Scene,
        refining: Refining,
        sub_pixels: u32,
    ) -> Result<Self, DeviceError> {
        Ok(Self {
            refiner: Refiner::new(gpu)?,
            scene,
            refining,
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

    /// Another way of refining, from the next frame on.
    pub fn set_refining(&mut self, refining: Refining) {
        self.refining = refining;
    }

    /// Balls that hold all that the scene shows (µm, in the world): tiles of a picture without any are
    /// left out. [`bounds`](crate::bounds) makes them from a mesh.
    pub fn set_bounds(&mut self, balls: Vec<Ball>) {
        self.bounds = Some(balls);
    }

    /// Other instances, or another scene, from the next frame on.
    pub fn set_scene(&mut self, scene: Scene) {
        self.scene = scene;
        self.bounds = None;
        self.plan = FramePlan::default();
        self.kept = None;
    }

    /// Whether what was chosen is kept for frames of the same view, one after the other: for windows,
    /// where a picture is drawn in several steps. Not beyond a million patches, which are chosen and
    /// drawn in turn.
    pub fn set_keeping(&mut self, keeps: bool) {
        self.keeps = keeps;
        self.kept = None;
    }

    /// Takes the scene out, to change it and set it again; until then there is none.
    pub fn take_scene(&mut self) -> Scene {
        self.plan = FramePlan::default();
        self.bounds = None;
        self.kept = None;
        std::mem::take(&mut self.scene)
    }

    /// Who tells what the ids of the frame mean that was prepared last.
    pub fn namer(&self) -> Namer {
        Namer::new(&self.plan, &self.scene)
    }

    /// What the frame that was prepared last draws. Chooses once more and waits: for statistics, not
    /// for every frame.
    ///
    /// # Errors
    /// What the device complained of.
    pub fn stats(&self, gpu: &Gpu) -> Result<FrameStats, DeviceError> {
        let mut stats = FrameStats::new(self.plan.patches);
        for round in 0..self.plan.batches.len() {
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            self.choose(round, &mut encoder, None);
            gpu.queue.submit([encoder.finish()]);
            let batch = &self.plan.batches[round];
            let chosen = self.refiner.read_chosen(gpu, &self.scene, batch)?;
            stats.add(&chosen, self.refining.caps);
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
}

impl VertexMaker for Adaptive {
    fn shows(&self, frame: &Frame) -> bool {
        let balls = self.bounds.as_ref();
        balls.is_none_or(|balls| any_shows(balls, frame))
    }

    fn shaders(&self) -> usize {
        Refiner::SHADERS
    }

    fn wgsl(&self, shader: usize) -> String {
        Refiner::vertex_wgsl(shader)
    }

    fn id_wgsl(&self) -> Option<&'static str> {
        Some(include_str!("surface_id.wgsl"))
    }

    fn layout(&self) -> &wgpu::BindGroupLayout {
        self.refiner.layout()
    }

    fn prepare(&mut self, gpu: &Gpu, frame: &Frame) -> Result<usize, DeviceError> {
        let sight = Sight {
            eye: frame.camera.eye(),
            forward: -frame.camera.axes()[2],
            planes: frame.frustum(),
            slope: frame.slope() * self.sub_pixels,
            near: frame.near,
        };
        let asked = Some((sight, self.refining));
        if self.kept != asked {
            self.kept = None;
            self.plan = self
                .refiner
                .prepare(gpu, &self.scene, &sight, &self.refining)?;
            *self.stale.get_mut() = true;
            let keeps = self.keeps && self.plan.batches.len() == 1;
            self.kept = asked.filter(|_| keeps);
        }
        Ok(self.plan.batches.len())
    }

    fn choose(
        &self,
        round: usize,
        encoder: &mut wgpu::CommandEncoder,
        timestamps: Option<wgpu::ComputePassTimestampWrites<'_>>,
    ) {
        let stale = self.stale.swap(false, Ordering::Relaxed) || self.kept.is_none();
        let batch = self.plan.batches.get(round).filter(|_| stale);
        self.refiner.choose(&self.scene, encoder, batch, timestamps);
    }

    fn draw(&self, round: usize, shader: usize, pass: &mut wgpu::RenderPass<'_>) {
        if let Some(batch) = self.plan.batches.get(round) {
            self.refiner.draw(pass, batch, shader);
        }
    }
}
