//! Triangles cut at planes, on the grid of a level, without cracks.
//!
//! Corners are whole numbers, and so are those that a cut makes. Where a plane meets an edge depends on the edge alone, so
//! the two triangles beside it get the same corner: what was closed stays closed, and corners on a plane are on it exactly.

use std::collections::HashMap;

use crate::grid::{HALF, STEPS};

/// A mesh on the grid of a level: corners by their stored places.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct GridMesh {
    pub(crate) corners: Vec<[i64; 3]>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

/// The part of a level that a triangle is in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Part {
    /// Its node.
    pub(crate) node: [u32; 3],
    /// Whether it is in the upper half of that, along each axis; never in the finest level, which is not halved.
    pub(crate) upper: [bool; 3],
}

impl GridMesh {
    /// Leaves out triangles of which two corners are in one place, and makes one of the two corners, so that what is beside
    /// such a triangle meets: by places, and by numbers.
    pub(crate) fn without_collapsed(mut self) -> Self {
        let mut one: HashMap<u32, u32> = HashMap::new();
        for triangle in &self.triangles {
            for i in 0..3 {
                let [a, b] = [triangle[i], triangle[(i + 1) % 3]];
                if self.corners[a as usize] == self.corners[b as usize] {
                    let [a, b] = [a, b].map(|corner| last(&one, corner));
                    if a != b {
                        one.insert(a.max(b), a.min(b));
                    }
                }
            }
        }
        if !one.is_empty() {
            for triangle in &mut self.triangles {
                *triangle = triangle.map(|corner| last(&one, corner));
            }
            self.triangles
                .retain(|[a, b, c]| a != b && b != c && c != a);
        }
        self
    }

    /// Cuts at all planes between the parts of a level.
    pub(crate) fn cut_for(mut self, level: u32) -> Self {
        for axis in 0..3 {
            let along = self.corners.iter().map(|corner| corner[axis]);
            let most = along.max().unwrap_or(0);
            let first = |node: i64| [node * STEPS, node * STEPS + HALF];
            let planes = (0..=most / STEPS).flat_map(first);
            let planes = planes.filter(|plane| level > 0 || plane % STEPS == 0);
            for plane in planes.filter(|&plane| 0 < plane && plane < most) {
                self.cut(axis, plane);
            }
        }
        self.without_collapsed()
    }

    /// Cuts at a plane.
    fn cut(&mut self, axis: usize, plane: i64) {
        let mut cut_edges = HashMap::new();
        let mut pieces = Vec::with_capacity(self.triangles.len());
        for triangle in std::mem::take(&mut self.triangles) {
            let sides = triangle.map(|c| (self.corners[c as usize][axis] - plane).signum());
            if !(sides.contains(&1) && sides.contains(&-1)) {
                pieces.push(triangle);
                continue;
            }
            // From the corner on the plane, or from the one that is alone on its side.
            let alone = |&i: &usize| sides.iter().filter(|&&side| side == sides[i]).count() == 1;
            let on_plane = (0..3).find(|&i| sides[i] == 0);
            let first = on_plane.or_else(|| (0..3).find(alone)).unwrap_or(0);
            let [a, b, c] = std::array::from_fn(|i| triangle[(first + i) % 3]);
            let mut meet = |from: u32, to: u32| {
                let edge = (from.min(to), from.max(to));
                *cut_edges
                    .entry(edge)
                    .or_insert_with(|| self.corner_on(edge, axis, plane))
            };
            if on_plane.is_some() {
                let p = meet(b, c);
                pieces.extend([[a, b, p], [a, p, c]]);
            } else {
                let (p, q) = (meet(a, b), meet(a, c));
                pieces.extend([[a, p, q], [p, b, c], [p, c, q]]);
            }
        }
        self.triangles = pieces;
    }

