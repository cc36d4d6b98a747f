//! OFF with its variants: `[ST][C][N]OFF`, whose extra numbers are skipped, and colors of faces.

use glam::DVec3;

use super::builder::Builder;
use super::lines::{Lines, data_line, number, whole, words};
use super::{ReadError, malformed, shown};
use crate::{SurfaceMesh, SurfaceVertex};

pub(super) fn read(bytes: &[u8]) -> Result<SurfaceMesh, ReadError> {
    let mut mesh = Builder::new(bytes.len());
    let mut lines = Lines::new(bytes);
    let first = data_line(&mut lines, "the keyword")?;
    let mut counts = words(first).peekable();
    // The keyword may be missing: `8 6 12` alone is a valid header.
    if counts
        .peek()
        .is_some_and(|word| !word.iter().all(u8::is_ascii_digit))
    {
        keyword(counts.next().unwrap_or_default(), &lines)?;
    }
    if counts.peek() == Some(&&b"BINARY"[..]) {
        let (at, what) = (lines.place(), "binary OFF".to_owned());
        return Err(ReadError::Unsupported {
            at,
            what,
            remedy: "write it as text, or as PLY",
        });
    }
    let mut counts: Vec<&[u8]> = counts.collect();
    if counts.is_empty() {
        counts = words(data_line(&mut lines, "the counts")?).collect();
    }
    let at = lines.place();
    let vertices: u64 = whole(counts.first().copied(), at)?;
    let faces: u64 = whole(counts.get(1).copied(), at)?;

    for _ in 0..vertices {
        let mut words = words(data_line(&mut lines, "the vertices")?);
        let mut next = || number(words.next(), lines.place());
        let position = DVec3::new(next()?, next()?, next()?);
        mesh.vertex(lines.place(), position, SurfaceVertex::default())?;
    }
    let mut corners = Vec::new();
    for _ in 0..faces {
        let mut words = words(data_line(&mut lines, "the faces")?);
        let at = lines.place();
        let count: usize = whole(words.next(), at)?;
        corners.clear();
        for _ in 0..count {
            corners.push(whole(words.next(), at)?);
        }
        mesh.face(at, &corners)?;
    }
    mesh.finish()
}

fn keyword(word: &[u8], lines: &Lines<'_>) -> Result<(), ReadError> {
    let at = lines.place();
    let Some(prefix) = word.strip_suffix(b"OFF") else {
        return Err(malformed(
            at,
            shown(word),
            "the keyword OFF, COFF, NOFF or STOFF",
        ));
    };
    if prefix.iter().any(|letter| b"4n".contains(letter)) {
        let what = format!("{} (points of more than three dimensions)", shown(word));
        return Err(ReadError::Unsupported {
            at,
            what,
            remedy: "write it in three dimensions",
        });
    }
    Ok(())
}
