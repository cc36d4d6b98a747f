//! Four numbers, or four vectors, at once.
//!
//! Processors add four numbers as fast as one. Each operation is that of IEEE 754 on each of the four, in the order in
//! which glam has it for one vector: results are equal to the bit to those of one after the other.

use std::ops::{Add, Div, Mul, Neg, Sub};

use glam::{BVec4A, Vec3, Vec4};

use crate::fours::four;

/// Four numbers.
pub(crate) type F32x4 = Vec4;

/// Which of four.
pub(crate) type Mask = BVec4A;

/// Four vectors.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Vec3x4 {
    pub(crate) x: F32x4,
    pub(crate) y: F32x4,
    pub(crate) z: F32x4,
}

impl Vec3x4 {
    pub(crate) const ZERO: Self = Self::splat(Vec3::ZERO);

    /// The same four times.
    pub(crate) const fn splat(v: Vec3) -> Self {
        Self {
            x: F32x4::splat(v.x),
            y: F32x4::splat(v.y),
            z: F32x4::splat(v.z),
        }
    }

    #[inline(always)]
    pub(crate) fn new([a, b, c, d]: [Vec3; 4]) -> Self {
        Self {
            x: F32x4::new(a.x, b.x, c.x, d.x),
            y: F32x4::new(a.y, b.y, c.y, d.y),
            z: F32x4::new(a.z, b.z, c.z, d.z),
        }
    }

    /// One after the other.
    #[inline(always)]
    pub(crate) fn each(self) -> [Vec3; 4] {
        let (x, y, z) = (self.x.to_array(), self.y.to_array(), self.z.to_array());
        four(|k| Vec3::new(x[k], y[k], z[k]))
    }

    /// The k-th, four times.
    #[inline(always)]
    pub(crate) fn only(self, k: usize) -> Self {
        Self {
            x: F32x4::splat(self.x[k]),
            y: F32x4::splat(self.y[k]),
            z: F32x4::splat(self.z[k]),
        }
    }

    #[inline(always)]
    pub(crate) fn select(mask: Mask, if_true: Self, if_false: Self) -> Self {
        Self {
            x: F32x4::select(mask, if_true.x, if_false.x),
            y: F32x4::select(mask, if_true.y, if_false.y),
            z: F32x4::select(mask, if_true.z, if_false.z),
        }
    }

    #[inline(always)]
    pub(crate) fn is_zero(self) -> Mask {
        self.x.cmpeq(F32x4::ZERO) & self.y.cmpeq(F32x4::ZERO) & self.z.cmpeq(F32x4::ZERO)
    }

    #[inline(always)]
    pub(crate) fn dot(self, other: Self) -> F32x4 {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    #[inline(always)]
    pub(crate) fn cross(self, other: Self) -> Self {
        Self {
            x: self.y * other.z - other.y * self.z,
            y: self.z * other.x - other.z * self.x,
            z: self.x * other.y - other.x * self.y,
        }
    }

    #[inline(always)]
    pub(crate) fn length_squared(self) -> F32x4 {
        self.dot(self)
    }

    #[inline(always)]
    pub(crate) fn length(self) -> F32x4 {
        self.length_squared().sqrt()
    }

    /// As unit vectors, and which have a direction.
    #[inline(always)]
    pub(crate) fn normalize(self) -> (Self, Mask) {
        let inverse = F32x4::ONE / self.length();
        let has_direction = inverse.cmpgt(F32x4::ZERO) & inverse.cmplt(F32x4::INFINITY);
        (self * inverse, has_direction)
    }

    /// As unit vectors; what has no direction is `fallback`.
    #[inline(always)]
    pub(crate) fn normalize_or(self, fallback: Self) -> Self {
        let (unit, has_direction) = self.normalize();
        Self::select(has_direction, unit, fallback)
    }

    #[inline(always)]
    pub(crate) fn normalize_or_zero(self) -> Self {
        self.normalize_or(Self::ZERO)
    }
}

impl Add for Vec3x4 {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self {
            x: self.x + other.x,
            y: self.y + other.y,
            z: self.z + other.z,
        }
    }
}

impl Sub for Vec3x4 {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self {
            x: self.x - other.x,
            y: self.y - other.y,
            z: self.z - other.z,
        }
    }
}

impl Neg for Vec3x4 {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self {
            x: -self.x,
            y: -self.y,
            z: -self.z,
        }
    }
}

impl Mul<F32x4> for Vec3x4 {
    type Output = Self;

    #[inline(always)]
    fn mul(self, by: F32x4) -> Self {
        Self {
            x: self.x * by,
            y: self.y * by,
            z: self.z * by,
        }
    }
}

impl Mul<f32> for Vec3x4 {
    type Output = Self;

    #[inline(always)]
    fn mul(self, by: f32) -> Self {
        self * F32x4::splat(by)
    }
}

impl Div<F32x4> for Vec3x4 {
    type Output = Self;

    #[inline(always)]
    fn div(self, by: F32x4) -> Self {
        Self {
            x: self.x / by,
            y: self.y / by,
            z: self.z / by,
        }
    }
}