    /// A new corner where an edge meets a plane.
    fn corner_on(&mut self, edge: (u32, u32), axis: usize, plane: i64) -> u32 {
        let [from, to] = [edge.0, edge.1].map(|corner| self.corners[corner as usize]);
        let forth = (to[axis] - from[axis]).signum();
        let length = forth * (to[axis] - from[axis]);
        let before = forth * (plane - from[axis]);
        // Rounded. Products have 63 bits in cells of 30 meters.
        let along =
            |i: usize| from[i] + (2 * (to[i] - from[i]) * before + length).div_euclid(2 * length);
        let mut corner = std::array::from_fn(along);
        corner[axis] = plane;
        self.corners.push(corner);
        (self.corners.len() - 1) as u32
    }

    /// The part that a triangle is in, which no plane cuts.
    pub(crate) fn part(&self, triangle: [u32; 3], level: u32) -> Part {
        let corners = triangle.map(|corner| self.corners[corner as usize]);
        let mut part = Part {
            node: [0; 3],
            upper: [false; 3],
        };
        for axis in 0..3 {
            let [a, b, c] = corners.map(|corner| corner[axis]);
            let (least, most) = (a.min(b).min(c), a.max(b).max(c));
            // Where all corners are in a plane, the part is that on the side of the solid.
            let inwards = match least == most {
                true => -normal(corners)[axis].signum(),
                false => 0,
            };
            // In halves of a step, a bit inwards.
            let place = least + most + inwards;
            let node = place.div_euclid(2 * STEPS);
            part.upper[axis] = level > 0 && place - node * 2 * STEPS > 2 * HALF;
            part.node[axis] = u32::try_from(node).unwrap_or(0);
        }
        part
    }
}

/// The corner that stands for one, and for all in its place that it was joined with.
fn last(one: &HashMap<u32, u32>, mut corner: u32) -> u32 {
    while let Some(&next) = one.get(&corner) {
        corner = next;
    }
    corner
}

