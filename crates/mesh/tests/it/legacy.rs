//! MSH of version 2.2, which STEPS and older programs read.

use std::collections::BTreeMap;
use std::io::Cursor;

use crate::shapes::{torus, written};
use glam::DVec3;
use neurotess_mesh::{
    FaceLabel, Format, InUnit, SurfaceMesh, Unit, check, read_bytes, region_code, write,
};

/// A torus of types and sections, quads among its faces.
fn traced() -> SurfaceMesh {
    let mut mesh = torus(40, 12, DVec3::new(900.5, 0.0, -3.0));
    for vertex in &mut mesh.vertices {
        vertex.kind = [1, 3, 0][vertex.section as usize % 3];
    }
    mesh
}

/// The lines of a section without the first one, which is their number.
fn lines<'t>(text: &'t str, section: &str) -> Vec<&'t str> {
    let start = text.find(&format!("${section}\n")).expect("the section");
    let end = text.find(&format!("$End{section}\n")).expect("its end");
    let mut lines = text[start..end].lines().skip(1);
    let count = lines.next().and_then(|line| line.parse().ok());
    let lines: Vec<&str> = lines.collect();
    assert_eq!(count, Some(lines.len()), "{section}");
    lines
}

fn numbers(line: &str) -> Vec<i32> {
    let words = line.split(' ');
    words.map(|word| word.parse().expect("a number")).collect()
}

#[neurotess_testing::test]
fn each_triangle_has_the_group_of_its_type_and_the_surface_of_its_section() {
    let mesh = traced();
    let bytes = written(&mesh, Format::Msh2);
    let text = std::str::from_utf8(&bytes).expect("text");
    assert!(text.starts_with("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"));
    let names = lines(text, "PhysicalNames");
    assert_eq!(
        names,
        [
            "2 1 \"soma\"",
            "2 3 \"basal_dendrite\"",
            "2 1000000 \"undefined\""
        ]
    );
    let nodes = lines(text, "Nodes");
    assert!(nodes[0].starts_with("1 ") && nodes[479].starts_with("480 "));
    let halves = mesh
        .faces
        .quads
        .iter()
        .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
    let triangles: Vec<[u32; 3]> = mesh.faces.triangles.iter().copied().chain(halves).collect();
    let elements: BTreeMap<usize, Vec<i32>> = lines(text, "Elements")
        .into_iter()
        .map(|line| (numbers(line)[0] as usize, numbers(line)))
        .collect();
    assert_eq!(elements.len(), triangles.len());
    let mut groups = BTreeMap::new();
    for (number, element) in elements {
        let corners = triangles[number - 1];
        let label = FaceLabel::of(corners.map(|corner| &mesh.vertices[corner as usize]));
        assert_eq!(element[1..4], [2, 2, region_code(label.kind)]);
        assert_eq!(element[5..], corners.map(|corner| corner as i32 + 1));
        groups.entry(element[4]).or_insert(label);
        assert_eq!(
            groups[&element[4]].section, label.section,
            "one section each"
        );
    }
    assert!(groups.len() > 2);
}

#[neurotess_testing::test]
fn both_versions_read_the_same() {
    let mesh = traced();
    let [new, old] = [Format::Msh, Format::Msh2].map(|format| {
        let mut mesh = read_bytes(&written(&mesh, format), format).expect("our own file");
        mesh.faces.triangles.sort_unstable();
        mesh
    });
    assert_eq!(
        (new.vertices.len(), new.origin),
        (old.vertices.len(), old.origin)
    );
    assert_eq!(new.faces, old.faces);
    for (new, old) in new.vertices.iter().zip(&old.vertices) {
        assert!(new.position.distance(old.position) < 1e-6);
        assert_eq!((new.kind, new.section), (old.kind, old.section));
    }
    let mut file = Cursor::new(Vec::new());
    write(&InUnit::new(&mesh, Unit::Meter), Format::Msh2, &mut file).expect("memory");
    let meters = check(&read_bytes(&file.into_inner(), Format::Msh2).expect("our own file"));
    assert!(meters.closed && (meters.volume / (check(&mesh).volume * 1e-18) - 1.0).abs() < 1e-6);
}

