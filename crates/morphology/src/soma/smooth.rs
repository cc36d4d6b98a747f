//! A smooth distance in each direction, fitted to one that has creases.
//!
//! Of an outline only the silhouette was traced; that every bump of it goes all the way around the body is none of what
//! was seen. So the logarithm of the distance is fitted, by least squares over directions, by a polynomial of degree 6 in
//! the direction's components along the long axis and across it, even in the third: the spherical harmonics up to that
//! degree that are the same on both sides of the outline's plane.

use std::sync::OnceLock;

use glam::DVec3;

/// Greatest degree: 4 rounds drops off, 8 follows bumps of a quarter of the soma.
const DEGREE: usize = 6;
/// Monomials of up to this degree.
const TERMS: usize = (DEGREE + 1) * (DEGREE + 2) / 2;
/// Directions that are fitted, on one side of the plane.
const FITTED: u32 = 400;
/// Share of the mean distance below which none is fitted: the logarithm of 0 is none.
const LEAST: f64 = 0.05;

/// A distance by direction: the exponential of a polynomial.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Smooth([f64; TERMS]);

/// Directions with their monomials, and the products of those.
struct Fit {
    directions: Vec<(DVec3, [f64; TERMS])>,
    products: Vec<[f64; TERMS]>,
}

impl Smooth {
    /// Fits distances; none if they are no positive numbers.
    pub(super) fn fit(distance: impl Fn(DVec3) -> f64) -> Option<Self> {
        static FIT: OnceLock<Fit> = OnceLock::new();
        let fit = FIT.get_or_init(Fit::new);
        let distances = fit
            .directions
            .iter()
            .map(|(direction, _)| distance(*direction));
        let distances: Vec<f64> = distances.collect();
        let mean = distances.iter().sum::<f64>() / distances.len() as f64;
        if !(mean.is_finite() && mean > 0.0) {
            return None;
        }
        let mut sums = [0.0; TERMS];
        for (distance, (_, terms)) in distances.iter().zip(&fit.directions) {
            let logarithm = distance.max(LEAST * mean).ln();
            for (sum, term) in sums.iter_mut().zip(terms) {
                *sum += logarithm * term;
            }
        }
        let factors = solve(fit.products.clone(), sums);
        factors
            .iter()
            .all(|factor| factor.is_finite())
            .then_some(Self(factors))
    }

    /// Logarithm of the distance in a direction.
    pub(super) fn logarithm(&self, direction: DVec3) -> f64 {
        let terms = terms(direction);
        self.0
            .iter()
            .zip(terms)
            .map(|(factor, term)| factor * term)
            .sum()
    }
}

impl Fit {
    fn new() -> Self {
        let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
        // A spiral with equal area for each direction.
        let direction = |i: u32| {
            let z = (f64::from(i) + 0.5) / f64::from(FITTED);
            let (sin, cos) = (golden * f64::from(i)).sin_cos();
            let across = (1.0 - z * z).sqrt();
            let direction = DVec3::new(across * cos, across * sin, z);
            (direction, terms(direction))
        };
        let directions: Vec<_> = (0..FITTED).map(direction).collect();
        let mut products = vec![[0.0; TERMS]; TERMS];
        for (_, terms) in &directions {
            for (row, a) in products.iter_mut().zip(terms) {
                for (product, b) in row.iter_mut().zip(terms) {
                    *product += a * b;
                }
            }
        }
        Self {
            directions,
            products,
        }
    }
}

/// The monomials xⁱ yʲ.
fn terms(direction: DVec3) -> [f64; TERMS] {
    let mut terms = [0.0; TERMS];
    let (mut at, mut x) = (0, 1.0);
    for i in 0..=DEGREE {
        let mut term = x;
        for _ in 0..=DEGREE - i {
            terms[at] = term;
            term *= direction.y;
            at += 1;
        }
        x *= direction.x;
    }
    terms
}

/// Solves a symmetric positive definite system by elimination.
fn solve(mut rows: Vec<[f64; TERMS]>, mut right: [f64; TERMS]) -> [f64; TERMS] {
    for pivot in 0..TERMS {
        let (done, below) = rows.split_at_mut(pivot + 1);
        let own = &done[pivot];
        for (i, row) in below.iter_mut().enumerate() {
            let factor = row[pivot] / own[pivot];
            for (value, above) in row.iter_mut().zip(own).skip(pivot) {
                *value -= factor * above;
            }
            right[pivot + 1 + i] -= factor * right[pivot];
        }
    }
    for pivot in (0..TERMS).rev() {
        let known: f64 = (pivot + 1..TERMS).map(|k| rows[pivot][k] * right[k]).sum();
        right[pivot] = (right[pivot] - known) / rows[pivot][pivot];
    }
    right
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_ellipsoid_is_fitted_and_bumps_are_not() {
        let ellipsoid = |d: DVec3| 1.0 / (d / DVec3::new(1.6, 0.9, 0.9)).length();
        let bumpy = |d: DVec3| ellipsoid(d) * (1.0 + 0.1 * (20.0 * d.x).sin());
        let smooth = Smooth::fit(bumpy).unwrap();
        for i in 0..50 {
            let angle = f64::from(i) * 0.13;
            let d = DVec3::new(angle.cos(), 0.6 * angle.sin(), 0.8 * angle.sin());
            let fitted = smooth.logarithm(d).exp();
            assert!((fitted / ellipsoid(d) - 1.0).abs() < 0.05, "{d}: {fitted}");
        }
        assert!(Smooth::fit(|_| 0.0).is_none() && Smooth::fit(|_| f64::NAN).is_none());
    }
}