/// The normal of a triangle, not of unit length.
fn normal([a, b, c]: [[i64; 3]; 3]) -> [i64; 3] {
    let [u, v] = [b, c].map(|corner| -> [i64; 3] { std::array::from_fn(|i| corner[i] - a[i]) });
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        u[j] * v[k] - u[k] * v[j]
    })
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    /// An octahedron of uneven proportions that reaches over several nodes.
    fn octahedron() -> GridMesh {
        let s = STEPS;
        let corners = vec![
            [10, s + 77, 40_001],
            [3 * s + 11, s - 900, 33_000],
            [s + 5, 9, 40_017],
            [s + 901, 2 * s - 3, 41_000],
            [2 * s, s + 1, 3],
            [s - 40, s, 2 * s + 17],
        ];
        let mut triangles = Vec::new();
        for [x, y, z] in [
            [0, 2, 4],
            [0, 3, 4],
            [1, 2, 4],
            [1, 3, 4],
            [0, 2, 5],
            [0, 3, 5],
            [1, 2, 5],
            [1, 3, 5],
        ] {
            // Odd numbers of upper corners turn it around.
            let upper = (x % 2) + (y % 2) + (z % 2);
            triangles.push(if upper % 2 == 0 { [x, z, y] } else { [x, y, z] });
        }
        GridMesh { corners, triangles }
    }

    /// Six times the volume.
    fn volume(mesh: &GridMesh) -> i128 {
        let of = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| mesh.corners[i as usize].map(i128::from));
            a[0] * (b[1] * c[2] - b[2] * c[1])
                + a[1] * (b[2] * c[0] - b[0] * c[2])
                + a[2] * (b[0] * c[1] - b[1] * c[0])
        };
        mesh.triangles.iter().map(of).sum()
    }

    /// By the numbers of corners.
    fn is_closed(mesh: &GridMesh) -> bool {
        let mut edges: BTreeMap<(u32, u32), i32> = BTreeMap::new();
        for t in &mesh.triangles {
            for i in 0..3 {
                let (a, b) = (t[i], t[(i + 1) % 3]);
                *edges.entry((a.min(b), a.max(b))).or_default() += if a < b { 1 } else { -1 };
            }
        }
        edges.values().all(|&sum| sum == 0)
    }

    #[test]
    fn corners_in_one_place_become_one() {
        let mut mesh = octahedron();
        // The edge between 0 and 2 has two more corners, both where 0 is.
        let there = mesh.corners[0];
        mesh.corners.extend([there, there]);
        let edge = |t: &[u32; 3]| t.contains(&0) && t.contains(&2);
        let (beside, mut rest): (Vec<_>, Vec<_>) = mesh.triangles.into_iter().partition(edge);
        assert_eq!(beside.len(), 2);
        for triangle in beside {
            for [first, second] in [[0, 6], [6, 7], [7, 2]] {
                let put = |corner| match corner {
                    0 => first,
                    2 => second,
                    other => other,
                };
                rest.push(triangle.map(put));
            }
        }
        mesh.triangles = rest;
        assert!(is_closed(&mesh));
        let joined = mesh.without_collapsed();
        assert_eq!(joined.triangles.len(), octahedron().triangles.len());
        assert!(is_closed(&joined));
        assert_eq!(volume(&joined), volume(&octahedron()));
    }

    #[test]
    fn no_triangle_crosses_a_plane_and_nothing_opens() {
        let whole = octahedron();
        assert!(is_closed(&whole) && volume(&whole) > 0);
        for level in [0, 1] {
            let cut = whole.clone().cut_for(level);
            assert!(cut.triangles.len() > whole.triangles.len());
            assert!(is_closed(&cut), "level {level}");
            let change = (volume(&cut) - volume(&whole)) as f64 / volume(&whole) as f64;
            assert!(change.abs() < 1e-4, "{change}");
            for t in &cut.triangles {
                for axis in 0..3 {
                    let along = t.map(|c| cut.corners[c as usize][axis]);
                    let (least, most) = (along.into_iter().min(), along.into_iter().max());
                    let (least, most) = (least.expect("three"), most.expect("three"));
                    for node in 0..4 {
                        let crossed = |plane: i64| least < plane && plane < most;
                        assert!(!crossed(node * STEPS));
                        assert!(level == 0 || !crossed(node * STEPS + HALF));
                    }
                }
            }
        }
    }

    #[test]
    fn a_cut_is_rounded_the_same_in_both_directions() {
        let mut mesh = GridMesh {
            corners: vec![[0, 0, 5], [3, 7, 5], [3, 7, 5], [0, 0, 5]],
            triangles: Vec::new(),
        };
        let forth = mesh.corner_on((0, 1), 0, 1);
        assert_eq!(mesh.corners[forth as usize], [1, 2, 5]);
        let back = mesh.corner_on((2, 3), 0, 1);
        assert_eq!(mesh.corners[back as usize], [1, 2, 5]);
    }

    #[test]
    fn triangles_in_a_plane_go_with_the_solid() {
        let part = |x: i64, turned: bool, level| {
            let mesh = GridMesh {
                corners: vec![[x, 1, 1], [x, 5, 1], [x, 1, 5]],
                triangles: Vec::new(),
            };
            let part = mesh.part(if turned { [0, 2, 1] } else { [0, 1, 2] }, level);
            (part.node[0], part.upper[0])
        };
        // The normal looks along x: the solid is below.
        assert_eq!(part(STEPS, false, 0), (0, false));
        assert_eq!(part(STEPS, true, 0), (1, false));
        assert_eq!(part(STEPS, false, 1), (0, true));
        assert_eq!(part(HALF, false, 1), (0, false));
        assert_eq!(part(HALF, true, 1), (0, true));
        assert_eq!(part(HALF + 1, false, 1), (0, true));
        assert_eq!(part(0, false, 0), (0, false));
    }
}
