//! Positions, directions and errors in few bits.

use glam::{Vec2, Vec3};

use super::layout::{ERROR_OFFSET, ERROR_STEPS, NO_LOD};

/// Steps of a stored coordinate.
pub(super) const STEPS: f32 = 65_535.0;

/// An error (µm) as a byte, rounded up so that no error is understated.
pub(super) fn error_byte(error: f32) -> u8 {
    if error <= 0.0 {
        return 0;
    }
    let step = ((error.log2() + ERROR_OFFSET) * ERROR_STEPS).ceil();
    step.clamp(1.0, f32::from(NO_LOD - 1)) as u8
}

/// The error (µm) of a byte.
pub(super) fn error_of(byte: u8) -> f32 {
    match byte {
        0 => 0.0,
        byte => (f32::from(byte) / ERROR_STEPS - ERROR_OFFSET).exp2(),
    }
}

pub(super) fn u32s_of(bytes: [u8; 8]) -> [u32; 2] {
    let [a, b, c, d, e, f, g, h] = bytes;
    [[a, b, c, d], [e, f, g, h]].map(u32::from_le_bytes)
}

pub(super) fn bytes_of(u32s: [u32; 2]) -> [u8; 8] {
    let [[a, b, c, d], [e, f, g, h]] = u32s.map(u32::to_le_bytes);
    [a, b, c, d, e, f, g, h]
}

/// Bytes as u32s, the last filled up with zeros.
pub(super) fn packed_bytes(mut bytes: Vec<u8>) -> Vec<u32> {
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    let fours = bytes.chunks_exact(4);
    fours
        .map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]))
        .collect()
}

/// The grid that positions are stored in: its lowest corner, and the length (µm) of a step.
pub(super) fn grid(positions: impl Iterator<Item = Vec3> + Clone) -> (Vec3, f32) {
    let low = positions.clone().fold(Vec3::MAX, Vec3::min);
    let high = positions.fold(Vec3::MIN, Vec3::max);
    let extent = (high - low).max_element();
    (low, (extent / STEPS).max(1e-9))
}

/// A position in steps of a grid, 16 bits for each coordinate, and 16 bits `more`.
pub(super) fn packed(position: Vec3, low: Vec3, step: f32, more: u32) -> [u32; 2] {
    let [x, y, z] = ((position - low) / step)
        .round()
        .clamp(Vec3::ZERO, Vec3::splat(STEPS))
        .to_array()
        .map(|v| v as u32);
    [x | (y << 16), z | (more << 16)]
}

/// A unit vector as octahedral coordinates of 16 bits each.
pub(super) fn packed_direction(v: Vec3) -> u32 {
    let p = octahedral(v);
    let whole = |x: f32| u32::from((x * 32_767.0).round() as i16 as u16);
    whole(p.x) | (whole(p.y) << 16)
}

/// Octahedral coordinates of a unit vector, −1 to 1 (Meyer et al., On floating-point normal
/// vectors, 2010).
pub(super) fn octahedral(v: Vec3) -> Vec2 {
    let size = v.abs().element_sum();
    if size <= 0.0 {
        return Vec2::ZERO;
    }
    let p = v.truncate() / size;
    if v.z >= 0.0 {
        return p;
    }
    let sign = |x: f32| if x >= 0.0 { 1.0 } else { -1.0 };
    Vec2::new((1.0 - p.y.abs()) * sign(p.x), (1.0 - p.x.abs()) * sign(p.y))
}

/// A sphere that holds these spheres, around the center of their bounding box.
pub(super) fn sphere(spheres: impl Iterator<Item = (Vec3, f32)> + Clone) -> (Vec3, f32) {
    let low = spheres
        .clone()
        .map(|(c, r)| c - r)
        .fold(Vec3::MAX, Vec3::min);
    let high = spheres
        .clone()
        .map(|(c, r)| c + r)
        .fold(Vec3::MIN, Vec3::max);
    let center = (low + high) / 2.0;
    let reach = spheres
        .map(|(c, r)| c.distance(center) + r)
        .fold(0.0, f32::max);
    // A little more, since positions are rounded when they are stored.
    (center, reach * 1.0001)
}
