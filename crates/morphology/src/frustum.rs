//! Frusta between two points.

use std::f64::consts::PI;

use crate::Point;

/// Distance (µm) of two points, in `f64`.
pub(crate) fn distance(a: &Point, b: &Point) -> f64 {
    a.position.as_dvec3().distance(b.position.as_dvec3())
}

fn clamped(a: f32, b: f32) -> (f64, f64) {
    (f64::from(a).max(0.0), f64::from(b).max(0.0))
}

/// Side of a frustum: π (a + b) √((a − b)² + L²), L ≥ 0.
pub(crate) fn frustum_area(a: f32, b: f32, length: f64) -> f64 {
    let (a, b) = clamped(a, b);
    PI * (a + b) * ((a - b) * (a - b) + length * length).sqrt()
}

/// Volume of a frustum: π L (a² + ab + b²) / 3, L ≥ 0.
pub(crate) fn frustum_volume(a: f32, b: f32, length: f64) -> f64 {
    let (a, b) = clamped(a, b);
    PI * length * (a * a + a * b + b * b) / 3.0
}
