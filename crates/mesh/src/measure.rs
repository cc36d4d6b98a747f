//! Volume and area of surfaces. Quads are split along the diagonal from their first corner, as in
//! every file that knows triangles only.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use crate::{CoarseMesh, Faces, Surface, SurfaceMesh};

/// Volume (µm³) and area (µm²).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measure {
    /// What the surface encloses: positive if the faces turn outwards. Means little if the surface
    /// is not closed: then it is taken about the center of the bounds.
    pub volume: f64,
    /// Sum over the faces.
    pub area: f64,
}

impl SurfaceMesh {
    /// Positions of vertices, relative to the origin.
    pub fn positions(&self) -> Vec<Vec3> {
        self.vertices.iter().map(|vertex| vertex.position).collect()
    }

    /// Volume and area.
    pub fn measure(&self) -> Measure {
        measure(&self.positions(), &self.faces)
    }
}

impl CoarseMesh {
    /// Positions of vertices, relative to the origin.
    pub fn positions(&self) -> Vec<Vec3> {
        self.vertices.iter().map(|vertex| vertex.position).collect()
    }

    /// The patches as quads.
    pub fn quads(&self) -> Faces {
        let quads = self.patches.iter().map(|patch| patch.corners).collect();
        Faces {
            triangles: Vec::new(),
            quads,
        }
    }

    /// Volume and area of the patches, each as two triangles.
    pub fn measure(&self) -> Measure {
        measure(&self.positions(), &self.quads())
    }
}

/// Volume and area of a surface made block by block; holds the positions and a block of faces a thread.
pub fn measure_surface(surface: &dyn Surface) -> Measure {
    let positions = positions(surface);
    let center = center(&positions);
    let of_block = |block: usize| {
        let mut faces = Faces::default();
        surface.faces(block, &mut faces);
        measure_about(center, &positions, &faces)
    };
    let blocks = (0..surface.face_blocks()).into_par_iter();
    let sums: Vec<Measure> = blocks.map(of_block).collect();
    sums.into_iter().fold(Measure::default(), Measure::plus)
}

/// Volume and area of faces. Equal input gives equal sums, whatever the number of threads.
pub fn measure(positions: &[Vec3], faces: &Faces) -> Measure {
    measure_about(center(positions), positions, faces)
}

/// Blocks of vertices that are made at once.
const AT_ONCE: usize = 64;

/// Positions of all blocks.
pub(crate) fn positions(surface: &dyn Surface) -> Vec<Vec3> {
    let mut positions = Vec::with_capacity(surface.vertex_count());
    let of_block = |&block: &usize| {
        let mut vertices = Vec::new();
        surface.vertices(block, &mut vertices);
        let positions: Vec<Vec3> = vertices.iter().map(|vertex| vertex.position).collect();
        positions
    };
    let blocks: Vec<usize> = (0..surface.vertex_blocks()).collect();
    for some in blocks.chunks(AT_ONCE) {
        let made: Vec<Vec<Vec3>> = some.par_iter().map(of_block).collect();
        made.into_iter().for_each(|made| positions.extend(made));
    }
    positions
}

impl Measure {
    fn plus(self, other: Self) -> Self {
        Self {
            volume: self.volume + other.volume,
            area: self.area + other.area,
        }
    }
}

/// Faces in one partial sum.
const CHUNK: usize = 1 << 14;

fn measure_about(center: DVec3, positions: &[Vec3], faces: &Faces) -> Measure {
    let at = |corner: u32| positions[corner as usize].as_dvec3() - center;
    let of = |[a, b, c]: [u32; 3]| {
        let [a, b, c] = [at(a), at(b), at(c)];
        let area = (b - a).cross(c - a).length() / 2.0;
        Measure {
            volume: a.dot(b.cross(c)) / 6.0,
            area,
        }
    };
    let triangles = partial_sums(&faces.triangles, |&face| of(face));
    let quads = partial_sums(&faces.quads, |&[a, b, c, d]| {
        of([a, b, c]).plus(of([a, c, d]))
    });
    triangles
        .into_iter()
        .chain(quads)
        .fold(Measure::default(), Measure::plus)
}

fn partial_sums<F: Sync>(faces: &[F], of: impl Fn(&F) -> Measure + Sync) -> Vec<Measure> {
    let chunks = faces.par_chunks(CHUNK);
    chunks
        .map(|chunk| {
            chunk
                .iter()
                .map(&of)
                .fold(Measure::default(), Measure::plus)
        })
        .collect()
}

fn center(positions: &[Vec3]) -> DVec3 {
    let empty = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    let (low, high) = positions
        .iter()
        .fold(empty, |(low, high), &p| (low.min(p), high.max(p)));
    if low.x <= high.x {
        (low.as_dvec3() + high.as_dvec3()) / 2.0
    } else {
        DVec3::ZERO
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unit_cube_has_volume_one_and_area_six() {
        let positions: Vec<Vec3> = [
            [0, 0, 0],
            [1, 0, 0],
            [1, 1, 0],
            [0, 1, 0],
            [0, 0, 1],
            [1, 0, 1],
            [1, 1, 1],
            [0, 1, 1],
        ]
        .map(|p: [i32; 3]| Vec3::from(p.map(|x| x as f32)) + 1000.0)
        .to_vec();
        let quads = [
            [0, 3, 2, 1],
            [4, 5, 6, 7],
            [0, 1, 5, 4],
            [1, 2, 6, 5],
            [2, 3, 7, 6],
            [3, 0, 4, 7],
        ];
        let faces = Faces {
            triangles: vec![],
            quads: quads.to_vec(),
        };
        let found = measure(&positions, &faces);
        assert!((found.volume - 1.0).abs() < 1e-12 && (found.area - 6.0).abs() < 1e-12);
        assert_eq!(measure(&[], &Faces::default()), Measure::default());
    }
}
