//! What exploration keeps of a coarse mesh: chunks of its paths with simplified lods, and its somata.
//!
//! A **chunk** is up to 64 segments of a path: what is culled, chosen and listed as one. Its positions
//! and radii are counted in 65,535 steps of its own extent: 8 bytes a point, and a byte for each
//! point of a simplified lod, at most one a point in all.

use std::ops::Range;

use glam::{DVec3, Vec2, Vec3};
use neurotess_mesh::{CoarseMesh, Role};

use super::layout::{
    CHUNK_FREE_END, CHUNK_FREE_START, CHUNK_ONE_COLOR_KEY, Chunk, ERROR_OFFSET, ERROR_STEPS,
    LEVELS, MOST_SEGMENTS, MOST_SWAY, NO_LOD,
};
use super::nested::simplify;
use super::paths::{PathPoint, TubePath, tube_paths};
use super::somata;
use crate::view::framing::BoundingSphere;

/// Steps of a stored coordinate.
const STEPS: f32 = 65_535.0;

/// A template for exploration, made on the host, ready to be uploaded.
#[derive(Clone, Debug, Default)]
pub struct Proxy {
    pub(crate) origin: DVec3,
    pub(crate) chunks: Vec<Chunk>,
    pub(crate) packed: Vec<u32>,
    pub(crate) color_keys: Vec<u32>,
    /// By chunk: tracing points that its color keys are of.
    pub(super) colors: Vec<Vec<u32>>,
    pub(crate) center: Vec3,
    pub(crate) reach: f32,
    points: usize,
}

impl Proxy {
    /// Sketches a mesh. `color_keys`: one per tracing point for whoever shades; missing ones are 0.
    pub fn new(mesh: &CoarseMesh, color_keys: &[u32]) -> Self {
        let mut proxy = Self {
            origin: mesh.origin,
            points: mesh
                .tracing
                .iter()
                .filter(|point| point.role != Role::Soma)
                .count(),
            ..Self::default()
        };
        somata::add(&mut proxy, mesh);
        let mut carriers = Carriers::new(mesh, proxy.chunks.len());
        for path in tube_paths(mesh) {
            let directions = directions(&path.points);
            let segments = path.points.len() - 1;
            let visible_chunks = segments.div_ceil(MOST_SEGMENTS);
            let cut = |visible_chunk: usize| visible_chunk * segments / visible_chunks;
            for visible_chunk in 0..visible_chunks {
                let (from, to) = (cut(visible_chunk), cut(visible_chunk + 1));
                let mut flags = 0;
                if visible_chunk == 0 && path.starts_free {
                    flags |= CHUNK_FREE_START;
                }
                if visible_chunk + 1 == visible_chunks {
                    flags |= CHUNK_FREE_END;
                }
                carriers.add(&path, from..to, proxy.chunks.len());
                proxy.add_chunk(&path.points[from..=to], &directions[from..=to], flags);
            }
        }
        carriers.carry(&mut proxy.chunks);
        proxy.set_color_keys(color_keys);
        (proxy.center, proxy.reach) = sphere_around(&proxy.chunks);
        proxy
    }

    /// Other colors: color keys of the tracing points of the mesh that it was made of.
    pub fn set_color_keys(&mut self, color_keys: &[u32]) {
        self.color_keys.clear();
        for (chunk, colors) in self.chunks.iter_mut().zip(&self.colors) {
            let color_key = |&tracing: &u32| color_keys.get(tracing as usize).copied().unwrap_or(0);
            let first = colors.first().map_or(0, color_key);
            if colors.iter().all(|tracing| color_key(tracing) == first) {
                chunk.flags |= CHUNK_ONE_COLOR_KEY;
                chunk.color_keys = first;
            } else {
                chunk.flags &= !CHUNK_ONE_COLOR_KEY;
                chunk.color_keys = self.color_keys.len() as u32;
                self.color_keys.extend(colors.iter().map(color_key));
            }
        }
    }

    /// Number of tracing points, those of somata aside.
    pub fn point_count(&self) -> usize {
        self.points
    }

    /// BoundingSphere around all of it, in the tracing's own coordinates (µm).
    pub fn sphere(&self) -> BoundingSphere {
        (self.origin + self.center.as_dvec3(), f64::from(self.reach))
    }

    /// Balls that together hold all of it, in the tracing's own coordinates (µm): one for each chunk.
    pub fn spheres(&self) -> Vec<BoundingSphere> {
        let sphere = |chunk: &Chunk| {
            let center = Vec3::from_array(chunk.center).as_dvec3();
            (self.origin + center, f64::from(chunk.reach))
        };
        self.chunks.iter().map(sphere).collect()
    }

