//! Meshes: surfaces that are no cells, such as brain regions, segments of electron microscopy and pipettes, drawn
//! beside any vertex source.
//!
//! A mesh is uploaded once ([`MeshGeometry`]), in chunks that each fit one binding; runs of triangles in them are
//! culled as one. How it looks ([`MeshLook`]) may change with every picture. Meshes may be open, and are seen from
//! both sides.
//!
//! Translucent ones need no order: see sheets.wgsl.

mod geometry;

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use neurotess_picture::meshes::{MeshLook, SHEET_DEPTH};
use neurotess_refine::wgsl::{ShaderParts, WgslFile};

pub use self::geometry::MeshGeometry;
#[cfg(test)]
pub(crate) use self::geometry::MeshVertex;
use super::companion::Companion;
use super::pick::PickId;
use crate::gpu::buffers::{UNIFORM_STRIDE, group_layout, group_with_frame, make, storage, uniform};
use crate::gpu::device::Gpu;
use crate::gpu::shader;
use neurotess_picture::Frame;
use neurotess_picture::{BoundingSphere, bounds::shows};

/// Set in the first number of a mesh's picking id. Markers have the bit above it.
const MESH_BIT: u32 = 1 << 30;
/// Instance of meshes: beyond all instances, so they have neither values nor a state.
const NO_INSTANCE: u32 = u32::MAX - 1;
/// Twin of `MeshFrame` in `meshes.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct MeshFrame {
    pub(crate) relative_from_mesh: [f32; 3],
    pub(crate) opacity: f32,
    pub(crate) color_key: u32,
    pub(crate) number: u32,
    pub(crate) edges: u32,
    pub(crate) first_half: u32,
    pub(crate) scale: f32,
    pub(crate) keyed: u32,
    pub(crate) pad: [f32; 2],
}

/// A chunk of a mesh, and what of it is drawn.
struct ShownChunk {
    mesh: usize,
    /// Index among the chunks of the mesh.
    chunk: usize,
    group: wgpu::BindGroup,
    /// Ranges of the index buffer.
    shown: Vec<std::ops::Range<u32>>,
}

/// Meshes on the device, each with its look.
pub struct Meshes {
    layout: wgpu::BindGroupLayout,
    frames: wgpu::Buffer,
    meshes: Vec<(Arc<MeshGeometry>, MeshLook)>,
    chunks: Vec<ShownChunk>,
}

impl Meshes {
    /// Meshes to be drawn together.
    pub fn new(gpu: &Gpu, meshes: Vec<(Arc<MeshGeometry>, MeshLook)>) -> Self {
        let layout = group_layout(&gpu.device, "meshes", &entries());
        let count: usize = meshes.iter().map(|(mesh, _)| mesh.chunks.len()).sum();
        let frames = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("frames of meshes"),
            size: UNIFORM_STRIDE * count.max(1) as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let no_keys = make(gpu, "no keys", 0, wgpu::BufferUsages::STORAGE);
        let mut chunks = Vec::new();
        for (mesh, (geometry, _)) in meshes.iter().enumerate() {
            for (chunk, buffers) in geometry.chunks.iter().enumerate() {
                chunks.push(ShownChunk {
                    mesh,
                    chunk,
                    group: group_with_frame(
                        gpu,
                        "meshes",
                        &layout,
                        [&buffers.vertices, &buffers.corners],
                        (&frames, size_of::<MeshFrame>()),
                        &[buffers.keys.as_ref().unwrap_or(&no_keys)],
                    ),
                    shown: Vec::new(),
                });
            }
        }
        Self {
            layout,
            frames,
            meshes,
            chunks,
        }
    }

    /// Number of meshes.
    pub fn len(&self) -> usize {
        self.meshes.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.meshes.is_empty()
    }

    /// Changes how a mesh looks, by its index.
    ///
    /// # Panics
    /// If there is no such mesh.
    pub fn set_look(&mut self, mesh: usize, look: MeshLook) {
        self.meshes[mesh].1 = look;
    }

    /// Triangles of all meshes.
    pub fn triangles(&self) -> u64 {
        let triangles = self.meshes.iter().map(|(mesh, _)| mesh.triangles());
        triangles.sum()
    }

    /// Bytes on the device.
    pub fn bytes(&self) -> u64 {
        self.meshes.iter().map(|(mesh, _)| mesh.bytes()).sum()
    }

    /// Spheres (µm) that hold them, for near planes.
    pub fn spheres(&self) -> impl Iterator<Item = BoundingSphere> {
        let meshes = self.meshes.iter();
        meshes.flat_map(|(mesh, look)| mesh.spheres(look.scale))
    }

