//! Gaps between sheets: how near to a face lies another that looks at it.
//!
//! Faces of a thin tube are near one another through the tube; that is no gap. So the other face counts only
//! where each lies in front of the other. Faces that share a vertex, by its position, are neighbors.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use crate::bvh::{Bounds, Bvh};

/// What [`gaps`] has found.
pub(crate) struct Gaps {
    /// Share of the triangles with a gap of less than the mean length of their sides.
    pub(crate) share: f64,
    /// The least gap over that length.
    pub(crate) least: Option<f64>,
}

/// Others that are looked at for each triangle. Real meshes have some tens nearby; where thousands lie in one
/// place, not all pairs are.
const LOOKS: usize = 512;

/// Judges the gaps in front of triangles, each from its middle.
pub(crate) fn gaps(positions: &[Vec3], triangles: &[[u32; 3]]) -> Gaps {
    let faces: Vec<Face> = triangles
        .par_iter()
        .filter_map(|face| Face::new(face.map(|corner| positions[corner as usize])))
        .collect();
    let boxes: Vec<Bounds> = faces
        .par_iter()
        .map(|face| Bounds::of(face.corners))
        .collect();
    let tree = Bvh::new(&boxes);
    let found: Vec<f64> = (0..tree.group_count())
        .into_par_iter()
        .flat_map_iter(|group| nearest(group, &faces, &tree))
        .collect();
    Gaps {
        share: found.len() as f64 / triangles.len().max(1) as f64,
        least: found.into_iter().min_by(f64::total_cmp),
    }
}

/// A triangle with an area.
struct Face {
    corners: [Vec3; 3],
    middle: DVec3,
    /// Outwards; its length is of no account.
    normal: DVec3,
    /// Mean length of the sides.
    side: f64,
}

impl Face {
    fn new(corners: [Vec3; 3]) -> Option<Self> {
        let [a, b, c] = corners.map(Vec3::as_dvec3);
        let normal = (b - a).cross(c - a);
        let sound = normal.is_finite() && normal != DVec3::ZERO;
        sound.then(|| Self {
            corners,
            middle: (a + b + c) / 3.0,
            normal,
            side: (a.distance(b) + b.distance(c) + c.distance(a)) / 3.0,
        })
    }

    /// Bounds of the half ball in front of the middle, as wide as the sides are long.
    fn front(&self) -> Bounds {
        let normal = self.normal.normalize_or_zero();
        // Along an axis that the normal leans away from, the ball is cut off at its rim.
        let reach = |lean: f64| match lean < 0.0 {
            true => self.side * (1.0 - lean * lean).max(0.0).sqrt(),
            false => self.side,
        };
        // A little more, for what is lost by rounding.
        let margin = 1e-6 * self.side + f64::from(f32::EPSILON) * self.middle.abs().max_element();
        let reach = |lean: f64| (reach(lean) + margin) as f32;
        let [low, high] = [-normal, normal].map(|lean| lean.to_array().map(reach));
        let middle = self.middle.as_vec3();
        Bounds {
            low: middle - Vec3::from_array(low),
            high: middle + Vec3::from_array(high),
        }
    }

    /// The distance from the middle to another face if each is in front of the other, and they are no
    /// neighbors.
    fn gap(&self, other: &Self) -> Option<f64> {
        let facing = self.normal.dot(other.normal) < 0.0;
        // Most others are the far wall of the same tube: this one is behind them.
        let before_other = other.normal.dot(self.middle - other.corners[0].as_dvec3()) > 0.0;
        if !facing || !before_other || self.is_neighbor(other) {
            return None;
        }
        let way = closest(self.middle, other.corners.map(Vec3::as_dvec3)) - self.middle;
        (self.normal.dot(way) > 0.0).then(|| way.length())
    }

    fn is_neighbor(&self, other: &Self) -> bool {
        self.corners
            .iter()
            .any(|corner| other.corners.contains(corner))
    }
}

