//! The simplest vertex source: a surface that was refined beforehand, held whole in the GPU's
//! memory.
//!
//! Its memory grows with the level. The adaptive source is compared with it. Surfaces are cut into
//! **chunks** that each fit one binding, and chunks into **runs** of triangles, which are culled as
//! one.

use std::collections::BTreeMap;
use std::ops::Range;

use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec3};
use neurotess_mesh::{CoarseMesh, Role, SampleId, SurfaceMesh, SurfaceVertex};
use neurotess_refine::wgsl::ShaderParts;
use neurotess_refine::{Lod, RefineOptions, Refinement};

use crate::gpu::buffers::{UNIFORM_STRIDE, group_layout, storage, uniform};
use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;
use crate::gpu::shader;
use crate::sources::octahedral::pack_normal;
use crate::sources::{SourceKey, VertexSource};
use crate::view::bounds::{any_shows, bounds};
use crate::view::frame::Frame;
use crate::view::frustum::BoundingSphere;
use crate::view::frustum::shows;

/// Triangles in a run: some thousand, so that culling takes far less time than drawing.
const RUN: usize = 4096;
/// Triangles in a chunk: 128 runs, at most 36 MiB of vertices if no two triangles shared any.
const CHUNK: usize = 128 * RUN;

/// A coarse mesh with a color key for each tracing point, which
/// [`ColorTable`](crate::color::ColorTable) looks colors up by.
#[derive(Clone, Copy, Debug)]
pub struct PrerefinedSurface<'m> {
    /// The mesh.
    pub mesh: &'m CoarseMesh,
    /// One per tracing point.
    pub color_keys: &'m [u32],
}

/// Where a surface is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Index of the mesh.
    pub mesh: usize,
    /// Added to its coordinates (µm).
    pub translation: DVec3,
}

/// Twin of `StoredVertex` in `prerefined.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct StoredVertex {
    pub(crate) x: f32,
    pub(crate) y: f32,
    pub(crate) z: f32,
    /// 0 on somata.
    pub(crate) radius: f32,
    pub(crate) normal: u32,
    pub(crate) color_key: u32,
}

impl StoredVertex {
    fn position(&self) -> Vec3 {
        Vec3::new(self.x, self.y, self.z)
    }
}

/// Twin of `Placement` in `prerefined.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct Placement {
    pub(crate) relative_from_mesh: [f32; 3],
    pub(crate) instance: u32,
}

/// Sizes of what is kept on the device.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Resident {
    /// Patches of the coarse meshes.
    pub patches: usize,
    /// Tracing points of the coarse meshes.
    pub points: usize,
    /// Vertices of the surface.
    pub vertices: usize,
    /// Triangles of the surface.
    pub triangles: usize,
    /// Bytes of vertices.
    pub vertex_bytes: u64,
    /// Bytes of the index buffers.
    pub corner_bytes: u64,
    /// Number of coarse edges by level.
    pub levels: BTreeMap<u32, usize>,
}

struct Run {
    /// Its range of the chunk's index buffer.
    corners: Range<u32>,
    center: Vec3,
    radius: f32,
    /// Whether it was in view in any frame.
    drawn: bool,
}

struct Chunk {
    mesh: usize,
    group: wgpu::BindGroup,
    corners: wgpu::Buffer,
    runs: Vec<Run>,
    /// What the current frame draws: index of the place, and range of the index buffer.
    shown: Vec<(u32, Range<u32>)>,
}

/// A refined surface in the GPU's memory.
pub struct Prerefined {
    layout: wgpu::BindGroupLayout,
    placements: wgpu::Buffer,
    /// By place: index of the mesh, and the point of the world that its coordinates are relative
    /// to.
    places: Vec<(usize, DVec3)>,
    chunks: Vec<Chunk>,
    bounds: Vec<BoundingSphere>,
    resident: Resident,
    drawn: usize,
    /// Whether no two triangles share corners, as wireframes need.
    barycentric: bool,
}

