//! The words of a part, written. Their layout: decode.rs.

use std::collections::BTreeMap;

use glam::Vec3;
use neurotess_mesh::Role;

use crate::ball::{ball_around, patch_ball};
use crate::decode::{
    OwnRing, POINT_END, POINT_GOES_ON, POINT_KIND_SHIFT, POINT_LOOSE, POINT_NARROWS,
    POINT_ORDINARY, POINTS_OF_BALL, from_ball, octahedral, radius, signed16, to_ball,
    to_octahedral, to_signed16,
};
use crate::pack::{Contents, PLACES_OF_BALL, Packer, Part, Slot, cap_ring, widened};

/// Most different words of a part's points.
pub(crate) const MOST_WORDS: usize = 1 << 10;

impl Packer<'_> {
    pub(crate) fn write(&self, contents: &Contents) -> Part {
        let mut part = Part::default();
        self.list_patches(contents, &mut part);
        let own = contents.slots.iter().filter_map(|slot| slot.ring);
        let own = own.filter_map(|ring| self.own(ring));
        let words = Words::new(own.map(|own| self.word(own.tracing)));
        let point_of = self.write_points(contents, &words, &mut part);
        self.write_loose(contents, &mut part);
        part.loose.clone_from(&contents.loose);
        self.write_patches(contents, &point_of, &mut part);
        part.places.words = part.heap.len() as u32;
        part.heap.extend(&words.list);
        part
    }

    /// Which patch is where, and the balls around them.
    fn list_patches(&self, contents: &Contents, part: &mut Part) {
        let Contents {
            slots,
            soma,
            quads,
            caps,
            ..
        } = contents;
        let others: Vec<usize> = [soma, quads, caps].into_iter().flatten().copied().collect();
        let places = |slot: &Slot| [0, 1, 2, 3].map(|k| slot.patch.map(|patch| patch + k));
        let all = slots
            .iter()
            .flat_map(places)
            .chain(others.iter().map(|&p| Some(p)));
        part.patches = all
            .map(|patch| patch.map_or(u32::MAX, |p| p as u32))
            .collect();
        part.balls = slots
            .chunks(POINTS_OF_BALL)
            .map(|slots| self.ball(slots))
            .collect();
        part.balls
            .extend(others.chunks(PLACES_OF_BALL).map(|patches| {
                let balls = patches
                    .iter()
                    .map(|&p| patch_ball(self.mesh, &self.mesh.patches[p]));
                widened(ball_around(balls))
            }));
    }

    /// Gives the point of every own ring by the ring's first vertex.
    fn write_points(
        &self,
        contents: &Contents,
        words: &Words,
        part: &mut Part,
    ) -> BTreeMap<u32, u32> {
        let mut point_of = BTreeMap::new();
        for (i, slot) in contents.slots.iter().enumerate() {
            let goes_on = if slot.patch.is_some() {
                POINT_GOES_ON
            } else {
                0
            };
            let own = slot
                .ring
                .and_then(|ring| self.own(ring).map(|own| (ring[0], own)));
            let point = match own {
                Some((first, own)) => {
                    point_of.insert(first, i as u32);
                    let ball = part.balls[i / POINTS_OF_BALL];
                    self.own_point(part, first, &own, ball, goes_on, words)
                }
                None => {
                    let ring = slot.ring.unwrap_or_default();
                    let [a, b, c, d] = ring.map(|v| contents.loose_id(v));
                    let kind = POINT_LOOSE << POINT_KIND_SHIFT;
                    [a | (b << 16), kind | goes_on, c | (d << 16), 0]
                }
            };
            part.heap.extend(point);
        }
        part.places.point_count = contents.slots.len() as u32;
        part.places.balls = part.heap.len() as u32;
        for &(center, radius) in &part.balls {
            let words = center.extend(radius).to_array().map(f32::to_bits);
            part.heap.extend(words);
            // How much edges bend is known when all is rounded: pack.rs.
            part.heap.push(0);
        }
        point_of
    }

    fn write_loose(&self, contents: &Contents, part: &mut Part) {
        part.places.loose = part.heap.len() as u32;
        let anchors = Anchors::new(self, &contents.loose);
        for &v in &contents.loose {
            let (words, position, normal) = anchors.loose(self, v);
            part.heap.extend(words);
            part.vertices.push((v, position, normal));
        }
        part.places.anchors = part.heap.len() as u32;
        anchors.write(self, &mut part.heap, &mut part.tracing);
    }

    fn write_patches(&self, contents: &Contents, point_of: &BTreeMap<u32, u32>, part: &mut Part) {
        let Part { heap, places, .. } = part;
        let corners = |patch: usize| {
            let corners = self.mesh.patches[patch].corners;
            corners.map(|v| contents.loose_id(v))
        };
        places.soma = heap.len() as u32;
        places.soma_count = contents.soma.len() as u32;
        let bits = contents.soma.iter().map(|&patch| {
            let [a, b, c, d] = corners(patch).map(u64::from);
            a | (b << 12) | (c << 24) | (d << 36)
        });
        let halves = bits.flat_map(|bits| [0, 16, 32].map(|shift| (bits >> shift) as u32 & 0xffff));
        let halves: Vec<u32> = halves.collect();
        let pair = |pair: &[u32]| pair[0] | (pair.get(1).copied().unwrap_or(0) << 16);
        heap.extend(halves.chunks(2).map(pair));
        places.quads = heap.len() as u32;
        places.quad_count = contents.quads.len() as u32;
        for &quad in &contents.quads {
            let [a, b, c, d] = corners(quad);
            let kind = self.mesh.patches[quad].kind as u32;
            let (a, b) = (a | ((kind & 1) << 15), b | ((kind >> 1) << 15));
            heap.extend([a | (b << 16), c | (d << 16)]);
        }
        places.caps = heap.len() as u32;
        for &cap in &contents.caps {
            let (first, reversed) = cap_ring(self.mesh.patches[cap].corners).unwrap_or((0, false));
            let point = point_of.get(&first).copied().unwrap_or(0);
            heap.push((point << 1) | u32::from(reversed));
        }
    }

    fn own_point(
        &self,
        part: &mut Part,
        first: u32,
        own: &OwnRing,
        (middle, reach): (Vec3, f32),
        goes_on: u32,
        words: &Words,
    ) -> [u32; 4] {
        let point = &self.mesh.tracing[own.tracing as usize];
        let place = to_ball(middle, reach, point.center);
        let center = from_ball(middle, reach, place);
        for k in 0..4 {
            let (position, normal) = own.corner(center, k);
            part.vertices.push((first + k, position, normal));
        }
        let radius = radius(own.radius);
        part.tracing
            .push((own.tracing, center, radius, own.tangent()));
        let [x, y, z] = place;
        let kind = if own.role == Role::End {
            POINT_END
        } else {
            POINT_ORDINARY
        };
        let (slope, narrows) = own.slope;
        let narrows = if narrows { POINT_NARROWS } else { 0 };
        [
            x | (y << 20),
            (y >> 12) | (z << 8) | goes_on | narrows | (kind << POINT_KIND_SHIFT),
            own.radius | (own.turn << 16) | ((self.level(own.tracing) - 1) << 26),
            own.tangent.0
                | (own.tangent.1 << 9)
                | (slope << 18)
                | (words.place(self.word(own.tracing)) << 22),
        ]
    }
}

