//! The tetrahedral reference sphere, of radius 1 about the origin.
//!
//! Two types. The **octahedron** is the paper's: its 8 tetrahedra and faces are split in two along
//! every edge `level` times, so that with N = 2^level there are 4·N² + 2 surface vertices, 4·N²
//! quads (the two triangles of a quad come from one quad, so that the pairing is by construction)
//! and 8·N³ tetrahedra. The **cube** has 6·n² quads of nearly equal size (equiangular map) over a
//! few shells, which serves better: neurites land closer to a quad's center, and quads are square.
//!
//! García-Cantero et al., Front. Neuroinform. 11:38, 2017, section on soma generation.

use std::collections::HashMap;
use std::f64::consts::FRAC_PI_4;

use glam::{DVec3, IVec3};

use crate::SphereKind;

/// Radius within which nodes do not move: without an anchor few and one-sided neurites would drag
/// the whole soma along.
pub(crate) const ANCHOR: f64 = 0.25;

/// Shells of the cube sphere, from the anchor outwards; growing so that cells stay about as high
/// as they are wide.
const CUBE_SHELLS: [f64; 4] = [ANCHOR, 0.42, 0.68, 1.0];

/// A sphere filled with tetrahedra. Surface nodes come first.
#[derive(Clone, Debug)]
pub(crate) struct Sphere {
    /// Nodes; the first `surface` of them have length 1.
    pub(crate) nodes: Vec<DVec3>,
    /// Number of surface nodes.
    pub(crate) surface: usize,
    /// Tetrahedra of positive volume.
    pub(crate) tetrahedra: Vec<[u32; 4]>,
    /// Surface quads, counter-clockwise seen from outside.
    pub(crate) quads: Vec<[u32; 4]>,
    /// Whether it is the same, tetrahedra included, mirrored at the planes x = 0, y = 0 and z = 0, and no
    /// tetrahedron crosses one of them.
    pub(crate) mirrored: bool,
}

impl Sphere {
    /// Makes the sphere of a kind and level.
    pub(crate) fn new(kind: SphereKind, level: u32) -> Self {
        match kind {
            SphereKind::Octahedron => octahedron(level.clamp(1, 5)),
            SphereKind::Cube => cube(level.clamp(2, 32)),
        }
    }

    /// Whether a node is held in place.
    pub(crate) fn anchored(&self, node: usize) -> bool {
        self.nodes[node].length() <= ANCHOR * (1.0 + 1e-9)
    }
}

fn octahedron(level: u32) -> Sphere {
    let n = 1_i32 << level;
    let shell = |p: IVec3| p.x.abs() + p.y.abs() + p.z.abs();
    let mut lattice = Vec::new();
    for s in [true, false] {
        for x in -n..=n {
            for y in -n..=n {
                for z in -n..=n {
                    let p = IVec3::new(x, y, z);
                    if (shell(p) == n) == s && shell(p) <= n {
                        lattice.push(p);
                    }
                }
            }
        }
    }
    let surface = lattice.iter().filter(|&&p| shell(p) == n).count();
    let index: HashMap<IVec3, u32> = lattice.iter().zip(0..).map(|(&p, i)| (p, i)).collect();
    let nodes: Vec<DVec3> = lattice
        .iter()
        .map(|&p| p.as_dvec3().normalize_or_zero() * (f64::from(shell(p)) / f64::from(n)))
        .collect();

    let mut tetrahedra = Vec::new();
    for octant in 0..8 {
        let sign = IVec3::new(1 - 2 * (octant & 1), 1 - (octant & 2), 1 - (octant & 4) / 2);
        for steps in kuhn_simplices(n) {
            let corner = steps.map(|[a, b, c]| index[&(IVec3::new(a, b - a, c - b) * sign)]);
            tetrahedra.push(positive(&nodes, corner));
        }
    }
    let mut quads = Vec::new();
    for (sx, sy) in [(1, 1), (-1, 1), (-1, -1), (1, -1)] {
        // One quad of the octahedron: pole, x, pole, y, split along x–y.
        let at = |p: i32, q: i32| {
            let (x, y, z) = if q >= p {
                (n - q, p, q - p)
            } else {
                (n - p, q, q - p)
            };
            index[&IVec3::new(x * sx, y * sy, z)]
        };
        for p in 0..n {
            for q in 0..n {
                quads.push(outward(
                    &nodes,
                    [at(p, q), at(p + 1, q), at(p + 1, q + 1), at(p, q + 1)],
                ));
            }
        }
    }
    Sphere {
        nodes,
        surface,
        tetrahedra,
        quads,
        mirrored: true,
    }
}

