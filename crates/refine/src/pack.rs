//! The resident form of a coarse mesh, written: what goes to the GPU once. Its layout: decode.rs.
//!
//! A mesh is cut into **parts** where it would not fit. Vertices that two parts or two runs share are
//! loose, and loose vertices keep the mesh's order, so that both sides of every edge have the same bits
//! and run along it in the same direction: no crack opens.

use std::collections::BTreeMap;

use glam::Vec3;
use neurotess_mesh::{CoarseMesh, PatchKind, Role};

use crate::ball::{ball_around, patch_ball};
use crate::decode::{
    LOOSE, OwnRing, POINT_END, POINT_GOES_ON, POINT_KIND_SHIFT, POINT_LOOSE, POINT_NARROWS,
    POINT_ORDINARY, POINTS_OF_BALL, POSITION_STEPS, from_ball, octahedral, signed16, to_ball,
    to_octahedral, to_signed16,
};
use crate::runs::{Run, find_runs, own_ring};

/// Places of patches that a ball is for.
pub const PLACES_OF_BALL: usize = 4 * POINTS_OF_BALL;
/// Most loose vertices of a part: their numbers have 15 bits.
const MOST_LOOSE: usize = 1 << 15;
/// Most different words of a part's points.
const MOST_WORDS: usize = 1 << 10;
/// Largest error of a point's centre, in its radii.
const MOST_CENTER_ERROR: f32 = 0.002;

/// Where the arrays of a part begin in its heap, in words, and how many there are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Places {
    /// Points.
    pub points: u32,
    /// Number of points.
    pub point_count: u32,
    /// Balls.
    pub balls: u32,
    /// Loose vertices.
    pub loose: u32,
    /// Anchors.
    pub anchors: u32,
    /// Loose patches.
    pub quads: u32,
    /// Number of loose patches.
    pub quad_count: u32,
    /// Caps.
    pub caps: u32,
    /// Words.
    pub words: u32,
}

/// A piece of a coarse mesh that fits a device.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Part {
    /// All that is resident.
    pub heap: Vec<u32>,
    /// Where what lies.
    pub places: Places,
    /// By place: the mesh's patch, or `u32::MAX` where there is none.
    pub patches: Vec<u32>,
    /// Ball around each [`PLACES_OF_BALL`] patches, at any level (µm).
    pub balls: Vec<(Vec3, f32)>,
    /// By vertex of the mesh that is in this part: position and normal as shaders read them.
    vertices: Vec<(u32, Vec3, Vec3)>,
    /// By tracing point: centre, radius and tangent as shaders read them.
    tracing: Vec<(u32, Vec3, f32, Vec3)>,
}

impl Part {
    /// Bytes by the name of what they hold.
    pub fn bytes(&self) -> Vec<(&'static str, u64)> {
        let p = &self.places;
        let names = [
            "points",
            "balls",
            "loose_vertices",
            "anchors",
            "loose_patches",
            "caps",
            "words",
        ];
        let starts = [
            p.points, p.balls, p.loose, p.anchors, p.quads, p.caps, p.words,
        ];
        let ends = starts[1..].iter().copied().chain([self.heap.len() as u32]);
        let sizes = starts
            .iter()
            .zip(ends)
            .map(|(start, end)| u64::from(end - start) * 4);
        names.into_iter().zip(sizes).collect()
    }
}

/// Packs a mesh into parts of at most `most_places` places for patches. `words`: one per tracing point
/// for the renderer; `values`: one level per tracing point. Missing ones are 0 and 1.
///
/// A soma has the word of its first vertex. More than 1,024 different words of a part's points lose
/// their lowest bits.
pub fn pack(mesh: &CoarseMesh, words: &[u32], values: &[u8], most_places: usize) -> Vec<Part> {
    let packer = Packer::new(mesh, words, values);
    let piles = packer.piles(most_places.max(4 * PLACES_OF_BALL));
    piles.iter().map(|pile| packer.part(pile)).collect()
}

/// The mesh as shaders read it: the same patches, with positions, radii and directions rounded.
pub fn dequantized(mesh: &CoarseMesh, parts: &[Part]) -> CoarseMesh {
    let mut rounded = mesh.clone();
    for part in parts {
        for &(vertex, position, normal) in &part.vertices {
            let vertex = &mut rounded.vertices[vertex as usize];
            (vertex.position, vertex.normal) = (position, normal);
        }
        for &(point, center, radius, tangent) in &part.tracing {
            let point = &mut rounded.tracing[point as usize];
            (point.center, point.radius, point.tangent) = (center, radius, tangent);
        }
    }
    rounded
}

