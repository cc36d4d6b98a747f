//! Shapes for tests of files.

use std::collections::{BTreeMap, BTreeSet};
use std::io::Cursor;

use glam::{DVec3, Vec3};
use neurotess_mesh::{Faces, Format, Surface, SurfaceMesh, SurfaceVertex, write};

/// A torus of quads, each third of them as two triangles; attributes differ from vertex to vertex.
pub(crate) fn torus(around: u32, across: u32, origin: DVec3) -> SurfaceMesh {
    let mut mesh = SurfaceMesh {
        origin,
        ..SurfaceMesh::default()
    };
    for i in 0..around {
        for j in 0..across {
            let turn = std::f32::consts::TAU;
            let (su, cu) = (turn * i as f32 / around as f32).sin_cos();
            let (sv, cv) = (turn * j as f32 / across as f32).sin_cos();
            let n = mesh.vertices.len() as i32;
            mesh.vertices.push(SurfaceVertex {
                position: Vec3::new((20.0 + 5.0 * cv) * cu, (20.0 + 5.0 * cv) * su, 5.0 * sv),
                normal: Vec3::new(cv * cu, cv * su, sv),
                kind: 1 + n % 4,
                point: n - 1,
                section: n / 7,
                radius: 5.0 + n as f32 / 64.0,
            });
        }
    }
    let at = |i: u32, j: u32| (i % around) * across + j % across;
    for i in 0..around {
        for j in 0..across {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            if (i + j) % 3 == 0 {
                mesh.faces.triangles.extend([[a, b, c], [a, c, d]]);
            } else {
                mesh.faces.quads.push([a, b, c, d]);
            }
        }
    }
    mesh
}

/// The bytes of a file.
pub(crate) fn written(mesh: &SurfaceMesh, format: Format) -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    write(mesh, format, &mut file).expect("a surface in memory is written");
    file.into_inner()
}

/// The JSON of a GLB.
pub(crate) fn json(glb: &[u8]) -> serde_json::Value {
    let length = u32::from_le_bytes(glb[12..16].try_into().expect("four")) as usize;
    serde_json::from_slice(&glb[20..20 + length]).expect("JSON")
}

/// Many blocks of few vertices and faces: as a surface refined patch by patch.
pub(crate) struct Blocks(pub(crate) SurfaceMesh, pub(crate) usize);

impl Surface for Blocks {
    fn origin(&self) -> DVec3 {
        self.0.origin
    }
    fn vertex_count(&self) -> usize {
        self.0.vertices.len()
    }
    fn triangle_count(&self) -> usize {
        self.0.faces.triangles.len()
    }
    fn quad_count(&self) -> usize {
        self.0.faces.quads.len()
    }
    fn vertex_blocks(&self) -> usize {
        self.0.vertices.len().div_ceil(self.1)
    }
    fn vertices(&self, block: usize, out: &mut Vec<SurfaceVertex>) {
        out.extend(self.0.vertices.iter().skip(block * self.1).take(self.1));
    }
    fn face_blocks(&self) -> usize {
        self.0
            .faces
            .quads
            .len()
            .max(self.0.faces.triangles.len())
            .div_ceil(self.1)
    }
    fn faces(&self, block: usize, out: &mut Faces) {
        out.triangles.extend(
            self.0
                .faces
                .triangles
                .iter()
                .skip(block * self.1)
                .take(self.1),
        );
        out.quads
            .extend(self.0.faces.quads.iter().skip(block * self.1).take(self.1));
    }
}

/// A cube of three voxels to a side as soma, and from three of its sides an axon, a basal and an apical dendrite, one
/// voxel thick and ten long. Each third face is two triangles.
pub(crate) fn neuron(origin: DVec3) -> SurfaceMesh {
    let mut voxels: BTreeSet<[i32; 3]> = BTreeSet::new();
    let side = || -1..=1;
    voxels.extend(side().flat_map(|x| side().flat_map(move |y| side().map(move |z| [x, y, z]))));
    voxels.extend((2..12).flat_map(|n| [[n, 0, 0], [-n, 0, 0], [0, n, 0]]));
    let mut mesh = SurfaceMesh {
        origin,
        ..SurfaceMesh::default()
    };
    let mut numbers = BTreeMap::new();
    for &voxel in &voxels {
        for axis in 0..3 {
            for sign in [-1, 1] {
                let mut next = voxel;
                next[axis] += sign;
                if voxels.contains(&next) {
                    continue;
                }
                let mut corners = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[u, v]| {
                    let mut corner = voxel.map(|x| 2 * x - 1);
                    corner[axis] += 1 + sign;
                    corner[(axis + 1) % 3] += 2 * u;
                    corner[(axis + 2) % 3] += 2 * v;
                    *numbers.entry(corner).or_insert_with(|| {
                        mesh.vertices.push(neuron_vertex(corner));
                        mesh.vertices.len() as u32 - 1
                    })
                });
                if sign < 0 {
                    corners.reverse();
                }
                let [a, b, c, d] = corners;
                if (mesh.faces.quads.len() + mesh.faces.triangles.len()).is_multiple_of(3) {
                    mesh.faces.triangles.extend([[a, b, c], [a, c, d]]);
                } else {
                    mesh.faces.quads.push(corners);
                }
            }
        }
    }
    mesh
}

fn neuron_vertex(corner: [i32; 3]) -> SurfaceVertex {
    let position = Vec3::from_array(corner.map(|x| x as f32));
    let section = match corner {
        [x, _, _] if x > 3 => 1,
        [x, _, _] if x < -3 => 2,
        [_, y, _] if y > 3 => 3,
        _ => 0,
    };
    SurfaceVertex {
        position,
        normal: position.normalize_or(Vec3::X),
        kind: section + 1,
        point: 1 + corner[0].abs().max(corner[1].abs()),
        section,
        radius: 1.0,
    }
}
