//! Whether a surface is one around its tracing at all. What is not is a fault of ours, and never written.

use glam::{Mat3, Vec3};

use crate::CoarseMesh;

/// Radii around each traced point that a surface reaches at most.
const MAX_RADII: f32 = 2.0;
/// Rounding of a box's sides, as a share of the greatest coordinate.
const ROUNDING: f32 = 1e-5;

/// A box (µm, relative to the surface's origin).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// Least coordinates; greater than `high` of nothing.
    pub low: Vec3,
    /// Greatest coordinates.
    pub high: Vec3,
}

impl Extent {
    /// That of nothing.
    pub const NONE: Self = Self {
        low: Vec3::INFINITY,
        high: Vec3::NEG_INFINITY,
    };

    /// With another point.
    pub fn with(self, point: Vec3) -> Self {
        Self {
            low: self.low.min(point),
            high: self.high.max(point),
        }
    }

    /// Both together.
    pub fn and(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    /// The box around it as it is elsewhere.
    pub(crate) fn transformed(self, linear: Mat3) -> Self {
        let corner = |k: u32| {
            let pick = |axis: u32| {
                if k >> axis & 1 == 0 {
                    self.low
                } else {
                    self.high
                }
            };
            linear * Vec3::new(pick(0).x, pick(1).y, pick(2).z)
        };
        match self.low.cmpgt(self.high).any() {
            true => self,
            false => (0..8).map(corner).fold(Self::NONE, Self::with),
        }
    }

    /// Whether a point is within it.
    pub fn has(&self, point: Vec3) -> bool {
        point.cmpge(self.low).all() && point.cmple(self.high).all()
    }

    /// Whether another is within it, but for rounding.
    fn holds(&self, other: Self) -> bool {
        let slack = Vec3::splat(ROUNDING * self.low.abs().max(self.high.abs()).max_element());
        other.low.cmpgt(other.high).any()
            || (other.low.cmpge(self.low - slack).all()
                && other.high.cmple(self.high + slack).all())
    }
}

impl CoarseMesh {
    /// The box that the surface is within at any level: around all traced points, each with two radii.
    pub fn reach(&self) -> Extent {
        self.around_tracing(MAX_RADII)
    }

    /// The box around all traced points, each with so many radii.
    pub fn around_tracing(&self, radii: f32) -> Extent {
        let points = self.tracing.iter();
        points.fold(Extent::NONE, |reach, point| {
            let around = Vec3::splat(radii * point.radius);
            reach
                .with(point.center - around)
                .with(point.center + around)
        })
    }
}

/// What is known of a surface before any of its vertices is made, for the check of what was made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Soundness {
    /// Volume (µm³) of the coarse mesh. Those whose tubes turn over are looked at more finely when they are made.
    pub volume: f64,
    /// What the surface may be within, in its own unit: [`CoarseMesh::reach`].
    pub reach: Extent,
}

/// A surface that is none around its tracing.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Unsound {
    /// It is inside out, as a whole.
    #[error(
        "the surface has a volume of {volume:.3} µm³: that is a fault of neurotess, nothing is written; please report it \
         with the tracing"
    )]
    InsideOut {
        /// Volume (µm³).
        volume: f64,
    },
    /// It reaches farther than the tracing and two radii.
    #[error(
        "the surface reaches from {} to {} µm, and the tracing with two radii from {} to {}: that is a fault of \
         neurotess, nothing is written; please report it with the tracing",
        extent.low, extent.high, reach.low, reach.high
    )]
    FarFromTracing {
        /// Around all vertices.
        extent: Extent,
        /// What they may be within.
        reach: Extent,
    },
}

impl Soundness {
    /// An error if the surface, which was found to extend so far, is inside out or reaches too far.
    ///
    /// # Errors
    /// Says which.
    pub fn check(&self, extent: Extent) -> Result<(), Unsound> {
        let Self { volume, reach } = *self;
        if volume < 0.0 {
            return Err(Unsound::InsideOut { volume });
        }
        match reach.holds(extent) {
            true => Ok(()),
            false => Err(Unsound::FarFromTracing { extent, reach }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::TracingPoint;

    #[test]
    fn what_is_inside_out_or_too_far_is_an_error() {
        let point = TracingPoint {
            radius: 1.0,
            ..TracingPoint::default()
        };
        let mesh = CoarseMesh {
            tracing: vec![point],
            ..CoarseMesh::default()
        };
        let of = |volume: f64, x: f32| {
            let reach = mesh.reach();
            let extent = Extent::NONE.with(Vec3::ZERO).with(Vec3::X * x);
            Soundness { volume, reach }.check(extent)
        };
        assert_eq!(of(1.0, 2.0), Ok(()));
        assert!(matches!(of(-1.0, 1.0), Err(Unsound::InsideOut { .. })));
        assert!(matches!(of(1.0, 2.1), Err(Unsound::FarFromTracing { .. })));
        let empty = Soundness {
            volume: 0.0,
            reach: CoarseMesh::default().reach(),
        };
        assert_eq!(empty.check(Extent::NONE), Ok(()));
    }

    #[test]
    fn boxes_turn_and_grow_with_what_is_in_them() {
        let extent = Extent::NONE.with(Vec3::ZERO).with(Vec3::new(1.0, 2.0, 3.0));
        let turned = extent.transformed(Mat3::from_cols(-Vec3::Y, Vec3::X * 2.0, Vec3::Z));
        assert_eq!(
            turned,
            Extent::NONE.with(-Vec3::Y).with(Vec3::new(4.0, 0.0, 3.0))
        );
        assert_eq!(Extent::NONE.transformed(Mat3::IDENTITY), Extent::NONE);
    }
}
