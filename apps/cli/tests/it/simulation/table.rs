//! `--table`

use std::collections::HashMap;
use std::fs;
use std::path::Path;

use glam::DVec3;
use neurotess::formats::{self, ReadOptions};
use neurotess::mesh::{FaceLabel, SurfaceMesh, read};
use neurotess::morphology::{Attachment, Morphology};

use super::neurotess;
use crate::work::sample;

struct Row {
    triangle: usize,
    label: FaceLabel,
    position: f64,
}

fn rows(path: &Path) -> Vec<Row> {
    let text = fs::read_to_string(path).expect("a table");
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("triangle,sample,section,position,type"));
    let row = |line: &str| {
        let numbers: Vec<f64> = line
            .split(',')
            .map(|word| word.parse().expect("a number"))
            .collect();
        let [triangle, point, section, position, kind] = numbers[..] else {
            panic!("{line}")
        };
        Row {
            triangle: triangle as usize,
            label: FaceLabel {
                point: point as i32,
                section: section as i32,
                kind: kind as i32,
            },
            position,
        }
    };
    lines.map(row).collect()
}

/// A sample with its mesh and table.
fn tabled(folder: &Path, name: &str) -> (Morphology, SurfaceMesh, Vec<Row>) {
    let path = sample(name);
    let command = format!("mesh {path} -o cell.ply --table cell.csv --level 2 -q --force");
    neurotess(folder, &command).expect("meshed");
    let morphology = formats::read(Path::new(&path), &ReadOptions::default()).expect("a sample");
    let mesh = read(&folder.join("cell.ply")).expect("our file");
    (morphology.morphology, mesh, rows(&folder.join("cell.csv")))
}

fn at(mesh: &SurfaceMesh, triangle: usize) -> [DVec3; 3] {
    mesh.faces.triangles[triangle]
        .map(|corner| mesh.vertices[corner as usize].position.as_dvec3() + mesh.origin)
}

#[neurotess_testing::test]
fn every_triangle_is_one_row_with_its_label() {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["granule.swc", "purkinje.swc"] {
        let (_, mesh, rows) = tabled(folder.path(), name);
        assert_eq!(rows.len(), mesh.faces.triangles.len());
        for (n, row) in rows.iter().enumerate() {
            assert_eq!(row.triangle, n);
            let corners = mesh.faces.triangles[n].map(|corner| &mesh.vertices[corner as usize]);
            assert_eq!(row.label, FaceLabel::of(corners));
            assert!((0.0..=1.0).contains(&row.position));
        }
    }
}

/// The points of a section's line, with radii.
fn line(morphology: &Morphology, section: usize) -> Vec<(DVec3, f64)> {
    let section = &morphology.sections[section];
    let start = match section.attachment {
        Attachment::Section(parent) => Some(morphology.sections[parent.index()].end as usize - 1),
        _ => None,
    };
    start
        .into_iter()
        .chain(section.range())
        .map(|n| &morphology.points[n])
        .map(|p| {
            (
                p.position.as_dvec3() + morphology.origin,
                f64::from(p.radius),
            )
        })
        .collect()
}

/// The place at a share of a line's length.
fn place(line: &[(DVec3, f64)], share: f64) -> (DVec3, f64) {
    let length = |pair: &[(DVec3, f64)]| pair[0].0.distance(pair[1].0);
    let total: f64 = line.windows(2).map(length).sum();
    let mut rest = share * total;
    for pair in line.windows(2) {
        let here = length(pair);
        if rest <= here && here > 0.0 {
            let t = rest / here;
            return (
                pair[0].0.lerp(pair[1].0, t),
                pair[0].1 * (1.0 - t) + pair[1].1 * t,
            );
        }
        rest -= here;
    }
    line[line.len() - 1]
}

