//! PLY, binary little endian. Turk, The PLY Polygon File Format, 1994:
//! <http://paulbourke.net/dataformats/ply/>.

use glam::DVec3;

use super::{File, WriteError, absolute, record};
use crate::Surface;

/// Bytes of a triangle: its count and three indices.
const TRIANGLE: u64 = 13;

pub(super) fn write(surface: &dyn Surface, file: &mut File<'_>) -> Result<(), WriteError> {
    let origin = surface.origin();
    let double = origin != DVec3::ZERO;
    let header = header(surface, double);
    let vertices = header.len() as u64;
    let triangles = vertices + surface.vertex_count() as u64 * if double { 52 } else { 40 };
    let quads = triangles + surface.triangle_count() as u64 * TRIANGLE;

    file.put(&mut 0, header.as_bytes())?;
    file.vertices(surface, &mut [vertices], |group, [bytes]| {
        bytes.reserve(52 * group.len());
        for v in group {
            let n = v.normal;
            if double {
                let [x, y, z] = absolute(v, origin);
                bytes.extend_from_slice(&record![52;
                    x, y, z, n.x, n.y, n.z, v.kind, v.point, v.section, v.radius]);
            } else {
                let p = v.position;
                bytes.extend_from_slice(&record![40;
                    p.x, p.y, p.z, n.x, n.y, n.z, v.kind, v.point, v.section, v.radius]);
            }
        }
    })?;
    file.faces(
        surface,
        &mut [triangles, quads],
        |group, [triangles, quads]| {
            triangles.reserve(13 * group.triangles.len());
            for [a, b, c] in &group.triangles {
                triangles.extend_from_slice(&record![13; 3u8, a, b, c]);
            }
            quads.reserve(17 * group.quads.len());
            for [a, b, c, d] in &group.quads {
                quads.extend_from_slice(&record![17; 4u8, a, b, c, d]);
            }
        },
    )
}

fn header(surface: &dyn Surface, double: bool) -> String {
    let real = if double { "double" } else { "float" };
    let (unit, vertices) = (surface.unit(), surface.vertex_count());
    let faces = surface.triangle_count() + surface.quad_count();
    // The indices are written unsigned; readers that take `int` read the same below 2³¹.
    let index = if vertices > i32::MAX as usize {
        "uint"
    } else {
        "int"
    };
    format!(
        "ply\n\
         format binary_little_endian 1.0\n\
         comment neurotess\n\
         comment units: {unit}\n\
         element vertex {vertices}\n\
         property {real} x\nproperty {real} y\nproperty {real} z\n\
         property float nx\nproperty float ny\nproperty float nz\n\
         property int type\nproperty int point\nproperty int section\n\
         property float radius\n\
         element face {faces}\n\
         property list uchar {index} vertex_indices\n\
         end_header\n"
    )
}
