//! Meshes that are no cells, and which samples translucent ones cover. Twin of meshes.wgsl and sheets.wgsl, whose head
//! says how it works.

use std::borrow::Cow;

use glam::DVec3;
use neurotess_mesh::SurfaceMesh;
use neurotess_picture::MeshLook;
use neurotess_picture::meshes::{Lit, SHEET_DEPTH};
use rayon::prelude::*;

use crate::bins::{Bins, Triangle, Vertices};
use crate::fragment::{Paint, bayer};
use crate::geometry::{NO_INSTANCE, Painting, vertex};
use crate::projection::Projection;
use crate::triangle::Drawn;

/// Triangles that a task takes.
const TOGETHER: usize = 1 << 14;

/// A surface that is no cell, such as a brain region.
pub struct SceneMesh {
    lit: Lit,
    origin: DVec3,
    /// How it looks.
    pub look: MeshLook,
}

impl SceneMesh {
    /// A mesh with a color key for each vertex; without keys it has the color of its look. Triangles without an area are
    /// left out.
    ///
    /// # Panics
    /// If there are keys, but not one for each vertex.
    pub fn new(mesh: SurfaceMesh, keys: &[u32], look: MeshLook) -> Self {
        Self {
            origin: mesh.origin,
            lit: Lit::new(mesh, keys),
            look,
        }
    }

    /// Number of triangles.
    pub fn triangles(&self) -> usize {
        self.lit.triangles.len()
    }

    /// On the grid; none if nothing of it shows. `number`: its own among all.
    pub(crate) fn drawn<'a>(&'a self, number: u32, painting: &Painting<'a>) -> Option<Drawn<'a>> {
        let Self { lit, look, .. } = self;
        if look.opacity <= 0.0 {
            return None;
        }
        let projection = painting.projection;
        let offset = (self.origin * look.scale - projection.eye).as_vec3();
        let scale = look.scale as f32;
        let has_keys = !lit.keys.is_empty();
        let sheet = Sheet {
            number,
            opacity: look.opacity.clamp(0.0, 1.0),
            edges: look.edges,
            projection: *projection,
        };
        let on_grid = |corner: u32| {
            let [position, normal] = lit.vertices[corner as usize];
            let point = if has_keys { corner } else { 0 };
            vertex(projection, scale * position + offset, normal, point)
        };
        let parts = lit.triangles.par_chunks(TOGETHER).enumerate();
        let pieces = parts.map(|(part, triangles)| {
            let mut vertices = Vertices::default();
            let mut bins = Bins::default();
            if painting.watch.is_stopped() {
                return bins.finished(vertices, painting.grid.len());
            }
            for (index, &corners) in triangles.iter().enumerate() {
                let first = vertices.vertices.len() as u32;
                let made = corners.map(on_grid);
                made.into_iter().for_each(|vertex| vertices.push(vertex));
                let triangle = Triangle {
                    corners: [first, first + 1, first + 2],
                    is_front: true,
                    is_half: part * TOGETHER + index >= lit.first_half,
                };
                bins.add((painting.grid, projection), &vertices, triangle, true);
            }
            bins.finished(vertices, painting.grid.len())
        });
        let pieces = pieces.collect();
        let keys: Cow<'a, [u32]> = match has_keys {
            true => Cow::Borrowed(&lit.keys),
            false => Cow::Owned(vec![look.color_key]),
        };
        Some(Drawn {
            pieces,
            paint: Paint {
                colors: Cow::Owned(painting.colors.of_keys(&keys, NO_INSTANCE, 0)),
                keys,
                instance: NO_INSTANCE,
                sheet: Some(sheet),
                filled: None,
                wire: painting.wire,
            },
            perspective: projection.is_perspective(),
        })
    }
}

/// What decides which samples a mesh covers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sheet {
    number: u32,
    opacity: f32,
    edges: bool,
    projection: Projection,
}