/// For the faces of a group the gaps in front of them over the mean lengths of their sides, those below 1.
fn nearest(group: usize, faces: &[Face], tree: &Bvh) -> Vec<f64> {
    let query = |n: u32| faces[n as usize].front();
    let mut found = Vec::new();
    let mut now = (u32::MAX, 0, f64::INFINITY);
    tree.overlaps_of_group(group, query, |n, other| {
        let (face, other) = (&faces[n as usize], &faces[other as usize]);
        if now.0 != n {
            found.extend((now.2 < 1.0).then_some(now.2));
            now = (n, 0, f64::INFINITY);
        }
        let (_, looks, least) = &mut now;
        *looks += 1;
        if let Some(gap) = face.gap(other) {
            *least = least.min(gap / face.side);
        }
        *looks < LOOKS
    });
    found.extend((now.2 < 1.0).then_some(now.2));
    found
}

/// The point of a triangle that is closest to `p` (C. Ericson, Real-Time Collision Detection, 2005, 5.1.5).
fn closest(p: DVec3, [a, b, c]: [DVec3; 3]) -> DVec3 {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + d1 / (d1 - d3) * ab;
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + d2 / (d2 - d6) * ac;
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
    }
    let sum = va + vb + vc;
    a + vb / sum * ab + vc / sum * ac
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of two triangles at a height, looking up or down.
    fn square(z: f32, up: bool, positions: &mut Vec<Vec3>, triangles: &mut Vec<[u32; 3]>) {
        let first = positions.len() as u32;
        let corners = [[0., 0.], [1., 0.], [1., 1.], [0., 1.]];
        positions.extend(corners.map(|[x, y]| Vec3::new(x, y, z)));
        let turns = if up {
            [[0, 1, 2], [0, 2, 3]]
        } else {
            [[0, 2, 1], [0, 3, 2]]
        };
        triangles.extend(turns.map(|face| face.map(|corner| first + corner)));
    }

    fn two(z: f32, up: [bool; 2]) -> Gaps {
        let (mut positions, mut triangles) = (vec![], vec![]);
        square(0.0, up[0], &mut positions, &mut triangles);
        square(z, up[1], &mut positions, &mut triangles);
        gaps(&positions, &triangles)
    }

    #[test]
    fn sheets_that_look_at_each_other_leave_a_gap() {
        let found = two(0.25, [true, false]);
        assert_eq!(found.share, 1.0);
        let side = (2.0 + 2.0_f64.sqrt()) / 3.0;
        assert!((found.least.expect("a gap") - 0.25 / side).abs() < 1e-6);
    }

    #[test]
    fn a_thin_sheet_has_no_gap_and_far_ones_neither() {
        for (z, up) in [
            (0.25, [false, true]),
            (0.25, [true, true]),
            (3.0, [true, false]),
        ] {
            let found = two(z, up);
            assert_eq!((found.share, found.least), (0.0, None), "{z} {up:?}");
        }
        assert_eq!(gaps(&[], &[]).least, None);
    }

    #[test]
    fn thousands_in_one_place_take_no_longer_than_a_share_of_the_pairs() {
        let (mut positions, mut triangles) = (vec![], vec![]);
        for _ in 0..8_000 {
            square(0.0, true, &mut positions, &mut triangles);
            square(0.25, false, &mut positions, &mut triangles);
        }
        // All pairs would be 10⁹; a hundredth is looked at.
        assert!(gaps(&positions, &triangles).least.is_some());
    }

    #[test]
    fn the_closest_point_is_closer_than_any_of_a_grid() {
        let triangle = [
            DVec3::ZERO,
            DVec3::new(2., 0., 0.3),
            DVec3::new(0.4, 1., -0.2),
        ];
        let [a, b, c] = triangle;
        for n in 0..1000 {
            let spread = |k: u32| f64::from((n * k) % 101) / 20.0 - 2.5;
            let p = DVec3::new(spread(37), spread(53), spread(71));
            let distance = p.distance(closest(p, triangle));
            let grid = (0..=40).flat_map(|i| (0..=40 - i).map(move |j| (i, j)));
            let least = grid
                .map(|(i, j)| a + f64::from(i) / 40.0 * (b - a) + f64::from(j) / 40.0 * (c - a))
                .map(|q| p.distance(q))
                .fold(f64::INFINITY, f64::min);
            assert!(distance <= least + 1e-12 && distance >= least - 0.06, "{p}");
        }
    }
}
