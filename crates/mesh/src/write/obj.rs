//! OBJ, text. Wavefront, Advanced Visualizer, appendix B1 (Object Files).

use super::{File, WriteError, push_index, push_position};
use crate::Surface;

pub(super) fn write(surface: &dyn Surface, file: &mut File<'_>) -> Result<(), WriteError> {
    let origin = surface.origin();
    let mut place = 0;
    let header = format!("# neurotess, units: {}\n", surface.unit());
    file.put(&mut place, header.as_bytes())?;
    let mut places = [place];
    file.vertices(surface, &mut places, |group, [text]| {
        text.reserve(72 * group.len());
        let mut buffer = zmij::Buffer::new();
        for vertex in group {
            text.extend_from_slice(b"v ");
            push_position(text, vertex, origin);
            text.extend_from_slice(b"\nvn");
            for x in vertex.normal.to_array() {
                text.push(b' ');
                text.extend_from_slice(buffer.format(x).as_bytes());
            }
            text.push(b'\n');
        }
    })?;
    file.faces(surface, &mut places, |group, [text]| {
        text.reserve(48 * group.triangles.len() + 64 * group.quads.len());
        for face in &group.triangles {
            push_face(text, face);
        }
        for face in &group.quads {
            push_face(text, face);
        }
    })
}

/// `f a//a b//b c//c`: a position and the normal of the same number, counted from 1.
fn push_face(text: &mut Vec<u8>, face: &[u32]) {
    text.push(b'f');
    for &corner in face {
        text.push(b' ');
        let start = text.len();
        push_index(text, u64::from(corner) + 1);
        let end = text.len();
        text.extend_from_slice(b"//");
        text.extend_from_within(start..end);
    }
    text.push(b'\n');
}
