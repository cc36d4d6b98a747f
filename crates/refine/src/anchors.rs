//! Anchors, which explicit vertices are stored relative to.

use std::collections::BTreeMap;

use glam::Vec3;
use neurotess_mesh::{CoarseMesh, Role, TracingPoint};

use crate::decode::{
    ANCHOR_TAPER_SHIFT, collar, octahedral, signed16, taper, to_collar, to_collar_or_border,
    to_octahedral, to_signed16, to_taper,
};
use crate::packer::Packer;

/// What an anchor is: a tracing point, or the center of a soma.
type Key = (u32, [u32; 3]);

fn key(mesh: &CoarseMesh, tracing: u32) -> Key {
    let point = &mesh.tracing[tracing as usize];
    if point.role == Role::Soma {
        (u32::MAX, point.center.to_array().map(f32::to_bits))
    } else {
        (tracing, [0; 3])
    }
}

/// By anchor: the greatest coordinate of an offset (µm), in all parts: a vertex that several parts have is rounded by it,
/// and must be in one place.
pub(crate) struct Reaches(BTreeMap<Key, f32>);

impl Reaches {
    /// Those of the vertices that are explicit.
    pub(crate) fn new(mesh: &CoarseMesh, explicit: &[bool]) -> Self {
        let mut reaches = BTreeMap::new();
        let vertices = mesh.vertices.iter().zip(explicit);
        for (vertex, _) in vertices.filter(|&(_, &explicit)| explicit) {
            let offset = vertex.position - mesh.tracing[vertex.tracing as usize].center;
            let reach = reaches
                .entry(key(mesh, vertex.tracing))
                .or_insert(f32::MIN_POSITIVE);
            *reach = reach.max(offset.abs().max_element() * 1.000_001);
        }
        Self(reaches)
    }
}

/// Anchors of explicit vertices of a part.
pub(crate) struct Anchors {
    /// By key: index, tracing point and reach.
    all: BTreeMap<Key, (u32, u32, f32)>,
}

impl Anchors {
    pub(crate) fn new(packer: &Packer<'_>, reaches: &Reaches, explicit: &[u32]) -> Self {
        let mut all = BTreeMap::new();
        for &v in explicit {
            let vertex = &packer.mesh.vertices[v as usize];
            let key = key(packer.mesh, vertex.tracing);
            let reach = reaches.0.get(&key).copied();
            let reach = reach.expect("a part has no vertices but explicit ones here");
            all.entry(key).or_insert((0, vertex.tracing, reach));
        }
        for (index, entry) in (0..).zip(all.values_mut()) {
            entry.0 = index;
        }
        Self { all }
    }

    pub(crate) fn explicit(&self, packer: &Packer<'_>, v: u32) -> ([u32; 3], Vec3, Vec3) {
        let vertex = &packer.mesh.vertices[v as usize];
        let (anchor, tracing, reach) = self
            .all
            .get(&key(packer.mesh, vertex.tracing))
            .copied()
            .expect("anchors are made of all explicit vertices");
        let center = packer.mesh.tracing[tracing as usize].center;
        let offset = (vertex.position - center) / reach;
        let [x, y, z] = offset.to_array().map(to_signed16);
        let (nx, ny) = to_octahedral(vertex.normal, 4095.0);
        let position = center + Vec3::new(signed16(x), signed16(y), signed16(z)) * reach;
        let packed = [
            x | (y << 16),
            z | (anchor << 16),
            nx | (ny << 12) | (packer.level(vertex.tracing) << 24),
        ];
        (packed, position, octahedral(nx, ny, 4095.0))
    }

    pub(crate) fn write(
        &self,
        packer: &Packer<'_>,
        packed: &mut Vec<u32>,
        read: &mut Vec<(u32, TracingPoint)>,
    ) {
        for &(_, tracing, reach) in self.all.values() {
            let point = &packer.mesh.tracing[tracing as usize];
            let (x, y) = to_octahedral(point.tangent, 65535.0);
            packed.extend(point.center.extend(reach).to_array().map(f32::to_bits));
            packed.extend([
                point.radius.to_bits(),
                x | (y << 16),
                point.role as u32
                    | (to_taper(point.taper) << ANCHOR_TAPER_SHIFT)
                    | to_collar_or_border(point),
                packer.color_key(tracing),
            ]);
            if point.role != Role::Soma {
                read.push((
                    tracing,
                    TracingPoint {
                        tangent: octahedral(x, y, 65535.0),
                        collar: collar(to_collar(point.collar)),
                        taper: taper(to_taper(point.taper)),
                        ..*point
                    },
                ));
            }
        }
    }
}
