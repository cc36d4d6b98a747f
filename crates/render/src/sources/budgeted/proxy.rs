//! What exploration mode keeps of a coarse mesh: chunks of its paths with simplified polylines, and
//! its somata.
//!
//! A **chunk** is up to 64 segments of a path, which are culled, selected and listed together. Its
//! positions and radii are stored in 65,535 steps of its own extent: 8 bytes a point. Each point of
//! a simplified polyline takes a byte, and all simplified polylines together have no more points
//! than the chunk.

use glam::{DVec3, Vec3};

use super::layout::{CHUNK_ONE_COLOR_KEY, CHUNK_SOMA, CHUNK_TWIG, Chunk};
use neurotess_picture::BoundingSphere;

/// A template for exploration mode, computed on the host, ready to be uploaded.
#[derive(Clone, Debug, Default)]
pub struct Proxy {
    pub(crate) origin: DVec3,
    pub(crate) chunks: Vec<Chunk>,
    pub(crate) packed: Vec<u32>,
    pub(crate) color_keys: Vec<u32>,
    /// By chunk: the tracing points that its color keys belong to.
    pub(super) colors: Vec<Vec<u32>>,
    pub(crate) center: Vec3,
    pub(crate) reach: f32,
    pub(super) points: usize,
}

impl Proxy {
    /// Sets the color keys, one for each tracing point of the mesh.
    pub fn set_color_keys(&mut self, color_keys: &[u32]) {
        self.color_keys.clear();
        for (chunk, colors) in self.chunks.iter_mut().zip(&self.colors) {
            let color_key = |&tracing: &u32| color_keys.get(tracing as usize).copied().unwrap_or(0);
            let first = colors.first().map_or(0, color_key);
            if colors.iter().all(|tracing| color_key(tracing) == first) {
                chunk.flags |= CHUNK_ONE_COLOR_KEY;
                chunk.color_keys = first;
            } else {
                chunk.flags &= !CHUNK_ONE_COLOR_KEY;
                chunk.color_keys = self.color_keys.len() as u32;
                self.color_keys.extend(colors.iter().map(color_key));
            }
        }
    }

    /// The same proxy with these color keys, one for each tracing point of the mesh.
    #[must_use]
    pub fn with_color_keys(&self, color_keys: &[u32]) -> Self {
        let mut colored = self.clone();
        colored.set_color_keys(color_keys);
        colored
    }

    /// Number of tracing points outside somata.
    pub fn point_count(&self) -> usize {
        self.points
    }

    /// Bounding sphere of the whole template, in the coordinates of the tracing (µm).
    pub fn sphere(&self) -> BoundingSphere {
        (self.origin + self.center.as_dvec3(), f64::from(self.reach))
    }

    /// Bounding spheres of the chunks, in the coordinates of the tracing (µm).
    pub fn spheres(&self) -> Vec<BoundingSphere> {
        let sphere = |chunk: &Chunk| {
            let center = Vec3::from_array(chunk.center).as_dvec3();
            (self.origin + center, f64::from(chunk.reach))
        };
        self.chunks.iter().map(sphere).collect()
    }

    /// Bytes on the device.
    pub fn bytes(&self) -> u64 {
        (size_of_val(&*self.chunks) + size_of_val(&*self.packed) + size_of_val(&*self.color_keys))
            as u64
    }

    /// The chunks that are somata.
    pub(super) fn somata(&self) -> &[Chunk] {
        let neurites = |chunk: &Chunk| chunk.flags & CHUNK_SOMA == 0;
        let somata = self.chunks.iter().position(neurites);
        &self.chunks[..somata.unwrap_or(self.chunks.len())]
    }

    /// The number of chunks before those that are twigs up to the last one, and the greatest length (µm) of these.
    pub(super) fn twigs(&self) -> (usize, f32) {
        let other = |chunk: &Chunk| chunk.flags & CHUNK_TWIG == 0;
        let before = self
            .chunks
            .iter()
            .rposition(other)
            .map_or(0, |last| last + 1);
        let lengths = self.chunks[before..].iter().map(|chunk| chunk.length);
        (before, lengths.fold(0.0, f32::max))
    }

    /// Sorts chunks: somata, then those that carry most. So the first ones of any instance are
    /// those that are worth most, wherever it is.
    pub(super) fn sort(&mut self) {
        let colors = std::mem::take(&mut self.colors);
        let mut all: Vec<(Chunk, Vec<u32>)> = self.chunks.drain(..).zip(colors).collect();
        let key = |chunk: &Chunk| (chunk.flags & CHUNK_SOMA == 0, -chunk.carried);
        all.sort_by(|(a, _), (b, _)| {
            let ((a, less), (b, more)) = (key(a), key(b));
            a.cmp(&b).then(less.total_cmp(&more))
        });
        (self.chunks, self.colors) = all.into_iter().unzip();
    }

    /// Adds a chunk with the tracing points that color it.
    pub(super) fn push(&mut self, chunk: Chunk, colors: Vec<u32>) {
        self.chunks.push(chunk);
        self.colors.push(colors);
    }
}

/// A chunk with offsets added to where its packed u32s and its color keys begin.
pub(super) fn moved(chunk: &Chunk, (packed, color_keys): (usize, usize)) -> Chunk {
    let mut chunk = *chunk;
    chunk.first += packed as u32;
    if chunk.flags & CHUNK_ONE_COLOR_KEY == 0 {
        chunk.color_keys += color_keys as u32;
    }
    chunk
}
