//! Writes the packed buffer of a part. Its layout is described in decode.rs.

use std::collections::BTreeMap;

use glam::Vec3;
use neurotess_mesh::{Role, TracingPoint};

use crate::anchors::{Anchors, Reaches};
use crate::bounding_sphere::{patch_sphere, sphere_around};
use crate::decode::{
    POINT_END, POINT_EXPLICIT, POINT_GOES_ON, POINT_KIND_SHIFT, POINT_NARROWS, POINT_ORDINARY,
    POINT_SHAPED, POINTS_OF_SPHERE, SHAPED_LEVEL_SHIFT, SHAPED_OPEN_SHIFT, TAPER_LOW_BITS,
    TAPER_NARROWS, collar, from_sphere, radius, taper, to_collar, to_sphere,
};
use crate::packer::{Contents, Packer, cap_ring, widened};
use crate::part::{MAX_COLOR_KEYS, MeshPart, PATCHES_OF_SPHERE};
use crate::ring_form::RingForm;

impl Packer<'_> {
    pub(crate) fn write(&self, contents: &Contents, reaches: &Reaches) -> MeshPart {
        let mut part = MeshPart::default();
        self.list_patches(contents, &mut part);
        let rings = contents.slots.iter().filter_map(|slot| slot.ring);
        let forms = rings.filter_map(|ring| self.form(ring));
        let color_keys = ColorKeys::new(forms.map(|form| self.color_key(form.circle().tracing)));
        let point_of = self.write_points(contents, &color_keys, &mut part);
        self.write_explicit(contents, reaches, &mut part);
        self.write_shaped(contents, &mut part);
        let shaped = contents.shaped.iter();
        let shaped = shaped.flat_map(|&(first, _)| first..first + 4);
        part.explicit = contents.explicit.iter().copied().chain(shaped).collect();
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
        let laterals = slots.iter().flat_map(|slot| slot.patches);
        part.patches = laterals.chain(others.iter().map(|&p| p as u32)).collect();
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

    /// Writes points, the rest of their tapers and bounding spheres. Returns the point of every implicit ring, by the ring's
    /// first vertex.
    fn write_points(
        &self,
        contents: &Contents,
        color_keys: &ColorKeys,
        part: &mut MeshPart,
    ) -> BTreeMap<u32, u32> {
        let mut point_of = BTreeMap::new();
        let mut tapers = Vec::new();
        for (i, slot) in contents.slots.iter().enumerate() {
            let form = slot.ring.and_then(|ring| Some((ring[0], self.form(ring)?)));
            let point = match &form {
                Some((first, form)) => {
                    let sphere = part.spheres[i / POINTS_OF_SPHERE];
                    let [x, y, mut z, w] = self.point_bits(part, *first, form, sphere, color_keys);
                    let (kind, named) = match form {
                        RingForm::Shaped(_) => (POINT_SHAPED, contents.shaped_index(*first)),
                        RingForm::Implicit(circle) => {
                            point_of.insert(*first, i as u32);
                            let end = circle.role == Role::End;
                            let turn = circle.turn | ((self.level(circle.tracing) - 1) << 10);
                            (if end { POINT_END } else { POINT_ORDINARY }, turn)
                        }
                    };
                    z |= named << 16;
                    [x, y | (kind << POINT_KIND_SHIFT), z, w]
                }
                None => {
                    // An empty slot is never drawn.
                    let ids = slot.ring.map(|ring| ring.map(|v| contents.id(v)));
                    let [a, b, c, d] = ids.unwrap_or_default();
                    let kind = POINT_EXPLICIT << POINT_KIND_SHIFT;
                    [a | (b << 16), kind | slot.open_sides(), c | (d << 16), 0]
                }
            };
            let low = form.map_or(0, |(_, form)| form.circle().taper);
            tapers.push(low & ((1 << TAPER_LOW_BITS) - 1));
            let goes_on = if slot.goes_on() { POINT_GOES_ON } else { 0 };
            let [x, y, z, w] = point;
            part.packed.extend([x, y | goes_on, z, w]);
        }
        part.layout.point_count = contents.slots.len() as u32;
        let together = |eight: &[u32]| {
            let shifted = (0..).step_by(TAPER_LOW_BITS as usize).zip(eight);
            shifted.fold(0, |bits, (shift, low)| bits | (low << shift))
        };
        part.packed
            .extend(tapers.chunks((32 / TAPER_LOW_BITS) as usize).map(together));
        part.layout.spheres = part.packed.len() as u32;
        for &(center, radius) in &part.spheres {
            let sphere = center.extend(radius).to_array().map(f32::to_bits);
            part.packed.extend(sphere);
            // The bend of its edges: pack.rs fills it in, once all positions are rounded.
            part.packed.push(0);
        }
        point_of
    }

    fn write_explicit(&self, contents: &Contents, reaches: &Reaches, part: &mut MeshPart) {
        part.layout.explicit = part.packed.len() as u32;
        let anchors = Anchors::new(self, reaches, &contents.explicit);
        for &v in &contents.explicit {
            let (vertex, position, normal) = anchors.explicit(self, v);
            part.packed.extend(vertex);
            part.vertices.push((v, position, normal));
        }
        part.layout.anchors = part.packed.len() as u32;
        anchors.write(self, &mut part.packed, &mut part.tracing);
    }

    fn write_shaped(&self, contents: &Contents, part: &mut MeshPart) {
        part.layout.shaped = part.packed.len() as u32;
        for &(_, point) in &contents.shaped {
            let slot = &contents.slots[point as usize];
            if let Some(RingForm::Shaped(shaped)) = slot.ring.and_then(|ring| self.form(ring)) {
                let level = (self.level(shaped.circle.tracing) - 1) << SHAPED_LEVEL_SHIFT;
                let open = slot.open_sides() << SHAPED_OPEN_SHIFT;
                part.packed.push(point | level | open);
                part.packed.extend(shaped.packed());
            }
        }
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
            corners.map(|v| contents.id(v))
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

    /// The bits of a point that do not depend on its kind: center, radius, tangent, taper and color key.
    fn point_bits(
        &self,
        part: &mut MeshPart,
        first: u32,
        form: &RingForm,
        (middle, reach): (Vec3, f32),
        color_keys: &ColorKeys,
    ) -> [u32; 4] {
        let circle = form.circle();
        let point = &self.mesh.tracing[circle.tracing as usize];
        let place = to_sphere(middle, reach, point.center);
        let center = from_sphere(middle, reach, place);
        for k in 0..4 {
            let (position, normal) = form.corner(center, k);
            part.vertices.push((first + k as u32, position, normal));
        }
        let collar = match form {
            RingForm::Implicit(_) => point.collar,
            RingForm::Shaped(_) => collar(to_collar(point.collar)),
        };
        let rounded = TracingPoint {
            center,
            radius: radius(circle.radius),
            tangent: circle.tangent(),
            collar,
            taper: taper(circle.taper),
            ..*point
        };
        part.tracing.push((circle.tracing, rounded));
        let [x, y, z] = place;
        let narrows = if circle.taper & TAPER_NARROWS == 0 {
            0
        } else {
            POINT_NARROWS
        };
        let high = (circle.taper & !TAPER_NARROWS) >> TAPER_LOW_BITS;
        [
            x | (y << 20),
            (y >> 12) | (z << 8) | narrows,
            circle.radius,
            circle.tangent.0
                | (circle.tangent.1 << 9)
                | (high << 18)
                | (color_keys.index_of(self.color_key(circle.tracing)) << 22),
        ]
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
            if list.len() <= MAX_COLOR_KEYS {
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
