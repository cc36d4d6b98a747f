//! The layout of a packed mesh, and how its numbers are read. WGSL twin: template.wgsl.
//!
//! | what | bytes | holds |
//! | --- | --- | --- |
//! | point | 16 | center in its sphere (3 × 20 bits), radius (16), tangent (18), turn of the ring (10), taper (5 of 9), level (6), color key (10), kind and run (3) |
//! | taper | ½ | the lowest 4 bits of a point's taper |
//! | shaped ring | 20 | its point (22), level (6), open sides (4); turn (4 × 10) and height (4 × 16) of each corner, whether it is an inset, and of that the collar (17), of others which corner lies in a crease (2), how far out (14), and the border (5) |
//! | sphere, for 32 points | 20 | center, radius, the most that an edge bends |
//! | explicit vertex | 12 | offset from its anchor (3 × 16), anchor (16), normal (24), level (8) |
//! | anchor | 32 | center, reach, radius, tangent, role, taper, collar or border, color key |
//! | patch of a soma | 6 | four explicit vertices |
//! | explicit patch | 8 | four explicit vertices, kind |
//! | cap | 4 | its ring |
//!
//! A point has an implicit ring, four vertices a quarter turn apart, and four lateral patches to
//! the next point: rings and lateral patches are computed from points alone. Where branches leave
//! through insets, the rings beside them have corners that are not a quarter turn apart, and those of
//! insets lie at different heights along the branch; at bends, a corner lies in the crease: these are **shaped rings**.
//! Some of the four sides from such a ring to the next are open. Joints, insertions and somata are made of explicit vertices,
//! stored relative to anchors.
//!
//! Patches outside of runs name explicit vertices by their index, and after them the corners of shaped
//! rings, four each.
//!
//! Errors: at most 0.2 % of the radius for the center (a ring whose sphere is too large for that becomes
//! explicit), 0.02 % for the radius, 0.4 % for the tangent, 0.4 % for the turn,
//! 2⁻⁹ for the square root of the taper; for explicit vertices
//! 2⁻¹⁶ of their distance from the anchor. All together less than a hundredth of the radius:
//! `resident_form_is_within_a_hundredth_of_the_radius`.

use glam::Vec3;
use neurotess_mesh::{Role, TracingPoint};

/// Number of points whose centers are stored relative to the same sphere.
pub const POINTS_OF_SPHERE: usize = 32;
/// Number of u32s of a bounding sphere.
pub(crate) const SPHERE_U32S: usize = 5;
/// Bit of a vertex that is explicit.
pub(crate) const EXPLICIT: u32 = 1 << 31;
pub(crate) const POINT_KIND_SHIFT: u32 = 30;
/// Kinds of a point: with an implicit ring, the same at an end, with a ring of explicit vertices, or
/// with a shaped ring. Those of implicit rings come first.
pub(crate) const POINT_ORDINARY: u32 = 0;
pub(crate) const POINT_END: u32 = 1;
pub(crate) const POINT_EXPLICIT: u32 = 2;
pub(crate) const POINT_SHAPED: u32 = 3;
/// Number of u32s of a shaped ring.
pub const SHAPED_U32S: usize = 5;
/// First bit of a shaped ring's level, and of its four open sides.
pub(crate) const SHAPED_LEVEL_SHIFT: u32 = 22;
pub(crate) const SHAPED_OPEN_SHIFT: u32 = 28;
/// Bit of a shaped ring that is an inset's.
pub(crate) const SHAPED_INSET: u32 = 1 << 10;
/// First bit of where a shaped ring's corner lies in a crease.
pub(crate) const SHAPED_CREASE_SHIFT: u32 = 11;
/// Bit of a collar that is negative.
pub(crate) const COLLAR_AGAINST: u32 = 1 << 16;
/// First bit of the corner of a shaped ring that lies in a crease, after how far out it is.
pub(crate) const CREASE_CORNER_SHIFT: u32 = 14;
/// Greatest distance of that corner from the center, in radii.
pub(crate) const MAX_CREASE: f32 = 4.0;
/// Number of steps of it.
pub(crate) const CREASE_STEPS: f32 = ((1 << CREASE_CORNER_SHIFT) - 1) as f32;
/// First bit of an anchor's taper, after its role.
pub(crate) const ANCHOR_TAPER_SHIFT: u32 = 3;
/// First bit of the collar of an anchor or a shaped ring that is an inset's.
pub(crate) const COLLAR_SHIFT: u32 = 15;
/// First bit of the border of any other: the upper bits, so that its sign is theirs.
pub(crate) const BORDER_SHIFT: u32 = 27;
/// Greatest height of a shaped ring's corner over its center, in radii.
pub(crate) const MAX_HEIGHT: f32 = 4.0;
/// Bit of a point where the tube narrows.
pub(crate) const POINT_NARROWS: u32 = 1 << 29;
/// Bit of a taper that is negative.
pub(crate) const TAPER_NARROWS: u32 = 1 << 8;
/// Number of bits of a taper that are stored after the points, and not with them.
pub(crate) const TAPER_LOW_BITS: u32 = 4;
/// Bit of a point that has lateral patches to the next.
pub(crate) const POINT_GOES_ON: u32 = 1 << 28;
/// Number of steps of a coordinate from one side of the sphere's bounding box to the other.
pub(crate) const POSITION_STEPS: f32 = ((1 << 20) - 1) as f32;
/// Radii are stored as floats with 5 bits of exponent, 2⁻¹⁶ to 2¹⁶ µm, and 11 bits of fraction.
pub(crate) const RADIUS_BASE: u32 = 111 << 11;