impl Prerefined {
    /// Refines meshes and uploads them. `lod` returns the levels of the mesh with this index, in
    /// the mesh's coordinates; `barycentric`: whether a wireframe will be drawn.
    ///
    /// # Errors
    /// They do not fit the device.
    pub fn new(
        gpu: &Gpu,
        meshes: &[PrerefinedSurface<'_>],
        lod: impl Fn(usize) -> Lod<'static>,
        options: &RefineOptions,
        barycentric: bool,
    ) -> Result<Self, DeviceError> {
        let own = (0..meshes.len()).map(|mesh| Place {
            mesh,
            translation: DVec3::ZERO,
        });
        let places: Vec<Place> = own.collect();
        Self::placed(gpu, meshes, &places, lod, options, barycentric)
    }

    /// Like [`Prerefined::new`], with each mesh drawn at any number of places.
    ///
    /// # Errors
    /// They do not fit the device.
    ///
    /// # Panics
    /// If a place refers to a mesh that does not exist.
    pub fn placed(
        gpu: &Gpu,
        meshes: &[PrerefinedSurface<'_>],
        places: &[Place],
        lod: impl Fn(usize) -> Lod<'static>,
        options: &RefineOptions,
        barycentric: bool,
    ) -> Result<Self, DeviceError> {
        let placements = buffer(
            gpu,
            "placements",
            UNIFORM_STRIDE * places.len().max(1) as u64,
            wgpu::BufferUsages::UNIFORM,
        )?;
        let mut made = Self {
            layout: group_layout(&gpu.device, "prerefined", &entries()),
            placements,
            places: places
                .iter()
                .map(|place| {
                    (
                        place.mesh,
                        meshes[place.mesh].mesh.origin + place.translation,
                    )
                })
                .collect(),
            chunks: Vec::new(),
            bounds: places
                .iter()
                .flat_map(|place| {
                    let spheres = bounds(meshes[place.mesh].mesh).into_iter();
                    spheres.map(|(center, radius)| (center + place.translation, radius))
                })
                .collect(),
            resident: Resident::default(),
            drawn: 0,
            barycentric,
        };
        for (index, source) in meshes.iter().enumerate() {
            // A vertex of a surface knows its sample: with the index of the tracing point in its
            // place, the color key is found by it.
            let mut numbered = source.mesh.clone();
            for (point, number) in numbered.tracing.iter_mut().zip(0..) {
                point.sample = SampleId(number);
            }
            let refined = Refinement::new(&numbered, lod(index), options);
            for (level, edges) in refined.level_histogram() {
                *made.resident.levels.entry(level).or_default() += edges;
            }
            let surface = SurfaceMesh::collect(&refined);
            made.resident.patches += source.mesh.patches.len();
            made.resident.points += source.mesh.tracing.len();
            let store = |vertex: &SurfaceVertex| store(vertex, source);
            for triangles in surface.faces.triangles.chunks(CHUNK) {
                made.add(gpu, index, &surface.vertices, triangles, store)?;
            }
        }
        gpu.check()?;
        Ok(made)
    }

    /// Sizes of what is kept on the device.
    pub fn resident(&self) -> &Resident {
        &self.resident
    }

    /// Triangles of the runs that were in view in any frame.
    pub fn drawn(&self) -> usize {
        self.drawn
    }

    /// Triangles of the runs that are in view in the frame that was prepared last, at all places.
    pub fn shown(&self) -> usize {
        let shown = self.chunks.iter().flat_map(|chunk| &chunk.shown);
        shown.map(|(_, corners)| corners.len() / 3).sum()
    }

    /// About the number of patches that [`Prerefined::drawn`] triangles come from.
    pub fn patches_drawn(&self) -> usize {
        let Resident {
            patches, triangles, ..
        } = self.resident;
        (patches * self.drawn).div_ceil(triangles.max(1))
    }

    fn add(
        &mut self,
        gpu: &Gpu,
        mesh: usize,
        vertices: &[SurfaceVertex],
        triangles: &[[u32; 3]],
        store: impl Fn(&SurfaceVertex) -> StoredVertex,
    ) -> Result<(), DeviceError> {
        // Vertices are numbered within the chunk, in the order of first use.
        let mut place = vec![u32::MAX; vertices.len()];
        let mut stored = Vec::new();
        let mut corners = Vec::with_capacity(3 * triangles.len());
        for &vertex in triangles.iter().flatten() {
            let slot = &mut place[vertex as usize];
            if *slot == u32::MAX {
                *slot = stored.len() as u32;
                stored.push(store(&vertices[vertex as usize]));
            }
            corners.push(*slot);
        }
        let storage = wgpu::BufferUsages::STORAGE;
        let vertex_buffer = filled(gpu, "vertices", bytemuck::cast_slice(&stored), storage)?;
        let usage = storage | wgpu::BufferUsages::INDEX;
        let corner_buffer = filled(gpu, "corners", bytemuck::cast_slice(&corners), usage)?;
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("prerefined"),
            layout: &self.layout,
            entries: &[
                entry(0, vertex_buffer.as_entire_binding()),
                entry(1, corner_buffer.as_entire_binding()),
                entry(
                    2,
                    wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                        buffer: &self.placements,
                        offset: 0,
                        size: wgpu::BufferSize::new(size_of::<Placement>() as u64),
                    }),
                ),
            ],
        });
        self.resident.vertices += stored.len();
        self.resident.triangles += triangles.len();
        self.resident.vertex_bytes += vertex_buffer.size();
        self.resident.corner_bytes += corner_buffer.size();
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
        self.chunks.push(Chunk {
            mesh,
            group,
            corners: corner_buffer,
            runs: runs.collect(),
            shown: Vec::new(),
        });
        Ok(())
    }
}

