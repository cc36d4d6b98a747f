//! A judge of closedness that shares nothing with the code under test.

use std::collections::{HashMap, HashSet};

use neurotess_mesh::SurfaceMesh;

/// Edges, each shared by exactly two faces in opposite directions; one fan of faces per vertex; no
/// vertex unused; Euler characteristic 2 per component.
pub(crate) fn assert_closed(mesh: &SurfaceMesh, what: &str) {
    let mut faces: Vec<Vec<u32>> = mesh.faces.triangles.iter().map(|t| t.to_vec()).collect();
    faces.extend(mesh.faces.quads.iter().map(|q| q.to_vec()));
    let mut next_at: HashMap<(u32, u32), u32> = HashMap::new();
    for face in &faces {
        for k in 0..face.len() {
            let (before, here, after) = (
                face[k],
                face[(k + 1) % face.len()],
                face[(k + 2) % face.len()],
            );
            assert_ne!(before, here, "{what}: face with an empty side");
            let double = next_at.insert((here, before), after).is_some();
            assert!(
                !double,
                "{what}: two faces use side {before}–{here} in one direction"
            );
        }
    }
    let sides: HashSet<(u32, u32)> = faces
        .iter()
        .flat_map(|f| (0..f.len()).map(|k| (f[k], f[(k + 1) % f.len()])))
        .collect();
    for &(a, b) in &sides {
        assert!(sides.contains(&(b, a)), "{what}: side {a}–{b} is open");
    }
    // Walking from face to face about a vertex must come round to all of them.
    let mut degree: HashMap<u32, usize> = HashMap::new();
    let mut start: HashMap<u32, u32> = HashMap::new();
    for &(v, neighbor) in next_at.keys() {
        *degree.entry(v).or_default() += 1;
        start.entry(v).or_insert(neighbor);
    }
    assert_eq!(degree.len(), mesh.vertices.len(), "{what}: unused vertices");
    for (&v, &first) in &start {
        let (mut here, mut steps) = (first, 0);
        loop {
            here = next_at[&(v, here)];
            steps += 1;
            if here == first {
                break;
            }
        }
        assert_eq!(steps, degree[&v], "{what}: vertex {v} joins several fans");
    }
    let mut group: Vec<usize> = (0..mesh.vertices.len()).collect();
    fn root(group: &mut [usize], mut i: usize) -> usize {
        while group[i] != i {
            group[i] = group[group[i]];
            i = group[i];
        }
        i
    }
    for face in &faces {
        for pair in face.windows(2) {
            let (a, b) = (
                root(&mut group, pair[0] as usize),
                root(&mut group, pair[1] as usize),
            );
            group[a] = b;
        }
    }
    let components = (0..group.len()).filter(|&i| group[i] == i).count();
    let euler = mesh.vertices.len() as i64 - sides.len() as i64 / 2 + faces.len() as i64;
    assert_eq!(euler, 2 * components as i64, "{what}: Euler characteristic");
}