    /// Bytes on the device.
    pub fn bytes(&self) -> u64 {
        (size_of_val(&*self.chunks) + size_of_val(&*self.packed) + size_of_val(&*self.color_keys))
            as u64
    }

    /// Adds a chunk whose points and simplified lods are packed here.
    fn add_chunk(&mut self, points: &[PathPoint], directions: &[Vec3], flags: u32) {
        let tube: Vec<(Vec3, f32)> = points.iter().map(|p| (p.center, p.radius)).collect();
        let length: f32 = tube.windows(2).map(|w| w[0].0.distance(w[1].0)).sum();
        let radius = tube.iter().map(|p| p.1).fold(0.0, f32::max);
        let mean = tube.iter().map(|p| p.1).sum::<f32>() / tube.len() as f32;
        let sway = sway(&tube, directions);
        let mut counts = [0_u8; 8];
        let mut errors = [NO_LOD; 8];
        counts[0] = (points.len() - 1) as u8;
        errors[0] = error_byte(sway);
        let mut lists: Vec<u8> = Vec::new();
        for (k, lod) in (1..LEVELS).zip(simplify(&tube)) {
            let Some(lod) = lod else { continue };
            counts[k] = (lod.kept.len() - 1) as u8;
            errors[k] = error_byte(lod.error + sway);
            lists.extend(lod.kept);
        }
        lists.resize(lists.len().next_multiple_of(4), 0);
        let (low, step) = grid(tube.iter().map(|p| p.0));
        let first = self.packed.len() as u32;
        for &(center, r) in &tube {
            let share = r / radius.max(f32::MIN_POSITIVE);
            self.packed
                .extend(packed(center, low, step, (share * STEPS).round() as u32));
        }
        self.packed.extend(
            lists
                .chunks_exact(4)
                .map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])),
        );
        let spheres = tube.iter().map(|&(center, r)| (center, r + sway));
        let (center, reach) = sphere(spheres);
        self.push(
            Chunk {
                center: center.to_array(),
                reach,
                low: low.to_array(),
                step,
                counts: color_keys_of(counts),
                errors: color_keys_of(errors),
                first,
                flags: Chunk::marks(flags, mean, radius),
                radius,
                length,
                carried: length * mean.sqrt(),
                start: packed_direction(directions[0]),
                end: packed_direction(directions[directions.len() - 1]),
                ..Chunk::default()
            },
            points.iter().map(|p| p.tracing).collect(),
        );
    }

    /// Adds a chunk with the tracing points that color it.
    pub(super) fn push(&mut self, chunk: Chunk, colors: Vec<u32>) {
        self.chunks.push(chunk);
        self.colors.push(colors);
    }
}

/// Which chunk hangs on which.
struct Carriers {
    /// By tracing point: the chunk that leads to it.
    chunk_of: Vec<usize>,
    /// By chunk: the one that it hangs on.
    carriers: Vec<usize>,
}

impl Carriers {
    /// Somata carry nothing, and nothing them.
    fn new(mesh: &CoarseMesh, somata: usize) -> Self {
        Self {
            chunk_of: vec![usize::MAX; mesh.tracing.len()],
            carriers: vec![usize::MAX; somata],
        }
    }

    /// Adds the chunk of some segments of a path. Paths come after those that they start from.
    fn add(&mut self, path: &TubePath, segments: Range<usize>, chunk: usize) {
        let start = match segments.start {
            0 => path.fork,
            first => Some(path.points[first].tracing),
        };
        let carrier = start.map_or(usize::MAX, |point| self.chunk_of[point as usize]);
        self.carriers.push(carrier);
        for point in &path.points[segments.start + 1..=segments.end] {
            self.chunk_of[point.tracing as usize] = chunk;
        }
    }

    /// Gives every chunk the greatest worth of what hangs on it.
    fn carry(&self, chunks: &mut [Chunk]) {
        for chunk in (0..chunks.len()).rev() {
            let carried = chunks[chunk].carried;
            if let Some(carrier) = chunks.get_mut(self.carriers[chunk]) {
                carrier.carried = carrier.carried.max(carried);
            }
        }
    }
}

/// A chunk whose packed buffer and color keys begin elsewhere.
pub(super) fn moved(chunk: &Chunk, (packed, color_keys): (usize, usize)) -> Chunk {
    let mut chunk = *chunk;
    chunk.first += packed as u32;
    if chunk.flags & CHUNK_ONE_COLOR_KEY == 0 {
        chunk.color_keys += color_keys as u32;
    }
    chunk
}

