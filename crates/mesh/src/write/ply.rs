//! PLY, binary little endian. Turk, The PLY Polygon File Format, 1994:
//! <http://paulbourke.net/dataformats/ply/>.

use glam::DVec3;

use super::{ColorBy, File, WriteError, absolute, push_numbers, record};
use crate::{Surface, SurfaceVertex, VertexAttribute};

/// Bytes of a triangle: its count and three indices.
const TRIANGLE: u64 = 13;

pub(super) fn write(
    surface: &dyn Surface,
    color_by: Option<ColorBy>,
    file: &mut File<'_>,
) -> Result<(), WriteError> {
    let origin = surface.origin();
    let double = origin != DVec3::ZERO;
    let own = surface.attributes();
    let header = header(surface, double, color_by.is_some());
    let vertices = header.len() as u64;
    let colored = if color_by.is_some() { 3 } else { 0 };
    let row = colored + if double { 52 } else { 40 };
    let own_bytes: usize = own.iter().map(|a| 4 * a.components).sum();
    let triangles = vertices + surface.vertex_count() as u64 * (row + own_bytes) as u64;
    let quads = triangles + surface.triangle_count() as u64 * TRIANGLE;

    file.put(&mut 0, header.as_bytes())?;
    let encode = |group: &[SurfaceVertex], bytes: &mut Vec<u8>| {
        bytes.reserve(row * group.len());
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
            if let Some(by) = color_by {
                bytes.extend_from_slice(&by.of(v));
            }
        }
    };
    if own.is_empty() {
        file.vertices(surface, &mut [vertices], |group, [bytes]| {
            encode(group, bytes);
        })?;
    } else {
        let (mut place, mut rows) = (vertices, Vec::new());
        file.vertices_as(
            surface,
            |_, group, [bytes]| encode(group, bytes),
            |file, group, [bytes]| {
                rows.clear();
                for (vertex, fixed) in group.zip(bytes.chunks_exact(row)) {
                    rows.extend_from_slice(fixed);
                    own.iter()
                        .for_each(|a| push_numbers(&mut rows, of_vertex(a, vertex)));
                }
                file.put(&mut place, &rows)
            },
        )?;
    }
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

fn of_vertex<'a>(attribute: &VertexAttribute<'a>, vertex: usize) -> &'a [f32] {
    let first = vertex * attribute.components;
    &attribute.values[first..first + attribute.components]
}

/// Says which properties belong together: PLY itself has no vectors.
fn own_comments(own: &[VertexAttribute<'_>]) -> String {
    let several = own.iter().filter(|a| a.components > 1);
    let comments = several.map(|a| format!("comment components: {} {}\n", a.name, a.components));
    comments.collect()
}

/// The properties of numbers of one's own: several of a vertex are counted.
fn own_properties(own: &[VertexAttribute<'_>]) -> String {
    let names = own.iter().flat_map(|a| {
        (0..a.components).map(|n| match a.components {
            1 => format!("property float {}\n", a.name),
            _ => format!("property float {}_{n}\n", a.name),
        })
    });
    names.collect()
}

fn header(surface: &dyn Surface, double: bool, colors: bool) -> String {
    let real = if double { "double" } else { "float" };
    let (unit, vertices) = (surface.unit(), surface.vertex_count());
    let faces = surface.triangle_count() + surface.quad_count();
    // The indices are written unsigned; readers that take `int` read the same below 2³¹.
    let index = if vertices > i32::MAX as usize {
        "uint"
    } else {
        "int"
    };
    let own = own_properties(surface.attributes());
    let comments = own_comments(surface.attributes());
    let colors = match colors {
        true => "property uchar red\nproperty uchar green\nproperty uchar blue\n",
        false => "",
    };
    format!(
        "ply\n\
         format binary_little_endian 1.0\n\
         comment neurotess\n\
         comment units: {unit}\n\
         {comments}\
         element vertex {vertices}\n\
         property {real} x\nproperty {real} y\nproperty {real} z\n\
         property float nx\nproperty float ny\nproperty float nz\n\
         property int type\nproperty int point\nproperty int section\n\
         property float radius\n\
         {colors}{own}\
         element face {faces}\n\
         property list uchar {index} vertex_indices\n\
         end_header\n"
    )
}