impl Contents {
    fn loose_id(&self, v: u32) -> u32 {
        self.loose.binary_search(&v).unwrap_or(0) as u32
    }
}

/// Different words of a part's points.
struct Words {
    list: Vec<u32>,
    dropped: u32,
}

impl Words {
    fn new(all: impl Iterator<Item = u32>) -> Self {
        let mut list: Vec<u32> = all.collect();
        let mut dropped = 0;
        loop {
            list.sort_unstable();
            list.dedup();
            if list.len() <= MOST_WORDS {
                return Self { list, dropped };
            }
            dropped += 1;
            list.iter_mut()
                .for_each(|word| *word = *word >> dropped << dropped);
        }
    }

    fn place(&self, word: u32) -> u32 {
        let word = word >> self.dropped << self.dropped;
        self.list.binary_search(&word).unwrap_or(0) as u32
    }
}

/// What loose vertices are relative to: their tracing points, one for all of a soma.
struct Anchors {
    /// By key: index, tracing point and reach.
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

    fn new(packer: &Packer<'_>, loose: &[u32]) -> Self {
        let mut all = BTreeMap::new();
        for &v in loose {
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

    fn loose(&self, packer: &Packer<'_>, v: u32) -> ([u32; 3], Vec3, Vec3) {
        let vertex = &packer.mesh.vertices[v as usize];
        let (anchor, tracing, reach) = self
            .all
            .get(&Self::key(packer, vertex.tracing))
            .copied()
            .unwrap_or_default();
        let center = packer.mesh.tracing[tracing as usize].center;
        let offset = (vertex.position - center) / reach;
        let [x, y, z] = offset.to_array().map(to_signed16);
        let (nx, ny) = to_octahedral(vertex.normal, 4095.0);
        let position = center + Vec3::new(signed16(x), signed16(y), signed16(z)) * reach;
        let words = [
            x | (y << 16),
            z | (anchor << 16),
            nx | (ny << 12) | (packer.level(vertex.tracing) << 24),
        ];
        (words, position, octahedral(nx, ny, 4095.0))
    }

    fn write(
        &self,
        packer: &Packer<'_>,
        heap: &mut Vec<u32>,
        read: &mut Vec<(u32, Vec3, f32, Vec3)>,
    ) {
        for &(_, tracing, reach) in self.all.values() {
            let point = &packer.mesh.tracing[tracing as usize];
            let (x, y) = to_octahedral(point.tangent, 65535.0);
            heap.extend(point.center.extend(reach).to_array().map(f32::to_bits));
            heap.extend([
                point.radius.to_bits(),
                x | (y << 16),
                point.role as u32,
                packer.word(tracing),
            ]);
            if point.role != Role::Soma {
                let tangent = octahedral(x, y, 65535.0);
                read.push((tracing, point.center, point.radius, tangent));
            }
        }
    }
}
