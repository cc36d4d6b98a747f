//! From a coarse mesh to its proxy.

use std::ops::Range;

use glam::Vec3;
use neurotess_mesh::{CoarseMesh, Role};

use super::layout::{
    CHUNK_FREE_END, CHUNK_FREE_START, CHUNK_TWIG, Chunk, LEVELS, LONGEST_TWIG, MAX_SEGMENTS,
    MAX_SWAY, NO_LOD,
};
use super::nested::simplify;
use super::paths::{PathPoint, TubePath, tube_paths};
use super::proxy::Proxy;
use super::quantized::{
    STEPS, error_byte, grid, packed, packed_bytes, packed_direction, sphere, u32s_of,
};
use super::somata;

impl Proxy {
    /// The proxy of a mesh. `color_keys`: one per tracing point, for the shading; missing ones are
    /// 0.
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
            let count = segments.div_ceil(MAX_SEGMENTS);
            let cut = |index: usize| index * segments / count;
            for index in 0..count {
                let (from, to) = (cut(index), cut(index + 1));
                let mut flags = 0;
                if index == 0 && path.starts_free {
                    flags |= CHUNK_FREE_START;
                }
                if index + 1 == count {
                    flags |= CHUNK_FREE_END;
                }
                carriers.add(&path, from..to, proxy.chunks.len());
                proxy.add_chunk(&path.points[from..=to], &directions[from..=to], flags);
            }
        }
        carriers.carry(&mut proxy.chunks);
        carriers.mark_twigs(&mut proxy.chunks);
        proxy.sort();
        proxy.set_color_keys(color_keys);
        (proxy.center, proxy.reach) = sphere_around(&proxy.chunks);
        proxy
    }

    /// Adds a chunk with these points: simplifies them and packs all its polylines.
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
        let (low, step) = grid(tube.iter().map(|p| p.0));
        let first = self.packed.len() as u32;
        for &(center, r) in &tube {
            let share = r / radius.max(f32::MIN_POSITIVE);
            self.packed
                .extend(packed(center, low, step, (share * STEPS).round() as u32));
        }
        self.packed.extend(packed_bytes(lists));
        let spheres = tube.iter().map(|&(center, r)| (center, r + sway));
        let (center, reach) = sphere(spheres);
        self.push(
            Chunk {
                center: center.to_array(),
                reach,
                low: low.to_array(),
                step,
                counts: u32s_of(counts),
                errors: u32s_of(errors),
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
}

/// From which chunk each chunk starts: its carrier.
struct Carriers {
    /// By tracing point: the chunk that leads to it.
    chunk_of: Vec<usize>,
    /// By chunk: its carrier, or `usize::MAX`.
    carriers: Vec<usize>,
    /// By chunk: whether it begins at a fork.
    forks: Vec<bool>,
}

impl Carriers {
    /// No chunks yet but those of somata, which neither have nor are carriers.
    fn new(mesh: &CoarseMesh, somata: usize) -> Self {
        Self {
            chunk_of: vec![usize::MAX; mesh.tracing.len()],
            carriers: vec![usize::MAX; somata],
            forks: vec![false; somata],
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
        self.forks.push(segments.start == 0 && path.fork.is_some());
        for point in &path.points[segments.start + 1..=segments.end] {
            self.chunk_of[point.tracing as usize] = chunk;
        }
    }

    /// Marks chunks that are twigs, and notes them in those that they leave.
    fn mark_twigs(&self, chunks: &mut [Chunk]) {
        let mut carries = vec![false; chunks.len()];
        for &carrier in &self.carriers {
            if let Some(carries) = carries.get_mut(carrier) {
                *carries = true;
            }
        }
        let mut twigs = vec![Twigs::default(); chunks.len()];
        for (index, &carrier) in self.carriers.iter().enumerate() {
            let inside = chunks.get(carrier).map_or(0.0, Chunk::mean);
            let chunk = &mut chunks[index];
            let ends = !carries[index] && chunk.length <= LONGEST_TWIG;
            // What goes on from the chunk before is the end of a long branch.
            let Some(of) = twigs.get_mut(carrier).filter(|_| ends && self.forks[index]) else {
                continue;
            };
            chunk.flags |= CHUNK_TWIG;
            of.count += 1;
            of.length += chunk.length;
            of.area += TWIG_INK * 2.0 * chunk.mean() * (chunk.length - inside).max(0.0);
        }
        for (chunk, twigs) in chunks.iter_mut().zip(twigs) {
            if twigs.count > 0 {
                chunk.note_twigs(twigs.count, twigs.length, twigs.area);
            }
        }
    }

    /// Gives every chunk the greatest `carried` of the chunks behind it.
    fn carry(&self, chunks: &mut [Chunk]) {
        for chunk in (0..chunks.len()).rev() {
            let carried = chunks[chunk].carried;
            if let Some(carrier) = chunks.get_mut(self.carriers[chunk]) {
                carrier.carried = carrier.carried.max(carried);
            }
        }
    }
}

/// Share of twigs' area that their ink amounts to: others lie before or behind the chunk, or are seen from their ends.
/// Of 1, 0.45 and 0.25, the one with which the ink of a spiny cell changes least (`far_spines_cost_nothing…`).
const TWIG_INK: f32 = 0.25;

/// Twigs that leave a chunk.
#[derive(Clone, Copy, Default)]
struct Twigs {
    count: u32,
    /// Of all together (µm, and µm² as seen from the side).
    length: f32,
    area: f32,
}

/// Unit direction of a path at each of its points: the mean of those of the segments before and
/// after.
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

/// Greatest distance (µm) of the curved path from the straight one.
fn sway(tube: &[(Vec3, f32)], directions: &[Vec3]) -> f32 {
    let of = |i: usize| {
        let way = tube[i + 1].0 - tube[i].0;
        let along = way.normalize_or_zero();
        let across = |d: Vec3| (d - along * d.dot(along)).length() * way.length() * (4.0 / 27.0);
        let most = MAX_SWAY * tube[i].1.min(tube[i + 1].1);
        across(directions[i]).min(most) + across(directions[i + 1]).min(most)
    };
    (0..tube.len() - 1).map(of).fold(0.0, f32::max)
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
