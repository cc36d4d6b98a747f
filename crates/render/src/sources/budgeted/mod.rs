//! Exploration mode: any scene within a budget of triangles, for a camera that moves.
//!
//! **Theory.** A scene of 50 million segments has more parts than a screen has pixels, so the work
//! must depend on what is visible. Instances are culled as a whole. For each of the others, every
//! **chunk**, up to 64 segments of a path ([`Proxy`]), computes on the GPU how many quads it would
//! take to draw it coarsely, within half a pixel, and round, and what each of these steps is worth:
//! square pixels per quad. A histogram of quads by worth gives the least worth that is within the
//! budget; in the same frame, all steps that are worth more are listed and drawn (select.wgsl,
//! visible_chunks.wgsl).
//!
//! A chunk is stored as seven nested polylines and drawn as the coarsest that is within half a
//! pixel of the curved path. A tube of a radius below three pixels is a strip that faces the eye,
//! with a cylinder's normals; a wider one is the half of the tube that faces the eye, round within
//! half a pixel. The shading widens strips below a pixel and makes them fainter, as it does all
//! tubes. Somata are dots of at least a pixel, then spheres, then their own mesh.
//!
//! **Practice.** [`Proxy::new`] on any thread, [`Exploration::add`] once for each template,
//! [`Exploration::set_instances`] when they change, [`Exploration::set_hidden`],
//! [`Exploration::set_state`] and [`Exploration::set_budget`] at any time: pipelines are made once.
//! Templates that may not fit the device: [`Exploration::add_streamed`] instead. A frame uploads 144 bytes and what
//! changed; if camera, size and scene are those of the frame before, it keeps that frame's selection.
//!
//! Why not the patches of [`Adaptive`](crate::Adaptive)? They form a closed surface at any levels,
//! for which they need eight triangles a segment. When a whole neuron fits the screen, the
//! difference cannot be seen.

mod buffers;
mod build;
mod bytes;
pub(crate) mod layout;
pub(crate) mod lod_requests;
mod nested;
pub(crate) mod passes;
mod paths;
mod pick;
mod proxy;
mod quantized;
mod residents;
mod somata;
pub(crate) mod stats;
mod streaming;

use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

use glam::DVec3;
use neurotess_refine::wgsl::{ShaderParts, WgslFile};

use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;
use crate::gpu::growable::GrowableBuffer;
use crate::gpu::shader;
use crate::sources::{SourceKey, VertexSource};
use buffers::Buffers;
use layout::{CELL, Eye, GpuInstance};
use neurotess_picture::Instance;
use neurotess_picture::bounds::shows;
use neurotess_picture::{DEFAULT_BUDGET, MAX_BUDGET};
use neurotess_picture::{Frame, Tile};
use passes::{Groups, Passes, Resident, Size, Work, vertex_shader};
use residents::Known;
use streaming::Streaming;

pub use pick::{ProxyPickResolver, ProxyPickTargets};
pub use proxy::Proxy;
pub use residents::ExplorationError;
pub use stats::ExplorationStats;
pub use streaming::StreamedTemplates;

/// Greatest distance (pixels) of what is drawn from the true surface.
const ERROR: f32 = 0.5;

/// A source that draws any scene within a budget of triangles.
#[derive(Debug)]
pub struct Exploration {
    passes: Passes,
    buffers: Buffers,
    gpu_instances: GrowableBuffer,
    known: Vec<Known>,
    /// Templates that are there in part, if not all fit.
    streaming: Option<Streaming>,
    instances: Vec<Instance>,
    /// Chunks of all instances, counted once: of a million instances that took 8 ms a frame.
    chunks: u64,
    /// Instances that were edited and are still to be uploaded.
    edited: Range<usize>,
    work: Work,
    groups: Option<Groups>,
    /// Most triangles of a frame.
    budget: u32,
    sub_pixels: f64,
    /// Whether the lists on the device must be written anew.
    stale: AtomicBool,
    /// The picture that they are for.
    picture: Option<Frame>,
}

impl Exploration {
    /// An empty scene. `sub_pixels`: number of sub-pixels along a pixel's side; errors are measured
    /// in whole pixels.
    ///
    /// # Errors
    /// The device reports an error.
    pub fn new(gpu: &Gpu, sub_pixels: u32) -> Result<Self, DeviceError> {
        let budget = DEFAULT_BUDGET;
        Ok(Self {
            passes: Passes::new(gpu)?,
            buffers: Buffers::new(gpu),
            gpu_instances: GrowableBuffer::new(gpu, "instances", 0),
            known: Vec::new(),
            streaming: None,
            instances: Vec::new(),
            chunks: 0,
            edited: 0..0,
            work: Work::new(gpu, Size::default())?,
            groups: None,
            budget,
            sub_pixels: f64::from(sub_pixels.max(1)),
            stale: AtomicBool::new(true),
            picture: None,
        })
    }

    /// Most triangles of a frame, at most [`MAX_BUDGET`], from the next frame on.
    pub fn set_budget(&mut self, triangles: u32) {
        let triangles = triangles.min(MAX_BUDGET);
        if self.budget != triangles {
            self.budget = triangles;
            self.changed(false);
        }
    }

    /// Most triangles of a frame.
    pub fn budget(&self) -> u32 {
        self.budget
    }

    /// Number of sub-pixels along a pixel's side, from the next frame on.
    pub fn set_sub_pixels(&mut self, sub_pixels: u32) {
        self.sub_pixels = f64::from(sub_pixels.max(1));
        self.changed(false);
    }

