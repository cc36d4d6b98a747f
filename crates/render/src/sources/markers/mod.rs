//! Markers: dots, spheres or contact discs that are no part of a membrane, such as synapses, drawn beside any vertex
//! source.
//!
//! [`Combined`](crate::Combined) draws them with one more shader. Markers are culled by chunks (chunks.rs); each chunk's
//! size in the picture selects a shape for its markers (shapes.rs), and how many of them are drawn. Markers
//! keep a least size, so that they can be seen from afar, and their cost is bounded by the pixels that they
//! cover and by a budget, not by their number.

mod chunks;
mod shapes;

use std::ops::Range;

use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec3};
use neurotess_refine::wgsl::{ShaderParts, WgslFile};

use self::chunks::{CHUNK, Chunk};
pub use self::shapes::MarkerShape;
use self::shapes::{DISC, GROWS, LIFT, Shapes};
use super::companion::Companion;
use super::octahedral::pack_normal;
use super::pick::PickId;
use crate::gpu::buffers::{
    UNIFORM_STRIDE, group_layout, group_with_frame, storage, uniform, upload,
};
use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;
use crate::gpu::shader;
use crate::view::frame::{Frame, Tile};
use crate::view::frustum::shows;

/// Markers of a block, which one binding holds: 64 MiB.
const BLOCK: usize = 2048 * CHUNK;
/// Set in the first number of a marker's picking id.
const MARKER_BIT: u32 = 1 << 31;
/// Instance of markers: beyond all instances, so they have neither values nor a state.
const NO_INSTANCE: u32 = u32::MAX - 1;
/// Of a marker that knows no direction: no pair of octahedral coordinates, which are at least -32,767.
const NO_OUTWARDS: u32 = 0x8000_8000;
/// Most markers of a chunk for each sub-pixel that its bounding sphere covers: further ones could hardly
/// show.
const MAX_PER_SUB_PIXEL: f32 = 4.0;

/// Where a marker is, and its color.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Marker {
    /// Its center (µm).
    pub position: DVec3,
    /// Of one that lies on a membrane: the unit vector away from the inside; zero if there is none.
    pub outwards: Vec3,
    /// What its color is looked up by: see [`ColorTable`](crate::color::ColorTable). Best a category, since
    /// it belongs to no instance that has values.
    pub color_key: u32,
}

/// How markers are drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MarkerSettings {
    /// What they are drawn as.
    pub shape: MarkerShape,
    /// Radius (µm).
    pub radius: f64,
    /// Least radius (sub-pixels).
    pub least: f64,
    /// Most triangles of a frame; markers that are too many are left out evenly.
    pub most_triangles: usize,
}

impl Default for MarkerSettings {
    fn default() -> Self {
        Self {
            shape: MarkerShape::Sphere,
            radius: 0.5,
            least: 1.0,
            most_triangles: 20_000_000,
        }
    }
}

/// Twin of `StoredMarker` in `markers.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct StoredMarker {
    pub(crate) x: f32,
    pub(crate) y: f32,
    pub(crate) z: f32,
    pub(crate) color_key: u32,
    pub(crate) outwards: u32,
}

/// Twin of `MarkerFrame` in `markers.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct MarkerFrame {
    pub(crate) relative_from_block: [f32; 3],
    pub(crate) radius: f32,
    pub(crate) right: [f32; 3],
    pub(crate) near: f32,
    pub(crate) up: [f32; 3],
    pub(crate) least: f32,
    pub(crate) backward: [f32; 3],
    pub(crate) first: u32,
    pub(crate) pixel_slope: f32,
    pub(crate) pixel_flat: f32,
    pub(crate) unused: [u32; 2],
}

/// Markers whose positions are stored relative to one origin, in one buffer.
struct Block {
    first: u32,
    origin: DVec3,
    group: wgpu::BindGroup,
}

/// A run of markers that are drawn alike.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Run {
    block: usize,
    shape: usize,
    /// Indices within the block.
    markers: Range<u32>,
}

/// Markers on the device.
pub struct Markers {
    layout: wgpu::BindGroupLayout,
    shapes: Shapes,
    frames: wgpu::Buffer,
    blocks: Vec<Block>,
    chunks: Vec<Chunk>,
    /// Index of each stored marker among those that the caller gave.
    order: Vec<u32>,
    settings: MarkerSettings,
    runs: Vec<Run>,
    /// Number of markers of the chunks that are in view.
    in_view: usize,
}