/// Unit vector from octahedral coordinates, each of which is one of `most` + 1 steps.
pub(crate) fn octahedral(x: u32, y: u32, most: f32) -> Vec3 {
    let px = x as f32 * (2.0 / most) - 1.0;
    let py = y as f32 * (2.0 / most) - 1.0;
    let z = 1.0 - px.abs() - py.abs();
    let fold = (-z).max(0.0);
    let away = |p: f32| if p >= 0.0 { -fold } else { fold };
    normalize_or(Vec3::new(px + away(px), py + away(py), z), Vec3::Z)
}

/// The function of the same name in evaluate.wgsl.
pub(crate) fn normalize_or(v: Vec3, otherwise: Vec3) -> Vec3 {
    v.normalize_or(otherwise)
}

/// Octahedral coordinates of a unit vector, in `most` + 1 steps.
pub(crate) fn to_octahedral(v: Vec3, most: f32) -> (u32, u32) {
    let p = v / (v.x.abs() + v.y.abs() + v.z.abs()).max(f32::MIN_POSITIVE);
    let (mut x, mut y) = (p.x, p.y);
    if p.z < 0.0 {
        let side = |p: f32| if p >= 0.0 { 1.0 } else { -1.0 };
        (x, y) = ((1.0 - p.y.abs()) * side(p.x), (1.0 - p.x.abs()) * side(p.y));
    }
    let steps = |c: f32| ((c + 1.0) * 0.5 * most + 0.5).clamp(0.0, most) as u32;
    (steps(x), steps(y))
}

/// Two unit vectors that form a right-handed orthonormal basis with a third: Duff et al., Building
/// an orthonormal basis, revisited, 2017.
pub(crate) fn basis(tangent: Vec3) -> (Vec3, Vec3) {
    let sign = if tangent.z >= 0.0 { 1.0 } else { -1.0 };
    let a = -1.0 / (sign + tangent.z);
    let b = tangent.x * tangent.y * a;
    let u = Vec3::new(
        1.0 + sign * tangent.x * tangent.x * a,
        sign * b,
        -sign * tangent.x,
    );
    let v = Vec3::new(b, sign + tangent.y * tangent.y * a, -tangent.y);
    (u, v)
}

/// Unit direction from a ring's center to its corner k: corners are a quarter turn about the
/// tangent apart.
pub(crate) fn ring_direction(tangent: Vec3, turn: u32, k: u32) -> Vec3 {
    let (u, v) = basis(tangent);
    let t = (turn & 0xff) as f32 / 256.0;
    let scale = 1.0 / (1.0 + t * t);
    let (c, s) = ((1.0 - t * t) * scale, 2.0 * t * scale);
    match (k + (turn >> 8)) & 3 {
        0 => u * c + v * s,
        1 => v * c - u * s,
        2 => -(u * c) - v * s,
        _ => u * s - v * c,
    }
}

