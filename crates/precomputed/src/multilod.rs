//! The multi-resolution mesh of a cell (`neuroglancer_multilod_draco`): its fragments, and the manifest that names them.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;
use neurotess_mesh::draco::{Attribute, AttributeKind, DracoError, Values, encode};
use rayon::prelude::*;
use serde_json::{Value, json};

use crate::cut::GridMesh;
use crate::grid::{BITS, Grid, STEPS};
use crate::octree::{LevelNodes, Node, listed};
use crate::shards::Sharding;

/// A level of detail of a cell at its place.
#[derive(Clone, Debug)]
pub struct PlacedLevel<'t> {
    /// Corners (nm).
    pub corners: Vec<DVec3>,
    /// Triangles, counter-clockwise seen from outside.
    pub triangles: &'t [[u32; 3]],
    /// How far (nm) the surface is from the smooth one.
    pub error: f64,
}

/// A cell as its files hold it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MultilodMesh {
    /// Fragments, those of the finest level first.
    pub fragments: Vec<u8>,
    /// Where each is, and how large.
    pub manifest: Vec<u8>,
    /// Triangles of all fragments.
    pub triangles: usize,
}

/// The `info` file of meshes.
pub fn mesh_info(sharding: Option<Sharding>) -> Value {
    let mut info = json!({
        "@type": "neuroglancer_multilod_draco",
        "vertex_quantization_bits": BITS,
        "transform": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0],
        "lod_scale_multiplier": 1,
    });
    if let Some(sharding) = sharding {
        info["sharding"] = sharding.json();
    }
    info
}

/// A level in its fragments.
struct Fragments {
    bytes: BTreeMap<Node, Vec<u8>>,
    children: BTreeSet<Node>,
    triangles: usize,
}

