//! The triangles that markers are drawn with: a square, and spheres of ever more triangles.

use std::ops::Range;

use glam::Vec3;

/// Corners of all shapes, three to a triangle: unit vectors, and 1 in the last component for squares.
pub(super) struct Shapes {
    pub(super) corners: Vec<[f32; 4]>,
    /// By shape, the simplest first: its range of the corners.
    pub(super) ranges: Vec<Range<u32>>,
}

/// Radius (sub-pixels) from which on a marker has the shape of this index. With 20, 80, 320 and 1,280
/// triangles a sphere's outline stays within half a sub-pixel of a circle up to about the next radius.
const FROM: [f32; 5] = [0.0, 1.5, 4.0, 16.0, 64.0];

impl Shapes {
    pub(super) fn new() -> Self {
        let square = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let corners = [0, 1, 2, 0, 2, 3].map(|k: usize| [square[k][0], square[k][1], 0.0, 1.0]);
        let mut shapes = Self {
            corners: corners.to_vec(),
            ranges: vec![0..corners.len() as u32],
        };
        let mut triangles = icosahedron();
        for _ in 1..FROM.len() {
            let first = shapes.corners.len() as u32;
            let corners = triangles.iter().flatten();
            shapes.corners.extend(corners.map(|c| [c.x, c.y, c.z, 0.0]));
            shapes.ranges.push(first..shapes.corners.len() as u32);
            triangles = triangles.into_iter().flat_map(quartered).collect();
        }
        shapes
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
    let half = |p: Vec3, q: Vec3| (p + q).normalize();
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
                    triangles.push(turned.map(Vec3::normalize));
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
        assert_eq!(counts, [2, 20, 80, 320, 1280]);
        for range in &shapes.ranges[1..] {
            let corners = &shapes.corners[range.start as usize..range.end as usize];
            let volume: f32 = corners
                .chunks(3)
                .map(|t| {
                    let [a, b, c] = [0, 1, 2].map(|k: usize| Vec3::new(t[k][0], t[k][1], t[k][2]));
                    a.dot(b.cross(c)) / 6.0
                })
                .sum();
            assert!((2.5..4.19).contains(&volume), "{volume}");
        }
    }

    #[test]
    fn larger_markers_have_finer_shapes() {
        let shapes: Vec<usize> = [0.3, 2.0, 4.0, 20.0, 1e4].map(Shapes::of_radius).to_vec();
        assert_eq!(shapes, [0, 1, 2, 3, 4]);
    }
}
