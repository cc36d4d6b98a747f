//! Whether a surface is one around its tracing at all. What is not is a fault of ours, and never written.

use glam::Vec3;

use crate::CoarseMesh;

/// Radii around each traced point that a surface reaches at most.
const MOST_RADII: f32 = 2.0;
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
        self.around_tracing(MOST_RADII)
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

/// What a surface is, beside what it may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Soundness {
    /// Volume (µm³).
    pub volume: f64,
    /// Around all vertices.
    pub extent: Extent,
    /// What it may be within: [`CoarseMesh::reach`].
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
    /// An error if the surface is inside out or reaches too far.
    ///
    /// # Errors
    /// Says which.
    pub fn check(&self) -> Result<(), Unsound> {
        let Self {
            volume,
            extent,
            reach,
        } = *self;
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
        let of = |volume: f64, x: f32| Soundness {
            volume,
            extent: Extent::NONE.with(Vec3::ZERO).with(Vec3::X * x),
            reach: mesh.reach(),
        };
        assert_eq!(of(1.0, 2.0).check(), Ok(()));
        assert!(matches!(
            of(-1.0, 1.0).check(),
            Err(Unsound::InsideOut { .. })
        ));
        assert!(matches!(
            of(1.0, 2.1).check(),
            Err(Unsound::FarFromTracing { .. })
        ));
        let empty = Soundness {
            volume: 0.0,
            extent: Extent::NONE,
            reach: CoarseMesh::default().reach(),
        };
        assert_eq!(empty.check(), Ok(()));
    }
}
