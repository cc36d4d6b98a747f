//! Formats of simulators: types and sections of faces, in files and back, and the table of triangles.

use std::collections::BTreeMap;
use std::io::Cursor;

use crate::shapes::{torus, written};
use glam::DVec3;
use neurotess_mesh::{
    FaceLabel, Format, InUnit, ReadError, Surface, SurfaceMesh, SurfaceTriangle, Unit, check,
    read_bytes, region_code, write, write_triangles,
};

/// A torus whose sections are arcs of it, of two kinds, as a tube that is traced around.
fn traced_torus() -> SurfaceMesh {
    let across = 12;
    let mut mesh = torus(40, across, DVec3::new(1000.5, -20.25, 0.0));
    for (n, vertex) in mesh.vertices.iter_mut().enumerate() {
        let ring = n as i32 / across as i32;
        vertex.point = 100 + ring;
        vertex.section = ring / 10;
        vertex.kind = [1, 2, 0, 7][vertex.section as usize];
    }
    mesh
}

/// The labels of all triangles, in the order of files.
fn labels(mesh: &SurfaceMesh) -> Vec<FaceLabel> {
    let halves = mesh.faces.quads.iter();
    let halves = halves.flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
    let triangles = mesh.faces.triangles.iter().copied().chain(halves);
    triangles
        .map(|corners| FaceLabel::of(corners.map(|corner| &mesh.vertices[corner as usize])))
        .collect()
}

fn counts(labels: impl IntoIterator<Item = (i32, i32)>) -> BTreeMap<(i32, i32), usize> {
    let mut counts = BTreeMap::new();
    for label in labels {
        *counts.entry(label).or_default() += 1;
    }
    counts
}

#[neurotess_testing::test]
fn gmsh_files_keep_types_and_sections() {
    for format in [Format::Msh, Format::Msh2] {
        keeps_types_and_sections(format);
    }
}

fn keeps_types_and_sections(format: Format) {
    let mesh = traced_torus();
    // The file says which version it is of.
    let found = read_bytes(&written(&mesh, format), Format::Msh).expect("our own file");
    let of = |mesh: &SurfaceMesh| counts(labels(mesh).iter().map(|l| (l.section, l.kind)));
    assert_eq!(of(&found), of(&mesh));
    assert_eq!(of(&mesh).len(), 4);
    let attributes = |mesh: &SurfaceMesh| -> Vec<_> {
        mesh.vertices.iter().map(|v| (v.section, v.kind)).collect()
    };
    // The soma and the last section meet, too: there the ring of the one is the other's.
    let differing = attributes(&found)
        .iter()
        .zip(attributes(&mesh))
        .filter(|(a, b)| *a != b)
        .count();
    assert_eq!(differing, 0);
}

#[neurotess_testing::test]
fn a_section_of_several_types_is_several_surfaces() {
    let mesh = torus(30, 10, DVec3::ZERO);
    let bytes = written(&mesh, Format::Msh);
    let report = check(&read_bytes(&bytes, Format::Msh).expect("our own file"));
    assert!(report.closed && report.oriented);
    let expected = counts(labels(&mesh).iter().map(|l| (l.section, l.kind)));
    let start = bytes
        .windows(9)
        .position(|w| w == b"$Elements")
        .expect("elements")
        + 10;
    let blocks = u64::from_le_bytes(bytes[start..start + 8].try_into().expect("eight bytes"));
    assert_eq!(blocks as usize, expected.len());
}

/// The markers of facets of a `.smesh` or `.poly`, by a reader of a few lines of its own.
fn markers(bytes: &[u8], format: Format) -> Vec<i32> {
    let text = std::str::from_utf8(bytes).expect("text");
    let mut lines = text.lines().filter(|line| !line.starts_with('#'));
    let mut head = || -> usize {
        let line = lines.next().expect("a line");
        line.split(' ')
            .next()
            .and_then(|n| n.parse().ok())
            .expect("a count")
    };
    let points = head();
    for n in 0..points {
        assert_eq!(head(), n, "points count from 0");
    }
    let facets = head();
    let marker = |line: &str| line.rsplit(' ').next().and_then(|m| m.parse().ok());
    let step = if format == Format::Poly { 2 } else { 1 };
    let lines: Vec<&str> = lines.collect();
    assert_eq!(lines[step * facets..], ["0", "0"], "no holes, no regions");
    let facets = lines[..step * facets].iter().step_by(step);
    facets.map(|line| marker(line).expect("a marker")).collect()
}

#[neurotess_testing::test]
fn tetgen_files_mark_facets_by_type() {
    let mesh = traced_torus();
    for format in [Format::Poly, Format::Smesh] {
        let bytes = written(&mesh, format);
        let expected: Vec<i32> = labels(&mesh).iter().map(|l| region_code(l.kind)).collect();
        let mut sorted = [markers(&bytes, format), expected];
        // Groups of faces write their triangles before their quads.
        sorted
            .iter_mut()
            .for_each(|markers| markers.sort_unstable());
        assert_eq!(sorted[0], sorted[1], "{format}");
        assert!(sorted[0].contains(&1_000_000), "type 0 has a code");
        let found = read_bytes(&bytes, format).expect("our own file");
        assert_eq!(found.vertices.len(), mesh.vertices.len());
        let kinds: Vec<i32> = found.vertices.iter().map(|v| v.kind).collect();
        assert!(
            [0, 1, 2, 7].iter().all(|kind| kinds.contains(kind)),
            "{format}"
        );
    }
}

