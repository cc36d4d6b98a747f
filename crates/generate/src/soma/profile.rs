//! LiveMesh's soma: a surface of revolution about each neurite, joined by their outermost parts.
//!
//! Defferrard 2015: the tube's radius at distance d from the soma's center is √(R² − d²) up to
//! 0.7 R, the neurite's own beyond 1.5 R, and a cubic with equal value and slope at both ends
//! between.

use glam::DVec3;

use super::insertion_quads::Insertion;

/// Share of R up to which the profile is the circle.
const CIRCLE_TO: f64 = 0.7;

/// Moves directions out to the profile. `vertices` are relative to the center in units of `radius`.
pub(crate) fn apply(vertices: &mut [DVec3], radius: f64, insertions: &[Insertion]) {
    for vertex in vertices {
        let Some(direction) = vertex.try_normalize() else {
            continue;
        };
        let reach = insertions
            .iter()
            .map(|i| along(direction, i, radius))
            .fold(1.0, f64::max);
        *vertex = direction * reach;
    }
}

/// Distance (in R) along `direction` at which the profile about one neurite is left.
fn along(direction: DVec3, insertion: &Insertion, radius: f64) -> f64 {
    let cos = direction.dot(insertion.direction);
    let end = insertion.distance / radius;
    if cos <= CIRCLE_TO || end <= 1.0 {
        return 1.0;
    }
    let sin = (1.0 - cos * cos).max(0.0).sqrt();
    let inside = |s: f64| s * sin < tube(s * cos, end, insertion.radius / radius);
    let (mut low, mut high) = (1.0, end / cos);
    if !inside(low) {
        return 1.0;
    }
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if inside(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// Radius of the tube at distance d; all in units of R.
fn tube(d: f64, end: f64, radius: f64) -> f64 {
    if d <= CIRCLE_TO {
        return (1.0 - d * d).max(0.0).sqrt();
    }
    let start = (1.0 - CIRCLE_TO * CIRCLE_TO).sqrt();
    let slope = -CIRCLE_TO / start;
    let length = end - CIRCLE_TO;
    let t = ((d - CIRCLE_TO) / length).min(1.0);
    let (t2, t3) = (t * t, t * t * t);
    (2.0 * t3 - 3.0 * t2 + 1.0) * start
        + (t3 - 2.0 * t2 + t) * length * slope
        + (3.0 * t2 - 2.0 * t3) * radius
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn profile_is_continuous_at_both_ends() {
        let before = tube(CIRCLE_TO - 1e-9, 1.5, 0.2);
        let after = tube(CIRCLE_TO + 1e-9, 1.5, 0.2);
        assert!((before - after).abs() < 1e-7);
        assert!((tube(1.5, 1.5, 0.2) - 0.2).abs() < 1e-12);
    }
}
