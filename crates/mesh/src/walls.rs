//! Walls within a cell: between the soma and each neurite, so that tetrahedra have regions.
//!
//! The border between a soma and a neurite is a loop of edges: faces on one side are of section 0, those on the
//! other are not ([`FaceLabel`]). A **wall** closes the loop: a disk of triangles through its middle. Its
//! inner vertices have the type [`WALL`] and a negative section, so every format that tells types and sections
//! of faces tells walls from the membrane. Soma and neurites then bound a **region** each, and share walls.
//!
//! A mesh with walls is no manifold: three faces meet at the edges of a loop. It is for mesh generators.

use std::collections::{HashMap, HashSet};

use glam::Vec3;

use crate::forest::Forest;
use crate::{
    FaceLabel, Region, Surface, SurfaceMesh, SurfaceVertex, WALL, forward_surface,
    self_intersections_of,
};

/// A mesh with walls.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Walled {
    /// The membrane's vertices and triangles first, as they were, then those of the walls.
    pub mesh: SurfaceMesh,
    /// The soma, then the neurites that a wall parts from it; none without a wall.
    pub regions: Vec<Region>,
    /// The file's own numbers of tracing points at borders that got no wall, since they are no simple loop or the
    /// wall would have crossed the membrane.
    pub left_out: Vec<i32>,
}

/// Vertices of a loop that are joined to the middle of a disk; more get a ring of half as many in between.
const MAX_SPOKES: usize = 12;

/// How far a seed is from its wall, of the wall's radius.
const SEED: f32 = 0.1;

impl Surface for Walled {
    forward_surface!(
        mesh: origin vertex_count triangle_count quad_count vertex_blocks
        face_blocks faces vertices
    );

    fn regions(&self) -> Vec<Region> {
        self.regions.clone()
    }
}

/// Adds walls between somata and neurites to a closed surface of triangles. Quads stay, and have no part in it.
pub fn with_walls(mesh: SurfaceMesh) -> Walled {
    let (loops, mut left_out) = borders(&mesh);
    let disks: Vec<Disk> = loops
        .iter()
        .map(|border| Disk::new(&mesh, border))
        .collect();
    let crossing = crossing(&mesh, &disks);
    let mut walled = Walled {
        mesh,
        ..Walled::default()
    };
    for (disk, crosses) in disks.into_iter().zip(crossing) {
        if crosses {
            left_out.push(disk.label.point);
        } else {
            walled.add(&disk);
        }
    }
    left_out.sort_unstable();
    walled.left_out = left_out;
    walled
}

impl Walled {
    fn add(&mut self, disk: &Disk) {
        let seed = |share: f32| self.mesh.origin + disk.seed(share).as_dvec3();
        if self.regions.is_empty() {
            self.regions.push(Region {
                seed: seed(-SEED),
                kind: 1,
                section: 0,
            });
        }
        self.regions.push(Region {
            seed: seed(SEED),
            kind: disk.label.kind,
            section: disk.label.section,
        });
        let walls = self.regions.len() as i32 - 1;
        let first = self.mesh.vertices.len() as u32;
        let inner = disk.inner.iter().map(|&position| SurfaceVertex {
            position,
            normal: disk.normal,
            kind: WALL,
            point: disk.label.point,
            section: -walls,
            radius: disk.radius,
        });
        self.mesh.vertices.extend(inner);
        let triangles = disk.triangles.iter();
        let triangles = triangles.map(|face| face.map(|corner| corner.number(first)));
        self.mesh.faces.triangles.extend(triangles);
    }
}

/// The border between a soma and a neurite.
struct Border {
    /// Vertices in the order in which the neurite's faces run along them.
    vertices: Vec<u32>,
    /// Of a face of the neurite.
    label: FaceLabel,
}

