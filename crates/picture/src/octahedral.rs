//! Unit vectors in 32 bits: as octahedral coordinates (Meyer et al., On floating-point normal vectors, 2010).

use glam::Vec3;

/// A unit vector as two signed 16-bit numbers: accurate to 0.005°.
pub fn pack_normal(normal: Vec3) -> u32 {
    let sum = normal.abs().element_sum().max(f32::MIN_POSITIVE);
    let (x, y) = (normal.x / sum, normal.y / sum);
    let sign = |value: f32| if value < 0.0 { -1.0 } else { 1.0 };
    let (x, y) = if normal.z < 0.0 {
        ((1.0 - y.abs()) * sign(x), (1.0 - x.abs()) * sign(y))
    } else {
        (x, y)
    };
    let snorm = |value: f32| u32::from((value.clamp(-1.0, 1.0) * 32767.0).round() as i16 as u16);
    snorm(x) | (snorm(y) << 16)
}