/// The n³ tetrahedra of Kuhn's triangulation in 0 ≤ a ≤ b ≤ c ≤ n.
fn kuhn_simplices(n: i32) -> Vec<[[i32; 3]; 4]> {
    const ORDERS: [[usize; 3]; 6] = [
        [0, 1, 2],
        [0, 2, 1],
        [1, 0, 2],
        [1, 2, 0],
        [2, 0, 1],
        [2, 1, 0],
    ];
    let mut simplices = Vec::new();
    for a in 0..n {
        for b in 0..n {
            for c in 0..n {
                for order in ORDERS {
                    let mut path = [[a, b, c]; 4];
                    for (step, &axis) in order.iter().enumerate() {
                        path[step + 1] = path[step];
                        path[step + 1][axis] += 1;
                    }
                    if path
                        .iter()
                        .all(|p| p[0] <= p[1] && p[1] <= p[2] && p[2] <= n)
                    {
                        simplices.push(path);
                    }
                }
            }
        }
    }
    simplices
}

fn cube(level: u32) -> Sphere {
    let n = level as i32;
    let direction = |p: IVec3| {
        let angle = |i: i32| (FRAC_PI_4 * (2.0 * f64::from(i) / f64::from(n) - 1.0)).tan();
        DVec3::new(angle(p.x), angle(p.y), angle(p.z)).normalize_or_zero()
    };
    let mut index: HashMap<IVec3, u32> = HashMap::new();
    let mut lattice = Vec::new();
    let mut quads = Vec::new();
    for axis in 0..3 {
        for side in [0, n] {
            let mut vertex = |i: i32, j: i32| {
                let mut p = [0; 3];
                (p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]) = (side, i, j);
                let p = IVec3::from_array(p);
                *index.entry(p).or_insert_with(|| {
                    lattice.push(p);
                    lattice.len() as u32 - 1
                })
            };
            for i in 0..n {
                for j in 0..n {
                    let q = [
                        vertex(i, j),
                        vertex(i + 1, j),
                        vertex(i + 1, j + 1),
                        vertex(i, j + 1),
                    ];
                    quads.push(if side == 0 {
                        [q[0], q[3], q[2], q[1]]
                    } else {
                        q
                    });
                }
            }
        }
    }
    let surface = lattice.len();
    let directions: Vec<DVec3> = lattice.iter().map(|&p| direction(p)).collect();
    let shells = CUBE_SHELLS.iter().rev();
    let nodes: Vec<DVec3> = shells
        .flat_map(|&radius| directions.iter().map(move |&d| d * radius))
        .collect();

    // Diagonals run by this order, so that they are mirrored where the cube's middle is a line between quads.
    let order = |v: u32| {
        let p = lattice[v as usize];
        ((p * 2 - n).abs().to_array(), v)
    };
    let mut tetrahedra = Vec::new();
    for quad in &quads {
        let first = (0..4)
            .min_by_key(|&i| order(quad[i]))
            .expect("a quad has corners");
        let q = |i: usize| quad[(first + i) % 4];
        for mut triangle in [[q(0), q(1), q(2)], [q(0), q(2), q(3)]] {
            triangle.sort_unstable_by_key(|&v| order(v));
            for layer in 0..CUBE_SHELLS.len() - 1 {
                prism(
                    &nodes,
                    triangle,
                    (surface * layer) as u32,
                    surface as u32,
                    &mut tetrahedra,
                );
            }
        }
    }
    Sphere {
        nodes,
        surface,
        tetrahedra,
        quads,
        mirrored: n % 2 == 0,
    }
}