/// Borders that are simple loops, one to a neurite, in the order of their first faces; and tracing points at others.
fn borders(mesh: &SurfaceMesh) -> (Vec<Border>, Vec<i32>) {
    let label = |face: &[u32; 3]| FaceLabel::of(face.map(|corner| &mesh.vertices[corner as usize]));
    let labels: Vec<FaceLabel> = mesh.faces.triangles.iter().map(label).collect();
    let faces = || mesh.faces.triangles.iter().zip(&labels);
    let sides = |face: &[u32; 3]| [0, 1, 2].map(|n| (face[n], face[(n + 1) % 3]));
    let of_somata: HashSet<(u32, u32)> = faces()
        .filter(|(_, label)| label.section == 0)
        .flat_map(|(face, _)| sides(face))
        .collect();
    let mut neurites = Forest::new(mesh.vertices.len());
    let mut next: HashMap<u32, u32> = HashMap::new();
    let mut starts: Vec<(u32, FaceLabel)> = Vec::new();
    let mut forked = Vec::new();
    for (face, &label) in faces().filter(|(_, label)| label.section != 0) {
        neurites.unite(face[0], face[1]);
        neurites.unite(face[1], face[2]);
        for (from, to) in sides(face) {
            if of_somata.contains(&(to, from)) {
                starts.push((from, label));
                if next.insert(from, to).is_some() {
                    forked.push(from);
                }
            }
        }
    }
    let mut loops: Vec<Border> = Vec::new();
    let mut left_out = Vec::new();
    let mut of_neurite: HashMap<u32, usize> = HashMap::new();
    let is_forked = |vertices: &[u32]| vertices.iter().any(|v| forked.contains(v));
    for (start, label) in starts {
        let (vertices, closes) = walk(&mut next, start);
        if vertices.is_empty() {
            // Its loop was walked from another vertex.
            continue;
        }
        *of_neurite.entry(neurites.root(start)).or_default() += 1;
        if !closes || vertices.len() < 3 || is_forked(&vertices) {
            left_out.push(label.point);
        } else {
            loops.push(Border { vertices, label });
        }
    }
    // A neurite with two borders, as one that comes back to its soma, is not parted from it by either.
    loops.retain(|border| {
        let alone = of_neurite.get(&neurites.root(border.vertices[0])) == Some(&1);
        if !alone {
            left_out.push(border.label.point);
        }
        alone
    });
    (loops, left_out)
}

/// Takes the loop from a vertex on out of the map of next vertices, and tells whether it closes.
fn walk(next: &mut HashMap<u32, u32>, start: u32) -> (Vec<u32>, bool) {
    let mut vertices = Vec::new();
    let mut at = start;
    while let Some(to) = next.remove(&at) {
        vertices.push(at);
        at = to;
    }
    (vertices, at == start)
}

/// A corner of a wall's triangle.
#[derive(Clone, Copy)]
enum Corner {
    /// A vertex of the membrane.
    Outer(u32),
    /// One of the wall's own.
    Inner(u32),
}

impl Corner {
    /// Its number in the mesh, where the wall's own vertices begin with `first`.
    fn number(self, first: u32) -> u32 {
        match self {
            Self::Outer(vertex) => vertex,
            Self::Inner(n) => first + n,
        }
    }
}

/// A wall.
struct Disk {
    label: FaceLabel,
    /// Positions of its own vertices; the middle is the last.
    inner: Vec<Vec3>,
    triangles: Vec<[Corner; 3]>,
    /// From the soma to the neurite.
    normal: Vec3,
    /// Mean distance of the loop from its middle (µm).
    radius: f32,
}