/// The turn of a ring whose corner 0 is in this direction, in the form that [`ring_direction`]
/// reads.
pub(crate) fn to_turn(tangent: Vec3, direction: Vec3) -> u32 {
    let (u, v) = basis(tangent);
    let angle = direction.dot(v).atan2(direction.dot(u));
    let angle = angle.rem_euclid(std::f32::consts::TAU);
    let quarter = (angle / std::f32::consts::FRAC_PI_2).floor().min(3.0);
    let rest = angle - quarter * std::f32::consts::FRAC_PI_2;
    let step = ((rest / 2.0).tan() * 256.0 + 0.5) as u32;
    ((quarter as u32) * 256 + step) & 0x3ff
}

/// A radius (µm) in 16 bits, if it is in their range.
pub(crate) fn to_radius(radius: f32) -> Option<u32> {
    // Rounded to the nearest fraction.
    let code = ((radius.to_bits() + (1 << 11)) >> 12).checked_sub(RADIUS_BASE)?;
    (radius > 0.0 && code < 1 << 16).then_some(code)
}

pub(crate) fn radius(code: u32) -> f32 {
    f32::from_bits((code + RADIUS_BASE) << 12)
}

/// A collar's length as 17 bits: as a radius, 0 for none or for one shorter than any, and a sign.
pub(crate) fn to_collar(length: f32) -> u32 {
    let against = if length < 0.0 { COLLAR_AGAINST } else { 0 };
    to_radius(length.abs()).map_or(0, |code| code | against)
}

pub(crate) fn collar(code: u32) -> f32 {
    match code {
        0 => 0.0,
        _ if code & COLLAR_AGAINST != 0 => -radius(code ^ COLLAR_AGAINST),
        _ => radius(code),
    }
}

/// The corner of a ring that lies in a crease, and how far (radii) from the center, as 16 bits; 0 for none.
pub(crate) fn to_crease(corner: usize, reach: f32) -> u32 {
    let steps = (reach * (CREASE_STEPS / MAX_CREASE) + 0.5).clamp(1.0, CREASE_STEPS);
    ((corner as u32) << CREASE_CORNER_SHIFT) | steps as u32
}

/// What an anchor or a shaped ring has in its upper bits: the collar of an inset, the border of any other.
pub(crate) fn to_collar_or_border(point: &TracingPoint) -> u32 {
    match point.role {
        Role::Inset => to_collar(point.collar) << COLLAR_SHIFT,
        _ => (i32::from(point.border) << BORDER_SHIFT).cast_unsigned(),
    }
}

/// How far (radii) corner k is from the center.
pub(crate) fn reach_of_corner(crease: u32, k: usize) -> f32 {
    let steps = crease & ((1 << CREASE_CORNER_SHIFT) - 1);
    match steps > 0 && crease >> CREASE_CORNER_SHIFT == k as u32 {
        true => steps as f32 * (MAX_CREASE / CREASE_STEPS),
        false => 1.0,
    }
}

/// A taper as 8 bits and a sign. The bits are those of its square root, so that small tapers are
/// accurate.
pub(crate) fn to_taper(taper: f32) -> u32 {
    let root = taper.abs().min(1.0).sqrt();
    let narrows = if taper < 0.0 { TAPER_NARROWS } else { 0 };
    (root * 255.0 + 0.5) as u32 | narrows
}

pub(crate) fn taper(code: u32) -> f32 {
    let root = (code & 0xff) as f32 / 255.0;
    let square = root * root;
    if code & TAPER_NARROWS == 0 {
        square
    } else {
        -square
    }
}

/// A position from its steps in a sphere's bounding box.
pub(crate) fn from_sphere(center: Vec3, sphere_radius: f32, [x, y, z]: [u32; 3]) -> Vec3 {
    let step = sphere_radius * (2.0 / POSITION_STEPS);
    let from_sphere = Vec3::new(x as f32, y as f32, z as f32) * step - Vec3::splat(sphere_radius);
    center + from_sphere
}

pub(crate) fn to_sphere(center: Vec3, sphere_radius: f32, p: Vec3) -> [u32; 3] {
    let step = sphere_radius * (2.0 / POSITION_STEPS);
    let place = (p - center + sphere_radius) / step.max(f32::MIN_POSITIVE);
    let steps = |c: f32| (c + 0.5).clamp(0.0, POSITION_STEPS) as u32;
    [steps(place.x), steps(place.y), steps(place.z)]
}

