//! Vertices and faces of some patches together, and what the whole surface encloses, from these.

use std::ops::Range;

use glam::{DVec3, Vec3};
use neurotess_mesh::{Faces, SurfaceVertex};
use rayon::prelude::*;

use crate::inner::coarse_vertex;
use crate::plan::Numbers;
use crate::refinement::{BLOCK, Refinement};

/// Vertices and faces of a block of patches: [`Refinement::patch_block`].
#[derive(Debug, Default)]
pub struct PatchBlock {
    /// All corners of its patches, and all vertices on their edges and inside, each once.
    pub vertices: Vec<SurfaceVertex>,
    /// Faces; their indices count from the first of the vertices.
    pub faces: Faces,
    /// By patch.
    numbers: Vec<Numbers>,
    corners: Places,
    edges: Places,
    /// Room for the numbers of a patch's vertices.
    rows: Vec<u32>,
}

/// Patches of a block: so few that their vertices stay in a processor's cache.
const PATCHES: usize = 128;

impl Refinement<'_> {
    /// Number of blocks of patches.
    pub fn patch_blocks(&self) -> usize {
        self.mesh.patches.len().div_ceil(PATCHES)
    }

    /// Vertices and faces of a block of patches, in place of what `out` holds. Indices of faces are the block's own, so
    /// blocks can be used one by one, in any order and from any thread, without the vertices of all. Vertices that
    /// several blocks share are in each, equal to the bit.
    pub fn patch_block(&self, block: usize, out: &mut PatchBlock) {
        let end = ((block + 1) * PATCHES).min(self.mesh.patches.len());
        let patches = block * PATCHES..end;
        self.block_vertices(patches.clone(), out);
        out.faces.triangles.clear();
        out.faces.quads.clear();
        for (patch, numbers) in patches.zip(&out.numbers) {
            let (rows, faces) = (&mut out.rows, &mut out.faces);
            let (mesh, options) = (self.mesh, &self.options);
            self.plan.faces(mesh, options, patch, numbers, rows, faces);
        }
    }

    /// Sets vertices and numbers of a block.
    fn block_vertices(&self, patches: Range<usize>, out: &mut PatchBlock) {
        out.vertices.clear();
        out.numbers.clear();
        out.corners.clear(4 * patches.len());
        out.edges.clear(4 * patches.len());
        let mut edges = Vec::with_capacity(4 * patches.len());
        let mut inside = Vec::with_capacity(patches.len());
        let mut next = 0;
        for patch in patches {
            let grid = self.plan.grid(self.mesh, &self.options, patch);
            let mut numbers = Numbers::default();
            if grid.nx > 0 {
                // Places of new vertices, whose values follow.
                let mut add = |count: usize| {
                    let first = next;
                    next += count;
                    first as u32
                };
                let corners = self.mesh.patches[patch].corners;
                for (number, corner) in numbers.corners.iter_mut().zip(corners) {
                    *number = out.corners.of(corner, || add(1));
                }
                let sides = self.plan.patch_edges[patch];
                for ((number, edge), level) in numbers.edges.iter_mut().zip(sides).zip(grid.levels)
                {
                    if level > 1 {
                        *number = out.edges.of(edge, || {
                            let first = add(level as usize - 1);
                            edges.push((edge, first as usize));
                            first
                        });
                    }
                }
                numbers.inner = add(grid.inner_count() as usize);
                inside.push((patch as u32, numbers.inner as usize));
            }
            out.numbers.push(numbers);
        }
        out.vertices.resize(next, SurfaceVertex::default());
        for (corner, place) in out.corners.all() {
            let vertex = &self.mesh.vertices[corner as usize];
            out.vertices[place as usize] = coarse_vertex(self.mesh, &self.options, vertex);
        }
        self.edge_vertices(edges, &mut out.vertices);
        self.patch_vertices(inside, &mut out.vertices);
    }

    /// Volume (µm³) and area (µm²) of the refined surface. Evaluates the whole surface, on all
    /// cores.
    pub fn volume_and_area(&self) -> (f64, f64) {
        let center = self
            .mesh
            .vertices
            .first()
            .map_or(Vec3::ZERO, |v| v.position);
        let count = self.mesh.patches.len();
        let sums: Vec<(f64, f64)> = (0..count.div_ceil(BLOCK))
            .into_par_iter()
            .map(|block| {
                let end = ((block + 1) * BLOCK).min(count);
                let mut out = PatchBlock::default();
                let mut sum = (0.0, 0.0);
                for start in (block * BLOCK..end).step_by(PATCHES) {
                    let patches = start..(start + PATCHES).min(end);
                    self.measure(patches, center, &mut out, &mut sum);
                }
                sum
            })
            .collect();
        sums.iter().fold((0.0, 0.0), |a, b| (a.0 + b.0, a.1 + b.1))
    }

    fn measure(
        &self,
        patches: Range<usize>,
        center: Vec3,
        out: &mut PatchBlock,
        sum: &mut (f64, f64),
    ) {
        self.block_vertices(patches.clone(), out);
        let at = |v: u32| -> DVec3 { (out.vertices[v as usize].position - center).as_dvec3() };
        for (patch, numbers) in patches.zip(&out.numbers) {
            let (rows, faces) = (&mut out.rows, &mut out.faces);
            faces.triangles.clear();
            faces.quads.clear();
            let (mesh, options) = (self.mesh, &self.options);
            self.plan.faces(mesh, options, patch, numbers, rows, faces);
            let quads = faces.quads.iter();
            let halves = quads.flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
            for [a, b, c] in faces.triangles.iter().copied().chain(halves) {
                let [a, b, c] = [at(a), at(b), at(c)];
                let cross = (b - a).cross(c - a);
                sum.0 += a.dot(cross) / 6.0;
                sum.1 += 0.5 * cross.length();
            }
        }
    }
}

/// Where corners or edges of a mesh are in a block: a table that is so small that it stays in a processor's cache.
#[derive(Debug, Default)]
struct Places {
    /// Corner or edge, and its place. Twice as many as can be needed, a power of two.
    slots: Vec<(u32, u32)>,
}

/// Of a slot that is free.
const FREE: u32 = u32::MAX;

impl Places {
    /// Forgets all, and makes room for this many.
    fn clear(&mut self, count: usize) {
        self.slots.clear();
        self.slots
            .resize((2 * count).next_power_of_two(), (FREE, 0));
    }

    /// The place of a thing: that of before, or that of now.
    fn of(&mut self, thing: u32, place: impl FnOnce() -> u32) -> u32 {
        let mask = self.slots.len() - 1;
        // Neighbors have numbers that follow one another.
        let mut at = thing as usize & mask;
        loop {
            let slot = &mut self.slots[at];
            if slot.0 == FREE {
                *slot = (thing, place());
                return slot.1;
            }
            if slot.0 == thing {
                return slot.1;
            }
            at = (at + 1) & mask;
        }
    }

    fn all(&self) -> impl Iterator<Item = (u32, u32)> {
        self.slots
            .iter()
            .copied()
            .filter(|&(thing, _)| thing != FREE)
    }
}