impl Sheet {
    pub(crate) fn is_translucent(&self) -> bool {
        self.edges || self.opacity < 1.0
    }

    /// Coverage of a fragment. `line`: how strongly lines of a half width (sub-pixels) along the edges cover it.
    pub(crate) fn coverage(&self, line: impl Fn(f32) -> f32) -> f32 {
        match self.edges {
            true => self.opacity * line(self.projection.half_line()),
            false => self.opacity,
        }
    }

    /// The samples of a sub-pixel that are covered.
    pub(crate) fn mask(
        &self,
        coverage: f32,
        samples: u32,
        pixel: [i32; 2],
        nearness: f32,
        is_front: bool,
    ) -> u32 {
        if coverage >= 1.0 {
            return (1 << samples) - 1;
        }
        let turned = pixel.map(|n| (n + 4096) as u32);
        let block = turned.map(|n| n >> 1);
        let [x, y] = turned.map(|n| n & 1);
        let sheet = scrambled(2 * self.number + u32::from(is_front));
        let of_block = scrambled(sheet).wrapping_add(block[1]);
        let of_block = scrambled(scrambled(of_block).wrapping_add(block[0]));
        let begin = (of_block >> 8) as f32 / 16_777_216.0;
        let depth = self.projection.depth(nearness);
        let layer = ((self.steps_of_depth(depth) + begin).floor() as i32).wrapping_add(1 << 20);
        let layer = layer as u32;
        let seed = scrambled(of_block.wrapping_add(layer));
        let kind = match is_front {
            true => layer % 3,
            false => 3 + layer % 2,
        };
        let kind = (2 * self.number + kind) % 5;
        // Below a sixteenth, neighboring blocks differ.
        let [bx, by] = block.map(|n| n & 3);
        let fine = bayer([bx, by]) + 0.25 * bayer([bx >> 1, by >> 1]) - 0.125;
        let fine = fine - fine.floor();
        let first = 4 * (x + 2 * y);
        (0..samples).fold(0, |mask, k| {
            let place = place_of(first + k, kind, seed) as f32;
            mask | u32::from(place + fine < 16.0 * coverage) << k
        })
    }

    /// Steps of depth, of which each holds what counts as one layer.
    fn steps_of_depth(&self, depth: f32) -> f32 {
        let Projection {
            slope, flat, near, ..
        } = self.projection;
        match flat > 0.0 {
            true => depth / (SHEET_DEPTH * flat),
            false => libm::logf(depth.max(near)) / (SHEET_DEPTH * slope),
        }
    }
}

/// O'Neill, PCG: a family of simple fast space-efficient statistically good algorithms for random number generation, 2014.
fn scrambled(value: u32) -> u32 {
    let state = value.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

/// A product in the field of four elements.
fn product(a: u32, b: u32) -> u32 {
    let tables = [0, 0xe4, 0x78, 0x9c];
    (tables[a as usize & 3] >> (2 * b)) & 3
}

/// Place of a sample, from 0 to 15, in an order of this kind.
fn place_of(index: u32, kind: u32, seed: u32) -> u32 {
    let (row, column) = (index >> 2, index & 3);
    // Lines in the plane over that field: of each kind four, which are parallel.
    let (group, other) = match kind == 4 {
        true => (column, row),
        false => (row ^ product(kind & 3, column), column),
    };
    // Which group is first, and which sample in each, is random.
    let first = product(1 + (seed >> 2) % 3, group) ^ (seed & 3);
    let bits = seed >> (16 + 4 * first);
    let second = product(1 + ((seed >> 8) + first) % 3, other) ^ (bits & 3);
    4 * first + second
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_order_has_every_place_once() {
        for kind in 0..5 {
            for seed in (0..2000_u32).map(scrambled) {
                let mut places: Vec<u32> = (0..16).map(|k| place_of(k, kind, seed)).collect();
                places.sort_unstable();
                assert!(places.into_iter().eq(0..16), "{kind} {seed}");
            }
        }
    }
}