/// A number from −1 to 1, stored in 16 bits.
pub(crate) fn signed16(bits: u32) -> f32 {
    (bits & 0xffff) as f32 * (2.0 / 65535.0) - 1.0
}

pub(crate) fn to_signed16(value: f32) -> u32 {
    ((value + 1.0) * 0.5 * 65535.0 + 0.5).clamp(0.0, 65535.0) as u32
}

/// An implicit ring in the form that it is stored in.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ImplicitRing {
    pub(crate) tracing: u32,
    pub(crate) radius: u32,
    pub(crate) tangent: (u32, u32),
    pub(crate) turn: u32,
    pub(crate) taper: u32,
    pub(crate) role: Role,
}

impl ImplicitRing {
    pub(crate) fn tangent(&self) -> Vec3 {
        octahedral(self.tangent.0, self.tangent.1, 511.0)
    }

    /// Position and normal of corner k around a center.
    pub(crate) fn corner(&self, center: Vec3, k: u32) -> (Vec3, Vec3) {
        let tangent = self.tangent();
        let direction = ring_direction(tangent, self.turn, k);
        let normal = normalize_or(direction - tangent * taper(self.taper), direction);
        (center + direction * radius(self.radius), normal)
    }
}

/// A ring around a point whose corners have turns and heights of their own.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShapedRing {
    /// Its turn is not used.
    pub(crate) circle: ImplicitRing,
    pub(crate) turns: [u32; 4],
    pub(crate) heights: [u32; 4],
    /// The collar of an inset, the border of any other, as stored.
    pub(crate) upper: u32,
    /// Of any other ring: which corner lies in a crease, and how far out.
    pub(crate) crease: u32,
}

impl ShapedRing {
    /// Position and normal of corner k around a center.
    pub(crate) fn corner(&self, center: Vec3, k: usize) -> (Vec3, Vec3) {
        let turned = ImplicitRing {
            turn: self.turns[k],
            ..self.circle
        };
        let (on_circle, normal) = turned.corner(center, 0);
        let across = (on_circle - center) * reach_of_corner(self.crease, k);
        let height = signed16(self.heights[k]) * MAX_HEIGHT * radius(self.circle.radius);
        (center + (across + self.circle.tangent() * height), normal)
    }

    /// All but its point and its open sides, as it is stored.
    pub(crate) fn packed(&self) -> [u32; SHAPED_U32S - 1] {
        let [a, b, c, d] = self.turns;
        let inset = if self.circle.role == Role::Inset {
            SHAPED_INSET
        } else {
            0
        };
        let pair = |k: usize| self.heights[k] | (self.heights[k + 1] << 16);
        [
            a | (b << 10) | (c << 20),
            d | inset | (self.crease << SHAPED_CREASE_SHIFT) | self.upper,
            pair(0),
            pair(2),
        ]
    }
}

/// Greatest error of a point's center, in radii.
const MAX_CENTER_ERROR: f32 = 0.002;

/// Whether a sphere is small enough for a point of this radius.
pub(crate) fn accurate(sphere: f32, radius: f32) -> bool {
    // A step is sphere · 2 / POSITION_STEPS; a center is off by up to half a step in each of three
    // directions.
    sphere / POSITION_STEPS * 1.74 <= MAX_CENTER_ERROR * radius
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn creases_keep_their_corner() {
        for (corner, reach) in [(0, 1.04_f32), (3, 2.4), (2, 1.0)] {
            let crease = to_crease(corner, reach);
            for k in 0..4 {
                let expected = if k == corner { reach } else { 1.0 };
                // Half a step.
                let off = (reach_of_corner(crease, k) - expected).abs();
                assert!(off <= 0.51 * MAX_CREASE / CREASE_STEPS, "{off}");
            }
        }
        assert_eq!([0, 1, 2, 3].map(|k| reach_of_corner(0, k)), [1.0; 4]);
    }

    #[test]
    fn collars_keep_their_direction() {
        for length in [0.3_f32, -0.3, 7.0, -7.0, 0.0] {
            let read = collar(to_collar(length));
            assert!(
                (read - length).abs() <= 3e-4 * length.abs(),
                "{read}, {length}"
            );
        }
        assert_eq!(collar(to_collar(-1e-9)), 0.0);
    }
}