/// Unit direction of a path at each of its points: between those of the segments before and after.
fn directions(points: &[PathPoint]) -> Vec<Vec3> {
    let way = |i: usize| (points[i + 1].center - points[i].center).normalize_or_zero();
    let last = points.len() - 1;
    (0..=last)
        .map(|i| {
            let before = if i == 0 { Vec3::ZERO } else { way(i - 1) };
            let after = if i == last { Vec3::ZERO } else { way(i) };
            (before + after).normalize_or(before.normalize_or(Vec3::X))
        })
        .collect()
}

/// How far (µm) the curved path is from the straight one at most.
fn sway(tube: &[(Vec3, f32)], directions: &[Vec3]) -> f32 {
    let of = |i: usize| {
        let way = tube[i + 1].0 - tube[i].0;
        let along = way.normalize_or_zero();
        let across = |d: Vec3| (d - along * d.dot(along)).length() * way.length() * (4.0 / 27.0);
        let most = MOST_SWAY * tube[i].1.min(tube[i + 1].1);
        across(directions[i]).min(most) + across(directions[i + 1]).min(most)
    };
    (0..tube.len() - 1).map(of).fold(0.0, f32::max)
}

/// Rounded up, so that no error is understated.
fn error_byte(error: f32) -> u8 {
    if error <= 0.0 {
        return 0;
    }
    let step = ((error.log2() + ERROR_OFFSET) * ERROR_STEPS).ceil();
    step.clamp(1.0, f32::from(NO_LOD - 1)) as u8
}

fn color_keys_of(bytes: [u8; 8]) -> [u32; 2] {
    let [a, b, c, d, e, f, g, h] = bytes;
    [[a, b, c, d], [e, f, g, h]].map(u32::from_le_bytes)
}

/// What positions are counted from, and in steps of.
pub(super) fn grid(positions: impl Iterator<Item = Vec3> + Clone) -> (Vec3, f32) {
    let low = positions.clone().fold(Vec3::MAX, Vec3::min);
    let high = positions.fold(Vec3::MIN, Vec3::max);
    let extent = (high - low).max_element();
    (low, (extent / STEPS).max(1e-9))
}

/// A position in steps, and 16 bits more.
pub(super) fn packed(position: Vec3, low: Vec3, step: f32, more: u32) -> [u32; 2] {
    let [x, y, z] = ((position - low) / step)
        .round()
        .clamp(Vec3::ZERO, Vec3::splat(STEPS))
        .to_array()
        .map(|v| v as u32);
    [x | (y << 16), z | (more << 16)]
}

/// A unit vector in two times 16 bits.
pub(super) fn packed_direction(v: Vec3) -> u32 {
    let p = octahedral(v);
    let whole = |x: f32| u32::from((x * 32_767.0).round() as i16 as u16);
    whole(p.x) | (whole(p.y) << 16)
}

/// Place of a unit vector on an unfolded octahedron (Meyer et al., On floating-point normal vectors,
/// 2010), −1 to 1.
pub(super) fn octahedral(v: Vec3) -> Vec2 {
    let size = v.abs().element_sum();
    if size <= 0.0 {
        return Vec2::ZERO;
    }
    let p = v.truncate() / size;
    if v.z >= 0.0 {
        return p;
    }
    let sign = |x: f32| if x >= 0.0 { 1.0 } else { -1.0 };
    Vec2::new((1.0 - p.y.abs()) * sign(p.x), (1.0 - p.x.abs()) * sign(p.y))
}

/// A sphere that holds spheres: around the middle of their box.
pub(super) fn sphere(spheres: impl Iterator<Item = (Vec3, f32)> + Clone) -> (Vec3, f32) {
    let low = spheres
        .clone()
        .map(|(c, r)| c - r)
        .fold(Vec3::MAX, Vec3::min);
    let high = spheres
        .clone()
        .map(|(c, r)| c + r)
        .fold(Vec3::MIN, Vec3::max);
    let center = (low + high) / 2.0;
    let reach = spheres
        .map(|(c, r)| c.distance(center) + r)
        .fold(0.0, f32::max);
    // Positions are stored rounded.
    (center, reach * 1.0001)
}

fn sphere_around(chunks: &[Chunk]) -> (Vec3, f32) {
    if chunks.is_empty() {
        return (Vec3::ZERO, 0.0);
    }
    sphere(
        chunks
            .iter()
            .map(|chunk| (Vec3::from_array(chunk.center), chunk.reach)),
    )
}
