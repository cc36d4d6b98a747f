//! The triangles that markers are drawn with: a square and a dome, which face the viewer, and spheres of ever
//! more triangles; for contacts these spheres with a disc.

use std::f32::consts::TAU;
use std::ops::Range;

use glam::Vec3;

/// Corners of all shapes, three to a triangle, and in the last component what they are relative to.
pub struct Shapes {
    /// The corners.
    pub corners: Vec<[f32; 4]>,
    /// By shape, the simplest first: its range of the corners. After those of spheres, those of contacts, as many.
    pub ranges: Vec<Range<u32>>,
}

/// What a marker is drawn as.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum MarkerShape {
    /// A dot of the least size, however near it is.
    Point,
    /// A sphere.
    #[default]
    Sphere,
    /// A sphere on a flat disc that lies on the membrane, for markers that know which way is outwards.
    Contact,
}

/// Radius (sub-pixels) from which on a marker has the shape of this index. With 8, 80, 320 and 1,280 triangles
/// a sphere's outline stays within half a sub-pixel of a circle up to the next radius.
const FROM: [f32; 5] = [0.0, 2.0, 6.0, 16.0, 64.0];
/// Last component of a corner of a sphere: a unit vector in the world.
const IN_WORLD: f32 = 0.0;
/// Of a corner of a dome: a unit vector along the view's right, up and backward.
const IN_VIEW: f32 = 1.0;
/// Of a corner of a square: the same, but its normal is backward.
const FLAT: f32 = 2.0;
/// Of a corner of a sphere that lies on a disc: a unit vector in the world.
const LIFTED: f32 = 3.0;
/// Of a corner of a disc: a unit vector along the membrane, and how far outwards it is.
const TOP: f32 = 4.0;
const EDGE: f32 = 5.0;
const BOTTOM: f32 = 6.0;
/// Triangles of a dome.
const SIDES: usize = 8;
/// Radius (sub-pixels) of a sphere from which on its disc shows, and from which on it is whole.
pub const GROWS: [f32; 2] = [6.0, 12.0];
/// Radius of a disc, in radii of its sphere.
pub const DISC: f32 = 2.0;
/// How far the sphere is lifted outwards, in its radii.
pub const LIFT: f32 = 0.9;
/// Half the thickness of a disc, in radii of the sphere.
const HALF: f32 = 0.12;

impl Default for Shapes {
    fn default() -> Self {
        Self::new()
    }
}

impl Shapes {
    /// All of them.
    pub fn new() -> Self {
        let square = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let square = [0, 1, 2, 0, 2, 3].map(|k: usize| [square[k][0], square[k][1], 1.0, FLAT]);
        let rim = |k: usize| {
            let (y, x) = (TAU * k as f32 / SIDES as f32).sin_cos();
            [x, y, 0.0, IN_VIEW]
        };
        let dome = (0..SIDES).flat_map(|k| [[0.0, 0.0, 1.0, IN_VIEW], rim(k), rim(k + 1)]);
        let mut shapes = Self {
            corners: Vec::new(),
            ranges: Vec::new(),
        };
        shapes.push(square);
        shapes.push(dome);
        let (flat, mut contacts) = (shapes.ranges.clone(), Vec::new());
        let mut triangles = icosahedron();
        while shapes.ranges.len() < FROM.len() {
            triangles = triangles.into_iter().flat_map(quartered).collect();
            let sphere = |kind| {
                triangles
                    .iter()
                    .flatten()
                    .map(move |c| [c.x, c.y, c.z, kind])
            };
            let round = disc(12 << contacts.len());
            contacts.push(sphere(LIFTED).chain(round).collect::<Vec<_>>());
            shapes.push(sphere(IN_WORLD).collect::<Vec<_>>());
        }
        // Small ones are like those of spheres.
        shapes.ranges.extend(flat);
        for contact in contacts {
            shapes.push(contact);
        }
        shapes
    }

    fn push(&mut self, corners: impl IntoIterator<Item = [f32; 4]>) {
        let first = self.corners.len() as u32;
        self.corners.extend(corners);
        self.ranges.push(first..self.corners.len() as u32);
    }

    /// The index of what is drawn for a marker of this radius (sub-pixels).
    pub fn of_radius(shape: MarkerShape, radius: f32) -> usize {
        let level = FROM.iter().rposition(|&from| radius >= from).unwrap_or(0);
        match shape {
            MarkerShape::Point => 0,
            MarkerShape::Sphere => level,
            MarkerShape::Contact => FROM.len() + level,
        }
    }

    /// Number of triangles of a shape.
    pub fn triangles(&self, shape: usize) -> usize {
        self.ranges[shape].len() / 3
    }
}