/// Encodes the levels of a cell, finest first.
///
/// # Errors
/// The encoder refuses it, or no level has a triangle.
pub fn multilod(levels: &[PlacedLevel<'_>]) -> Result<MultilodMesh, DracoError> {
    let grid = grid_of(levels);
    let numbered: Vec<(u32, &PlacedLevel<'_>)> = (0..).zip(levels).collect();
    let made = numbered.into_par_iter();
    let made = made.map(|(number, level)| Fragments::of(level, number, &grid));
    let made: Vec<Fragments> = made.collect::<Result<_, _>>()?;
    if made.first().is_none_or(|finest| finest.bytes.is_empty()) {
        return Err(DracoError::Empty);
    }
    let nodes: Vec<LevelNodes> = made
        .iter()
        .map(|level| LevelNodes {
            full: level.bytes.keys().copied().collect(),
            children: level.children.clone(),
        })
        .collect();
    let manifest = manifest(&grid, &scales(levels), &listed(&nodes), &made);
    let fragments = made.iter().flat_map(|level| level.bytes.values());
    Ok(MultilodMesh {
        fragments: fragments.flatten().copied().collect(),
        manifest,
        triangles: made.iter().map(|level| level.triangles).sum(),
    })
}

fn grid_of(levels: &[PlacedLevel<'_>]) -> Grid {
    let corners = || levels.iter().flat_map(|level| &level.corners);
    let min = corners().fold(DVec3::INFINITY, |min, &corner| min.min(corner));
    let max = corners().fold(DVec3::NEG_INFINITY, |max, &corner| max.max(corner));
    Grid::around(min, max)
}

/// Half of the error (nm) that may be as large as a pixel: neuroglancer takes the next finer level where a pixel is less
/// than twice this. It never falls from level to level, and is never 0, with which nothing is shown.
fn scales(levels: &[PlacedLevel<'_>]) -> Vec<f32> {
    let mut greatest = f32::MIN_POSITIVE;
    let scale = |level: &PlacedLevel<'_>| {
        greatest = greatest.max((level.error / 2.0) as f32);
        greatest
    };
    levels.iter().map(scale).collect()
}

impl Fragments {
    fn of(level: &PlacedLevel<'_>, number: u32, grid: &Grid) -> Result<Self, DracoError> {
        let corners = level.corners.iter();
        let mesh = GridMesh {
            corners: corners.map(|&point| grid.stored(number, point)).collect(),
            triangles: level.triangles.to_vec(),
        };
        let mesh = mesh.without_collapsed().cut_for(number);
        let mut of_node: BTreeMap<Node, ([u32; 3], Vec<[u32; 3]>)> = BTreeMap::new();
        let mut children = BTreeSet::new();
        for &triangle in &mesh.triangles {
            let part = mesh.part(triangle, number);
            let (_, triangles) = of_node
                .entry(Node::at(part.node))
                .or_insert((part.node, Vec::new()));
            triangles.push(triangle);
            children.insert(Node::child(part));
        }
        let mut numbers = vec![u32::MAX; mesh.corners.len()];
        let mut bytes = BTreeMap::new();
        for (node, (place, triangles)) in of_node {
            bytes.insert(node, fragment(&mesh, place, &triangles, &mut numbers)?);
        }
        Ok(Self {
            bytes,
            children,
            triangles: mesh.triangles.len(),
        })
    }
}

/// Encodes the triangles of a node. `numbers`: room for a number for each corner of the level, `u32::MAX` before and after.
fn fragment(
    mesh: &GridMesh,
    node: [u32; 3],
    triangles: &[[u32; 3]],
    numbers: &mut [u32],
) -> Result<Vec<u8>, DracoError> {
    let near = node.map(|along| i64::from(along) * STEPS);
    let mut corners: Vec<i32> = Vec::new();
    let mut own = |corner: u32| {
        let number = &mut numbers[corner as usize];
        if *number == u32::MAX {
            *number = (corners.len() / 3) as u32;
            let stored = mesh.corners[corner as usize];
            corners.extend((0..3).map(|i| (stored[i] - near[i]) as i32));
        }
        *number
    };
    let numbered: Vec<[u32; 3]> = triangles.iter().map(|t| t.map(&mut own)).collect();
    for &corner in triangles.as_flattened() {
        numbers[corner as usize] = u32::MAX;
    }
    let positions = Attribute {
        kind: AttributeKind::Position,
        components: 3,
        values: Values::I32(&corners),
        quantization: None,
    };
    Ok(encode(&numbered, &[positions])?.bytes)
}

/// The bytes of the manifest: little-endian, positions of fragments as all x, all y and all z, and sizes.
fn manifest(grid: &Grid, scales: &[f32], listed: &[BTreeSet<Node>], made: &[Fragments]) -> Vec<u8> {
    let mut bytes: Vec<u8> = Vec::new();
    let mut floats = |values: &[f32]| bytes.extend(values.iter().flat_map(|v| v.to_le_bytes()));
    floats(&grid.chunk);
    floats(&grid.origin);
    let levels = listed.len();
    bytes.extend((levels as u32).to_le_bytes());
    bytes.extend(scales.iter().flat_map(|scale| scale.to_le_bytes()));
    // Offsets of each level's corners: none.
    bytes.extend(std::iter::repeat_n(0, 12 * levels));
    let counts = listed.iter().map(|nodes| nodes.len() as u32);
    bytes.extend(counts.flat_map(u32::to_le_bytes));
    for (nodes, level) in listed.iter().zip(made) {
        for axis in 0..3 {
            let along = nodes.iter().map(|node| node.place()[axis]);
            bytes.extend(along.flat_map(u32::to_le_bytes));
        }
        let size = |node: &Node| level.bytes.get(node).map_or(0, Vec::len) as u32;
        bytes.extend(nodes.iter().flat_map(|node| size(node).to_le_bytes()));
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tetrahedron with this near corner and side (nm).
    fn tetrahedron(near: f64, side: f64, error: f64) -> PlacedLevel<'static> {
        let at = |x: f64, y: f64, z: f64| DVec3::splat(near) + side * DVec3::new(x, y, z);
        PlacedLevel {
            corners: vec![
                at(0., 0., 0.),
                at(1., 0., 0.),
                at(0., 1., 0.),
                at(0., 0., 1.),
            ],
            triangles: &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
            error,
        }
    }

    fn u32s(bytes: &[u8]) -> Vec<u32> {
        let words = bytes.as_chunks::<4>().0.iter();
        words.map(|&word| u32::from_le_bytes(word)).collect()
    }

    #[test]
    fn a_cell_in_one_node_has_one_fragment_a_level() {
        let levels = [1.0, 8.0, 4.0].map(|error| tetrahedron(500.0, 1e6, error));
        let mesh = multilod(&levels).expect("encoded");
        let words = u32s(&mesh.manifest);
        let floats: Vec<f32> = words.iter().map(|&word| f32::from_bits(word)).collect();
        let side = 1e6 * 65_535.0 / 65_533.0;
        assert!(floats[..3].iter().all(|s| (s / side - 1.0).abs() < 1e-6));
        assert_eq!(floats[3..6], [500.0; 3]);
        assert_eq!(words[6], 3);
        // Half of the errors, never falling.
        assert_eq!(floats[7..10], [0.5, 4.0, 4.0]);
        assert_eq!(words[10..19], [0; 9]);
        assert_eq!(words[19..22], [1; 3]);
        let fragments = words[22..].as_chunks::<4>().0;
        assert!(fragments.iter().all(|f| f[..3] == [0; 3] && f[3] > 0));
        let sizes: u32 = fragments.iter().map(|f| f[3]).sum();
        assert_eq!((fragments.len(), sizes as usize), (3, mesh.fragments.len()));
        assert_eq!(mesh.triangles, 12);
        assert!(mesh.fragments.starts_with(b"DRACO"));
    }

    #[test]
    fn a_large_cell_is_cut_into_nodes() {
        let levels = [1.0, 2.0].map(|error| tetrahedron(-2e6, 5e6, error));
        let mesh = multilod(&levels).expect("encoded");
        let words = u32s(&mesh.manifest);
        let [finest, coarsest] = words[15..17] else {
            panic!("two levels");
        };
        let (finest, coarsest) = (finest as usize, coarsest as usize);
        // Four nodes along each axis, of which a tetrahedron meets the lower corner.
        assert!((20..64).contains(&finest), "{finest}");
        assert!((4..=8).contains(&coarsest), "{coarsest}");
        let rows = &words[17..17 + 4 * finest];
        let place = |n: usize| [rows[n], rows[finest + n], rows[2 * finest + n]];
        assert_eq!((place(0), place(1)), ([0, 0, 0], [1, 0, 0]));
        assert_eq!(words.len(), 17 + 4 * (finest + coarsest));
        let sizes = rows[3 * finest..]
            .iter()
            .chain(&words[17 + 4 * finest + 3 * coarsest..]);
        assert_eq!(
            sizes.map(|&s| s as usize).sum::<usize>(),
            mesh.fragments.len()
        );
    }

    #[test]
    fn nothing_is_no_mesh() {
        assert!(multilod(&[]).is_err());
        let mut level = tetrahedron(0.0, 1.0, 1.0);
        level.triangles = &[];
        assert!(multilod(&[level]).is_err());
    }
}