impl Markers {
    /// Uploads markers.
    ///
    /// # Errors
    /// They do not fit the device.
    pub fn new(
        gpu: &Gpu,
        markers: &[Marker],
        settings: MarkerSettings,
    ) -> Result<Self, DeviceError> {
        let positions: Vec<DVec3> = markers.iter().map(|marker| marker.position).collect();
        let order = chunks::ordered(&positions);
        let chunks = chunks::chunks(&positions, &order);
        let layout = group_layout(&gpu.device, "markers", &entries());
        let shapes = Shapes::new();
        let corners = upload(gpu, "shapes", wgpu::BufferUsages::STORAGE, &shapes.corners);
        let blocks = order.len().div_ceil(BLOCK).max(1) as u64;
        let frames = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("frames of markers"),
            size: UNIFORM_STRIDE * blocks,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let mut made = Self {
            layout,
            shapes,
            frames,
            blocks: Vec::new(),
            chunks,
            order,
            settings,
            runs: Vec::new(),
            in_view: 0,
        };
        for (part, first) in made.order.chunks(BLOCK).zip((0_u32..).step_by(BLOCK)) {
            let origin = made.chunks[first as usize / CHUNK].center;
            let stored = part.iter().map(|&index| {
                let Marker {
                    position,
                    outwards,
                    color_key,
                } = markers[index as usize];
                let [x, y, z] = (position - origin).as_vec3().to_array();
                let outwards = match outwards == Vec3::ZERO {
                    true => NO_OUTWARDS,
                    false => pack_normal(outwards),
                };
                StoredMarker {
                    x,
                    y,
                    z,
                    color_key,
                    outwards,
                }
            });
            let stored: Vec<StoredMarker> = stored.collect();
            let stored = upload(gpu, "markers", wgpu::BufferUsages::STORAGE, &stored);
            made.blocks.push(Block {
                first,
                origin,
                group: group_with_frame(
                    gpu,
                    "markers",
                    &made.layout,
                    [&stored, &corners],
                    (&made.frames, size_of::<MarkerFrame>()),
                    &[],
                ),
            });
        }
        gpu.check()?;
        Ok(made)
    }

    /// Number of markers.
    pub fn len(&self) -> usize {
        self.order.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.order.is_empty()
    }

    /// How they are drawn.
    pub fn settings(&self) -> MarkerSettings {
        self.settings
    }

    /// Changes how they are drawn.
    pub fn set_settings(&mut self, settings: MarkerSettings) {
        self.settings = settings;
    }

    /// Number of markers that a frame draws, and of those in view: more than that if pixels or the budget do not
    /// suffice for all.
    pub fn shown(&mut self, frame: &Frame) -> [usize; 2] {
        self.select(frame);
        let drawn = self.runs.iter().map(|run| run.markers.len()).sum();
        [drawn, self.in_view]
    }

    /// Bytes on the device.
    pub fn bytes(&self) -> u64 {
        (size_of::<StoredMarker>() * self.order.len()) as u64
    }

    /// Index of the marker that an id means; none if it means none.
    pub fn picked(&self, [first, second]: PickId) -> Option<usize> {
        let is_marker = first & MARKER_BIT != 0;
        let index = self.order.get(second as usize).filter(|_| is_marker)?;
        Some(*index as usize)
    }

    /// Radius (µm): none of points, which have the least size.
    fn radius(&self) -> f64 {
        match self.settings.shape {
            MarkerShape::Point => 0.0,
            MarkerShape::Sphere | MarkerShape::Contact => self.settings.radius,
        }
    }

    /// How far (µm) what is drawn for a marker reaches from its place.
    fn reach(&self) -> f64 {
        match self.settings.shape {
            MarkerShape::Contact => self.radius() * f64::from(DISC.max(1.0 + LIFT) + 0.1),
            MarkerShape::Point | MarkerShape::Sphere => self.radius(),
        }
    }

    fn select(&mut self, frame: &Frame) {
        let whole = Frame {
            tile: Tile {
                x: 0,
                y: 0,
                width: frame.size[0],
                height: frame.size[1],
            },
            ..*frame
        };
        // What lies just outside the picture occludes what is inside.
        let margin = frame.pixel().times(0.1 * f64::from(frame.size[1]));
        let (planes, tile_planes) = (whole.frustum(), frame.frustum());
        let (eye, pixel) = (frame.camera.eye(), frame.pixel());
        let seen = |chunk: &Chunk, planes: &[glam::Vec4; 5]| {
            let center = chunk.relative(eye);
            let reach = chunk.reach + self.reach();
            let around = margin.at(f64::from(center.length()) + reach);
            shows(planes, center, (reach + around) as f32)
        };
        let wanted: Vec<(Chunk, usize, u32)> = self
            .chunks
            .iter()
            .filter(|chunk| seen(chunk, &planes))
            .map(|chunk| {
                let depth = frame.camera.depth(chunk.center);
                let nearest = (depth - chunk.reach).max(frame.near);
                let radius = (self.radius() / pixel.at(nearest)).max(self.settings.least);
                (
                    *chunk,
                    Shapes::of_radius(self.settings.shape, radius as f32),
                    fitting(chunk, pixel.at(depth.max(frame.near))),
                )
            })
            .collect();
        let triangles = |(_, shape, count): &(Chunk, usize, u32)| {
            self.shapes.triangles(*shape) as f64 * f64::from(*count)
        };
        let all: f64 = wanted.iter().map(triangles).sum();
        let share = (self.settings.most_triangles as f64 / all.max(1.0)).min(1.0);
        let mut runs: Vec<Run> = Vec::new();
        let mut in_view = 0;
        for (chunk, shape, count) in wanted.iter().filter(|(c, ..)| seen(c, &tile_planes)) {
            in_view += chunk.count as usize;
            let count = (share * f64::from(*count)).ceil() as u32;
            let block = chunk.first as usize / BLOCK;
            let first = chunk.first - self.blocks[block].first;
            match runs.last_mut() {
                Some(run) if (run.block, run.shape, run.markers.end) == (block, *shape, first) => {
                    run.markers.end = first + count;
                }
                _ => runs.push(Run {
                    block,
                    shape: *shape,
                    markers: first..first + count,
                }),
            }
        }
        (self.runs, self.in_view) = (runs, in_view);
    }
}