/// What goes into one part.
#[derive(Default)]
struct Pile {
    runs: Vec<usize>,
    others: Vec<usize>,
}

struct Packer<'m> {
    mesh: &'m CoarseMesh,
    words: &'m [u32],
    values: &'m [u8],
    runs: Vec<Run>,
    others: Vec<usize>,
    /// By vertex.
    loose: Vec<bool>,
}

impl<'m> Packer<'m> {
    fn new(mesh: &'m CoarseMesh, words: &'m [u32], values: &'m [u8]) -> Self {
        let (runs, others) = find_runs(mesh);
        let mut packer = Self {
            mesh,
            words,
            values,
            runs,
            others,
            loose: vec![false; mesh.vertices.len()],
        };
        packer.find_loose();
        packer
    }

    /// A ring is its own if it is a circle, in one run only, and otherwise in its cap at most.
    fn find_loose(&mut self) {
        let mut uses = vec![0_u8; self.mesh.vertices.len()];
        for ring in self.runs.iter().flat_map(|run| &run.rings) {
            for &v in ring {
                uses[v as usize] = uses[v as usize].saturating_add(1);
            }
        }
        let mut at_end = vec![false; self.mesh.vertices.len()];
        for run in &self.runs {
            at_end[run.rings[0][0] as usize] = true;
            at_end[run.rings[run.rings.len() - 1][0] as usize] = true;
        }
        for &other in &self.others {
            let patch = &self.mesh.patches[other];
            let ring = cap_ring(patch.corners).filter(|&(first, _)| at_end[first as usize]);
            let plain = patch.kind == PatchKind::Cap && ring.is_some();
            for v in patch.corners {
                self.loose[v as usize] |= !plain || uses[v as usize] != 1;
            }
        }
        for run in &self.runs {
            for &ring in &run.rings {
                let own = own_ring(self.mesh, ring).is_some();
                let shared = ring
                    .iter()
                    .any(|&v| uses[v as usize] != 1 || self.loose[v as usize]);
                if !own || shared {
                    ring.iter().for_each(|&v| self.loose[v as usize] = true);
                }
            }
        }
        // In the worst of cases a ball holds points of two runs at the mesh's two ends.
        let reach = |run: &Run| {
            let centers = run.rings.iter().map(|ring| (self.center(ring[0]), 0.0));
            ball_around(centers)
        };
        let whole = ball_around(self.runs.iter().map(reach)).1;
        let near = self.runs.iter().any(|run| {
            let mut rings = run
                .rings
                .iter()
                .filter(|ring| !self.loose[ring[0] as usize]);
            rings.any(|ring| !accurate(whole * 1.5, self.radius(ring[0])))
        });
        if near {
            self.loosen_inaccurate();
        }
    }

    /// Makes loose what the ball that it would be in is too large for.
    fn loosen_inaccurate(&mut self) {
        loop {
            let mut found = Vec::new();
            for pile in self.piles(usize::MAX) {
                let rings = self.rings(&pile);
                for chunk in rings.chunks(POINTS_OF_BALL) {
                    let radius = self.ball(chunk).1;
                    let own = chunk.iter().filter_map(|slot| slot.ring);
                    let own = own.filter(|ring| !self.loose[ring[0] as usize]);
                    found.extend(own.filter(|ring| !accurate(radius, self.radius(ring[0]))));
                }
            }
            if found.is_empty() {
                return;
            }
            for ring in found {
                ring.iter().for_each(|&v| self.loose[v as usize] = true);
            }
        }
    }

    fn center(&self, vertex: u32) -> Vec3 {
        self.mesh.tracing[self.mesh.vertices[vertex as usize].tracing as usize].center
    }

    fn radius(&self, vertex: u32) -> f32 {
        self.mesh.tracing[self.mesh.vertices[vertex as usize].tracing as usize].radius
    }

