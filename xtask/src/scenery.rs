//! Meshes for the pictures: layers of a cortex and a pipette, as OBJ.

use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// A mesh of quads.
#[derive(Default)]
struct Quads {
    text: String,
    count: usize,
}

impl Quads {
    /// Adds a vertex (µm); returns its number in the file.
    fn vertex(&mut self, [x, y, z]: [f64; 3]) -> usize {
        // Writing to a String does not fail.
        let _ = writeln!(self.text, "v {x:.3} {y:.3} {z:.3}");
        self.count += 1;
        self.count
    }

    fn face(&mut self, [a, b, c, d]: [usize; 4]) {
        let _ = writeln!(self.text, "f {a} {b} {c} {d}");
    }
}

/// Half the side (µm) of a layer.
const HALF: f64 = 170.0;
/// Radius (µm) of the cortex's curvature.
const CURVATURE: f64 = 900.0;
/// Quads along a side of a layer.
const SIDE: usize = 24;

/// A block of cortex between two heights (µm) at its middle.
fn layer(heights: [f64; 2]) -> Quads {
    let mut quads = Quads::default();
    let sheets = heights.map(|height| {
        let mut vertex = |i: usize, j: usize| {
            let [x, z] = [i, j].map(|n| HALF * (2.0 * n as f64 / SIDE as f64 - 1.0));
            quads.vertex([x, height - (x * x + z * z) / (2.0 * CURVATURE), z])
        };
        let row = |i: usize, vertex: &mut dyn FnMut(usize, usize) -> usize| {
            (0..=SIDE).map(|j| vertex(i, j)).collect::<Vec<_>>()
        };
        (0..=SIDE).map(|i| row(i, &mut vertex)).collect::<Vec<_>>()
    });
    let [below, above] = &sheets;
    for i in 0..SIDE {
        for j in 0..SIDE {
            let corners = |sheet: &[Vec<usize>]| {
                [
                    sheet[i][j],
                    sheet[i + 1][j],
                    sheet[i + 1][j + 1],
                    sheet[i][j + 1],
                ]
            };
            quads.face(corners(below));
            let [a, b, c, d] = corners(above);
            quads.face([d, c, b, a]);
        }
    }
    for k in 0..SIDE {
        for [from, to] in [
            [[k, 0], [k + 1, 0]],
            [[k + 1, SIDE], [k, SIDE]],
            [[0, k + 1], [0, k]],
            [[SIDE, k], [SIDE, k + 1]],
        ] {
            let of = |sheet: &[Vec<usize>], [i, j]: [usize; 2]| sheet[i][j];
            quads.face([
                of(below, from),
                of(above, from),
                of(above, to),
                of(below, to),
            ]);
        }
    }
    quads
}

/// A glass pipette: an open cone from its tip (µm) along a unit vector.
fn pipette(tip: [f64; 3], along: [f64; 3]) -> Quads {
    const AROUND: usize = 32;
    const RINGS: usize = 12;
    let mut quads = Quads::default();
    let [x, y, z] = along;
    let flat = x.hypot(y);
    let across = [y / flat, -x / flat, 0.0];
    let upwards = [x * z / flat, y * z / flat, -flat];
    for ring in 0..=RINGS {
        let share = ring as f64 / RINGS as f64;
        let radius = 0.7 + 9.0 * share;
        for k in 0..AROUND {
            let (sin, cos) = (TAU * k as f64 / AROUND as f64).sin_cos();
            let place = |axis: usize| {
                let out = cos * across[axis] + sin * upwards[axis];
                tip[axis] + 110.0 * share * along[axis] + radius * out
            };
            quads.vertex([place(0), place(1), place(2)]);
        }
    }
    for ring in 0..RINGS {
        for k in 0..AROUND {
            let first = 1 + ring * AROUND;
            let next = (k + 1) % AROUND;
            quads.face([
                first + k,
                first + next,
                first + AROUND + next,
                first + AROUND + k,
            ]);
        }
    }
    quads
}

/// Writes all of them to a folder.
pub(crate) fn write(folder: &Path) -> anyhow::Result<()> {
    fs::create_dir_all(folder)?;
    for (name, mesh) in [
        ("layer_1", layer([330.0, 415.0])),
        ("layer_2-3", layer([110.0, 330.0])),
        ("layer_5", layer([-110.0, 110.0])),
        (
            "pipette",
            pipette([7.0, 3.0, 7.0], [0.8, 0.5, 0.11_f64.sqrt()]),
        ),
    ] {
        fs::write(folder.join(format!("{name}.obj")), mesh.text)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    /// Number of faces on each side of each edge, by how it is passed.
    fn sides(mesh: &Quads) -> BTreeMap<[usize; 2], usize> {
        let mut sides = BTreeMap::new();
        for line in mesh.text.lines().filter_map(|l| l.strip_prefix("f ")) {
            let corners: Vec<usize> = line.split(' ').map(|n| n.parse().expect("n")).collect();
            for k in 0..4 {
                let edge = [corners[k], corners[(k + 1) % 4]];
                *sides.entry(edge).or_default() += 1;
            }
        }
        sides
    }

    #[test]
    fn layers_are_closed_and_pipettes_open_at_both_ends() {
        let open = |mesh: &Quads| {
            let sides = sides(mesh);
            assert!(sides.values().all(|&count| count == 1), "oriented");
            let edges = sides.keys();
            edges
                .filter(|[a, b]| !sides.contains_key(&[*b, *a]))
                .count()
        };
        assert_eq!(open(&layer([0.0, 100.0])), 0);
        assert_eq!(open(&pipette([0.0; 3], [0.8, 0.6, 0.0])), 64);
    }

    #[test]
    fn all_are_written() {
        let folder = crate::steps::root().join("target/pictures");
        write(&folder).expect("written");
        for name in ["layer_1", "layer_2-3", "layer_5", "pipette"] {
            assert!(folder.join(format!("{name}.obj")).exists(), "{name}");
        }
    }
}
