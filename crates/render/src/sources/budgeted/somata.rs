//! The somata of a proxy: their quads as they are in the mesh, and one more for each neurite, which
//! closes the opening that the neurite grows from.

use std::collections::BTreeMap;

use glam::Vec3;
use neurotess_mesh::{CoarseMesh, Patch, PatchKind, Role};

use super::layout::{CHUNK_SOMA, Chunk};
use super::proxy::Proxy;
use super::quantized::{grid, octahedral, packed, sphere};

/// Most vertices and quads of a soma that is kept as a mesh; a larger one is drawn as a sphere.
const MOST: usize = 1 << 16;

/// Adds all somata of a mesh.
pub(super) fn add(proxy: &mut Proxy, mesh: &CoarseMesh) {
    let of_soma = mesh.patches.iter().filter(|p| p.kind == PatchKind::Soma);
    let quads: Vec<[u32; 4]> = of_soma.map(|patch| patch.corners).collect();
    let rings = first_rings(mesh);
    for mut part in connected(&quads) {
        let own: BTreeMap<u32, ()> = part.iter().flatten().map(|&v| (v, ())).collect();
        part.extend(rings.iter().filter(|ring| own.contains_key(&ring[0])));
        add_soma(proxy, mesh, &part);
    }
}

/// The rings that neurites grow from, facing outwards: they close the openings of a soma's own
/// quads.
fn first_rings(mesh: &CoarseMesh) -> Vec<[u32; 4]> {
    let near = |patch: &Patch| {
        let tracing = mesh.vertices[patch.corners[0] as usize].tracing;
        mesh.tracing[tracing as usize].role == Role::Insertion
    };
    let around = mesh.patches.chunks(4).filter(|four| {
        four.len() == 4
            && four.iter().all(|p| p.kind == PatchKind::Lateral && near(p))
            && (0..4).all(|k| four[k].corners[1] == four[(k + 1) % 4].corners[0])
    });
    around
        .map(|four| [0, 1, 2, 3].map(|k: usize| four[k].corners[0]))
        .collect()
}

/// Groups of connected quads, in the order of their lowest vertex.
fn connected(quads: &[[u32; 4]]) -> Vec<Vec<[u32; 4]>> {
    let mut leader: BTreeMap<u32, u32> = BTreeMap::new();
    fn find(leader: &mut BTreeMap<u32, u32>, vertex: u32) -> u32 {
        let mut at = vertex;
        loop {
            let next = *leader.entry(at).or_insert(at);
            if next == at {
                break;
            }
            at = next;
        }
        leader.insert(vertex, at);
        at
    }
    for quad in quads {
        let mut first = find(&mut leader, quad[0]);
        for &vertex in &quad[1..] {
            let other = find(&mut leader, vertex);
            leader.insert(other.max(first), other.min(first));
            first = other.min(first);
        }
    }
    let mut parts: BTreeMap<u32, Vec<[u32; 4]>> = BTreeMap::new();
    for &quad in quads {
        let part = find(&mut leader, quad[0]);
        parts.entry(part).or_default().push(quad);
    }
    parts.into_values().collect()
}

fn add_soma(proxy: &mut Proxy, mesh: &CoarseMesh, quads: &[[u32; 4]]) {
    let mut numbers: BTreeMap<u32, u32> = BTreeMap::new();
    let mut vertices = Vec::new();
    // The soma's own vertices first, since the soma has the color of its first vertex.
    let own = |&&vertex: &&u32| {
        let tracing = mesh.vertices[vertex as usize].tracing;
        mesh.tracing[tracing as usize].role == Role::Soma
    };
    let (inner, all) = (quads.iter().flatten().filter(own), quads.iter().flatten());
    for &vertex in inner.chain(all) {
        numbers.entry(vertex).or_insert_with(|| {
            vertices.push(vertex);
            vertices.len() as u32 - 1
        });
    }
    let whole = vertices.len() < MOST && quads.len() < MOST;
    let at = |&v: &u32| &mesh.vertices[v as usize];
    let positions = vertices.iter().map(|v| at(v).position);
    let (low, step) = grid(positions.clone());
    let (center, reach) = sphere(positions.clone().map(|p| (p, 0.0)));
    let first = proxy.packed.len() as u32;
    if whole {
        let bytes = |n: Vec3| {
            let p = octahedral(n) * 127.0;
            let byte = |x: f32| u32::from(x.round() as i8 as u8);
            byte(p.x) | (byte(p.y) << 8)
        };
        for vertex in &vertices {
            let v = at(vertex);
            proxy
                .packed
                .extend(packed(v.position, low, step, bytes(v.normal)));
        }
        for quad in quads {
            let [a, b, c, d] = quad.map(|v| numbers[&v]);
            proxy.packed.extend([a | (b << 16), c | (d << 16)]);
        }
    }
    // From afar a soma is drawn as a sphere with its mean radius.
    let (middle, radius) = middle(mesh, &vertices).unwrap_or((center, reach));
    proxy.push(
        Chunk {
            center: middle.to_array(),
            reach: reach + middle.distance(center),
            low: low.to_array(),
            step,
            counts: [
                if whole { quads.len() as u32 } else { 0 },
                vertices.len() as u32,
            ],
            first,
            flags: Chunk::marks(CHUNK_SOMA, radius, radius),
            radius,
            length: 2.0 * radius,
            ..Chunk::default()
        },
        // A single color: on the soma's side, the rings of neurites have the soma's color too.
        vec![at(&vertices[0]).tracing],
    );
}

/// Center of a soma, and the mean distance (µm) of its surface from it, leaving out the rings of
/// neurites.
fn middle(mesh: &CoarseMesh, vertices: &[u32]) -> Option<(Vec3, f32)> {
    let own = || {
        let tracing = vertices.iter().map(|&v| mesh.vertices[v as usize].tracing);
        let points = tracing.map(|tracing| &mesh.tracing[tracing as usize]);
        points.filter(|point| point.role == Role::Soma)
    };
    let center = own().next()?.center;
    let count = own().count() as f32;
    Some((center, own().map(|point| point.radius).sum::<f32>() / count))
}
