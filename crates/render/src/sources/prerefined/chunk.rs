//! A part of a surface on the device, drawn and culled by runs of triangles.

use std::ops::Range;

use glam::{Vec3, Vec4};
use neurotess_mesh::SurfaceVertex;

use super::stored::{Placement, StoredVertex};
use super::{PrerefinedSurface, Resident};
use crate::gpu::buffers::UNIFORM_STRIDE;
use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;
use neurotess_picture::Frame;
use neurotess_picture::bounds::shows;

/// Triangles in a run: some thousand, so that culling takes far less time than drawing.
const RUN: usize = 4096;
/// Triangles in a chunk: 128 runs, at most 36 MiB of vertices if no two triangles shared any.
pub(super) const CHUNK: usize = 128 * RUN;

/// What a chunk is made of.
pub(super) struct Part<'a> {
    /// Index of the mesh.
    pub(super) mesh: usize,
    pub(super) source: &'a PrerefinedSurface<'a>,
    /// Vertices of the whole surface.
    pub(super) vertices: &'a [SurfaceVertex],
    pub(super) triangles: &'a [[u32; 3]],
}

impl Part<'_> {
    /// Its vertices, numbered in the order of first use, and their numbers by corner.
    fn stored(&self) -> (Vec<StoredVertex>, Vec<u32>) {
        let mut place = vec![u32::MAX; self.vertices.len()];
        let mut stored = Vec::new();
        let mut corners = Vec::with_capacity(3 * self.triangles.len());
        for &vertex in self.triangles.iter().flatten() {
            let slot = &mut place[vertex as usize];
            if *slot == u32::MAX {
                *slot = stored.len() as u32;
                let vertex = &self.vertices[vertex as usize];
                stored.push(StoredVertex::new(vertex, self.source));
            }
            corners.push(*slot);
        }
        (stored, corners)
    }
}

struct Run {
    /// Its range of the chunk's index buffer.
    corners: Range<u32>,
    center: Vec3,
    radius: f32,
    /// Whether it was in view in any frame.
    drawn: bool,
}

pub(super) struct Chunk {
    /// Index of the mesh.
    pub(super) mesh: usize,
    group: wgpu::BindGroup,
    vertices: wgpu::Buffer,
    corners: wgpu::Buffer,
    runs: Vec<Run>,
    /// What the current frame draws: index of the place, and range of the index buffer.
    shown: Vec<(u32, Range<u32>)>,
}