    /// Runs and other patches by part, in the mesh's order.
    fn piles(&self, most_places: usize) -> Vec<Pile> {
        let mut piles = vec![Pile::default()];
        let (mut places, mut loose) = (PLACES_OF_BALL, 0);
        let mut room = |piles: &mut Vec<Pile>, more_places: usize, more_loose: usize| {
            places += more_places;
            loose += more_loose;
            if places > most_places || loose > MOST_LOOSE {
                piles.push(Pile::default());
                (places, loose) = (PLACES_OF_BALL + more_places, more_loose);
            }
            piles.len() - 1
        };
        for (i, run) in self.runs.iter().enumerate() {
            let used = run.rings.iter().filter(|ring| self.loose[ring[0] as usize]);
            let pile = room(&mut piles, 4 * run.rings.len(), 4 * used.count());
            piles[pile].runs.push(i);
        }
        for &other in &self.others {
            let corners = self.mesh.patches[other].corners;
            if self.loose[corners[0] as usize] {
                let pile = room(&mut piles, 1, 4);
                piles[pile].others.push(other);
            }
        }
        // A cap of an own ring goes where its ring is.
        let mut owner = BTreeMap::new();
        for (p, pile) in piles.iter().enumerate() {
            for &run in &pile.runs {
                let rings = &self.runs[run].rings;
                for ring in [rings[0], rings[rings.len() - 1]] {
                    owner.insert(ring[0], p);
                }
            }
        }
        for &other in &self.others {
            let corners = self.mesh.patches[other].corners;
            if !self.loose[corners[0] as usize] {
                let first = corners.into_iter().min().unwrap_or(0);
                if let Some(&pile) = owner.get(&first) {
                    piles[pile].others.push(other);
                }
            }
        }
        piles.retain(|pile| !pile.runs.is_empty() || !pile.others.is_empty());
        piles
    }

    /// The rings of a pile, one after the other, with the patches that lead on.
    fn rings(&self, pile: &Pile) -> Vec<Slot> {
        let mut slots = Vec::new();
        for run in pile.runs.iter().map(|&run| &self.runs[run]) {
            for (i, &ring) in run.rings.iter().enumerate() {
                let goes_on = i + 1 < run.rings.len();
                slots.push(Slot {
                    ring: Some(ring),
                    patch: goes_on.then_some(run.first_patch + 4 * i),
                });
            }
        }
        slots.resize(
            slots.len().next_multiple_of(POINTS_OF_BALL),
            Slot::default(),
        );
        slots
    }

    fn ball(&self, slots: &[Slot]) -> (Vec3, f32) {
        let patches = slots
            .iter()
            .filter_map(|slot| slot.patch)
            .flat_map(|patch| patch..patch + 4);
        let patches = patches.map(|patch| patch_ball(self.mesh, &self.mesh.patches[patch]));
        let centers = slots.iter().filter_map(|slot| slot.ring);
        let centers = centers.map(|ring| (self.center(ring[0]), 0.0));
        widened(ball_around(patches.chain(centers)))
    }

    fn part(&self, pile: &Pile) -> Part {
        let slots = self.rings(pile);
        let (quads, caps): (Vec<usize>, Vec<usize>) = pile
            .others
            .iter()
            .partition(|&&other| self.loose[self.mesh.patches[other].corners[0] as usize]);
        let mut part = Part::default();
        let places = |slot: &Slot| [0, 1, 2, 3].map(|k| slot.patch.map(|patch| patch + k));
        let all = slots
            .iter()
            .flat_map(places)
            .chain(quads.iter().chain(&caps).map(|&p| Some(p)));
        part.patches = all
            .map(|patch| patch.map_or(u32::MAX, |p| p as u32))
            .collect();
        part.balls = slots
            .chunks(POINTS_OF_BALL)
            .map(|slots| self.ball(slots))
            .collect();
        let others: Vec<usize> = quads.iter().chain(&caps).copied().collect();
        part.balls
            .extend(others.chunks(PLACES_OF_BALL).map(|patches| {
                let balls = patches
                    .iter()
                    .map(|&p| patch_ball(self.mesh, &self.mesh.patches[p]));
                widened(ball_around(balls))
            }));
        self.write(&mut part, &slots, &quads, &caps);
        part
    }

