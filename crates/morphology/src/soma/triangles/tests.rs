use std::f64::consts::{PI, TAU};

use super::super::shape::SomaShape;
use super::*;

type Mesh = (Vec<DVec3>, Vec<[u32; 3]>);

/// A sphere of triangles, outwards, whose vertices are moved.
fn sphere(moved: impl Fn(DVec3) -> DVec3) -> Mesh {
    let (rows, columns) = (40, 60);
    let mut vertices = vec![moved(DVec3::Z), moved(-DVec3::Z)];
    for row in 1..rows {
        for column in 0..columns {
            let polar = PI * f64::from(row) / f64::from(rows);
            let (sin, cos) = (TAU * f64::from(column) / f64::from(columns)).sin_cos();
            let unit = DVec3::new(polar.sin() * cos, polar.sin() * sin, polar.cos());
            vertices.push(moved(unit));
        }
    }
    let at = |row: u32, column: u32| 2 + (row - 1) * columns + column % columns;
    let mut triangles = Vec::new();
    for column in 0..columns {
        triangles.push([0, at(1, column), at(1, column + 1)]);
        triangles.push([1, at(rows - 1, column + 1), at(rows - 1, column)]);
        for row in 1..rows - 1 {
            let [a, b] = [at(row, column), at(row + 1, column)];
            let [d, c] = [at(row, column + 1), at(row + 1, column + 1)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    (vertices, triangles)
}

/// A tube of radius 3 in the shape of an S: two arcs of radius 8 by so many radians.
fn bent_twice(angle: f64) -> Mesh {
    sphere(|unit| {
        let turned = angle * unit.z.abs();
        let (sin, cos) = turned.sin_cos();
        let along = DVec3::new(sin, 1.0 - cos, 0.0) * 8.0 * unit.z.signum();
        // As thick along most of it.
        let round = (1.0 - unit.z * unit.z).max(1e-12).sqrt();
        let width = 3.0 * (1.0 - unit.z.powi(8)).max(0.0).sqrt() / round;
        along + DVec3::new(-sin, cos, 0.0) * (width * unit.x) + DVec3::Z * (width * unit.y)
    })
}

/// Half axes (µm) and center of the ellipsoid of these tests.
const HALF: DVec3 = DVec3::new(12.0, 8.0, 6.0);
const CENTER: DVec3 = DVec3::new(30.0, -20.0, 5.0);

fn shape((vertices, triangles): &Mesh) -> Result<SomaShape, SomaMeshError> {
    SomaShape::from_mesh(vertices, triangles)
}

/// Greatest share by which distances about the center of the ellipsoid are off.
fn off(shape: &SomaShape) -> f64 {
    let directions = Directions::new(9);
    let off = directions.units.iter().map(|&unit| {
        let right = 1.0 / (unit / HALF).length();
        (shape.distance(unit) / right - 1.0).abs()
    });
    off.fold(0.0, f64::max)
}

#[test]
fn an_ellipsoid_of_triangles_has_its_distances_and_volume() {
    let mut mesh = sphere(|unit| CENTER + unit * HALF);
    let outwards = shape(&mesh).expect("a soma");
    assert!(outwards.center().distance(CENTER) < 1e-9);
    assert_eq!(outwards.hidden(), None);
    // The sides of the mesh are as far within.
    assert!(off(&outwards) < 5e-3, "{}", off(&outwards));
    let volume = 4.0 / 3.0 * PI * HALF.x * HALF.y * HALF.z;
    let share = outwards.volume() / volume;
    assert!((share - 1.0).abs() < 0.01, "{share}");
    mesh.1.iter_mut().for_each(|triangle| triangle.swap(0, 1));
    let inwards = shape(&mesh).expect("a soma");
    assert!((inwards.volume() / outwards.volume() - 1.0).abs() < 1e-9);
}

#[test]
fn holes_where_neurites_were_cut_off_are_closed() {
    let mut mesh = sphere(|unit| CENTER + unit * HALF);
    let is_cut = |v: u32| {
        let unit = (mesh.0[v as usize] - CENTER) / HALF;
        unit.dot(DVec3::X) > 0.95 || unit.dot(DVec3::new(0.6, 0.0, -0.8)) > 0.97
    };
    let mut triangles = mesh.1.clone();
    triangles.retain(|triangle| !triangle.iter().any(|&v| is_cut(v)));
    assert!(triangles.len() < mesh.1.len());
    mesh.1 = triangles;
    let open = shape(&mesh).expect("a soma");
    // The centroid of what is left is elsewhere.
    let shift = open.center().distance(CENTER);
    assert!(shift < 0.5, "{shift}");
    let share = open.volume() / (4.0 / 3.0 * PI * HALF.x * HALF.y * HALF.z);
    assert!((share - 1.0).abs() < 0.03, "{share}");
}

#[test]
fn a_center_is_found_that_sees_everything() {
    // Two arms at a right angle: each hides the other's inner side from the centroid between them.
    let arms = |unit: DVec3| match unit.x.max(unit.y) > 0.93 {
        true => unit * 24.0,
        false => unit * 8.0,
    };
    let mesh = sphere(arms);
    let faces = faces(&mesh.0, &mesh.1).expect("faces");
    let middle = centroid(&faces);
    let off = kernel(&faces, middle).expect("a center").distance(middle);
    let found = shape(&mesh).expect("star-shaped");
    assert!(off > 0.5, "{off} from {middle}");
    assert_eq!(found.hidden(), None, "about {}", found.center());
}

#[test]
fn what_is_not_star_shaped_is_refused_with_a_place() {
    let found = shape(&bent_twice(3.0)).map(|shape| shape.hidden());
    let Err(SomaMeshError::NotStarShaped(hidden)) = found else {
        panic!("{found:?}");
    };
    assert!(hidden.share > MAX_HIDDEN, "{hidden:?}");
    let message = SomaMeshError::NotStarShaped(hidden).to_string();
    let place = format!("({:.2}, ", hidden.place.x);
    assert!(message.contains(&place), "{message}");
}

#[test]
fn a_stub_of_a_neurite_is_told() {
    // Two knobs that are wider than their necks: no place sees behind both.
    let knob = |unit: DVec3| match unit.x.abs() > 0.955 {
        true => DVec3::new(17.0 * unit.x.signum(), 27.0 * unit.y, 27.0 * unit.z),
        false => unit * 8.0,
    };
    let found = shape(&sphere(knob)).expect("mostly star-shaped");
    let hidden = found.hidden().expect("the knobs hide their necks");
    assert!(
        hidden.share < MAX_HIDDEN && hidden.place.x.abs() > 12.0,
        "{hidden:?}"
    );
}

#[test]
fn what_is_no_surface_is_refused() {
    let (vertices, mut triangles) = sphere(|unit| unit);
    assert_eq!(
        shape(&(vertices.clone(), Vec::new())),
        Err(SomaMeshError::Empty)
    );
    let flat = vertices.iter().map(|v| DVec3::new(v.x, 0.0, 0.0)).collect();
    assert_eq!(shape(&(flat, triangles.clone())), Err(SomaMeshError::Empty));
    let cup: Vec<[u32; 3]> = (triangles.iter().copied())
        .filter(|triangle| triangle.iter().all(|&v| vertices[v as usize].z >= 0.6))
        .collect();
    let open = shape(&(vertices.clone(), cup));
    assert!(matches!(open, Err(SomaMeshError::Open { .. })), "{open:?}");
    triangles[7][1] = 90_000;
    let index = 90_000;
    assert_eq!(
        shape(&(vertices, triangles)),
        Err(SomaMeshError::BadVertex { index })
    );
}
