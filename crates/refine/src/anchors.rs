//! Anchors, which explicit vertices are stored relative to.

use std::collections::BTreeMap;

use glam::Vec3;
use neurotess_mesh::{Role, TracingPoint};

use crate::decode::{
    ANCHOR_COLLAR_SHIFT, ANCHOR_TAPER_SHIFT, collar, octahedral, signed16, taper, to_collar,
    to_octahedral, to_signed16, to_taper,
};
use crate::packer::Packer;

/// Anchors of explicit vertices: their tracing points, or the center of
/// a soma.
pub(crate) struct Anchors {
    /// By key: index, tracing point and greatest coordinate of an offset (µm).
    all: BTreeMap<(u32, [u32; 3]), (u32, u32, f32)>,
}

impl Anchors {
    fn key(packer: &Packer<'_>, tracing: u32) -> (u32, [u32; 3]) {
        let point = &packer.mesh.tracing[tracing as usize];
        if point.role == Role::Soma {
            (u32::MAX, point.center.to_array().map(f32::to_bits))
        } else {
            (tracing, [0; 3])
        }
    }

    pub(crate) fn new(packer: &Packer<'_>, explicit: &[u32]) -> Self {
        let mut all = BTreeMap::new();
        for &v in explicit {
            let vertex = &packer.mesh.vertices[v as usize];
            let offset = vertex.position - packer.mesh.tracing[vertex.tracing as usize].center;
            let key = Self::key(packer, vertex.tracing);
            let entry = all.entry(key).or_insert((0, vertex.tracing, 0.0_f32));
            entry.2 = entry.2.max(offset.abs().max_element());
        }
        for (index, entry) in (0..).zip(all.values_mut()) {
            entry.0 = index;
            entry.2 = (entry.2 * 1.000_001).max(f32::MIN_POSITIVE);
        }
        Self { all }
    }

    pub(crate) fn explicit(&self, packer: &Packer<'_>, v: u32) -> ([u32; 3], Vec3, Vec3) {
        let vertex = &packer.mesh.vertices[v as usize];
        let (anchor, tracing, reach) = self
            .all
            .get(&Self::key(packer, vertex.tracing))
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
                    | (to_collar(point.collar) << ANCHOR_COLLAR_SHIFT),
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
