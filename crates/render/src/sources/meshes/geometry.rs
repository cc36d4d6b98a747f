//! A mesh on the device, in chunks and runs.

use std::ops::Range;

use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec3};
use neurotess_mesh::SurfaceMesh;
use neurotess_picture::meshes::Lit;
use neurotess_picture::octahedral::pack_normal;

use crate::gpu::buffers::upload;
use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;
use neurotess_picture::BoundingSphere;

/// Triangles in a run: some thousand, so that culling takes far less time than drawing.
const RUN: usize = 4096;
/// Triangles in a chunk: 128 runs, at most 24 MiB of vertices if no two triangles shared any.
const CHUNK: usize = 128 * RUN;

/// Twin of `MeshVertex` in `meshes.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct MeshVertex {
    pub(crate) x: f32,
    pub(crate) y: f32,
    pub(crate) z: f32,
    pub(crate) normal: u32,
}

/// Triangles that are culled as one.
pub(super) struct Run {
    /// Its range of the chunk's index buffer.
    pub(super) corners: Range<u32>,
    /// Bounding sphere, relative to the mesh's origin.
    pub(super) center: Vec3,
    pub(super) radius: f32,
}

/// Triangles with buffers of their own.
pub(super) struct Chunk {
    pub(super) vertices: wgpu::Buffer,
    pub(super) corners: wgpu::Buffer,
    /// Color keys of the vertices.
    pub(super) keys: Option<wgpu::Buffer>,
    pub(super) runs: Vec<Run>,
    /// Index of its first triangle that is half of a quad.
    pub(super) first_half: u32,
    triangles: usize,
}

/// A mesh on the device.
pub struct MeshGeometry {
    pub(super) origin: DVec3,
    pub(super) chunks: Vec<Chunk>,
}

impl MeshGeometry {
    /// Uploads a mesh.
    ///
    /// # Errors
    /// The device has no room for it.
    pub fn new(gpu: &Gpu, mesh: SurfaceMesh) -> Result<Self, DeviceError> {
        Self::with_keys(gpu, mesh, &[])
    }

    /// Uploads a mesh with a color key for each vertex: a category or, beside no
    /// [values of instances](crate::color::ColorTable::values), a fraction of the scale. Colors are interpolated between
    /// vertices, but for pictures that are colored anew, where a triangle has the color of its first vertex. Without keys
    /// it has the color of its look.
    ///
    /// # Errors
    /// The device has no room for it.
    ///
    /// # Panics
    /// If there are keys, but not one for each vertex.
    pub fn with_keys(gpu: &Gpu, mesh: SurfaceMesh, keys: &[u32]) -> Result<Self, DeviceError> {
        let origin = mesh.origin;
        let lit = Lit::new(mesh, keys);
        let mut chunks = Vec::new();
        // By vertex: its number within the chunk.
        let mut places = vec![u32::MAX; lit.vertices.len()];
        for (triangles, first) in lit.triangles.chunks(CHUNK).zip((0..).step_by(CHUNK)) {
            let first_half = lit.first_half.saturating_sub(first).min(triangles.len());
            let chunk = Chunk::new(gpu, &lit, triangles, &mut places);
            chunks.push(Chunk {
                first_half: first_half as u32,
                ..chunk
            });
            gpu.check()?;
        }
        Ok(Self { origin, chunks })
    }

    /// Number of triangles that have an area.
    pub fn triangles(&self) -> u64 {
        let triangles = self.chunks.iter().map(|chunk| chunk.triangles as u64);
        triangles.sum()
    }

    /// Bytes on the device.
    pub fn bytes(&self) -> u64 {
        let bytes = |chunk: &Chunk| {
            let keys = chunk.keys.as_ref().map_or(0, wgpu::Buffer::size);
            chunk.vertices.size() + chunk.corners.size() + keys
        };
        self.chunks.iter().map(bytes).sum()
    }

    /// Spheres that hold it, in the world (µm). `scale`: micrometers of a unit of its coordinates.
    pub fn spheres(&self, scale: f64) -> impl Iterator<Item = BoundingSphere> {
        let runs = self.chunks.iter().flat_map(|chunk| &chunk.runs);
        runs.map(move |run| {
            let center = self.origin + run.center.as_dvec3();
            (scale * center, scale * f64::from(run.radius))
        })
    }
}

impl Chunk {
    /// `places`: all `u32::MAX`, and left so.
    fn new(gpu: &Gpu, lit: &Lit, triangles: &[[u32; 3]], places: &mut [u32]) -> Self {
        let vertices = &lit.vertices;
        // Vertices are numbered within the chunk, in the order of first use.
        let mut used: Vec<u32> = Vec::new();
        let mut corners = Vec::with_capacity(3 * triangles.len());
        for &vertex in triangles.iter().flatten() {
            let place = &mut places[vertex as usize];
            if *place == u32::MAX {
                *place = used.len() as u32;
                used.push(vertex);
            }
            corners.push(*place);
        }
        for &vertex in &used {
            places[vertex as usize] = u32::MAX;
        }
        let position = |&corner: &u32| vertices[used[corner as usize] as usize][0];
        let runs = corners.chunks(3 * RUN).zip((0_u32..).step_by(3 * RUN));
        let runs = runs.map(|(run, first)| {
            let low = run.iter().map(position).fold(Vec3::MAX, Vec3::min);
            let high = run.iter().map(position).fold(Vec3::MIN, Vec3::max);
            Run {
                corners: first..first + run.len() as u32,
                center: low.midpoint(high),
                radius: low.distance(high) / 2.0,
            }
        });
        let runs = runs.collect();
        let stored = used.iter().map(|&vertex| {
            let [position, normal] = vertices[vertex as usize];
            let [x, y, z] = position.to_array();
            let normal = pack_normal(normal);
            MeshVertex { x, y, z, normal }
        });
        let stored: Vec<MeshVertex> = stored.collect();
        let keys = used
            .iter()
            .map(|&vertex| lit.keys.get(vertex as usize).copied());
        let keys: Option<Vec<u32>> = keys.collect();
        let storage = wgpu::BufferUsages::STORAGE;
        let index = storage | wgpu::BufferUsages::INDEX;
        Self {
            vertices: upload(gpu, "vertices", storage, &stored),
            corners: upload(gpu, "corners", index, &corners),
            keys: keys.map(|keys| upload(gpu, "keys", storage, &keys)),
            runs,
            first_half: 0,
            triangles: triangles.len(),
        }
    }
}
