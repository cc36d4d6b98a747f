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
//! the cubic is of that: [`Profile::share`], 1 at both rings. So rings, and surfaces of level 1, do not depend on it.

use neurotess_mesh::Role;

use super::center_line::CenterLine;
use super::corner::Corner;

/// Greatest slope of the cubic at one of its ends, in slopes of the straight way.
pub(crate) const STEEPEST_PROFILE: f32 = 3.0;

/// The radius (µm) along a tube, `from` + `way` y + y (1 − y) ((1 − y) b₀ − y b₁) for y ∈ [0, 1]: the slopes (µm) at
/// both ends are `way` + b₀ and `way` + b₁.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Profile {
    from: f32,
    way: f32,
    beyond: [f32; 2],
}

/// A number with its derivative.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Share {
    pub(crate) value: f32,
    pub(crate) derivative: f32,
}

impl Profile {
    /// From the ring of corner `a` to that of `b`, between which the center line is `line`.
    pub(crate) fn new(a: &Corner, b: &Corner, line: &CenterLine) -> Self {
        let way = b.radius - a.radius;
        let speeds = line.speeds();
        let slope = |corner: &Corner, speed: f32| match corner.has_taper() {
            true => limited(corner.taper * speed, way),
            false => way,
        };
        let [near, far] = [slope(a, speeds[0]), slope(b, speeds[1])];
        Self {
            from: a.radius,
            way,
            beyond: [near - way, far - way],
        }
    }

    /// The radius (µm).
    pub(crate) fn radius(&self, y: f32) -> f32 {
        self.from + self.way * y + self.bump(y)
    }

    /// The radius over what it would be on the straight way, with its derivative.
    pub(crate) fn share(&self, y: f32) -> Share {
        let straight = 1.0 / (self.from + self.way * y).max(f32::MIN_POSITIVE);
        let bump = self.bump(y) * straight;
        let [near, far] = self.beyond;
        let turn = (1.0 - y) * near - y * far;
        let bump_y = (1.0 - 2.0 * y) * turn - y * (1.0 - y) * (near + far);
        Share {
            value: 1.0 + bump,
            derivative: (bump_y - bump * self.way) * straight,
        }
    }

    /// How much more the radius is than on the straight way (µm).
    fn bump(&self, y: f32) -> f32 {
        let [near, far] = self.beyond;
        y * (1.0 - y) * ((1.0 - y) * near - y * far)
    }

    /// Bound of the second derivative (µm).
    pub(crate) fn bend(&self) -> f32 {
        let [near, far] = self.beyond;
        let start = (4.0 * near + 2.0 * far).abs();
        start.max((2.0 * near + 4.0 * far).abs())
    }

    /// Bound of the derivative (µm): those of the ends and of the control point between them.
    pub(crate) fn steepest(&self) -> f32 {
        let [near, far] = self.beyond;
        let ends = (self.way + near).abs().max((self.way + far).abs());
        ends.max((self.way - near - far).abs())
    }
}

/// A slope as one of a monotone cubic between values that are `way` apart.
fn limited(slope: f32, way: f32) -> f32 {
    let most = STEEPEST_PROFILE * way;
    // In this order also where it is not a number.
    slope.max(most.min(0.0)).min(most.max(0.0))
}

impl Corner {
    /// Whether both tubes beside its ring have the slope of its taper.
    fn has_taper(&self) -> bool {
        matches!(self.role, Role::Ordinary | Role::End)
    }
}
