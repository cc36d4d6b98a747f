//! Markers: dots, spheres or contact discs that are no part of a membrane, such as synapses, drawn beside any vertex
//! source.
//!
//! [`Combined`](crate::Combined) draws them with one more shader. Markers are culled by chunks (chunks.rs); each chunk's
//! size in the picture selects a shape for its markers (shapes.rs), and how many of them are drawn. Markers
//! keep a least size, so that they can be seen from afar, and their cost is bounded by the pixels that they
//! cover and by a budget, not by their number.

use std::ops::Range;

use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec3};
use neurotess_picture::markers::{
    CHUNK, DISC, GROWS, LIFT, Marker, MarkerRun, MarkerSettings, OrderedMarkers,
};
use neurotess_picture::octahedral::pack_normal;
use neurotess_refine::wgsl::{ShaderParts, WgslFile};

use super::companion::Companion;
use super::pick::PickId;
use crate::gpu::buffers::{
    UNIFORM_STRIDE, group_layout, group_with_frame, storage, uniform, upload,
};
use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;
use crate::gpu::shader;
use neurotess_picture::Frame;

/// Markers of a block, which one binding holds: 64 MiB.
const BLOCK: usize = 2048 * CHUNK;
/// Set in the first number of a marker's picking id.
const MARKER_BIT: u32 = 1 << 31;
/// Instance of markers: beyond all instances, so they have neither values nor a state.
const NO_INSTANCE: u32 = u32::MAX - 1;
/// Of a marker that knows no direction: no pair of octahedral coordinates, which are at least -32,767.
const NO_OUTWARDS: u32 = 0x8000_8000;
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
    ordered: OrderedMarkers,
    frames: wgpu::Buffer,
    blocks: Vec<Block>,
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
        let ordered = OrderedMarkers::new(markers, settings);
        let layout = group_layout(&gpu.device, "markers", &entries());
        let storage = wgpu::BufferUsages::STORAGE;
        let corners = upload(gpu, "shapes", storage, &ordered.shapes.corners);
        let blocks = ordered.order.len().div_ceil(BLOCK).max(1) as u64;
        let frames = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("frames of markers"),
            size: UNIFORM_STRIDE * blocks,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let block = |(part, first): (&[u32], u32)| {
            let origin = ordered.chunk_center(first);
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
            let stored = upload(gpu, "markers", storage, &stored);
            Block {
                first,
                origin,
                group: group_with_frame(
                    gpu,
                    "markers",
                    &layout,
                    [&stored, &corners],
                    (&frames, size_of::<MarkerFrame>()),
                    &[],
                ),
            }
        };
        let parts = ordered.order.chunks(BLOCK);
        let blocks = parts.zip((0_u32..).step_by(BLOCK)).map(block).collect();
        gpu.check()?;
        Ok(Self {
            layout,
            ordered,
            frames,
            blocks,
            runs: Vec::new(),
            in_view: 0,
        })
    }

    /// Number of markers.
    pub fn len(&self) -> usize {
        self.ordered.order.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.ordered.order.is_empty()
    }

    /// How they are drawn.
    pub fn settings(&self) -> MarkerSettings {
        self.ordered.settings
    }

    /// Changes how they are drawn.
    pub fn set_settings(&mut self, settings: MarkerSettings) {
        self.ordered.settings = settings;
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
        (size_of::<StoredMarker>() * self.len()) as u64
    }

    /// Index of the marker that an id means; none if it means none.
    pub fn picked(&self, [first, second]: PickId) -> Option<usize> {
        let is_marker = first & MARKER_BIT != 0;
        let index = self.ordered.order.get(second as usize);
        Some(*index.filter(|_| is_marker)? as usize)
    }

    /// Runs of markers that are drawn alike, of neighboring chunks together.
    fn select(&mut self, frame: &Frame) {
        let (selected, in_view) = self.ordered.select(frame);
        let mut runs: Vec<Run> = Vec::new();
        for MarkerRun {
            first,
            shape,
            count,
        } in selected
        {
            let block = first as usize / BLOCK;
            let first = first - self.blocks[block].first;
            match runs.last_mut() {
                Some(run) if (run.block, run.shape, run.markers.end) == (block, shape, first) => {
                    run.markers.end = first + count;
                }
                _ => runs.push(Run {
                    block,
                    shape,
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
        let least = frame.pixel().times(self.ordered.settings.least);
        for (index, block) in self.blocks.iter().enumerate() {
            let uniforms = MarkerFrame {
                relative_from_block: (block.origin - frame.camera.eye()).as_vec3().to_array(),
                radius: self.ordered.radius().max(least.flat) as f32,
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
        self.ordered.chunks()
    }

    fn shows(&self, frame: &Frame) -> bool {
        self.ordered.shows(frame)
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        for run in &self.runs {
            let offset = UNIFORM_STRIDE as u32 * run.block as u32;
            pass.set_bind_group(0, &self.blocks[run.block].group, &[offset]);
            pass.draw(
                self.ordered.shapes.ranges[run.shape].clone(),
                run.markers.clone(),
            );
        }
    }
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