impl Disk {
    fn new(mesh: &SurfaceMesh, border: &Border) -> Self {
        let at = |vertex: u32| mesh.vertices[vertex as usize].position;
        let outer: Vec<Vec3> = border.vertices.iter().map(|&vertex| at(vertex)).collect();
        let count = outer.len() as f32;
        let middle = outer.iter().sum::<Vec3>() / count;
        let turns = (0..outer.len()).map(|n| {
            let [a, b] = [outer[n], outer[(n + 1) % outer.len()]];
            (a - middle).cross(b - middle)
        });
        let mut disk = Self {
            label: border.label,
            inner: Vec::new(),
            triangles: Vec::new(),
            normal: turns.sum::<Vec3>().normalize_or_zero(),
            radius: outer.iter().map(|p| p.distance(middle)).sum::<f32>() / count,
        };
        let mut ring: Vec<(Corner, Vec3)> = border
            .vertices
            .iter()
            .map(|&v| Corner::Outer(v))
            .zip(outer)
            .collect();
        while ring.len() > MAX_SPOKES {
            ring = disk.step_inwards(&ring, middle);
        }
        let center = disk.push(middle).0;
        for n in 0..ring.len() {
            let [a, b] = [ring[n].0, ring[(n + 1) % ring.len()].0];
            disk.triangles.push([a, b, center]);
        }
        disk
    }

    fn push(&mut self, position: Vec3) -> (Corner, Vec3) {
        self.inner.push(position);
        (Corner::Inner(self.inner.len() as u32 - 1), position)
    }

    /// A ring half as far from the middle with half as many vertices, joined to this one.
    fn step_inwards(&mut self, ring: &[(Corner, Vec3)], middle: Vec3) -> Vec<(Corner, Vec3)> {
        let inner: Vec<(Corner, Vec3)> = ring
            .chunks(2)
            .map(|pair| self.push((pair[0].1 + middle) / 2.0))
            .collect();
        for (n, pair) in ring.chunks(2).enumerate() {
            let (own, next) = (inner[n].0, inner[(n + 1) % inner.len()].0);
            let after = ring[(2 * n + pair.len()) % ring.len()].0;
            if let [a, b] = pair {
                self.triangles.push([a.0, b.0, own]);
                self.triangles.push([b.0, after, next]);
                self.triangles.push([own, b.0, next]);
            } else {
                self.triangles.push([pair[0].0, after, next]);
                self.triangles.push([pair[0].0, next, own]);
            }
        }
        inner
    }

    /// A point beside the middle: a share of the radius towards the neurite.
    fn seed(&self, share: f32) -> Vec3 {
        let middle = self.inner.last().copied().unwrap_or_default();
        middle + share * self.radius * self.normal
    }
}

