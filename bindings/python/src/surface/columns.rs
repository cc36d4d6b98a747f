//! A surface as one array for each attribute.

use std::fmt::{self, Display, Formatter};
use std::sync::atomic::{AtomicBool, Ordering};

use glam::DVec3;
use neurotess::mesh::{Faces, Surface, SurfaceVertex};
use neurotess::recipe::memory::{self, TooLittleMemory};
use rayon::prelude::*;

/// Arrays of a surface. Positions are in the coordinates of the tracing.
#[derive(Clone, Debug, Default)]
pub(crate) struct Columns {
    pub(super) origin: DVec3,
    pub(super) vertices: Vec<[f64; 3]>,
    pub(super) normals: Vec<[f32; 3]>,
    pub(super) types: Vec<i32>,
    pub(super) points: Vec<i32>,
    pub(super) sections: Vec<i32>,
    pub(super) radii: Vec<f32>,
    pub(super) faces: Faces,
}

/// Why there are no arrays.
#[derive(Debug)]
pub(crate) enum Untaken {
    /// Another thread asked to stop.
    Stopped,
    /// There is too little memory for them.
    Memory(TooLittleMemory),
}

impl Display for Untaken {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Stopped => f.write_str("stopped"),
            Self::Memory(e) => write!(f, "{e}: choose a lower level="),
        }
    }
}

/// Blocks that are made at a time, for each thread: more make waiting for the slowest one rarer, and take memory
/// (a block of level 4 is about a megabyte).
const BLOCKS_PER_THREAD: usize = 2;

impl Columns {
    /// Collects all blocks of a surface, some at a time: each is made and written into its place by one thread.
    ///
    /// # Errors
    /// Another thread has set `stopped`.
    pub(crate) fn of(surface: &dyn Surface, stopped: &AtomicBool) -> Result<Self, Untaken> {
        let mut columns = Self::zero(surface).map_err(Untaken::Memory)?;
        let at_once = BLOCKS_PER_THREAD * rayon::current_num_threads();
        let mut made: Vec<Vec<SurfaceVertex>> = vec![Vec::new(); at_once];
        let mut rest = columns.rows();
        for first in (0..surface.vertex_blocks()).step_by(at_once) {
            if stopped.load(Ordering::Relaxed) {
                return Err(Untaken::Stopped);
            }
            let blocks = at_once.min(surface.vertex_blocks() - first);
            let made = made[..blocks].par_iter_mut().enumerate();
            let made: Vec<&[SurfaceVertex]> = made
                .map(|(block, out)| {
                    out.clear();
                    surface.vertices(first + block, out);
                    &out[..]
                })
                .collect();
            let places: Vec<_> = made.iter().map(|block| rest.take(block.len())).collect();
            let filled = places.into_par_iter().zip(made);
            filled.for_each(|(rows, block)| rows.fill(surface.origin(), block));
        }
        let mut made = vec![Faces::default(); at_once];
        let Faces { triangles, quads } = &mut columns.faces;
        let (mut triangles, mut quads) = (&mut triangles[..], &mut quads[..]);
        for first in (0..surface.face_blocks()).step_by(at_once) {
            if stopped.load(Ordering::Relaxed) {
                return Err(Untaken::Stopped);
            }
            let blocks = at_once.min(surface.face_blocks() - first);
            let made = made[..blocks].par_iter_mut().enumerate();
            let made: Vec<&Faces> = made
                .map(|(block, out)| {
                    out.triangles.clear();
                    out.quads.clear();
                    surface.faces(first + block, out);
                    &*out
                })
                .collect();
            let place = |faces: &&Faces| {
                let triangles = take(&mut triangles, faces.triangles.len());
                (triangles, take(&mut quads, faces.quads.len()))
            };
            let places: Vec<_> = made.iter().map(place).collect();
            places.into_par_iter().zip(made).for_each(|(to, faces)| {
                to.0.copy_from_slice(&faces.triangles);
                to.1.copy_from_slice(&faces.quads);
            });
        }
        Ok(columns)
    }

    /// Columns of the surface's size. Zeros cost nothing until they are written over: the system gives pages of
    /// them when they are first touched.
    fn zero(surface: &dyn Surface) -> Result<Self, TooLittleMemory> {
        let (count, triangles, quads) = (
            surface.vertex_count(),
            surface.triangle_count(),
            surface.quad_count(),
        );
        // All of them together, before the first.
        let [all, of_triangles, of_quads] = [count, triangles, quads].map(|n| n as u64);
        memory::check(52 * all + 12 * of_triangles + 16 * of_quads)?;
        Ok(Self {
            origin: surface.origin(),
            vertices: memory::filled([0.0; 3], count)?,
            normals: memory::filled([0.0; 3], count)?,
            types: memory::filled(0, count)?,
            points: memory::filled(0, count)?,
            sections: memory::filled(0, count)?,
            radii: memory::filled(0.0, count)?,
            faces: Faces {
                triangles: memory::filled([0; 3], triangles)?,
                quads: memory::filled([0; 4], quads)?,
            },
        })
    }

    fn rows(&mut self) -> Rows<'_> {
        Rows {
            vertices: &mut self.vertices,
            normals: &mut self.normals,
            types: &mut self.types,
            points: &mut self.points,
            sections: &mut self.sections,
            radii: &mut self.radii,
        }
    }

    /// Vertices and triangles that come from elsewhere: there are no attributes.
    pub(super) fn of_arrays(vertices: &[[f64; 3]], triangles: &[[u32; 3]]) -> Self {
        let count = vertices.len();
        Self {
            origin: DVec3::ZERO,
            vertices: vertices.to_vec(),
            normals: vec![[0.0; 3]; count],
            types: vec![0; count],
            points: vec![-1; count],
            sections: vec![-1; count],
            radii: vec![0.0; count],
            faces: Faces {
                triangles: triangles.to_vec(),
                quads: Vec::new(),
            },
        }
    }
}

/// Rows of the columns of vertices.
struct Rows<'c> {
    vertices: &'c mut [[f64; 3]],
    normals: &'c mut [[f32; 3]],
    types: &'c mut [i32],
    points: &'c mut [i32],
    sections: &'c mut [i32],
    radii: &'c mut [f32],
}

impl<'c> Rows<'c> {
    /// Takes the first rows away.
    fn take(&mut self, count: usize) -> Self {
        Self {
            vertices: take(&mut self.vertices, count),
            normals: take(&mut self.normals, count),
            types: take(&mut self.types, count),
            points: take(&mut self.points, count),
            sections: take(&mut self.sections, count),
            radii: take(&mut self.radii, count),
        }
    }

    fn fill(self, origin: DVec3, vertices: &[SurfaceVertex]) {
        let at = |v: &SurfaceVertex| (origin + v.position.as_dvec3()).to_array();
        fill(self.vertices, vertices, at);
        fill(self.normals, vertices, |v| v.normal.to_array());
        fill(self.types, vertices, |v| v.kind);
        fill(self.points, vertices, |v| v.point);
        fill(self.sections, vertices, |v| v.section);
        fill(self.radii, vertices, |v| v.radius);
    }
}

fn fill<T>(column: &mut [T], vertices: &[SurfaceVertex], value: impl Fn(&SurfaceVertex) -> T) {
    for (place, vertex) in column.iter_mut().zip(vertices) {
        *place = value(vertex);
    }
}

/// Takes the first items away.
fn take<'s, T>(rest: &mut &'s mut [T], count: usize) -> &'s mut [T] {
    let (first, others) = std::mem::take(rest).split_at_mut(count);
    *rest = others;
    first
}