/// Splits the prism over a triangle between two shells in three, so that neighbors agree on the
/// diagonals: each runs from the earlier corner outside to the later one inside.
fn prism(nodes: &[DVec3], triangle: [u32; 3], first: u32, shell: u32, out: &mut Vec<[u32; 4]>) {
    let [a, b, c] = triangle.map(|v| v + first);
    let [a1, b1, c1] = [a + shell, b + shell, c + shell];
    for corners in [[a, b, c, c1], [a, b, b1, c1], [a, a1, b1, c1]] {
        out.push(positive(nodes, corners));
    }
}

fn positive(nodes: &[DVec3], [a, b, c, d]: [u32; 4]) -> [u32; 4] {
    if volume(nodes, [a, b, c, d]) < 0.0 {
        [a, c, b, d]
    } else {
        [a, b, c, d]
    }
}

/// Signed volume of a tetrahedron.
pub(crate) fn volume(nodes: &[DVec3], corners: [u32; 4]) -> f64 {
    let [a, b, c, d] = corners.map(|i| nodes[i as usize]);
    (b - a).dot((c - a).cross(d - a)) / 6.0
}

fn outward(nodes: &[DVec3], [a, b, c, d]: [u32; 4]) -> [u32; 4] {
    let p = |i: u32| nodes[i as usize];
    if (p(c) - p(a)).cross(p(d) - p(b)).dot(p(a) + p(c)) < 0.0 {
        [a, d, c, b]
    } else {
        [a, b, c, d]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn octahedron_of_level_3_is_the_papers() {
        let sphere = Sphere::new(SphereKind::Octahedron, 3);
        assert_eq!(sphere.surface, 258);
        assert_eq!(sphere.nodes.len(), 833);
        assert_eq!(sphere.quads.len() * 2, 512);
        assert_eq!(sphere.tetrahedra.len(), 4096);
    }

    #[test]
    fn tetrahedra_fill_the_soma_sphere_and_meet_face_to_face() {
        for (kind, level) in [
            (SphereKind::Octahedron, 3),
            (SphereKind::Octahedron, 4),
            (SphereKind::Cube, 6),
            (SphereKind::Cube, 11),
        ] {
            let sphere = Sphere::new(kind, level);
            let mut faces: HashMap<[u32; 3], usize> = HashMap::new();
            let mut total = 0.0;
            for t in &sphere.tetrahedra {
                assert!(volume(&sphere.nodes, *t) > 1e-9, "{kind:?} {level}");
                total += volume(&sphere.nodes, *t);
                for leave in 0..4 {
                    let mut face: Vec<u32> = (0..4).filter(|&i| i != leave).map(|i| t[i]).collect();
                    face.sort_unstable();
                    *faces.entry([face[0], face[1], face[2]]).or_default() += 1;
                }
            }
            let outer = faces.values().filter(|&&n| n == 1).count();
            let hollow = if kind == SphereKind::Cube { 2 } else { 1 };
            assert!(faces.values().all(|&n| n <= 2));
            assert_eq!(outer, sphere.quads.len() * 2 * hollow);
            let core = if kind == SphereKind::Cube {
                ANCHOR.powi(3)
            } else {
                0.0
            };
            let soma_sphere = 4.0 / 3.0 * std::f64::consts::PI * (1.0 - core);
            assert!(
                total < soma_sphere && total > 0.93 * soma_sphere,
                "{total} of {soma_sphere}"
            );
        }
    }
}
