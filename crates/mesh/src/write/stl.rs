//! STL, binary: 80 bytes of header, a count, 50 bytes a triangle.
//! <https://en.wikipedia.org/wiki/STL_(file_format)>.

use glam::Vec3;

use super::{File, WriteError, record, split};
use crate::measure::positions;
use crate::{Format, Surface};

pub(super) fn write(surface: &dyn Surface, file: &mut File<'_>) -> Result<(), WriteError> {
    let count = surface.triangle_count() as u64 + 2 * surface.quad_count() as u64;
    let Ok(count) = u32::try_from(count) else {
        return Err(WriteError::TooLarge {
            format: Format::Stl,
            size: count,
            unit: "triangles",
        });
    };
    // Must not begin with `solid`: that is how readers know the text form.
    let mut header = [b' '; 84];
    let title = format!("neurotess, units: {}", surface.unit());
    header[..title.len()].copy_from_slice(title.as_bytes());
    header[80..].copy_from_slice(&count.to_le_bytes());
    let mut place = 0;
    file.put(&mut place, &header)?;

    let origin = surface.origin();
    let mut positions = positions(surface);
    if let Some(lost) = positions.iter().position(|p| !p.is_finite()) {
        return Err(WriteError::NotFinite(lost));
    }
    for position in &mut positions {
        *position = (position.as_dvec3() + origin).as_vec3();
    }
    file.faces(surface, &mut [place], |group, [bytes]| {
        let quads = group.quads.iter().flat_map(split);
        bytes.reserve(50 * (group.triangles.len() + 2 * group.quads.len()));
        for face in group.triangles.iter().copied().chain(quads) {
            let [a, b, c] = face.map(|corner| positions[corner as usize]);
            let n = normal([a, b, c]);
            bytes.extend_from_slice(&record![50;
                n.x, n.y, n.z, a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z, 0u16]);
        }
    })
}

/// Unit normal; zero if the triangle has no area.
fn normal(corners: [Vec3; 3]) -> Vec3 {
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    (b - a).cross(c - a).normalize_or_zero().as_vec3()
}
