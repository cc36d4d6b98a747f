//! The triangles that markers are drawn with: a square and a dome, which face the viewer, and spheres of ever
//! more triangles.

use std::f32::consts::TAU;
use std::ops::Range;

use glam::Vec3;

/// Corners of all shapes, three to a triangle, and in the last component what they are relative to.
pub(super) struct Shapes {
    pub(super) corners: Vec<[f32; 4]>,
    /// By shape, the simplest first: its range of the corners.
    pub(super) ranges: Vec<Range<u32>>,
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
/// Triangles of a dome.
const SIDES: usize = 8;

impl Shapes {
    pub(super) fn new() -> Self {
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
        let mut triangles = icosahedron();
        while shapes.ranges.len() < FROM.len() {
            triangles = triangles.into_iter().flat_map(quartered).collect();
            let corners = triangles.iter().flatten();
            shapes.push(corners.map(|c| [c.x, c.y, c.z, IN_WORLD]));
        }
        shapes
    }

    fn push(&mut self, corners: impl IntoIterator<Item = [f32; 4]>) {
        let first = self.corners.len() as u32;
        self.corners.extend(corners);
        self.ranges.push(first..self.corners.len() as u32);
    }

    /// The shape of a marker of this radius (sub-pixels).
    pub(super) fn of_radius(radius: f32) -> usize {
        FROM.iter().rposition(|&from| radius >= from).unwrap_or(0)
    }

    /// Number of triangles of a shape.
    pub(super) fn triangles(&self, shape: usize) -> usize {
        self.ranges[shape].len() / 3
    }
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
        for range in &shapes.ranges[2..] {
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
        let shapes: Vec<usize> = [0.3, 2.0, 6.0, 20.0, 1e4].map(Shapes::of_radius).to_vec();
        assert_eq!(shapes, [0, 1, 2, 3, 4]);
    }
}
