//! Writes the packed buffer of a part. Its layout is described in decode.rs.

use std::collections::BTreeMap;

use glam::Vec3;
use neurotess_mesh::{Role, TracingPoint};

use crate::bounding_sphere::{patch_sphere, sphere_around};
use crate::decode::{
    ImplicitRing, POINT_END, POINT_EXPLICIT, POINT_GOES_ON, POINT_KIND_SHIFT, POINT_NARROWS,
    POINT_ORDINARY, POINTS_OF_SPHERE, collar, from_sphere, octahedral, radius, signed16, to_collar,
    to_octahedral, to_signed16, to_sphere,
};
use crate::packer::{Contents, Packer, Slot, cap_ring, widened};
use crate::part::{MOST_COLOR_KEYS, MeshPart, PATCHES_OF_SPHERE};

impl Packer<'_> {
    pub(crate) fn write(&self, contents: &Contents) -> MeshPart {
        let mut part = MeshPart::default();
        self.list_patches(contents, &mut part);
        let rings = contents.slots.iter().filter_map(|slot| slot.ring);
        let implicit = rings.filter_map(|ring| self.implicit(ring));
        let color_keys = ColorKeys::new(implicit.map(|implicit| self.color_key(implicit.tracing)));
        let point_of = self.write_points(contents, &color_keys, &mut part);
        self.write_explicit(contents, &mut part);
        part.explicit.clone_from(&contents.explicit);
        self.write_patches(contents, &point_of, &mut part);
        part.layout.color_keys = part.packed.len() as u32;
        part.packed.extend(&color_keys.list);
        part
    }

    /// Lists the patches in the order of their slots, and their bounding spheres.
    fn list_patches(&self, contents: &Contents, part: &mut MeshPart) {
        let Contents {
            slots,
            soma,
            quads,
            caps,
            ..
        } = contents;
        let others: Vec<usize> = [soma, quads, caps].into_iter().flatten().copied().collect();
        let patches = |slot: &Slot| [0, 1, 2, 3].map(|k| slot.patch.map(|patch| patch + k));
        let all = slots
            .iter()
            .flat_map(patches)
            .chain(others.iter().map(|&p| Some(p)));
        part.patches = all
            .map(|patch| patch.map_or(u32::MAX, |p| p as u32))
            .collect();
        part.spheres = slots
            .chunks(POINTS_OF_SPHERE)
            .map(|slots| self.sphere(slots))
            .collect();
        part.spheres
            .extend(others.chunks(PATCHES_OF_SPHERE).map(|patches| {
                let spheres = patches
                    .iter()
                    .map(|&p| patch_sphere(self.mesh, &self.mesh.patches[p]));
                widened(sphere_around(spheres))
            }));
    }

    /// Writes points and bounding spheres. Returns the point of every implicit ring, by the ring's
    /// first vertex.
    fn write_points(
        &self,
        contents: &Contents,
        color_keys: &ColorKeys,
        part: &mut MeshPart,
    ) -> BTreeMap<u32, u32> {
        let mut point_of = BTreeMap::new();
        for (i, slot) in contents.slots.iter().enumerate() {
            let goes_on = if slot.patch.is_some() {
                POINT_GOES_ON
            } else {
                0
            };
            let implicit = slot
                .ring
                .and_then(|ring| self.implicit(ring).map(|implicit| (ring[0], implicit)));
            let point = match implicit {
                Some((first, implicit)) => {
                    point_of.insert(first, i as u32);
                    let sphere = part.spheres[i / POINTS_OF_SPHERE];
                    self.implicit_point(part, first, &implicit, sphere, goes_on, color_keys)
                }
                None => {
                    // An empty slot is never drawn.
                    let ids = slot.ring.map(|ring| ring.map(|v| contents.explicit_id(v)));
                    let [a, b, c, d] = ids.unwrap_or_default();
                    let kind = POINT_EXPLICIT << POINT_KIND_SHIFT;
                    [a | (b << 16), kind | goes_on, c | (d << 16), 0]
                }
            };
            part.packed.extend(point);
        }
        part.layout.point_count = contents.slots.len() as u32;
        part.layout.spheres = part.packed.len() as u32;
        for &(center, radius) in &part.spheres {
            let sphere = center.extend(radius).to_array().map(f32::to_bits);
            part.packed.extend(sphere);
            // The bend of its edges: pack.rs fills it in, once all positions are rounded.
            part.packed.push(0);
        }
        point_of
    }

    fn write_explicit(&self, contents: &Contents, part: &mut MeshPart) {
        part.layout.explicit = part.packed.len() as u32;
        let anchors = Anchors::new(self, &contents.explicit);
        for &v in &contents.explicit {
            let (vertex, position, normal) = anchors.explicit(self, v);
            part.packed.extend(vertex);
            part.vertices.push((v, position, normal));
        }
        part.layout.anchors = part.packed.len() as u32;
        anchors.write(self, &mut part.packed, &mut part.tracing);
    }

    fn write_patches(
        &self,
        contents: &Contents,
        point_of: &BTreeMap<u32, u32>,
        part: &mut MeshPart,
    ) {
        let MeshPart { packed, layout, .. } = part;
        let corners = |patch: usize| {
            let corners = self.mesh.patches[patch].corners;
            corners.map(|v| contents.explicit_id(v))
        };
        layout.soma = packed.len() as u32;
        layout.soma_count = contents.soma.len() as u32;
        let bits = contents.soma.iter().map(|&patch| {
            let [a, b, c, d] = corners(patch).map(u64::from);
            a | (b << 12) | (c << 24) | (d << 36)
        });
        let halves = bits.flat_map(|bits| [0, 16, 32].map(|shift| (bits >> shift) as u32 & 0xffff));
        let halves: Vec<u32> = halves.collect();
        let pair = |pair: &[u32]| pair[0] | (pair.get(1).copied().unwrap_or(0) << 16);
        packed.extend(halves.chunks(2).map(pair));
        layout.quads = packed.len() as u32;
        layout.quad_count = contents.quads.len() as u32;
        for &quad in &contents.quads {
            let [a, b, c, d] = corners(quad);
            let kind = self.mesh.patches[quad].kind as u32;
            let (a, b) = (a | ((kind & 1) << 15), b | ((kind >> 1) << 15));
            packed.extend([a | (b << 16), c | (d << 16)]);
        }
        layout.caps = packed.len() as u32;
        for &cap in &contents.caps {
            let (first, reversed) = cap_ring(self.mesh.patches[cap].corners)
                .expect("explicit.rs leaves only caps of whole rings");
            let point = point_of[&first];
            packed.push((point << 1) | u32::from(reversed));
        }
    }

    fn implicit_point(
        &self,
        part: &mut MeshPart,
        first: u32,
        implicit: &ImplicitRing,
        (middle, reach): (Vec3, f32),
        goes_on: u32,
        color_keys: &ColorKeys,
    ) -> [u32; 4] {
        let point = &self.mesh.tracing[implicit.tracing as usize];
        let place = to_sphere(middle, reach, point.center);
        let center = from_sphere(middle, reach, place);
        for k in 0..4 {
            let (position, normal) = implicit.corner(center, k);
            part.vertices.push((first + k, position, normal));
        }
        let radius = radius(implicit.radius);
        part.tracing.push((
            implicit.tracing,
            TracingPoint {
                center,
                radius,
                tangent: implicit.tangent(),
                ..*point
            },
        ));
        let [x, y, z] = place;
        let kind = if implicit.role == Role::End {
            POINT_END
        } else {
            POINT_ORDINARY
        };
        let (slope, narrows) = implicit.slope;
        let narrows = if narrows { POINT_NARROWS } else { 0 };
        [
            x | (y << 20),
            (y >> 12) | (z << 8) | goes_on | narrows | (kind << POINT_KIND_SHIFT),
            implicit.radius | (implicit.turn << 16) | ((self.level(implicit.tracing) - 1) << 26),
            implicit.tangent.0
                | (implicit.tangent.1 << 9)
                | (slope << 18)
                | (color_keys.index_of(self.color_key(implicit.tracing)) << 22),
        ]
    }
}

