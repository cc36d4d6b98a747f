//! POLY and SMESH, text: TetGen's piecewise linear complexes. Hang Si, TetGen's manual 1.6, sections
//! 5.2.2 and 5.2.3: <https://wias-berlin.de/software/tetgen/fformats.html>.
//!
//! Points and facets count from 0, as the faces of all our files. Each triangle is a facet whose marker
//! is the code of its type ([`region_code`]). There are no holes, and no regions unless the surface has walls:
//! else it is closed, and all that is inside is one cell.

use super::corners::{Corners, VertexBlocks, triangles};
use super::{File, WriteError, push_index, push_position};
use crate::{Surface, region_code};

/// Lines of a facet in POLY: its polygons, holes and marker, then its corners.
pub(super) fn write_poly(surface: &dyn Surface, file: &mut File<'_>) -> Result<(), WriteError> {
    write(surface, file, |text, corners, triangle| {
        text.extend_from_slice(b"1 0 ");
        push_index(text, marker(corners, triangle));
        text.push(b'\n');
        push_corners(text, triangle);
        text.push(b'\n');
    })
}

/// One line for each facet: its corners, then its marker.
pub(super) fn write_smesh(surface: &dyn Surface, file: &mut File<'_>) -> Result<(), WriteError> {
    write(surface, file, |text, corners, triangle| {
        push_corners(text, triangle);
        text.push(b' ');
        push_index(text, marker(corners, triangle));
        text.push(b'\n');
    })
}

fn write(
    surface: &dyn Surface,
    file: &mut File<'_>,
    push_facet: impl Fn(&mut Vec<u8>, &Corners, [u32; 3]) + Sync,
) -> Result<(), WriteError> {
    let blocks = VertexBlocks::find(surface)?;
    let origin = surface.origin();
    let (unit, vertices) = (surface.unit(), surface.vertex_count());
    let header = format!("# neurotess, units: {unit}\n# points\n{vertices} 3 0 0\n");
    let mut places = [0];
    file.put(&mut places[0], header.as_bytes())?;
    file.vertices_of_blocks(surface, &mut places, |made_of, group, [text]| {
        let first = blocks.start(made_of.start);
        for (n, vertex) in group.iter().enumerate() {
            push_index(text, (first + n) as u64);
            text.push(b' ');
            push_position(text, vertex, origin);
            text.push(b'\n');
        }
    })?;
    let facets = surface.triangle_count() + 2 * surface.quad_count();
    let header = format!("# facets, marked by type\n{facets} 1\n");
    file.put(&mut places[0], header.as_bytes())?;
    file.faces(surface, &mut places, |group, [text]| {
        let corners = blocks.corners(group);
        for triangle in triangles(group) {
            push_facet(text, &corners, triangle);
        }
    })?;
    file.put(&mut places[0], &holes_and_regions(surface))
}

/// No holes; regions by a point in each, their attribute being the code of their type.
fn holes_and_regions(surface: &dyn Surface) -> Vec<u8> {
    let regions = surface.regions();
    let mut text = format!(
        "# holes\n0\n# regions, their attribute by type\n{}\n",
        regions.len()
    );
    for (n, region) in regions.iter().enumerate() {
        let [x, y, z] = region.seed.to_array();
        text += &format!("{n} {x} {y} {z} {}\n", region_code(region.kind));
    }
    text.into_bytes()
}

fn marker(corners: &Corners, triangle: [u32; 3]) -> u64 {
    u64::from(region_code(corners.label(triangle).kind).unsigned_abs())
}

fn push_corners(text: &mut Vec<u8>, triangle: [u32; 3]) {
    text.push(b'3');
    for corner in triangle {
        text.push(b' ');
        push_index(text, u64::from(corner));
    }
}
