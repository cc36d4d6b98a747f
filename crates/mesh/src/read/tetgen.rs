//! POLY and SMESH, TetGen's piecewise linear complexes:
//! <https://wias-berlin.de/software/tetgen/fformats.html>.
//!
//! Each polygon of a facet becomes a face; polygons of one or two corners (points and segments within a
//! facet) are skipped, and so are holes and regions. Vertices get the types of the faces around them
//! where facets have markers; they have no section.

use glam::DVec3;

use super::builder::Builder;
use super::lines::{Lines, data_line, number, whole, words};
use super::regions::{Region, Regions};
use super::{FilePosition, ReadError, malformed};
use crate::{SurfaceMesh, type_of_region};

pub(super) fn read_poly(bytes: &[u8]) -> Result<SurfaceMesh, ReadError> {
    read(bytes, |lines, marked, facets| {
        let line = data_line(lines, "the facets")?;
        let mut head = words(line);
        let at = lines.place();
        let polygons: u64 = whole(head.next(), at)?;
        let holes: u64 = head.next().map_or(Ok(0), |word| whole(Some(word), at))?;
        let marker = marker(head.next().filter(|_| marked), at)?;
        for _ in 0..polygons {
            let line = data_line(lines, "the facets")?;
            facets.push(words(line), marker, lines.place())?;
        }
        for _ in 0..holes {
            data_line(lines, "the facets")?;
        }
        Ok(())
    })
}

pub(super) fn read_smesh(bytes: &[u8]) -> Result<SurfaceMesh, ReadError> {
    read(bytes, |lines, marked, facets| {
        let line = data_line(lines, "the facets")?;
        let at = lines.place();
        let mut words_of_line = words(line);
        let corners: usize = whole(words_of_line.clone().next(), at)?;
        let marker = words_of_line.nth(corners.saturating_add(1));
        facets.push(
            words(line),
            self::marker(marker.filter(|_| marked), at)?,
            at,
        )
    })
}

/// Faces as they are read; indices count as in the file.
#[derive(Default)]
struct Facets {
    corners: Vec<u64>,
    /// Where the corners of each begin, its place and its type.
    faces: Vec<(usize, FilePosition, Option<i32>)>,
}

impl Facets {
    /// Takes a polygon: the number of its corners, and these.
    fn push<'w>(
        &mut self,
        mut words: impl Iterator<Item = &'w [u8]>,
        kind: Option<i32>,
        at: FilePosition,
    ) -> Result<(), ReadError> {
        let count: usize = whole(words.next(), at)?;
        let first = self.corners.len();
        for _ in 0..count {
            self.corners.push(whole(words.next(), at)?);
        }
        if count < 3 {
            self.corners.truncate(first);
        } else {
            self.faces.push((first, at, kind));
        }
        Ok(())
    }
}

fn read(
    bytes: &[u8],
    read_facet: impl Fn(&mut Lines<'_>, bool, &mut Facets) -> Result<(), ReadError>,
) -> Result<SurfaceMesh, ReadError> {
    let mut lines = Lines::new(bytes);
    let (first, positions) = points(&mut lines)?;
    let line = data_line(&mut lines, "the number of facets")?;
    let mut head = words(line);
    let count: u64 = whole(head.next(), lines.place())?;
    let marked = head.next().is_some_and(|word| word != b"0");
    let mut facets = Facets::default();
    for _ in 0..count {
        read_facet(&mut lines, marked, &mut facets)?;
    }
    assemble(bytes.len(), first, &positions, &facets)
}

/// The number of the first point, 0 or 1, and all positions.
fn points(lines: &mut Lines<'_>) -> Result<(u64, Vec<(FilePosition, DVec3)>), ReadError> {
    let line = data_line(lines, "the number of points")?;
    let at = lines.place();
    let mut head = words(line);
    let count: u64 = whole(head.next(), at)?;
    if head.next().is_some_and(|word| word != b"3") {
        return Err(malformed(at, "another dimension", "3"));
    }
    let mut first = 0;
    let mut positions = Vec::new();
    for n in 0..count {
        let line = data_line(lines, "the points")?;
        let at = lines.place();
        let mut words = words(line);
        let index: u64 = whole(words.next(), at)?;
        if n == 0 {
            first = index;
        }
        if index.checked_sub(first) != Some(n) {
            let found = format!("point {index}");
            return Err(malformed(at, found, "points in order, counted from 0 or 1"));
        }
        let mut next = || number(words.next(), at);
        positions.push((at, DVec3::new(next()?, next()?, next()?)));
    }
    Ok((first, positions))
}

fn assemble(
    bytes: usize,
    first: u64,
    positions: &[(FilePosition, DVec3)],
    facets: &Facets,
) -> Result<SurfaceMesh, ReadError> {
    let mut regions = Regions::of(positions.len());
    let ends = facets.faces.iter().skip(1).map(|face| face.0);
    let ends: Vec<usize> = ends.chain([facets.corners.len()]).collect();
    let mut faces = Vec::with_capacity(facets.faces.len());
    for (&(start, at, kind), &end) in facets.faces.iter().zip(&ends) {
        let mut corners = Vec::with_capacity(end - start);
        for &corner in &facets.corners[start..end] {
            let index = corner
                .checked_sub(first)
                .and_then(|n| u32::try_from(n).ok());
            let missing = || malformed(at, format!("point {corner}"), "a point of the file");
            let index = index.ok_or_else(missing)?;
            let region = kind.map(|kind| Region {
                section: None,
                kind,
            });
            regions.add(index, region);
            corners.push(index);
        }
        faces.push((at, corners));
    }
    let mut mesh = Builder::new(bytes);
    for (n, &(at, position)) in positions.iter().enumerate() {
        mesh.vertex(at, position, regions.vertex(n))?;
    }
    for (at, corners) in faces {
        mesh.face(at, &corners)?;
    }
    mesh.finish()
}

fn marker(word: Option<&[u8]>, at: FilePosition) -> Result<Option<i32>, ReadError> {
    word.map(|word| whole(Some(word), at).map(type_of_region))
        .transpose()
}
