//! The triangles of a surface one by one, as rows of a table.

use std::io::{Seek, Write};

use glam::DVec3;
use rayon::prelude::*;

use crate::write::corners::{VertexBlocks, triangles};
use crate::write::{File, WriteError, agree, faces_of, groups, window};
use crate::{FaceLabel, Surface};

/// A triangle of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceTriangle {
    /// Its number, from 0 on: triangles first, then the halves of quads. The triangles of a file have
    /// the same order.
    pub number: u64,
    /// What it shows of the cell.
    pub label: FaceLabel,
    /// The mean of its corners in the tracing's own coordinates, in the unit of the surface.
    pub center: DVec3,
}

/// Writes a row for each triangle of a surface, in their order if the surface has no quads. `push_row`
/// appends the bytes of a row; it is called from several threads. Holds a few blocks of the surface.
///
/// # Errors
/// As [`write()`](crate::write()).
pub fn write_triangles<W: Write + Seek>(
    surface: &dyn Surface,
    out: &mut W,
    push_row: impl Fn(&mut Vec<u8>, &SurfaceTriangle) + Sync,
) -> Result<(), WriteError> {
    let blocks = VertexBlocks::find(surface)?;
    let (count, quads) = (surface.triangle_count(), surface.quad_count());
    let origin = surface.origin();
    let mut file = File::begin(out)?;
    let mut place = 0;
    let mut found = [0, 0];
    for window in groups(surface.face_blocks(), count + quads).chunks(window()) {
        let faces: Vec<_> = window
            .par_iter()
            .map(|group| faces_of(surface, group.clone()))
            .collect();
        let mut starts = Vec::with_capacity(faces.len());
        for faces in &faces {
            starts.push([found[0], count + 2 * found[1]]);
            found = [
                found[0] + faces.triangles.len(),
                found[1] + faces.quads.len(),
            ];
        }
        let rows: Vec<Vec<u8>> = faces
            .par_iter()
            .zip(starts)
            .map(|(faces, start)| {
                let corners = blocks.corners(faces);
                let mut rows = Vec::new();
                for (n, triangle) in triangles(faces).enumerate() {
                    let half = n.checked_sub(faces.triangles.len());
                    let number = half.map_or(start[0] + n, |half| start[1] + half) as u64;
                    let at = triangle.map(|corner| corners.vertex(corner).position.as_dvec3());
                    let row = SurfaceTriangle {
                        number,
                        label: corners.label(triangle),
                        center: (at[0] + at[1] + at[2]) / 3.0 + origin,
                    };
                    push_row(&mut rows, &row);
                }
                rows
            })
            .collect();
        for rows in rows {
            file.put(&mut place, &rows)?;
        }
    }
    agree("triangles", count, found[0])?;
    agree("quads", quads, found[1])?;
    file.out.flush()?;
    Ok(())
}
