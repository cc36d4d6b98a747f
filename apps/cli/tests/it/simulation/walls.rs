//! `--walls`

use std::fs;

use neurotess::mesh::{SurfaceMesh, WALL, check, read};

use super::neurotess;
use crate::work::sample;

/// Numbers of the lines of a TetGen file after the one that says what they are.
fn rows(text: &str, title: &str) -> Vec<Vec<f64>> {
    let lines = text.lines().skip_while(|line| !line.starts_with(title));
    let rows = lines.skip(1).take_while(|line| !line.starts_with('#'));
    let numbers = |line: &str| -> Vec<f64> {
        let words = line.split(' ');
        words.map(|word| word.parse().expect("a number")).collect()
    };
    // The first one counts the others.
    rows.skip(1).map(numbers).collect()
}

#[neurotess_testing::test]
fn soma_and_neurites_become_regions() {
    let folder = tempfile::tempdir().expect("a folder");
    let cell = sample("granule.swc");
    let made = |out: &str, more: &str| -> SurfaceMesh {
        let command = format!("mesh {cell} -o {out} --level 2 -q {more}")
            .trim_end()
            .to_owned();
        neurotess(folder.path(), &command).expect("meshed");
        read(&folder.path().join(out)).expect("our file")
    };
    let membrane = made("plain.smesh", "");
    let walled = made("walls.smesh", "--walls");
    let (faces, walls) = walled
        .faces
        .triangles
        .split_at(membrane.faces.triangles.len());
    assert_eq!(faces, membrane.faces.triangles);
    assert!(!walls.is_empty());
    let text = fs::read_to_string(folder.path().join("walls.smesh")).expect("text");
    let regions = rows(&text, "# regions");
    // The soma, the axon, four dendrites.
    let kinds: Vec<f64> = regions.iter().map(|row| row[4]).collect();
    assert_eq!(kinds, [1.0, 2.0, 3.0, 3.0, 3.0, 3.0]);
    let marked = rows(&text, "# facets");
    let marked = marked.iter().filter(|row| row[4] == 2_000_000.0).count();
    assert_eq!(marked, walls.len());
    let report = check(&walled);
    assert!(!report.closed && report.self_intersections == 0);

    // Walls are told from the membrane in Gmsh's files, too, and meters are meters.
    let gmsh = made("walls.msh", "--walls");
    assert!(gmsh.vertices.iter().any(|vertex| vertex.kind == WALL));
    made("meters.smesh", "--walls --unit m");
    let text = fs::read_to_string(folder.path().join("meters.smesh")).expect("text");
    for (um, m) in regions.iter().zip(rows(&text, "# regions")) {
        for axis in 1..4 {
            assert!((um[axis] * 1e-6 - m[axis]).abs() < 1e-10, "{um:?} {m:?}");
        }
    }
}

#[neurotess_testing::test]
fn what_cannot_have_walls_says_so() {
    let folder = tempfile::tempdir().expect("a folder");
    let cell = sample("granule.swc");
    let run = |more: &str| neurotess(folder.path(), &format!("mesh {cell} --level 1 {more}"));
    let refused = run("--walls -o cell.ply").expect_err("PLY has no walls");
    assert!(
        refused.contains("write msh, msh2, poly or smesh"),
        "{refused}"
    );
    let json = run("--walls -o cell.msh --soma none --json").expect("meshed");
    assert!(json.contains("no neurite leaves a soma"), "{json}");
    assert!(
        !run("-o a.msh --resume --json")
            .expect("meshed")
            .contains("\"skipped\"")
    );
    let other = run("-o a.msh --resume --json --walls").expect("meshed");
    assert!(
        !other.contains("\"skipped\""),
        "other options, another file"
    );
}