impl VertexSource for Prerefined {
    fn shows(&self, frame: &Frame) -> bool {
        any_shows(&self.bounds, frame)
    }

    fn parts(&self) -> usize {
        self.bounds.len()
    }

    fn key(&self) -> SourceKey {
        SourceKey {
            name: "prerefined",
            variant: self.barycentric.into(),
            ..SourceKey::default()
        }
    }

    fn shader(&self, _shader: usize) -> ShaderParts {
        vertex_shader(self.barycentric)
    }

    fn layout(&self, _shader: usize) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    fn prepare(&mut self, gpu: &Gpu, frame: &Frame) -> Result<usize, DeviceError> {
        let eye = frame.camera.eye();
        let offsets = self
            .places
            .iter()
            .map(|&(_, origin)| (origin - eye).as_vec3());
        let offsets: Vec<Vec3> = offsets.collect();
        for (index, offset) in offsets.iter().enumerate() {
            let placement = Placement {
                relative_from_mesh: offset.to_array(),
                instance: index as u32,
            };
            let bytes = bytemuck::bytes_of(&placement);
            gpu.queue
                .write_buffer(&self.placements, UNIFORM_STRIDE * index as u64, bytes);
        }
        let planes = frame.frustum();
        for chunk in &mut self.chunks {
            chunk.shown.clear();
            let here = self.places.iter().zip(&offsets).zip(0_u32..);
            for ((_, &offset), place) in here.filter(|((place, _), _)| place.0 == chunk.mesh) {
                for run in &mut chunk.runs {
                    // A margin of 8 sub-pixels, since thin tubes are drawn a pixel wide.
                    let center = run.center + offset;
                    let pixels =
                        8.0 * frame.pixel().at(f64::from(center.length() + run.radius)) as f32;
                    if !shows(&planes, center, run.radius + pixels) {
                        continue;
                    }
                    if !run.drawn {
                        self.drawn += run.corners.len() / 3;
                        run.drawn = true;
                    }
                    match chunk.shown.last_mut() {
                        Some((of, last)) if *of == place && last.end == run.corners.start => {
                            last.end = run.corners.end;
                        }
                        _ => chunk.shown.push((place, run.corners.clone())),
                    }
                }
            }
        }
        Ok(1)
    }

    fn draw(&self, _round: usize, _shader: usize, pass: &mut wgpu::RenderPass<'_>) {
        for chunk in self.chunks.iter().filter(|chunk| !chunk.shown.is_empty()) {
            if !self.barycentric {
                pass.set_index_buffer(chunk.corners.slice(..), wgpu::IndexFormat::Uint32);
            }
            for (place, shown) in &chunk.shown {
                pass.set_bind_group(0, &chunk.group, &[UNIFORM_STRIDE as u32 * place]);
                if self.barycentric {
                    pass.draw(shown.clone(), 0..1);
                } else {
                    pass.draw_indexed(shown.clone(), 0, 0..1);
                }
            }
        }
    }
}

/// Defines `surface_vertex`. `barycentric`: no two triangles share corners.
pub(crate) fn vertex_shader(barycentric: bool) -> ShaderParts {
    let mut parts = ShaderParts::new(&[shader::file("prerefined.wgsl")]);
    parts.constants.bool("BARYCENTRIC", barycentric);
    parts
}

fn store(vertex: &SurfaceVertex, source: &PrerefinedSurface<'_>) -> StoredVertex {
    let tracing = vertex.point as usize;
    let soma = source.mesh.tracing[tracing].role == Role::Soma;
    StoredVertex {
        x: vertex.position.x,
        y: vertex.position.y,
        z: vertex.position.z,
        radius: if soma { 0.0 } else { vertex.radius },
        normal: pack_normal(vertex.normal),
        color_key: source.color_keys.get(tracing).copied().unwrap_or(0),
    }
}

/// Group 0: vertices, corners, and the placement of an instance.
pub(crate) fn entries() -> Vec<wgpu::BindGroupLayoutEntry> {
    let vertex = wgpu::ShaderStages::VERTEX;
    vec![
        storage(0, vertex, true),
        storage(1, vertex, true),
        uniform(2, vertex, true),
    ]
}

fn entry(binding: u32, resource: wgpu::BindingResource<'_>) -> wgpu::BindGroupEntry<'_> {
    wgpu::BindGroupEntry { binding, resource }
}

/// A buffer that can be written to.
fn buffer(
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
