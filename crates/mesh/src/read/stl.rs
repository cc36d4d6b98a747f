//! STL, binary or text. Nothing is merged: each triangle has three vertices of its own.

use glam::{DVec3, Vec3};

use super::builder::Builder;
use super::lines::{Lines, number, words};
use super::{FilePosition, ReadError, malformed, shown};
use crate::{SurfaceMesh, SurfaceVertex};

/// Bytes before the triangles.
const HEADER: usize = 84;

/// Bytes of a triangle.
const TRIANGLE: usize = 50;

pub(super) fn read(bytes: &[u8]) -> Result<SurfaceMesh, ReadError> {
    // Some binary files begin with `solid`, too: the size decides first.
    let announced = announced(bytes);
    let fits = announced.is_some_and(|count| {
        (HEADER..HEADER + TRIANGLE).contains(&(bytes.len() - (count * TRIANGLE).min(bytes.len())))
    });
    let text = bytes.trim_ascii_start().starts_with(b"solid");
    match announced {
        Some(count) if fits => binary(bytes, count),
        _ if text => ascii(bytes),
        Some(count) if count * TRIANGLE > bytes.len() - HEADER => Err(ReadError::Truncated {
            at: FilePosition::Byte(80),
            what: "the triangles",
        }),
        Some(count) => {
            let held = (bytes.len() - HEADER) / TRIANGLE;
            let found = format!("count {count}, but the file holds {held} triangles");
            Err(malformed(
                FilePosition::Byte(80),
                found,
                "the number of triangles",
            ))
        }
        None => Err(malformed(
            FilePosition::Byte(0),
            shown(bytes),
            "84 bytes of header or 'solid'",
        )),
    }
}

/// The count of a binary file; at most 2³² × 50 bytes, which a usize of 64 bits holds.
fn announced(bytes: &[u8]) -> Option<usize> {
    let count = bytes.get(80..HEADER)?;
    Some(u32::from_le_bytes(count.try_into().ok()?) as usize)
}

fn binary(bytes: &[u8], count: usize) -> Result<SurfaceMesh, ReadError> {
    let mut mesh = Builder::new(bytes.len());
    for (n, triangle) in bytes[HEADER..]
        .chunks_exact(TRIANGLE)
        .take(count)
        .enumerate()
    {
        let at = FilePosition::Byte(HEADER + n * TRIANGLE);
        let [normal, corners @ ..] = [0, 1, 2, 3].map(|row| {
            Vec3::from([0, 1, 2].map(|axis| {
                let at = 12 * row + 4 * axis;
                f32::from_le_bytes([0, 1, 2, 3].map(|byte| triangle[at + byte]))
            }))
        });
        push(&mut mesh, at, normal, corners.map(Vec3::as_dvec3))?;
    }
    mesh.finish()
}

fn ascii(bytes: &[u8]) -> Result<SurfaceMesh, ReadError> {
    let mut mesh = Builder::new(bytes.len());
    let mut lines = Lines::new(bytes);
    let mut corners = Vec::new();
    while let Some(line) = lines.next() {
        let at = lines.place();
        let mut words = words(line);
        let word = words.next().unwrap_or_default();
        match &word.to_ascii_lowercase()[..] {
            b"vertex" => {
                let mut next = || number(words.next(), at);
                corners.push(DVec3::new(next()?, next()?, next()?));
            }
            b"endfacet" => {
                let Ok(triangle) = <[DVec3; 3]>::try_from(&corners[..]) else {
                    let found = format!("a facet of {} vertices", corners.len());
                    return Err(malformed(at, found, "three"));
                };
                push(&mut mesh, at, Vec3::ZERO, triangle)?;
                corners.clear();
            }
            b"" | b"solid" | b"facet" | b"outer" | b"endloop" | b"endsolid" => {}
            _ => {
                return Err(malformed(
                    at,
                    shown(word),
                    "facet, vertex or another word of STL",
                ));
            }
        }
    }
    if corners.is_empty() {
        return mesh.finish();
    }
    Err(ReadError::Truncated {
        at: lines.place(),
        what: "a facet",
    })
}

fn push(
    mesh: &mut Builder,
    at: FilePosition,
    normal: Vec3,
    corners: [DVec3; 3],
) -> Result<(), ReadError> {
    let first = mesh.vertex_count() as u32;
    for corner in corners {
        mesh.vertex(
            at,
            corner,
            SurfaceVertex {
                normal,
                ..SurfaceVertex::default()
            },
        )?;
    }
    mesh.face(at, &[first, first + 1, first + 2])
}
