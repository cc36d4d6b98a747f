//! The radius along a tube. WGSL twin: profile.wgsl.
//!
//! **Theory.** Between two rings the radius is a monotone cubic (Fritsch and Carlson, Monotone piecewise cubic
//! interpolation, SIAM Journal on Numerical Analysis 17, 1980, 238–246). Its slope at an ordinary ring is the
//! ring's taper, for both tubes beside it, times the length of the center line's tangent: the surface has one normal
//! there. Elsewhere (joints, insets, somata) tubes have no slope in common, and the cubic has that of the straight
//! way: a natural end, (3 way − other) / 2, gave 1.6 % more crossings beside forks at level 4. Slopes stay within the square of Fritsch and Carlson, 0 to 3 times the straight one, whatever the taper was
//! rounded to: the radius is the traced one at both rings, and between the two on the way.
//!
//! Offsets of corners are blended as they always were, with a radius that is straight, and then multiplied by what
//! the cubic is of that: [`Profiles::share`], 1 at both rings. So rings, and surfaces of level 1, do not depend on it.

use neurotess_mesh::Role;

use super::center_line::CenterLines;
use super::corner::{Corners, mask};
use super::four::{F32x4, Mask};

/// Greatest slope of the cubic at one of its ends, in slopes of the straight way.
pub(crate) const STEEPEST_PROFILE: f32 = 3.0;

/// The radii (µm) along four tubes, each `from` + `way` y + y (1 − y) ((1 − y) b₀ − y b₁) for y ∈ [0, 1]: the slopes (µm) at
/// both ends are `way` + b₀ and `way` + b₁.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Profiles {
    from: F32x4,
    way: F32x4,
    beyond: [F32x4; 2],
}

/// Four numbers with their derivatives.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shares {
    pub(crate) value: F32x4,
    pub(crate) derivative: F32x4,
}

impl Profiles {
    /// From the rings of corners `a` to those of `b`, between which the center lines are `line`.
    #[inline(always)]
    pub(crate) fn new(a: &Corners, b: &Corners, line: &CenterLines) -> Self {
        let way = b.radius - a.radius;
        let speeds = line.speeds();
        let slope = |corner: &Corners, speed: F32x4| {
            F32x4::select(corner.has_taper(), limited(corner.taper * speed, way), way)
        };
        let [near, far] = [slope(a, speeds[0]), slope(b, speeds[1])];
        Self {
            from: a.radius,
            way,
            beyond: [near - way, far - way],
        }
    }

    /// The radius (µm).
    pub(crate) fn radius(&self, y: F32x4) -> F32x4 {
        self.from + self.way * y + self.bump(y)
    }

    /// The radius over what it would be on the straight way, with its derivative.
    pub(crate) fn share(&self, y: F32x4) -> Shares {
        let straight = F32x4::ONE / (self.from + self.way * y).max(F32x4::splat(f32::MIN_POSITIVE));
        let bump = self.bump(y) * straight;
        let [near, far] = self.beyond;
        let turn = (1.0 - y) * near - y * far;
        let bump_y = (1.0 - 2.0 * y) * turn - y * (1.0 - y) * (near + far);
        Shares {
            value: 1.0 + bump,
            derivative: (bump_y - bump * self.way) * straight,
        }
    }

    /// How much more the radius is than on the straight way (µm).
    fn bump(&self, y: F32x4) -> F32x4 {
        let [near, far] = self.beyond;
        y * (1.0 - y) * ((1.0 - y) * near - y * far)
    }

    /// Bound of the second derivative (µm).
    pub(crate) fn bend(&self) -> F32x4 {
        let [near, far] = self.beyond;
        let start = (4.0 * near + 2.0 * far).abs();
        start.max((2.0 * near + 4.0 * far).abs())
    }

    /// Bound of the derivative (µm): those of the ends and of the control point between them.
    pub(crate) fn steepest(&self) -> F32x4 {
        let [near, far] = self.beyond;
        let ends = (self.way + near).abs().max((self.way + far).abs());
        ends.max((self.way - near - far).abs())
    }
}

/// Slopes as those of monotone cubics between values that are `way` apart.
fn limited(slope: F32x4, way: F32x4) -> F32x4 {
    let most = STEEPEST_PROFILE * way;
    let (least, greatest) = (most.min(F32x4::ZERO), most.max(F32x4::ZERO));
    // Not by `max`, so that what is not a number is the least on all processors.
    let steep = F32x4::select(slope.cmpgt(least), slope, least);
    steep.min(greatest)
}

impl Corners {
    /// At which both tubes beside the ring have the slope of its taper.
    fn has_taper(&self) -> Mask {
        mask(self.role, |role| matches!(role, Role::Ordinary | Role::End))
    }
}