    fn write(&self, part: &mut Part, slots: &[Slot], quads: &[usize], caps: &[usize]) {
        let rings = slots.iter().filter_map(|slot| slot.ring);
        let in_quads = quads
            .iter()
            .flat_map(|&quad| self.mesh.patches[quad].corners);
        let mut loose: Vec<u32> = rings.flatten().chain(in_quads).collect();
        loose.retain(|&v| self.loose[v as usize]);
        loose.sort_unstable();
        loose.dedup();
        let loose_id = |v: u32| loose.binary_search(&v).unwrap_or(0) as u32;
        let own = slots
            .iter()
            .filter_map(|slot| slot.ring)
            .filter_map(|ring| self.own(ring));
        let words = Words::new(own.map(|own| self.word(own.tracing)));
        let mut heap = Vec::new();
        let mut point_of = BTreeMap::new();
        for (i, slot) in slots.iter().enumerate() {
            let goes_on = if slot.patch.is_some() {
                POINT_GOES_ON
            } else {
                0
            };
            let own = slot
                .ring
                .and_then(|ring| self.own(ring).map(|own| (ring, own)));
            if let Some((ring, own)) = own {
                point_of.insert(ring[0], i as u32);
                let ball = part.balls[i / POINTS_OF_BALL];
                heap.extend(self.own_point(part, ring[0], &own, ball, goes_on, &words));
            } else {
                let [a, b, c, d] = slot.ring.map_or([0; 4], |ring| ring.map(loose_id));
                let kind = POINT_LOOSE << POINT_KIND_SHIFT;
                heap.extend([a | (b << 16), kind | goes_on, c | (d << 16), 0]);
            }
        }
        let places = &mut part.places;
        places.point_count = slots.len() as u32;
        places.balls = heap.len() as u32;
        for &(center, radius) in &part.balls {
            heap.extend(center.extend(radius).to_array().map(f32::to_bits));
        }
        places.loose = heap.len() as u32;
        let anchors = Anchors::new(self, &loose);
        for &v in &loose {
            let (words, position, normal) = anchors.loose(self, v);
            heap.extend(words);
            part.vertices.push((v, position, normal));
        }
        places.anchors = heap.len() as u32;
        anchors.write(self, &mut heap, &mut part.tracing);
        places.quads = heap.len() as u32;
        places.quad_count = quads.len() as u32;
        for patch in quads.iter().map(|&quad| &self.mesh.patches[quad]) {
            let [a, b, c, d] = patch.corners.map(loose_id);
            let kind = patch.kind as u32;
            let (a, b) = (a | ((kind & 1) << 15), b | ((kind >> 1) << 15));
            heap.extend([a | (b << 16), c | (d << 16)]);
        }
        places.caps = heap.len() as u32;
        for &cap in caps {
            let (first, reversed) = cap_ring(self.mesh.patches[cap].corners).unwrap_or((0, false));
            let point = point_of.get(&first).copied().unwrap_or(0);
            heap.push((point << 1) | u32::from(reversed));
        }
        places.words = heap.len() as u32;
        heap.extend(&words.list);
        part.heap = heap;
    }

    fn own(&self, ring: [u32; 4]) -> Option<OwnRing> {
        let own = !self.loose[ring[0] as usize];
        own.then(|| own_ring(self.mesh, ring)).flatten()
    }

    fn word(&self, tracing: u32) -> u32 {
        self.words.get(tracing as usize).copied().unwrap_or(0)
    }

    fn level(&self, tracing: u32) -> u32 {
        let value = self.values.get(tracing as usize).copied().unwrap_or(1);
        u32::from(value.clamp(1, 64))
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
        let radius = crate::decode::radius(own.radius);
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

/// Place for a point: its ring, and the first of the patches that lead on.
#[derive(Clone, Copy, Debug, Default)]
struct Slot {
    ring: Option<[u32; 4]>,
    patch: Option<usize>,
}

/// First vertex of the ring that a cap closes, and whether it runs the other way round.
fn cap_ring(corners: [u32; 4]) -> Option<(u32, bool)> {
    let first = corners.into_iter().min()?;
    let forwards = [0, 1, 2, 3].map(|k| first + k);
    let backwards = [3, 2, 1, 0].map(|k| first + k);
    match corners {
        c if c == forwards => Some((first, false)),
        c if c == backwards => Some((first, true)),
        _ => None,
    }
}

/// Whether a ball is small enough for a point of this radius.
fn accurate(ball: f32, radius: f32) -> bool {
    // Half a step in each of three directions.
    ball / POSITION_STEPS * 1.74 <= MOST_CENTER_ERROR * radius
}

/// Room for what rounding moves.
fn widened((center, radius): (Vec3, f32)) -> (Vec3, f32) {
    (center, radius * 1.01 + 1e-6)
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

const _: () = assert!(LOOSE == 1 << 31 && MOST_LOOSE <= 1 << 15);
