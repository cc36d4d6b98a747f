//! Radii that make up for the sides of the polygons around neurites.
//!
//! Vertices on the traced radius make a polygon that lies within the traced circle: of eight sides it has 90 % of
//! its area, so that a refined neurite holds a tenth less than was traced. With a radius larger by the root of
//! what is missing the polygon has the area of the circle.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use glam::DVec2;

/// No edge is cut into more pieces.
const MAX_PIECES: f64 = 64.0;

/// How many sides the polygons around neurites get when the mesh is refined: each ring has four edges, cut into
/// pieces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sides {
    /// So many pieces all over, 1 to 64: the level of the refinement.
    Level(u32),
    /// Pieces of about `radii` times the traced radius, of at least `least` and at most `most` µm, as many as the
    /// length of the edge rounded to them.
    ByLength {
        /// Length of a piece, in radii.
        radii: f64,
        /// µm.
        least: f64,
        /// µm; counts even where it is below `least`.
        most: f64,
    },
}

impl Sides {
    /// Radius (µm) of the polygon that has the area of a circle of radius `traced` (µm).
    pub fn radius(self, traced: f64) -> f64 {
        // The larger radius may have more sides.
        (0..2).fold(traced, |radius, _| {
            traced * growth(self.pieces(radius, traced))
        })
    }

    /// Radius (µm) of the circle that has the area of a polygon of radius `radius` (µm).
    pub(crate) fn traced(self, radius: f64) -> f64 {
        (0..3).fold(radius, |traced, _| {
            radius / growth(self.pieces(radius, traced))
        })
    }

    /// Pieces of each edge of a ring of this radius (µm) where the traced one is `traced`.
    fn pieces(self, radius: f64, traced: f64) -> u32 {
        let pieces = match self {
            Self::Level(level) => f64::from(level),
            Self::ByLength { radii, least, most } => {
                let piece = (radii * traced).max(least).min(most);
                (FRAC_PI_2 * radius / piece).round()
            }
        };
        pieces.clamp(1.0, MAX_PIECES) as u32
    }
}

/// Circumradius of a polygon by the radius of the circle with its area. Refinement puts vertices at even steps of
/// the chord of each quarter, not of its arc.
fn growth(pieces: u32) -> f64 {
    let vertex = |n: u32| {
        let share = f64::from(n) / f64::from(pieces);
        DVec2::new(1.0 - share, share).normalize_or_zero()
    };
    let triangles = (0..pieces).map(|n| vertex(n).perp_dot(vertex(n + 1)) / 2.0);
    (FRAC_PI_4 / triangles.sum::<f64>()).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polygons_have_the_area_of_the_circle() {
        // Of a square 2 r², of a regular octagon 2 √2 r².
        let squared = |level: u32| Sides::Level(level).radius(1.0).powi(2);
        let circle = std::f64::consts::PI;
        assert!((2.0 * squared(1) - circle).abs() < 1e-12);
        assert!((8.0_f64.sqrt() * squared(2) - circle).abs() < 1e-12);
        assert!((squared(64) - 1.0).abs() < 2e-4);
    }

    #[test]
    fn sides_follow_from_lengths() {
        let free = Sides::ByLength {
            radii: 1.0,
            least: 0.0,
            most: f64::MAX,
        };
        let count = |sides: Sides, traced: f64| sides.pieces(sides.radius(traced), traced);
        assert_eq!([0.1, 1.0, 10.0].map(|radius| count(free, radius)), [2; 3]);
        let bound = Sides::ByLength {
            radii: 1.0,
            least: 0.5,
            most: 1.0,
        };
        assert_eq!(
            [0.1, 1.0, 2.0].map(|radius| count(bound, radius)),
            [1, 2, 3]
        );
        assert_eq!(count(bound, 1e6), 64);
        for traced in [0.1, 0.3, 0.95, 1.5, 1.62, 40.0] {
            assert!(
                (bound.traced(bound.radius(traced)) - traced).abs() < 1e-9,
                "{traced}"
            );
        }
    }
}
