//! VTU, VTK's XML unstructured grid with appended raw data:
//! <https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html>.
//!
//! Ten arrays, each a 64-bit count of bytes and the data; the last, of colors, is left out where there are none. Vertices
//! fill seven of them side by side. Numbers of one's own follow.

use glam::DVec3;

use super::{ColorBy, File, WriteError, absolute, push_numbers, record};
use crate::{Surface, Unit, VertexAttribute};

const TRIANGLE: u8 = 5;
const QUAD: u8 = 9;

pub(super) fn write(
    surface: &dyn Surface,
    color_by: Option<ColorBy>,
    file: &mut File<'_>,
) -> Result<(), WriteError> {
    let origin = surface.origin();
    let double = origin != DVec3::ZERO;
    let vertices = surface.vertex_count() as u64;
    let (triangles, quads) = (surface.triangle_count() as u64, surface.quad_count() as u64);
    let cells = triangles + quads;
    let sizes = [
        vertices * if double { 24 } else { 12 },
        12 * vertices,
        4 * vertices,
        4 * vertices,
        4 * vertices,
        4 * vertices,
        8 * (3 * triangles + 4 * quads),
        8 * cells,
        cells,
        3 * vertices,
    ];
    let mut offsets = [0; 11];
    for (n, size) in sizes.iter().enumerate() {
        offsets[n + 1] = offsets[n] + 8 + size;
    }
    let arrays = if color_by.is_some() { 10 } else { 9 };

    let own = surface.attributes();
    let header = header(
        surface.unit(),
        vertices,
        cells,
        double,
        &offsets[..=arrays],
        own,
    );
    let start = header.len() as u64;
    file.put(&mut 0, header.as_bytes())?;
    let data: [u64; 10] = std::array::from_fn(|n| start + offsets[n] + 8);
    let [
        points,
        normals,
        kinds,
        tracing,
        sections,
        radii,
        connectivity,
        ends,
        types,
        colors,
    ] = data;

    for (place, size) in data[..arrays].iter().zip(sizes) {
        file.put(&mut (place - 8), &size.to_le_bytes())?;
    }
    let mut places = [points, normals, kinds, tracing, sections, radii, colors];
    file.vertices(surface, &mut places, |group, buffers| {
        let [points, normals, kinds, tracing, sections, radii, colors] = buffers;
        for v in group {
            if double {
                let [x, y, z] = absolute(v, origin);
                points.extend_from_slice(&record![24; x, y, z]);
            } else {
                let p = v.position;
                points.extend_from_slice(&record![12; p.x, p.y, p.z]);
            }
            normals.extend_from_slice(&record![12; v.normal.x, v.normal.y, v.normal.z]);
            kinds.extend_from_slice(&v.kind.to_le_bytes());
            tracing.extend_from_slice(&v.point.to_le_bytes());
            sections.extend_from_slice(&v.section.to_le_bytes());
            radii.extend_from_slice(&v.radius.to_le_bytes());
            if let Some(by) = color_by {
                colors.extend_from_slice(&by.of(v));
            }
        }
    })?;
    let quads_at = connectivity + 8 * 3 * triangles;
    file.faces(
        surface,
        &mut [connectivity, quads_at],
        |group, [triangles, quads]| {
            for &face in &group.triangles {
                let [a, b, c] = face.map(u64::from);
                triangles.extend_from_slice(&record![24; a, b, c]);
            }
            for &face in &group.quads {
                let [a, b, c, d] = face.map(u64::from);
                quads.extend_from_slice(&record![32; a, b, c, d]);
            }
        },
    )?;
    cells_of(file, ends, types, triangles, quads)?;
    let mut end = start + offsets[arrays];
    for attribute in own {
        let mut bytes = (4 * attribute.values.len() as u64).to_le_bytes().to_vec();
        push_numbers(&mut bytes, attribute.values);
        file.put(&mut end, &bytes)?;
    }
    file.put(&mut end, b"\n  </AppendedData>\n</VTKFile>\n")
}

/// Ends and types of cells: they follow from the counts.
fn cells_of(
    file: &mut File<'_>,
    mut ends: u64,
    mut types: u64,
    triangles: u64,
    quads: u64,
) -> Result<(), WriteError> {
    let mut buffer = Vec::new();
    for first in (0..triangles + quads).step_by(1 << 16) {
        let cells = first..(triangles + quads).min(first + (1 << 16));
        buffer.clear();
        for cell in cells.clone() {
            let end = 3 * (cell + 1) + (cell + 1).saturating_sub(triangles);
            buffer.extend_from_slice(&end.to_le_bytes());
        }
        file.put(&mut ends, &buffer)?;
        buffer.clear();
        buffer.extend(cells.map(|cell| if cell < triangles { TRIANGLE } else { QUAD }));
        file.put(&mut types, &buffer)?;
    }
    Ok(())
}

/// Arrays of numbers of one's own, from this offset on.
fn own_arrays(own: &[VertexAttribute<'_>], mut offset: u64) -> String {
    let array = |a: &VertexAttribute<'_>| {
        let here = offset;
        offset += 8 + 4 * a.values.len() as u64;
        format!(
            "\n        <DataArray type=\"Float32\" Name=\"{}\" NumberOfComponents=\"{}\" \
             format=\"appended\" offset=\"{here}\"/>",
            a.name, a.components
        )
    };
    own.iter().map(array).collect()
}

fn header(
    unit: Unit,
    vertices: u64,
    cells: u64,
    double: bool,
    offsets: &[u64],
    own: &[VertexAttribute<'_>],
) -> String {
    let real = if double { "Float64" } else { "Float32" };
    let array = |n: usize, kind: &str, name: &str, components: usize| {
        format!(
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" \
             format=\"appended\" offset=\"{}\"/>",
            offsets[n]
        )
    };
    let colors = match offsets.len() {
        11 => format!("\n        {}", array(9, "UInt8", "RGB", 3)),
        _ => String::new(),
    };
    let after = offsets.last().copied().unwrap_or(0);
    format!(
        r#"<?xml version="1.0"?>
<!-- neurotess, units: {unit} -->
<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64">
  <UnstructuredGrid>
    <Piece NumberOfPoints="{vertices}" NumberOfCells="{cells}">
      <PointData Scalars="type" Normals="Normals">
        {}
        {}
        {}
        {}
        {}{colors}{}
      </PointData>
      <Points>
        {}
      </Points>
      <Cells>
        {}
        {}
        {}
      </Cells>
    </Piece>
  </UnstructuredGrid>
  <AppendedData encoding="raw">
   _"#,
        array(1, "Float32", "Normals", 3),
        array(2, "Int32", "type", 1),
        array(3, "Int32", "point", 1),
        array(4, "Int32", "section", 1),
        array(5, "Float32", "radius", 1),
        own_arrays(own, after),
        array(0, real, "Points", 3),
        array(6, "Int64", "connectivity", 1),
        array(7, "Int64", "offsets", 1),
        array(8, "UInt8", "types", 1),
    )
}
