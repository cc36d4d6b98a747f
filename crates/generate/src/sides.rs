//! Radii that make up for the sides of the polygons around neurites.
//!
//! Vertices on the traced radius make a polygon that lies within the traced circle: of eight sides it has 90 % of
//! its area, so that a refined neurite holds a tenth less than was traced. With radii larger by
//! √(2π/n / sin(2π/n)) a regular polygon of n sides has the area of the circle.

use std::f64::consts::{FRAC_PI_2, TAU};

/// Most quads' edges are never cut into more pieces.
const MOST_PIECES: f64 = 64.0;

/// How many sides the polygons around neurites get when the mesh is refined.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sides {
    /// So many all over, 3 or more.
    Count(u32),
    /// Each of the four edges of a ring gets pieces of about `radii` times the traced radius, of at least `least`
    /// and at most `most` µm, as many as its length rounded to them.
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
        (0..2).fold(traced, |radius, _| traced * growth(self.of(radius, traced)))
    }

    /// Radius (µm) of the circle that has the area of a polygon of radius `radius` (µm).
    pub(crate) fn traced(self, radius: f64) -> f64 {
        (0..3).fold(radius, |traced, _| radius / growth(self.of(radius, traced)))
    }

    /// Sides of a polygon of this radius (µm) where the traced one is `traced`.
    fn of(self, radius: f64, traced: f64) -> u32 {
        match self {
            Self::Count(count) => count.max(3),
            Self::ByLength { radii, least, most } => {
                let piece = (radii * traced).max(least).min(most);
                let pieces = (FRAC_PI_2 * radius / piece).round();
                4 * pieces.clamp(1.0, MOST_PIECES) as u32
            }
        }
    }
}

/// Circumradius of a regular polygon by the radius of the circle with its area.
fn growth(sides: u32) -> f64 {
    let angle = TAU / f64::from(sides);
    (angle / angle.sin()).sqrt()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    #[test]
    fn polygons_have_the_area_of_the_circle() {
        for sides in [3, 4, 8, 12, 256] {
            let radius = Sides::Count(sides).radius(0.7);
            let area = f64::from(sides) / 2.0 * radius * radius * (TAU / f64::from(sides)).sin();
            assert!((area - PI * 0.49).abs() < 1e-12, "{sides}");
        }
    }

    #[test]
    fn sides_follow_from_lengths() {
        let free = Sides::ByLength {
            radii: 1.0,
            least: 0.0,
            most: f64::MAX,
        };
        let count = |sides: Sides, traced: f64| sides.of(sides.radius(traced), traced);
        assert_eq!([0.1, 1.0, 10.0].map(|radius| count(free, radius)), [8; 3]);
        let bound = Sides::ByLength {
            radii: 1.0,
            least: 0.5,
            most: 1.0,
        };
        assert_eq!(
            [0.1, 1.0, 2.0].map(|radius| count(bound, radius)),
            [4, 8, 12]
        );
        assert_eq!(count(bound, 1e6), 256);
        for traced in [0.1, 0.3, 0.95, 1.5, 1.62, 40.0] {
            assert!(
                (bound.traced(bound.radius(traced)) - traced).abs() < 1e-9,
                "{traced}"
            );
        }
    }
}
