//! OBJ: positions and faces; everything else is skipped.

use glam::DVec3;

use super::builder::Builder;
use super::lines::{Lines, number, whole, words};
use super::{FilePosition, ReadError, malformed, shown};
use crate::{SurfaceMesh, SurfaceVertex};

pub(super) fn read(bytes: &[u8]) -> Result<SurfaceMesh, ReadError> {
    let mut mesh = Builder::new(bytes.len());
    let mut lines = Lines::new(bytes);
    let mut corners = Vec::new();
    let mut joined = Vec::new();
    while let Some(mut line) = lines.next() {
        let at = lines.place();
        if line.ends_with(b"\\") {
            joined.clear();
            while let Some(begun) = line.strip_suffix(b"\\") {
                joined.extend_from_slice(begun);
                joined.push(b' ');
                line = lines.next().unwrap_or_default();
            }
            joined.extend_from_slice(line);
            line = &joined;
        }
        let line = line.split(|&byte| byte == b'#').next().unwrap_or_default();
        let mut words = words(line);
        match words.next() {
            Some(b"v") => {
                let mut next = || number(words.next(), at);
                let position = DVec3::new(next()?, next()?, next()?);
                mesh.vertex(at, position, SurfaceVertex::default())?;
            }
            Some(b"f") => {
                corners.clear();
                for word in words {
                    corners.push(corner(word, mesh.vertex_count(), at)?);
                }
                mesh.face(at, &corners)?;
            }
            // A file of something else: one line of it is enough to say so.
            Some(word) if !word.iter().all(|&byte| byte.is_ascii_graphic()) => {
                return Err(malformed(
                    at,
                    shown(word),
                    "lines such as 'v 1 2 3' and 'f 1 2 3'",
                ));
            }
            _ => {}
        }
    }
    mesh.finish()
}

/// `7`, `7/1`, `7//3`, `7/1/3`; from 1 on, or backwards from −1.
fn corner(word: &[u8], vertices: usize, at: FilePosition) -> Result<u32, ReadError> {
    let position = word.split(|&byte| byte == b'/').next();
    let index: i64 = whole(position, at)?;
    let from_zero = if index < 0 {
        vertices as i64 + index
    } else {
        index - 1
    };
    u32::try_from(from_zero)
        .map_err(|_| malformed(at, format!("index {index}"), "from 1 on, or back from -1"))
}