impl Companion for Markers {
    fn shader(&self) -> ShaderParts {
        vertex_shader()
    }

    fn id_shader(&self) -> WgslFile {
        shader::file("marker_id.wgsl")
    }

    fn key_shader(&self) -> WgslFile {
        shader::file("marker_keys.wgsl")
    }

    fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    /// Selects what a frame draws: for the whole picture, whatever the tile, so that tiles fit together.
    fn prepare(&mut self, gpu: &Gpu, frame: &Frame) {
        self.select(frame);
        let [right, up, backward] = frame.camera.view_rotation().map(|axis| axis.to_array());
        let least = frame.pixel().times(self.settings.least);
        for (index, block) in self.blocks.iter().enumerate() {
            let uniforms = MarkerFrame {
                relative_from_block: (block.origin - frame.camera.eye()).as_vec3().to_array(),
                radius: self.radius().max(least.flat) as f32,
                right,
                near: frame.near as f32,
                up,
                least: least.slope as f32,
                backward,
                first: block.first,
                pixel_slope: frame.pixel().slope as f32,
                pixel_flat: frame.pixel().flat as f32,
                unused: [0; 2],
            };
            let bytes = bytemuck::bytes_of(&uniforms);
            gpu.queue
                .write_buffer(&self.frames, UNIFORM_STRIDE * index as u64, bytes);
        }
    }

    fn parts(&self) -> usize {
        self.chunks.len()
    }

    fn shows(&self, frame: &Frame) -> bool {
        let (planes, eye) = (frame.frustum(), frame.camera.eye());
        let reach = |chunk: &Chunk| {
            let center = chunk.relative(eye);
            let least = frame.pixel().times(self.settings.least);
            let least = least.at(f64::from(center.length()));
            (chunk.reach + self.reach().max(least)) as f32
        };
        let mut chunks = self.chunks.iter();
        chunks.any(|chunk| shows(&planes, chunk.relative(eye), reach(chunk)))
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        for run in &self.runs {
            let offset = UNIFORM_STRIDE as u32 * run.block as u32;
            pass.set_bind_group(0, &self.blocks[run.block].group, &[offset]);
            pass.draw(self.shapes.ranges[run.shape].clone(), run.markers.clone());
        }
    }
}

/// How many of a chunk's markers are drawn, by the sub-pixels that it covers. `sub_pixel`: size (µm) of one
/// at its depth.
fn fitting(chunk: &Chunk, sub_pixel: f64) -> u32 {
    let radius = (chunk.reach / sub_pixel) as f32 + 1.0;
    let covered = std::f32::consts::PI * radius * radius;
    chunk.count.min((MAX_PER_SUB_PIXEL * covered).ceil() as u32)
}

/// Defines `surface_vertex`.
pub(crate) fn vertex_shader() -> ShaderParts {
    let mut parts = ShaderParts::new(&[shader::file("markers.wgsl")]);
    parts.constants.u32("NO_INSTANCE", NO_INSTANCE);
    parts.constants.u32("MARKER_BIT", MARKER_BIT);
    parts.constants.u32("NO_OUTWARDS", NO_OUTWARDS);
    parts.constants.f32("GROWS_FROM", GROWS[0]);
    parts.constants.f32("GROWS_TO", GROWS[1]);
    parts.constants.f32("DISC", DISC);
    parts.constants.f32("LIFT", LIFT);
    parts
}

/// Group 0: markers, corners of shapes, and the frame.
pub(crate) fn entries() -> Vec<wgpu::BindGroupLayoutEntry> {
    let vertex = wgpu::ShaderStages::VERTEX;
    vec![
        storage(0, vertex, true),
        storage(1, vertex, true),
        uniform(2, vertex, true),
    ]
}
