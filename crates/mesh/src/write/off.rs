//! OFF, text. Geomview manual, "OFF Files":
//! <http://www.geomview.org/docs/html/OFF.html>.

use super::{File, WriteError, push_index, push_position};
use crate::Surface;

pub(super) fn write(surface: &dyn Surface, file: &mut File<'_>) -> Result<(), WriteError> {
    let origin = surface.origin();
    let faces = surface.triangle_count() + surface.quad_count();
    // No comment: trimesh and meshio trip over one that follows the header.
    let header = format!("OFF\n{} {faces} 0\n", surface.vertex_count());
    let mut place = 0;
    file.put(&mut place, header.as_bytes())?;
    let mut places = [place];
    file.vertices(surface, &mut places, |group, [text]| {
        text.reserve(36 * group.len());
        for vertex in group {
            push_position(text, vertex, origin);
            text.push(b'\n');
        }
    })?;
    file.faces(surface, &mut places, |group, [text]| {
        text.reserve(26 * group.triangles.len() + 34 * group.quads.len());
        for face in &group.triangles {
            push_face(text, face);
        }
        for face in &group.quads {
            push_face(text, face);
        }
    })
}

fn push_face(text: &mut Vec<u8>, face: &[u32]) {
    push_index(text, face.len() as u64);
    for &corner in face {
        text.push(b' ');
        push_index(text, u64::from(corner));
    }
    text.push(b'\n');
}