    /// Index of the mesh that an id means; none if it means none.
    pub fn picked(&self, [first, second]: PickId) -> Option<usize> {
        let is_mesh = first & MESH_BIT != 0 && first >> 31 == 0;
        (is_mesh && (second as usize) < self.meshes.len()).then_some(second as usize)
    }
}

impl Companion for Meshes {
    fn shader(&self) -> ShaderParts {
        vertex_shader()
    }

    fn id_shader(&self) -> WgslFile {
        shader::file("mesh_id.wgsl")
    }

    fn key_shader(&self) -> WgslFile {
        shader::file("mesh_keys.wgsl")
    }

    fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    fn is_two_sided(&self) -> bool {
        true
    }

    fn parts(&self) -> usize {
        let spheres = self
            .meshes
            .iter()
            .map(|(mesh, look)| mesh.spheres(look.scale).count());
        spheres.sum()
    }

    fn shows(&self, frame: &Frame) -> bool {
        let (planes, eye) = (frame.frustum(), frame.camera.eye());
        self.meshes.iter().any(|(mesh, look)| {
            let mut spheres = mesh.spheres(look.scale).filter(|_| look.opacity > 0.0);
            spheres.any(|(center, radius)| shows(&planes, (center - eye).as_vec3(), radius as f32))
        })
    }

    fn prepare(&mut self, gpu: &Gpu, frame: &Frame) {
        let eye = frame.camera.eye();
        let planes = frame.frustum();
        for (index, shown) in self.chunks.iter_mut().enumerate() {
            let (mesh, look) = &self.meshes[shown.mesh];
            let chunk = &mesh.chunks[shown.chunk];
            let offset = (mesh.origin * look.scale - eye).as_vec3();
            let scale = look.scale as f32;
            let uniforms = MeshFrame {
                relative_from_mesh: offset.to_array(),
                opacity: look.opacity.clamp(0.0, 1.0),
                color_key: look.color_key,
                number: shown.mesh as u32,
                edges: u32::from(look.edges),
                first_half: chunk.first_half,
                scale,
                keyed: u32::from(chunk.keys.is_some()),
                pad: [0.0; 2],
            };
            let bytes = bytemuck::bytes_of(&uniforms);
            let place = UNIFORM_STRIDE * index as u64;
            gpu.queue.write_buffer(&self.frames, place, bytes);
            shown.shown.clear();
            if look.opacity <= 0.0 {
                continue;
            }
            for run in &chunk.runs {
                if !shows(&planes, scale * run.center + offset, scale * run.radius) {
                    continue;
                }
                match shown.shown.last_mut() {
                    Some(last) if last.end == run.corners.start => last.end = run.corners.end,
                    _ => shown.shown.push(run.corners.clone()),
                }
            }
        }
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        for (index, shown) in self.chunks.iter().enumerate() {
            let (mesh, look) = &self.meshes[shown.mesh];
            if shown.shown.is_empty() {
                continue;
            }
            pass.set_bind_group(0, &shown.group, &[UNIFORM_STRIDE as u32 * index as u32]);
            let corners = &mesh.chunks[shown.chunk].corners;
            pass.set_index_buffer(corners.slice(..), wgpu::IndexFormat::Uint32);
            for range in &shown.shown {
                // Edges need to know which corner of its triangle a vertex is.
                match look.edges {
                    true => pass.draw(range.clone(), 0..1),
                    false => pass.draw_indexed(range.clone(), 0, 0..1),
                }
            }
        }
    }
}

/// Defines `surface_vertex`, and the coverage of translucent surfaces.
pub(crate) fn vertex_shader() -> ShaderParts {
    let files = ["meshes.wgsl", "sheets.wgsl"].map(shader::file);
    let mut parts = ShaderParts::new(&files);
    parts.constants.u32("NO_INSTANCE", NO_INSTANCE);
    parts.constants.u32("MESH_BIT", MESH_BIT);
    parts.constants.f32("SHEET_DEPTH", SHEET_DEPTH);
    parts.constants.flag("SHEETS");
    parts
}

/// Group 0: vertices, corners, the frame, and keys.
pub(crate) fn entries() -> Vec<wgpu::BindGroupLayoutEntry> {
    let vertex = wgpu::ShaderStages::VERTEX;
    vec![
        storage(0, vertex, true),
        storage(1, vertex, true),
        uniform(2, wgpu::ShaderStages::VERTEX_FRAGMENT, true),
        storage(3, vertex, true),
    ]
}