/// Corners of a flat disc with this many corners around.
fn disc(sides: usize) -> impl Iterator<Item = [f32; 4]> {
    let rim = move |k: usize, height: f32, kind: f32| {
        let (y, x) = (TAU * k as f32 / sides as f32).sin_cos();
        [x, y, height, kind]
    };
    (0..sides).flat_map(move |k| {
        let [top, low] = [(HALF, TOP), (-HALF, BOTTOM)].map(|(height, kind)| {
            [
                [0.0, 0.0, height, kind],
                rim(k, height, kind),
                rim(k + 1, height, kind),
            ]
        });
        let [a, b] = [k, k + 1].map(|k| [rim(k, -HALF, EDGE), rim(k, HALF, EDGE)]);
        let turned = [low[0], low[2], low[1]];
        let edge = [a[0], b[0], b[1], a[0], b[1], a[1]];
        top.into_iter().chain(turned).chain(edge)
    })
}

fn quartered([a, b, c]: [Vec3; 3]) -> [[Vec3; 3]; 4] {
    let half = |p: Vec3, q: Vec3| (p + q).normalize_or(Vec3::Y);
    let (ab, bc, ca) = (half(a, b), half(b, c), half(c, a));
    [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
}

fn icosahedron() -> Vec<[Vec3; 3]> {
    let golden = f32::midpoint(1.0, 5.0_f32.sqrt());
    let mut corners = Vec::new();
    for a in [-1.0, 1.0] {
        for b in [-golden, golden] {
            corners.extend([
                Vec3::new(0.0, a, b),
                Vec3::new(a, b, 0.0),
                Vec3::new(b, 0.0, a),
            ]);
        }
    }
    // Corners at the distance of an edge, 2, are neighbors; faces are turned outwards.
    let near = |p: Vec3, q: Vec3| (p.distance(q) - 2.0).abs() < 1e-3;
    let mut triangles = Vec::new();
    for (i, &p) in corners.iter().enumerate() {
        for (j, &q) in corners.iter().enumerate().skip(i + 1) {
            for &r in &corners[j + 1..] {
                if near(p, q) && near(q, r) && near(r, p) {
                    let outwards = (q - p).cross(r - p).dot(p) > 0.0;
                    let turned = if outwards { [p, q, r] } else { [p, r, q] };
                    triangles.push(turned.map(|p| p.normalize_or(Vec3::Y)));
                }
            }
        }
    }
    triangles
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spheres_are_closed_and_face_outwards() {
        let shapes = Shapes::new();
        let counts: Vec<usize> = (0..FROM.len()).map(|s| shapes.triangles(s)).collect();
        assert_eq!(counts, [2, 8, 80, 320, 1280]);
        for range in &shapes.ranges[2..FROM.len()] {
            let corners = &shapes.corners[range.start as usize..range.end as usize];
            let volume: f32 = corners
                .chunks(3)
                .map(|t| {
                    let [a, b, c] = [0, 1, 2].map(|k: usize| Vec3::new(t[k][0], t[k][1], t[k][2]));
                    a.dot(b.cross(c)) / 6.0
                })
                .sum();
            assert!((3.5..4.19).contains(&volume), "{volume}");
        }
    }

    #[test]
    fn larger_markers_have_finer_shapes() {
        let of = |shape| [0.3, 2.0, 6.0, 20.0, 1e4].map(|radius| Shapes::of_radius(shape, radius));
        assert_eq!(of(MarkerShape::Sphere), [0, 1, 2, 3, 4]);
        assert_eq!(of(MarkerShape::Contact), [5, 6, 7, 8, 9]);
        assert_eq!(of(MarkerShape::Point), [0; 5]);
    }

    #[test]
    fn contacts_have_a_closed_disc_that_faces_outwards() {
        let shapes = Shapes::new();
        let counts: Vec<usize> = (5..10).map(|s| shapes.triangles(s)).collect();
        assert_eq!(counts, [2, 8, 80 + 48, 320 + 96, 1280 + 192]);
        let range = &shapes.ranges[9];
        let corners = &shapes.corners[range.start as usize..range.end as usize];
        let of_disc = corners.chunks(3).filter(|t| t[0][3] > LIFTED);
        let volume: f32 = of_disc
            .map(|t| {
                let [a, b, c] = [0, 1, 2].map(|k: usize| Vec3::new(t[k][0], t[k][1], t[k][2]));
                a.dot(b.cross(c)) / 6.0
            })
            .sum();
        let whole = std::f32::consts::PI * 2.0 * HALF;
        assert!((0.95 * whole..whole).contains(&volume), "{volume}");
    }
}