impl Chunk {
    /// Uploads a part of a surface. `layout`: that of group 0.
    pub(super) fn new(
        gpu: &Gpu,
        layout: &wgpu::BindGroupLayout,
        placements: &wgpu::Buffer,
        part: &Part<'_>,
    ) -> Result<Self, DeviceError> {
        let (stored, corners) = part.stored();
        let storage = wgpu::BufferUsages::STORAGE;
        let vertex_buffer = filled(gpu, "vertices", bytemuck::cast_slice(&stored), storage)?;
        let usage = storage | wgpu::BufferUsages::INDEX;
        let corner_buffer = filled(gpu, "corners", bytemuck::cast_slice(&corners), usage)?;
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("prerefined"),
            layout,
            entries: &[
                entry(0, vertex_buffer.as_entire_binding()),
                entry(1, corner_buffer.as_entire_binding()),
                entry(
                    2,
                    wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                        buffer: placements,
                        offset: 0,
                        size: wgpu::BufferSize::new(size_of::<Placement>() as u64),
                    }),
                ),
            ],
        });
        Ok(Self {
            mesh: part.mesh,
            group,
            vertices: vertex_buffer,
            corners: corner_buffer,
            runs: runs(&stored, &corners),
            shown: Vec::new(),
        })
    }

    /// Adds what it keeps on the device.
    pub(super) fn count(&self, resident: &mut Resident) {
        let [vertices, corners] = [&self.vertices, &self.corners].map(wgpu::Buffer::size);
        resident.vertices += vertices as usize / size_of::<StoredVertex>();
        resident.triangles += corners as usize / size_of::<[u32; 3]>();
        resident.vertex_bytes += vertices;
        resident.corner_bytes += corners;
    }

    /// Finds the runs that are in view. `places`: index and offset of each place of its mesh.
    /// Returns the number of triangles of runs that were in no frame before.
    pub(super) fn cull(
        &mut self,
        frame: &Frame,
        planes: &[Vec4; 5],
        places: impl Iterator<Item = (u32, Vec3)>,
    ) -> usize {
        self.shown.clear();
        let mut new = 0;
        for (place, offset) in places {
            for run in &mut self.runs {
                // A margin of 8 sub-pixels, since thin tubes are drawn a pixel wide.
                let center = run.center + offset;
                let pixels = 8.0 * frame.pixel().at(f64::from(center.length() + run.radius)) as f32;
                if !shows(planes, center, run.radius + pixels) {
                    continue;
                }
                if !run.drawn {
                    new += run.corners.len() / 3;
                    run.drawn = true;
                }
                match self.shown.last_mut() {
                    Some((of, last)) if *of == place && last.end == run.corners.start => {
                        last.end = run.corners.end;
                    }
                    _ => self.shown.push((place, run.corners.clone())),
                }
            }
        }
        new
    }

    /// Number of triangles in view, at all places.
    pub(super) fn shown(&self) -> usize {
        let shown = self.shown.iter();
        shown.map(|(_, corners)| corners.len() / 3).sum()
    }

    /// Draws what is in view. `barycentric`: no two triangles share corners.
    pub(super) fn draw(&self, barycentric: bool, pass: &mut wgpu::RenderPass<'_>) {
        if self.shown.is_empty() {
            return;
        }
        if !barycentric {
            pass.set_index_buffer(self.corners.slice(..), wgpu::IndexFormat::Uint32);
        }
        for (place, shown) in &self.shown {
            pass.set_bind_group(0, &self.group, &[UNIFORM_STRIDE as u32 * place]);
            if barycentric {
                pass.draw(shown.clone(), 0..1);
            } else {
                pass.draw_indexed(shown.clone(), 0, 0..1);
            }
        }
    }
}

/// Cuts triangles into runs.
fn runs(stored: &[StoredVertex], corners: &[u32]) -> Vec<Run> {
    let runs = corners.chunks(3 * RUN).zip((0_u32..).step_by(3 * RUN));
    let runs = runs.map(|(run, first)| {
        let positions = || run.iter().map(|&c| stored[c as usize].position());
        let low = positions().fold(Vec3::MAX, Vec3::min);
        let high = positions().fold(Vec3::MIN, Vec3::max);
        Run {
            corners: first..first + run.len() as u32,
            center: (low + high) / 2.0,
            radius: (high - low).length() / 2.0,
            drawn: false,
        }
    });
    runs.collect()
}

fn entry(binding: u32, resource: wgpu::BindingResource<'_>) -> wgpu::BindGroupEntry<'_> {
    wgpu::BindGroupEntry { binding, resource }
}

/// A buffer that can be written to.
pub(super) fn buffer(
    gpu: &Gpu,
    what: &'static str,
    bytes: u64,
    usage: wgpu::BufferUsages,
) -> Result<wgpu::Buffer, DeviceError> {
    let most = gpu.largest_binding();
    if bytes > most {
        return Err(DeviceError::TooLarge { what, bytes, most });
    }
    Ok(gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(what),
        size: bytes,
        usage: usage | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    }))
}

fn filled(
    gpu: &Gpu,
    what: &'static str,
    bytes: &[u8],
    usage: wgpu::BufferUsages,
) -> Result<wgpu::Buffer, DeviceError> {
    let buffer = buffer(gpu, what, bytes.len() as u64, usage)?;
    gpu.queue.write_buffer(&buffer, 0, bytes);
    gpu.check()?;
    Ok(buffer)
}
