//! The simplest vertex source: a surface that was refined beforehand, held whole in the GPU's
//! memory.
//!
//! Its memory grows with the level. The adaptive source is compared with it. Surfaces are cut into
//! **chunks** that each fit one binding, and chunks into **runs** of triangles, which are culled as
//! one.

mod chunk;
mod stored;

use std::collections::BTreeMap;

use glam::{DVec3, Vec3};
use neurotess_mesh::{CoarseMesh, SampleId, SurfaceMesh};
use neurotess_refine::wgsl::ShaderParts;
use neurotess_refine::{Lod, RefineOptions, Refinement};

use crate::gpu::buffers::{UNIFORM_STRIDE, group_layout};
use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;
use crate::sources::{SourceKey, VertexSource};
use neurotess_picture::BoundingSphere;
use neurotess_picture::Frame;
use neurotess_picture::bounds::{any_shows, bounds};

use chunk::{CHUNK, Chunk, Part, buffer};

#[cfg(test)]
pub(crate) use stored::StoredVertex;
pub(crate) use stored::{Placement, entries, vertex_shader};

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
            for triangles in surface.faces.triangles.chunks(CHUNK) {
                let part = Part {
                    mesh: index,
                    source,
                    vertices: &surface.vertices,
                    triangles,
                };
                let chunk = Chunk::new(gpu, &made.layout, &made.placements, &part)?;
                chunk.count(&mut made.resident);
                made.chunks.push(chunk);
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
        self.chunks.iter().map(Chunk::shown).sum()
    }

    /// About the number of patches that [`Prerefined::drawn`] triangles come from.
    pub fn patches_drawn(&self) -> usize {
        let Resident {
            patches, triangles, ..
        } = self.resident;
        (patches * self.drawn).div_ceil(triangles.max(1))
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
            let mesh = chunk.mesh;
            let places = self.places.iter().zip(&offsets).zip(0..);
            let of_mesh = places.filter(|&((&(of, _), _), _)| of == mesh);
            let of_mesh = of_mesh.map(|((_, &offset), place)| (place, offset));
            self.drawn += chunk.cull(frame, &planes, of_mesh);
        }
        Ok(1)
    }

    fn draw(&self, _round: usize, _shader: usize, pass: &mut wgpu::RenderPass<'_>) {
        for chunk in &self.chunks {
            chunk.draw(self.barycentric, pass);
        }
    }
}
