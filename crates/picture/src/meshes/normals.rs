//! Normals of any mesh, for its light.
//!
//! Files often have none, or wrong ones. A vertex gets the mean of the normals of its faces, weighted by their
//! angles there (Thürmer & Wüthrich, Computing vertex normals from polygonal facets, 1998), over all vertices at
//! the same place: STL repeats them for each face. A face that lies too far from that mean keeps its own normal, with
//! vertices of its own: so edges of boxes stay sharp, and faces that are turned the wrong way are lit as others.

use glam::Vec3;
use neurotess_mesh::{Faces, SurfaceMesh, merge_identical};

/// Cosine of the angle between a face and the mean at a vertex from which on there is a crease: 50°. At the corner of
/// a box it is 55°, at that of an icosahedron 37°.
const CREASE: f32 = 0.643;

/// A mesh of triangles with normals.
pub struct Lit {
    /// Positions and unit normals.
    pub vertices: Vec<[Vec3; 2]>,
    /// Indices of three vertices each.
    pub triangles: Vec<[u32; 3]>,
    /// Index of the first triangle that is half of a quad: its side across from its first corner is no edge.
    pub first_half: usize,
    /// Color keys of the vertices, if the mesh has any.
    pub keys: Vec<u32>,
}

impl Lit {
    /// Of a mesh. Triangles without an area are left out. `keys`: by vertex, or none; vertices at one place that differ in them stay
    /// apart.
    ///
    /// # Panics
    /// If there are keys, but not one for each vertex.
    pub fn new(mut mesh: SurfaceMesh, keys: &[u32]) -> Self {
        assert!(keys.is_empty() || keys.len() == mesh.vertices.len());
        let given = (!keys.is_empty()).then(|| mesh.faces.clone());
        merge_identical(&mut mesh);
        let corner_keys = given.map(|given| corner_keys(&given, &mesh.faces, keys));
        let positions: Vec<Vec3> = mesh.vertices.iter().map(|v| v.position).collect();
        let mut triangles = mesh.faces.triangles;
        triangles.retain(|&corners| has_area(corners));
        let first_half = triangles.len();
        let quads = mesh.faces.quads.iter();
        let halves = quads.flat_map(halved);
        triangles.extend(halves.filter(|&corners| has_area(corners)));
        let mut vertices: Vec<[Vec3; 2]> = means(&positions, &triangles)
            .into_iter()
            .zip(&positions)
            .map(|(normal, &position)| [position, normal])
            .collect();
        for corners in &mut triangles {
            let normal = face_normal(&positions, *corners);
            for corner in corners {
                let [position, mean] = vertices[*corner as usize];
                if normal.dot(mean) < CREASE {
                    *corner = vertices.len() as u32;
                    vertices.push([position, normal]);
                }
            }
        }
        let mut lit = Self {
            vertices,
            triangles,
            first_half,
            keys: Vec::new(),
        };
        if let Some(corner_keys) = corner_keys {
            lit.set_keys(&corner_keys);
        }
        lit
    }

    /// Gives vertices the keys of their corners; a corner whose key is another than its vertex has becomes a vertex of its
    /// own.
    fn set_keys(&mut self, corner_keys: &[[u32; 3]]) {
        self.keys = vec![NO_KEY; self.vertices.len()];
        let corners = self.triangles.iter_mut().flatten();
        for (corner, &key) in corners.zip(corner_keys.iter().flatten()) {
            let known = &mut self.keys[*corner as usize];
            if *known == NO_KEY {
                *known = key;
            } else if *known != key {
                let vertex = self.vertices[*corner as usize];
                *corner = self.vertices.len() as u32;
                self.vertices.push(vertex);
                self.keys.push(key);
            }
        }
    }
}

/// A key that none has: the last category.
const NO_KEY: u32 = u32::MAX;

/// The triangles of a quad. They share the side across from the first corner of each.
fn halved(&[a, b, c, d]: &[u32; 4]) -> [[u32; 3]; 2] {
    [[a, b, d], [c, d, b]]
}

/// By triangle that has an area after vertices were `merged`: the keys of its corners as they were `given`.
fn corner_keys(given: &Faces, merged: &Faces, keys: &[u32]) -> Vec<[u32; 3]> {
    let all = |faces: &Faces| -> Vec<[u32; 3]> {
        let halves = faces.quads.iter().flat_map(halved);
        faces.triangles.iter().copied().chain(halves).collect()
    };
    let pairs = all(given).into_iter().zip(all(merged));
    let shown = pairs.filter(|(_, merged)| has_area(*merged));
    shown
        .map(|(given, _)| given.map(|vertex| keys[vertex as usize]))
        .collect()
}

fn has_area([a, b, c]: [u32; 3]) -> bool {
    a != b && b != c && c != a
}