/// A tetrahedron with two of its faces, a point, a line and a node inside, as Gmsh 4 writes them with -format msh22.
const TEXT: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 7 \"wall\"\n$EndPhysicalNames\n\
    $Nodes\n5\n2 0 0 0\n3 1 0 0\n5 0 1 0\n9 0 0 1\n20 .2 .2 .2\n$EndNodes\n\
    $Elements\n5\n1 15 2 0 1 2\n2 1 2 0 1 2 3\n3 2 2 7 3 2 5 3\n4 2 4 7 3 1 1 2 3 9\n5 4 2 0 1 20 3 5 9\n\
    $EndElements\n";

#[neurotess_testing::test]
fn text_of_gmsh_is_read_without_what_is_inside() {
    for version in ["2.2 0 8", "2 0 8", "2.1 0 8"] {
        let text = TEXT.replace("2.2 0 8", version);
        let mesh = read_bytes(text.as_bytes(), Format::Msh).expect("a valid file");
        assert_eq!(mesh.vertices.len(), 4, "the node inside is left out");
        assert_eq!(mesh.faces.triangles, [[0, 2, 1], [0, 1, 3]]);
        let alien = mesh.vertices.iter().all(|v| (v.section, v.kind) == (0, 0));
        assert!(alien, "entities of others are no sections");
    }
}

/// The same in binary: two elements of a type and a number of tags may stand together.
fn binary(big: bool) -> Vec<u8> {
    let ints = |numbers: &[i32]| -> Vec<u8> {
        let bytes = |n: &i32| {
            if big {
                n.to_be_bytes()
            } else {
                n.to_le_bytes()
            }
        };
        numbers.iter().flat_map(bytes).collect()
    };
    let mut file = b"$MeshFormat\n2.2 1 8\n".to_vec();
    file.extend(ints(&[1]));
    file.extend_from_slice(b"\n$EndMeshFormat\n$Nodes\n5\n");
    let nodes = [
        (2, [0.0, 0.0, 0.0]),
        (3, [1.0, 0.0, 0.0]),
        (5, [0.0, 1.0, 0.0]),
        (9, [0.0, 0.0, 1.0]),
        (20, [0.2, 0.2, 0.2_f64]),
    ];
    for (tag, position) in nodes {
        file.extend(ints(&[tag]));
        for x in position {
            file.extend(if big {
                x.to_be_bytes()
            } else {
                x.to_le_bytes()
            });
        }
    }
    file.extend_from_slice(b"\n$EndNodes\n$Elements\n4\n");
    file.extend(ints(&[1, 1, 2, 2, 0, 1, 2, 3]));
    file.extend(ints(&[2, 2, 2, 3, 7, 3, 2, 5, 3, 4, 7, 3, 2, 3, 9]));
    file.extend(ints(&[4, 1, 2, 5, 0, 1, 20, 3, 5, 9]));
    file.extend_from_slice(b"\n$EndElements\n");
    file
}

#[neurotess_testing::test]
fn binary_files_of_either_order_are_read() {
    let expected = read_bytes(TEXT.as_bytes(), Format::Msh2).expect("a valid file");
    for big in [false, true] {
        let found = read_bytes(&binary(big), Format::Msh2).expect("a valid file");
        assert_eq!(found, expected);
    }
    let mut cut = binary(false);
    cut.truncate(cut.len() - 40);
    assert!(read_bytes(&cut, Format::Msh).is_err());
}

#[neurotess_testing::test]
fn faults_name_their_place() {
    for (from, to, message) in [
        ("2 3 9\n5 4", "2 3 8\n5 4", "line 21: node 8"),
        ("5 0 1 0", "3 0 1 0", "node 3 a second time"),
        ("5 4 2 0 1 20", "5 99 2 0 1 20", "element type 99"),
        (
            "3 2 2 7",
            "3 9 2 7",
            "a face with nodes between its corners",
        ),
        ("3 2 2 7 3 2", "3 2 -2 7 3 2", ": -2: expected"),
        ("3 2 2 7 3 2", "3 2 2000000000 7 3 2", "2000000000 tags"),
        ("$Nodes\n5", "$Nodes\n5000000000", ""),
        ("$EndElements\n", "", "its $End is missing"),
        ("2.2 0 8", "1.0 0 8", "MSH version '1.0'"),
    ] {
        let text = TEXT.replacen(from, to, 1);
        assert_ne!(text, TEXT, "{from}");
        let fault = read_bytes(text.as_bytes(), Format::Msh2).expect_err("a fault");
        assert!(fault.to_string().contains(message), "{fault}");
    }
}