/// A tetrahedron with two of its faces, as Gmsh 4.15 writes them.
const TEXT: &str = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 1 1\n\
    3 0 0 0 1 1 1 1 7 0\n1 0 0 0 1 1 1 0 1 3\n$EndEntities\n\
    $Nodes\n2 5 2 20\n2 3 0 4\n2\n3\n5\n9\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n\
    3 1 0 1\n20\n.2 .2 .2\n$EndNodes\n\
    $Elements\n2 3 1 3\n2 3 2 2\n1 2 5 3\n2 2 3 9\n3 1 4 1\n3 20 3 5 9\n$EndElements\n";

#[neurotess_testing::test]
fn gmsh_text_is_read_without_what_is_inside() {
    let mesh = read_bytes(TEXT.as_bytes(), Format::Msh).expect("a valid file");
    assert_eq!(mesh.vertices.len(), 4, "the node inside is left out");
    assert_eq!(mesh.faces.triangles, [[0, 2, 1], [0, 1, 3]]);
    let alien = mesh.vertices.iter().all(|v| (v.section, v.kind) == (0, 0));
    assert!(alien, "entities of others are no sections");
}

#[neurotess_testing::test]
fn gmsh_faults_name_their_place() {
    let fault = |from: &str, to: &str| -> ReadError {
        let text = TEXT.replace(from, to);
        assert_ne!(text, TEXT);
        read_bytes(text.as_bytes(), Format::Msh).expect_err("a fault")
    };
    for (from, to, message) in [
        ("4.1 0 8", "4.0 0 8", "line 2: MSH version '4.0'"),
        ("2 2 3 9\n3 1", "2 2 3 8\n3 1", "line 27: node 8"),
        ("3\n5\n9\n0 0 0", "3\n5\n5\n0 0 0", "node 5 a second time"),
        ("3 1 4 1\n3 20", "3 1 99 1\n3 20", "element type 99"),
        ("$EndElements\n", "", "its $End is missing"),
        (
            "$Elements\n2 3 1 3\n2 3 2 2",
            "$Elements\n2 3 1 3\n2 3 9 2",
            "corners",
        ),
    ] {
        let found = fault(from, to).to_string();
        assert!(found.contains(message), "{found}");
    }
}

#[neurotess_testing::test]
fn tetgen_variants() {
    let smesh = "# a part\n4 3 0 0\n1 0 0 0\n2 1 0 0 # corner\n\n3 0 1 0\n4 0 0 1\n\
        2 1\n3 1 3 2 5\n4 1 2 3 4 -1\n0\n0\n";
    let mesh = read_bytes(smesh.as_bytes(), Format::Smesh).expect("a valid file");
    assert_eq!(mesh.faces.triangles, [[0, 2, 1]]);
    assert_eq!(mesh.faces.quads, [[0, 1, 2, 3]]);
    let poly = "3 3\n0 0 0 0\n1 1 0 0\n2 0 1 0\n1 0\n2 1\n3 0 1 2\n2 0 1\n1 .2 .2 0\n0\n";
    let mesh = read_bytes(poly.as_bytes(), Format::Poly).expect("a valid file");
    assert_eq!(mesh.faces.triangles, [[0, 1, 2]], "segments are skipped");
    for (text, message) in [
        ("1 3 0 0\n1 0 0 0\n1 0\n3 0 1 1\n", "line 4: point 0"),
        ("2 3 0 0\n1 0 0 0\n5 0 0 0\n", "line 3: point 5"),
        ("2 2 0 0\n", "another dimension"),
        ("4294967295 3 0 0\n", "the points"),
    ] {
        let fault = read_bytes(text.as_bytes(), Format::Smesh).expect_err("a fault");
        assert!(fault.to_string().contains(message), "{fault}");
    }
}

#[neurotess_testing::test]
fn meters_are_millionths_in_all_formats() {
    let mesh = traced_torus();
    let expected = mesh.measure().volume * 1e-18;
    for format in Format::ALL {
        let mut file = Cursor::new(Vec::new());
        write(&InUnit::new(&mesh, Unit::Meter), format, &mut file).expect("memory");
        let bytes = file.into_inner();
        let mut found = read_bytes(&bytes, format).expect("our own file");
        neurotess_mesh::merge_identical(&mut found);
        let report = check(&found);
        // STL and GLB hold 32 bits, 1000 µm away from the origin.
        let ratio = report.volume / expected;
        assert!((ratio - 1.0).abs() < 1e-3, "{format}: {ratio}");
        assert!(report.closed, "{format}");
        let text = String::from_utf8_lossy(&bytes[..bytes.len().min(400)]).into_owned();
        let says_unit = !matches!(format, Format::Glb | Format::Off);
        assert_eq!(text.contains("units: meter"), says_unit, "{format}");
    }
}

fn rows(surface: &dyn Surface) -> Vec<SurfaceTriangle> {
    let rows = std::sync::Mutex::new(Vec::new());
    let mut file = Cursor::new(Vec::new());
    write_triangles(surface, &mut file, |text, row| {
        rows.lock().expect("no panic").push(*row);
        text.extend_from_slice(format!("{}\n", row.number).as_bytes());
    })
    .expect("memory");
    let text = String::from_utf8(file.into_inner()).expect("text");
    let mut rows = rows.into_inner().expect("no panic");
    assert_eq!(text.lines().count(), rows.len());
    rows.sort_by_key(|row| row.number);
    rows
}

#[neurotess_testing::test]
fn every_triangle_is_one_row() {
    let mesh = traced_torus();
    let rows = rows(&mesh);
    let expected = labels(&mesh);
    assert_eq!(rows.len(), expected.len());
    for (n, (row, label)) in rows.iter().zip(&expected).enumerate() {
        assert_eq!((row.number, row.label), (n as u64, *label));
    }
    let [a, b, c] = mesh.faces.triangles[5]
        .map(|corner| mesh.vertices[corner as usize].position.as_dvec3() + mesh.origin);
    assert!(rows[5].center.distance((a + b + c) / 3.0) < 1e-9);
}