impl Contents {
    fn explicit_id(&self, v: u32) -> u32 {
        self.explicit
            .binary_search(&v)
            .expect("a part lists all its explicit vertices") as u32
    }
}

/// The different color keys of a part's points.
struct ColorKeys {
    list: Vec<u32>,
    /// Number of low bits that are set to 0, so that there are few enough different ones.
    dropped: u32,
}

impl ColorKeys {
    fn new(all: impl Iterator<Item = u32>) -> Self {
        let mut list: Vec<u32> = all.collect();
        let mut dropped = 0;
        loop {
            list.sort_unstable();
            list.dedup();
            if list.len() <= MOST_COLOR_KEYS {
                return Self { list, dropped };
            }
            dropped += 1;
            list.iter_mut()
                .for_each(|key| *key = *key >> dropped << dropped);
        }
    }

    fn index_of(&self, key: u32) -> u32 {
        let key = key >> self.dropped << self.dropped;
        self.list
            .binary_search(&key)
            .expect("a part lists the color keys of all its points") as u32
    }
}

/// Anchors, which explicit vertices are stored relative to: their tracing points, or the center of
/// a soma.
struct Anchors {
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

    fn new(packer: &Packer<'_>, explicit: &[u32]) -> Self {
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

    fn explicit(&self, packer: &Packer<'_>, v: u32) -> ([u32; 3], Vec3, Vec3) {
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

    fn write(
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
                point.role as u32 | (to_collar(point.collar) << 16),
                packer.color_key(tracing),
            ]);
            if point.role != Role::Soma {
                read.push((
                    tracing,
                    TracingPoint {
                        tangent: octahedral(x, y, 65535.0),
                        collar: collar(to_collar(point.collar)),
                        ..*point
                    },
                ));
            }
        }
    }
}