    /// Bytes on the device by the name of the buffer.
    pub fn bytes(&self) -> Vec<(&'static str, u64)> {
        let [chunks, points, color_keys] = self.buffers.used().by_buffer();
        let mut bytes = vec![
            ("chunks", chunks + self.buffers.shapes.used()),
            ("points", points),
            ("color_keys", color_keys),
            ("instances", self.gpu_instances.used()),
        ];
        bytes.extend(self.work.bytes());
        bytes
    }

    /// Bytes of templates per tracing point outside somata.
    pub fn bytes_per_point(&self) -> f64 {
        let points: usize = self.known.iter().map(|known| known.points).sum();
        self.buffers.bytes() as f64 / points.max(1) as f64
    }

    /// What a frame would select from if all instances showed.
    fn size(&self) -> Size {
        Size {
            instances: self.instances.len(),
            chunks: self.chunks,
            budget: self.budget / 2,
        }
    }

    fn eye(&self, frame: &Frame) -> Eye {
        let ([width, height], margin) = (frame.size, frame.around);
        let around = Frame {
            tile: Tile {
                x: -(margin as i32),
                y: -(margin as i32),
                width: width + 2 * margin,
                height: height + 2 * margin,
            },
            ..*frame
        };
        let (cell, offset) = in_cells(frame.camera.eye());
        let pixel = frame.pixel().times(self.sub_pixels);
        Eye {
            planes: around.frustum().map(|plane| plane.to_array()),
            cell,
            slope: pixel.slope as f32,
            offset,
            near: frame.near as f32,
            forward: (-frame.camera.axes()[2]).as_vec3().to_array(),
            error: ERROR,
            flat: pixel.flat as f32,
            budget: self.budget / 2,
            instances: self.instances.len() as u32,
            ..Eye::default()
        }
    }
}

/// The cell that a point of the world is in, and its position in the cell (µm).
fn in_cells(p: DVec3) -> ([i32; 3], [f32; 3]) {
    let cell = (p / CELL).floor();
    let offset = (p - cell * CELL).as_vec3();
    (cell.to_array().map(|c| c as i32), offset.to_array())
}

impl VertexSource for Exploration {
    fn shows(&self, frame: &Frame) -> bool {
        let planes = frame.frustum();
        let eye = frame.camera.eye();
        self.instances.iter().any(|instance| {
            let known = &self.known[instance.template.0 as usize];
            let center = known.origin + known.center.as_dvec3();
            let center = (instance.placement.world_from_cell(center) - eye).as_vec3();
            let reach = f64::from(known.reach) * instance.placement.scale;
            // A margin of 8 sub-pixels, since thin tubes are drawn a pixel wide.
            let pixels = 8.0 * frame.pixel().at(f64::from(center.length()) + reach);
            !instance.hidden && shows(&planes, center, (reach + pixels) as f32)
        })
    }

    fn parts(&self) -> usize {
        self.instances.len()
    }

    fn key(&self) -> SourceKey {
        SourceKey {
            name: "budgeted",
            ..SourceKey::default()
        }
    }

    fn shader(&self, _shader: usize) -> ShaderParts {
        vertex_shader()
    }

    fn id_shader(&self, _shader: usize) -> Option<WgslFile> {
        Some(shader::file("visible_chunks_id.wgsl"))
    }

    fn key_shader(&self, _shader: usize) -> Option<WgslFile> {
        Some(shader::file("visible_chunk_keys.wgsl"))
    }

    fn layout(&self, _shader: usize) -> &wgpu::BindGroupLayout {
        &self.passes.drawing
    }

    /// Selects for the whole picture, whatever the tile, so that tiles fit together.
    fn prepare(&mut self, gpu: &Gpu, frame: &Frame) -> Result<usize, DeviceError> {
        if !self.edited.is_empty() {
            let edited = std::mem::take(&mut self.edited);
            let instances = &self.instances[edited.clone()];
            let gpu_instances: Vec<GpuInstance> =
                instances.iter().map(|i| self.cull_instances(i)).collect();
            self.gpu_instances.write(gpu, edited.start, &gpu_instances);
        }
        let whole = Frame {
            tile: Tile::default(),
            ..*frame
        };
        if *self.stale.get_mut() || self.picture != Some(whole) || self.is_pending() {
            self.stream(gpu, frame);
        }
        let size = self.size();
        if !self.work.holds(&size) {
            self.work = Work::new(gpu, size)?;
            self.groups = None;
        }
        if self.groups.is_none() {
            let resident = Resident {
                buffers: &self.buffers,
                gpu_instances: &self.gpu_instances,
            };
            self.groups = Some(self.passes.groups(gpu, &self.work, &resident));
            *self.stale.get_mut() = true;
        }
        if *self.stale.get_mut() || self.picture != Some(whole) {
            let eye = self.eye(frame);
            gpu.queue
                .write_buffer(&self.work.eye, 0, bytemuck::bytes_of(&eye));
            self.picture = Some(whole);
            *self.stale.get_mut() = true;
        }
        gpu.check()?;
        Ok(1)
    }

    fn select(
        &self,
        _round: usize,
        encoder: &mut wgpu::CommandEncoder,
        timestamps: Option<wgpu::ComputePassTimestampWrites<'_>>,
    ) {
        let groups = self.groups.as_ref();
        let groups = groups.filter(|_| self.stale.swap(false, Ordering::Relaxed));
        let instances = self.instances.len();
        self.passes
            .record(encoder, &self.work, groups, instances, timestamps);
    }

    fn draw(&self, _round: usize, _shader: usize, pass: &mut wgpu::RenderPass<'_>) {
        if let Some(groups) = &self.groups {
            self.passes.draw(pass, &self.work, groups);
        }
    }
}