/// A membrane lies about a radius away from the line that was traced: half of all triangles do so to a
/// tenth (chords of level 2 are cos(π/8) of it away), and all but one in a hundred to within 1.25 radii,
/// since membranes are wider at forks. What falls beyond an end of the line is left out: the way to the
/// soma, and caps.
#[neurotess_testing::test]
fn places_on_the_tracing_are_where_the_triangles_are() {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["granule.swc", "star.swc", "motor.swc"] {
        let (morphology, mesh, rows) = tabled(folder.path(), name);
        let lines: Vec<_> = (0..morphology.sections.len())
            .map(|n| line(&morphology, n))
            .collect();
        let mut reach = Vec::new();
        let beside = |row: &&Row| row.position > 0.0 && row.position < 1.0;
        let of_neurites = rows.iter().filter(|row| row.label.section > 0);
        for row in of_neurites.filter(beside) {
            let [a, b, c] = at(&mesh, row.triangle);
            let line = &lines[row.label.section as usize - 1];
            if line.len() > 1 {
                let (center, radius) = place(line, row.position);
                reach.push(((a + b + c) / 3.0).distance(center) / radius);
            }
        }
        assert!(reach.len() > 1000, "{name}");
        reach.sort_unstable_by(f64::total_cmp);
        let at = |share: f64| reach[(share * (reach.len() - 1) as f64) as usize];
        neurotess_testing::note!("{name}: {} {} {}", at(0.5), at(0.99), at(1.0));
        assert!((at(0.5) - 1.0).abs() < 0.1, "{name}: {}", at(0.5));
        assert!(at(0.99) < 1.25, "{name}: {}", at(0.99));
    }
}

/// The cone between a sample and its neighbors reaches the triangles that it is named for.
#[neurotess_testing::test]
fn named_samples_are_near() {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["granule.swc", "star.swc", "motor.swc"] {
        let (morphology, mesh, rows) = tabled(folder.path(), name);
        let lines: Vec<_> = (0..morphology.sections.len())
            .map(|n| line(&morphology, n))
            .collect();
        let mut spots = HashMap::new();
        for (n, section) in morphology.sections.iter().enumerate() {
            let first = lines[n].len() - section.range().len();
            for (k, point) in section.range().enumerate() {
                spots.insert((n as i32 + 1, morphology.sample_ids[point]), first + k);
            }
        }
        let mut far = 0;
        let of_neurites = || rows.iter().filter(|row| row.label.section > 0);
        for row in of_neurites() {
            let [a, b, c] = at(&mesh, row.triangle);
            let key = (row.label.section, i64::from(row.label.point));
            let spot = *spots.get(&key).expect("the sample is of the section");
            let line = &lines[row.label.section as usize - 1];
            let near = &line[spot.saturating_sub(1)..(spot + 2).min(line.len())];
            let radius = near.iter().map(|p| p.1).fold(0.0, f64::max);
            let cones = near
                .iter()
                .map(|p| p.0.distance(line[spot].0))
                .fold(0.0, f64::max);
            let distance = ((a + b + c) / 3.0).distance(line[spot].0);
            far += usize::from(distance > cones + 2.0 * radius);
        }
        let share = far as f64 / of_neurites().count() as f64;
        neurotess_testing::note!("{name}: {share}");
        assert!(share < 0.01, "{name}: {share}");
    }
}

#[neurotess_testing::test]
fn a_table_is_there_with_its_mesh_or_not_at_all() {
    let folder = tempfile::tempdir().expect("a folder");
    let cell = sample("granule.swc");
    let run = |arguments: &str| neurotess(folder.path(), &format!("mesh {arguments} --level 1"));
    let there = |name: &str| folder.path().join(name).exists();

    fs::write(folder.path().join("no.swc"), "1 1 0 0\n").expect("a file");
    run("no.swc -o no.ply --table no.csv").expect_err("no morphology");
    assert!(!there("no.csv") && !there("no.ply"));

    run(&format!("{cell} -o a.ply --table a.csv")).expect("meshed");
    let before = fs::read(folder.path().join("a.csv")).expect("a table");
    let refused = run(&format!("{cell} -o b.ply --table a.csv")).expect_err("the table exists");
    assert!(refused.contains("--force"), "{refused}");
    assert!(!there("b.ply"));
    assert_eq!(
        fs::read(folder.path().join("a.csv")).expect("a table"),
        before
    );

    let samples = crate::work::root().join("samples").display().to_string();
    for (wrong, message) in [
        (format!("{samples} -o all --table all.csv"), "one input"),
        (format!("{cell} -o c.ply --table c.ply"), "the same file"),
        (format!("{cell} -o c.ply --quads --table c.csv"), "--quads"),
    ] {
        let refused = run(&wrong).expect_err("wrong usage");
        assert!(refused.contains(message), "{refused}");
    }
    let coarse = format!("mesh {cell} -o c.ply --table c.csv --level 0");
    let refused = neurotess(folder.path(), &coarse).expect_err("quads");
    assert!(refused.contains("level 0"), "{refused}");
}
