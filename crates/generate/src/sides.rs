//! Radii that make up for the sides of the polygons around neurites.
//!
//! Vertices on the traced radius make a polygon that lies within the traced circle: of eight sides it has 90 % of
//! its area, so that a refined neurite holds a tenth less than was traced, and 97 % of its perimeter, so that the
//! membrane is smaller by as much. With a larger radius the polygon has the area of the circle, or its perimeter: not
//! both.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use glam::DVec2;

/// No edge is cut into more pieces. A guard.
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

/// Radii of rings that make up for the sides of the polygons around neurites.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Polygons {
    /// How many sides they get.
    pub sides: Sides,
    /// What they have as the traced circles do.
    pub equal: Equal,
}

/// What polygons around neurites have as the traced circles do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Equal {
    /// The area: neurites hold the volume that was traced.
    Area,
    /// The perimeter: their membranes have the area that was traced, as for capacitances and densities of channels.
    Perimeter,
}

impl Polygons {
    /// Radius (µm) of the polygon that is equal to a circle of radius `traced` (µm).
    pub fn radius(self, traced: f64) -> f64 {
        // The larger radius may have more sides.
        (0..2).fold(traced, |radius, _| {
            traced * self.equal.growth(self.sides.pieces(radius, traced))
        })
    }

    /// Radius (µm) of the circle that a polygon of radius `radius` (µm) is equal to.
    pub(crate) fn traced(self, radius: f64) -> f64 {
        (0..3).fold(radius, |traced, _| {
            radius / self.equal.growth(self.sides.pieces(radius, traced))
        })
    }
}

impl Sides {
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

impl Equal {
    /// Circumradius of a polygon by the radius of the circle that it is equal to. Refinement puts vertices at even steps
    /// of the chord of each quarter, not of its arc.
    fn growth(self, pieces: u32) -> f64 {
        let vertex = |n: u32| {
            let share = f64::from(n) / f64::from(pieces);
            DVec2::new(1.0 - share, share).normalize_or_zero()
        };
        let sides = (0..pieces).map(|n| [vertex(n), vertex(n + 1)]);
        match self {
            Self::Area => {
                let area: f64 = sides.map(|[a, b]| a.perp_dot(b) / 2.0).sum();
                (FRAC_PI_4 / area).sqrt()
            }
            Self::Perimeter => FRAC_PI_2 / sides.map(|[a, b]| a.distance(b)).sum::<f64>(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polygons(sides: Sides, equal: Equal) -> Polygons {
        Polygons { sides, equal }
    }

    #[test]
    fn polygons_have_the_area_of_the_circle() {
        // Of a square 2 r², of a regular octagon 2 √2 r².
        let squared = |level: u32| {
            polygons(Sides::Level(level), Equal::Area)
                .radius(1.0)
                .powi(2)
        };
        let circle = std::f64::consts::PI;
        assert!((2.0 * squared(1) - circle).abs() < 1e-12);
        assert!((8.0_f64.sqrt() * squared(2) - circle).abs() < 1e-12);
        assert!((squared(64) - 1.0).abs() < 2e-4);
    }

    #[test]
    fn polygons_have_the_perimeter_of_the_circle() {
        // A square's is 4 √2 r, a regular octagon's 16 sin(22.5°) r.
        let radius = |level: u32| polygons(Sides::Level(level), Equal::Perimeter).radius(1.0);
        let circle = std::f64::consts::TAU;
        assert!((4.0 * 2.0_f64.sqrt() * radius(1) - circle).abs() < 1e-12);
        assert!((16.0 * 22.5_f64.to_radians().sin() * radius(2) - circle).abs() < 1e-12);
        assert!((radius(64) - 1.0).abs() < 1e-4);
    }

    #[test]
    fn sides_follow_from_lengths() {
        let free = Sides::ByLength {
            radii: 1.0,
            least: 0.0,
            most: f64::MAX,
        };
        let count = |sides: Sides, traced: f64| {
            sides.pieces(polygons(sides, Equal::Area).radius(traced), traced)
        };
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
            for equal in [Equal::Area, Equal::Perimeter] {
                let bound = polygons(bound, equal);
                let back = bound.traced(bound.radius(traced));
                assert!((back - traced).abs() < 1e-9, "{traced}");
            }
        }
    }
}
