//! Directions all around a point, and what distances along them enclose.

use std::f64::consts::{FRAC_2_PI, FRAC_PI_4, PI};

use glam::{DMat3, DVec3};

/// Which face of the cube of [`Directions`] a direction goes through, and where: coordinates from −1 to 1 in the order of the
/// grid's rows and columns.
pub(super) fn place_on_cube(direction: DVec3) -> (usize, [f64; 2]) {
    let length = direction.abs();
    let axis = match length.max_element() {
        most if most == length.x => 0,
        most if most == length.y => 1,
        _ => 2,
    };
    let along = direction[axis];
    let face = 2 * axis + usize::from(along > 0.0);
    let row = direction[(axis + 1) % 3] / along;
    let column = direction[(axis + 2) % 3] / along.abs();
    (face, [row, column])
}

/// Directions through the corners of a grid on the faces of a cube, in equal angles.
pub(super) struct Directions {
    /// Unit directions.
    pub(super) units: Vec<DVec3>,
    /// Triangles over them, counter-clockwise seen from outside.
    triangles: Vec<[usize; 3]>,
}

impl Directions {
    /// `count` quads along an edge of the cube.
    pub(super) fn new(count: u32) -> Self {
        let side = count as usize + 1;
        let (mut units, mut triangles) = (Vec::new(), Vec::new());
        let tangent = |i: usize| (FRAC_PI_4 * (2.0 * i as f64 / f64::from(count) - 1.0)).tan();
        for axis in 0..3 {
            for sign in [-1.0, 1.0] {
                let first = units.len();
                for i in 0..side {
                    for j in 0..side {
                        let mut unit = [0.0; 3];
                        unit[axis] = sign;
                        unit[(axis + 1) % 3] = sign * tangent(i);
                        unit[(axis + 2) % 3] = tangent(j);
                        units.push(DVec3::from_array(unit).normalize_or_zero());
                    }
                }
                for (i, j) in (0..side - 1).flat_map(|i| (0..side - 1).map(move |j| (i, j))) {
                    let [a, b] = [first + i * side + j, first + (i + 1) * side + j];
                    triangles.push([a, b, b + 1]);
                    triangles.push([a, b + 1, a + 1]);
                }
            }
        }
        Self { units, triangles }
    }

    /// Volume and area of what distances along the directions enclose, exact of spheres: what chords cut off is made
    /// up for by that of the sphere.
    pub(super) fn volume_and_area(&self, distances: &[f64]) -> (f64, f64) {
        let (volume, area) = self.within(|corner| self.units[corner] * distances[corner]);
        let (of_sphere, its_area) = self.within(|corner| self.units[corner]);
        (
            volume / of_sphere * (4.0 / 3.0 * PI),
            area / its_area * (4.0 * PI),
        )
    }

    /// See [`SomaShape::stretch`](super::SomaShape::stretch): the second moments of the places at these distances. Of an
    /// ellipsoid of 5 : 2 : 2 their ratio is 2.1.
    pub(super) fn stretch(&self, distances: &[f64]) -> DMat3 {
        let places = self.units.iter().zip(distances).map(|(&unit, r)| unit * *r);
        let moments = places.map(|p| DMat3::from_cols(p * p.x, p * p.y, p * p.z));
        let moments = moments.fold(DMat3::ZERO, |sum, moment| sum + moment);
        let size = (moments.x_axis.x + moments.y_axis.y + moments.z_axis.z) / 3.0;
        match size.is_finite() && size > 0.0 {
            true => moments * (1.0 / size),
            false => DMat3::IDENTITY,
        }
    }

    fn within(&self, corner: impl Fn(usize) -> DVec3) -> (f64, f64) {
        let triangles = self.triangles.iter();
        triangles.fold((0.0, 0.0), |(volume, area), triangle| {
            let [a, b, c] = triangle.map(&corner);
            let normal = (b - a).cross(c - a);
            (volume + a.dot(normal) / 6.0, area + 0.5 * normal.length())
        })
    }
}

/// Distances along the directions of a grid, bilinear in between.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ByDirection {
    /// Quads along an edge of the cube.
    count: u32,
    distances: Vec<f64>,
}

impl ByDirection {
    /// Distances in the order of [`Directions::new`] of the same count.
    pub(super) fn new(count: u32, distances: Vec<f64>) -> Self {
        Self { count, distances }
    }

    /// A smooth distance: in each direction the mean of the logarithms around it, with weights that fall off within so many
    /// radians as a bell does.
    pub(super) fn smoothed(count: u32, width: f64, distance: impl Fn(DVec3) -> f64) -> Self {
        let units = Directions::new(count).units;
        let logarithms: Vec<f64> = units.iter().map(|&unit| distance(unit).ln()).collect();
        let least = (3.0 * width).cos();
        let mut sums = vec![[0.0; 2]; units.len()];
        // Two directions weigh as much for one another; each sum is over all directions in their order.
        for (i, unit) in units.iter().enumerate() {
            for (j, other) in units.iter().enumerate().skip(i) {
                let cosine = unit.dot(*other);
                if cosine > least {
                    let weight = ((cosine - 1.0) / (width * width)).exp();
                    let mut add = |to: usize, from: usize| {
                        sums[to][0] += weight * logarithms[from];
                        sums[to][1] += weight;
                    };
                    add(i, j);
                    if i != j {
                        add(j, i);
                    }
                }
            }
        }
        let means = sums.into_iter().map(|[sum, weight]| (sum / weight).exp());
        Self::new(count, means.collect())
    }

    /// The distance in a unit direction.
    pub(super) fn at(&self, direction: DVec3) -> f64 {
        let (face, place) = place_on_cube(direction);
        let side = self.count as usize + 1;
        let cell = |x: f64| {
            let x = (0.5 + x.atan() * FRAC_2_PI) * f64::from(self.count);
            let cell = (x as usize).min(side - 2);
            (cell, x - cell as f64)
        };
        let [(i, x), (j, y)] = place.map(cell);
        let at = |i: usize, j: usize| self.distances[(face * side + i) * side + j];
        let near = at(i, j) * (1.0 - y) + at(i, j + 1) * y;
        let far = at(i + 1, j) * (1.0 - y) + at(i + 1, j + 1) * y;
        near * (1.0 - x) + far * x
    }
}