/// For each wall, whether it crosses the membrane or another one.
fn crossing(mesh: &SurfaceMesh, disks: &[Disk]) -> Vec<bool> {
    let mut positions = mesh.positions();
    let mut faces = mesh.faces.clone();
    // Walls' faces come after all triangles, so quads keep their numbers behind them.
    let mut owners = Vec::new();
    let first_wall = faces.triangles.len();
    for (n, disk) in disks.iter().enumerate() {
        let first = positions.len() as u32;
        positions.extend(&disk.inner);
        let triangles = disk.triangles.iter();
        faces
            .triangles
            .extend(triangles.map(|face| face.map(|corner| corner.number(first))));
        owners.resize(faces.triangles.len() - first_wall, n);
    }
    let chosen: Vec<u32> = (first_wall as u32..faces.triangles.len() as u32).collect();
    let mut crosses = vec![false; disks.len()];
    for face in self_intersections_of(&positions, &faces, &chosen)
        .into_iter()
        .flatten()
    {
        if let Some(&owner) = (face as usize)
            .checked_sub(first_wall)
            .and_then(|n| owners.get(n))
        {
            crosses[owner] = true;
        }
    }
    crosses
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::Faces;
    use crate::topology;

    /// A box of `sides` walls with a tube on top of it: rings of vertices, closed by their middles. Of section 0
    /// up to `soma` rings.
    fn bottle(sides: u32, rings: u32, soma: u32, radius: impl Fn(u32) -> f32) -> SurfaceMesh {
        let mut mesh = SurfaceMesh {
            origin: DVec3::new(100.0, 0.0, 0.0),
            ..SurfaceMesh::default()
        };
        let mut vertex = |position: Vec3, ring: u32| {
            mesh.vertices.push(SurfaceVertex {
                position,
                section: i32::from(ring >= soma),
                kind: if ring < soma { 1 } else { 3 },
                point: ring as i32,
                ..SurfaceVertex::default()
            });
        };
        for ring in 0..rings {
            for side in 0..sides {
                let (sin, cos) = (std::f32::consts::TAU * side as f32 / sides as f32).sin_cos();
                vertex(
                    Vec3::new(radius(ring) * cos, radius(ring) * sin, ring as f32),
                    ring,
                );
            }
        }
        vertex(Vec3::new(0.0, 0.0, -0.5), 0);
        vertex(Vec3::new(0.0, 0.0, rings as f32 - 0.5), rings);
        let at = |ring: u32, side: u32| ring * sides + side % sides;
        let mut triangles = Vec::new();
        for side in 0..sides {
            triangles.push([at(0, side + 1), at(0, side), rings * sides]);
            triangles.push([
                at(rings - 1, side),
                at(rings - 1, side + 1),
                rings * sides + 1,
            ]);
            for ring in 1..rings {
                let [a, b] = [at(ring - 1, side), at(ring - 1, side + 1)];
                let [c, d] = [at(ring, side + 1), at(ring, side)];
                triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
        mesh.faces.triangles = triangles;
        mesh
    }

    /// The faces of one side, closed by the wall: a sphere.
    fn is_sphere(walled: &SurfaceMesh, take: impl Fn(FaceLabel) -> bool) -> bool {
        let label = |face: &[u32; 3]| FaceLabel::of(face.map(|c| &walled.vertices[c as usize]));
        let triangles = walled.faces.triangles.iter().copied();
        let faces = Faces {
            triangles: triangles.filter(|face| take(label(face))).collect(),
            quads: Vec::new(),
        };
        let shape = topology(&walled.positions(), &faces);
        shape.closed && shape.vertex_manifold && shape.euler == 2
    }

    #[test]
    fn a_wall_parts_soma_and_neurite() {
        for sides in [3, 8, 12, 13, 27, 64] {
            let mesh = bottle(sides, 6, 3, |ring| if ring < 3 { 2.0 } else { 1.0 });
            let (vertices, triangles) = (mesh.vertices.clone(), mesh.faces.triangles.clone());
            let walled = with_walls(mesh);
            assert!(walled.left_out.is_empty(), "{sides}");
            assert_eq!(walled.mesh.vertices[..vertices.len()], vertices);
            assert_eq!(walled.mesh.faces.triangles[..triangles.len()], triangles);
            assert!(
                is_sphere(&walled.mesh, |label| label.section <= 0),
                "{sides}"
            );
            assert!(
                is_sphere(&walled.mesh, |label| label.section != 0),
                "{sides}"
            );
            let [soma, neurite] = walled.regions[..] else {
                panic!("{:?}", walled.regions)
            };
            assert_eq!((soma.kind, soma.section), (1, 0));
            assert_eq!((neurite.kind, neurite.section), (3, 1));
            // The border is the ring of height 3.
            assert!(
                soma.seed.distance(DVec3::new(100.0, 0.0, 2.9)) < 1e-5,
                "{soma:?}"
            );
            assert!(neurite.seed.distance(DVec3::new(100.0, 0.0, 3.1)) < 1e-5);
        }
    }

    #[test]
    fn without_a_soma_or_a_neurite_there_is_no_wall() {
        for soma in [0, 9] {
            let mesh = bottle(8, 6, soma, |_| 1.0);
            let walled = with_walls(mesh.clone());
            assert_eq!((walled.mesh, walled.regions), (mesh, vec![]));
        }
    }

    #[test]
    fn a_wall_that_would_cross_the_membrane_is_left_out() {
        let mut mesh = bottle(8, 6, 3, |_| 1.0);
        // The bottom is pushed in, through the middle of the border.
        let bottom = mesh.vertices.len() - 2;
        mesh.vertices[bottom].position.z = 3.4;
        let walled = with_walls(mesh.clone());
        assert_eq!((walled.mesh, walled.left_out.len()), (mesh, 1));
    }
}