fn face_normal(positions: &[Vec3], corners: [u32; 3]) -> Vec3 {
    let [a, b, c] = corners.map(|corner| positions[corner as usize]);
    (b - a).cross(c - a).normalize_or_zero()
}

/// The mean normal at each vertex.
fn means(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let mut sums = vec![Vec3::ZERO; positions.len()];
    for &corners in triangles {
        let normal = face_normal(positions, corners);
        for k in 0..3 {
            let [at, next, last] = [k, k + 1, k + 2].map(|k| corners[k % 3] as usize);
            let sides = [next, last].map(|to| positions[to] - positions[at]);
            let [one, other] = sides.map(Vec3::normalize_or_zero);
            sums[at] += normal * one.dot(other).clamp(-1.0, 1.0).acos();
        }
    }
    sums.into_iter().map(Vec3::normalize_or_zero).collect()
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use neurotess_mesh::SurfaceVertex;

    use super::*;

    fn mesh(positions: &[[f32; 3]], faces: Faces) -> SurfaceMesh {
        let vertex = |&position: &[f32; 3]| SurfaceVertex {
            position: position.into(),
            ..SurfaceVertex::default()
        };
        SurfaceMesh {
            origin: DVec3::ZERO,
            vertices: positions.iter().map(vertex).collect(),
            faces,
        }
    }

    /// A box of quads, whose vertices each face has for itself, as in STL.
    fn cube() -> SurfaceMesh {
        let mut positions = Vec::new();
        let mut quads = Vec::new();
        for axis in 0..3 {
            for side in [-1.0, 1.0] {
                let first = positions.len() as u32;
                let corner = |u: f32, v: f32| {
                    let mut p = [0.0; 3];
                    p[axis] = side;
                    p[(axis + 1) % 3] = u * side;
                    p[(axis + 2) % 3] = v;
                    p
                };
                positions.extend([
                    corner(-1.0, -1.0),
                    corner(1.0, -1.0),
                    corner(1.0, 1.0),
                    corner(-1.0, 1.0),
                ]);
                quads.push([first, first + 1, first + 2, first + 3]);
            }
        }
        let triangles = Vec::new();
        mesh(&positions, Faces { triangles, quads })
    }

    #[test]
    fn faces_of_a_box_are_flat() {
        let lit = Lit::new(cube(), &[]);
        assert_eq!((lit.triangles.len(), lit.first_half), (12, 0));
        for corners in &lit.triangles {
            let [a, b, c] = corners.map(|corner| lit.vertices[corner as usize]);
            let flat = (b[0] - a[0]).cross(c[0] - a[0]).normalize_or_zero();
            for [_, normal] in [a, b, c] {
                assert!(normal.distance(flat) < 1e-6, "{normal} {flat}");
            }
            // Outwards: away from the center.
            assert!(flat.dot(a[0]) > 0.5);
        }
    }

    #[test]
    fn a_ridge_that_is_not_steep_is_smooth() {
        // Two triangles that share an edge, 40° apart, the vertices of the edge repeated.
        let (y, z) = 40.0_f32.to_radians().sin_cos();
        let positions = [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.5, -1.0, 0.0],
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.5, z, y],
        ];
        let triangles = vec![[1, 0, 2], [3, 4, 5], [0, 1, 1]];
        let quads = Vec::new();
        let lit = Lit::new(mesh(&positions, Faces { triangles, quads }), &[]);
        assert_eq!((lit.triangles.len(), lit.vertices.len()), (2, 4));
    }

    #[test]
    fn vertices_at_one_place_with_several_keys_stay_apart() {
        // Each face has its vertices for itself; the first three are of one color, as smooth meshes are.
        let flat = mesh(
            &[
                [0.0; 3],
                [1.0, 0.0, 0.0],
                [0.0, 1.0, 0.0],
                [1.0, 0.0, 0.0],
                [1.0, 1.0, 0.0],
                [0.0, 1.0, 0.0],
            ],
            Faces {
                triangles: vec![[0, 1, 2], [1, 1, 2], [3, 4, 5]],
                quads: vec![[0, 1, 4, 2]],
            },
        );
        let keys = [7, 7, 7, 7, 9, 8];
        let lit = Lit::new(flat, &keys);
        let of_corners = lit
            .triangles
            .iter()
            .map(|t| t.map(|v| lit.keys[v as usize]));
        let of_corners: Vec<_> = of_corners.collect();
        assert_eq!(of_corners, [[7, 7, 7], [7, 9, 8], [7, 7, 7], [9, 7, 7]]);
        assert_eq!((lit.vertices.len(), lit.keys.len()), (5, 5));
        for (triangle, expected) in lit.triangles.iter().zip([[0, 1, 2], [1, 3, 2]]) {
            for (&vertex, at) in triangle.iter().zip(expected) {
                assert_eq!(lit.vertices[vertex as usize][0], lit.vertices[at][0]);
            }
        }
    }
}
