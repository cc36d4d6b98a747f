//! Proxies with fewer points, for scenes that do not fit the device as a whole.
//!
//! **Theory.** A chunk is stored as nested polylines (nested.rs), of which a picture draws the coarsest that is within
//! half a pixel. Without its finest polylines a chunk takes a fraction of the memory, and where the picture wants none of
//! those it is drawn as before, to the bit: kept points have the same coordinates, coarser polylines the same points and
//! errors.

use crate::sources::budgeted::buffers::Counts;
use crate::sources::budgeted::layout::{
    CHUNK_ONE_COLOR_KEY, CHUNK_SOMA, Chunk, LEVELS, MAX_SEGMENTS, NO_LOD,
};
use crate::sources::budgeted::proxy::Proxy;
use crate::sources::budgeted::quantized::{bytes_of, error_of, packed_bytes, u32s_of};

/// How much of a proxy is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Detail {
    /// Most chunks: those that carry most.
    pub(super) chunks: usize,
    /// Most segments of a chunk.
    pub(super) segments: usize,
}

/// A soma is drawn by its mesh if its radius is above so many pixels.
const SOMA_MESH_PIXELS: f32 = 6.0;
/// Half a pixel: the error of everything that is drawn as finely as it shows.
const HALF_PIXEL: f32 = 0.5;

impl Detail {
    /// All that there is.
    pub(super) const FULL: Self = Self::of_all(MAX_SEGMENTS);

    /// All chunks, with at most so many segments each.
    pub(super) const fn of_all(segments: usize) -> Self {
        Self {
            chunks: usize::MAX,
            segments,
        }
    }

    /// The chunks that are kept.
    fn kept(self, proxy: &Proxy) -> &[Chunk] {
        &proxy.chunks[..self.chunks.min(proxy.chunks.len())]
    }

    /// The polyline of a chunk that becomes its finest one; none of a soma's mesh.
    fn finest(self, chunk: &Chunk) -> Option<usize> {
        let full = self.segments >= MAX_SEGMENTS;
        match chunk.flags & CHUNK_SOMA {
            0 if full => Some(0),
            0 => {
                let counts = bytes_of(chunk.counts);
                let fits = |&level: &usize| (1..=self.segments).contains(&counts[level].into());
                Some((0..LEVELS).find(fits).unwrap_or(0))
            }
            _ => full.then_some(0),
        }
    }

    /// The greatest distance (µm) of what is left from what there was. A picture in which a pixel is at least twice as
    /// large is the same to the bit.
    pub(super) fn error(self, proxy: &Proxy) -> f32 {
        let kept = self.kept(proxy);
        let left_out = proxy.chunks[kept.len()..].iter();
        let of_kept = kept.iter().map(|chunk| match self.finest(chunk) {
            None => chunk.radius / SOMA_MESH_PIXELS * HALF_PIXEL,
            Some(0) => 0.0,
            Some(level) => error_of(bytes_of(chunk.errors)[level]),
        });
        let of_others = left_out.map(|chunk| 2.0 * chunk.reach);
        of_kept.chain(of_others).fold(0.0, f32::max)
    }

    /// Elements that are left of a proxy.
    pub(super) fn counts(self, proxy: &Proxy) -> Counts {
        let kept = self.kept(proxy);
        let mut counts = Counts {
            chunks: kept.len() as u64,
            ..Counts::default()
        };
        for chunk in kept {
            let finest = self.finest(chunk);
            counts.packed += u32s(chunk, finest) as u64;
            if chunk.flags & CHUNK_ONE_COLOR_KEY == 0 {
                counts.color_keys += points(chunk, finest.unwrap_or(0)) as u64;
            }
        }
        counts
    }

    /// Which of all points of a chunk the points of its finest polyline are; none if they are all.
    fn points(self, proxy: &Proxy, chunk: &Chunk) -> Option<Vec<u8>> {
        let level = self.finest(chunk).filter(|&level| level > 0)?;
        Some(list(proxy, chunk, level).collect())
    }

    /// Which of all points of a chunk a point of the reduced chunk is.
    pub(super) fn point(self, proxy: &Proxy, chunk: usize, point: usize) -> usize {
        let points = proxy
            .chunks
            .get(chunk)
            .and_then(|chunk| self.points(proxy, chunk));
        let kept = points.and_then(|points| points.get(point).copied());
        kept.map_or(point, usize::from)
    }
}

/// A proxy with this much detail, to be uploaded: it has colors, but no longer knows which tracing points have them.
pub(super) fn reduced(proxy: &Proxy, detail: Detail) -> Proxy {
    let mut less = Proxy {
        origin: proxy.origin,
        center: proxy.center,
        reach: proxy.reach,
        points: proxy.points,
        ..Proxy::default()
    };
    for chunk in detail.kept(proxy) {
        let mut kept = *chunk;
        kept.first = less.packed.len() as u32;
        match detail.finest(chunk) {
            None => kept.counts[0] = 0,
            Some(0) => {
                let own = chunk.first as usize..chunk.first as usize + u32s(chunk, Some(0));
                less.packed.extend(&proxy.packed[own]);
            }
            Some(level) => {
                let points: Vec<u8> = list(proxy, chunk, level).collect();
                (kept.counts, kept.errors) = without(chunk, level);
                for &point in &points {
                    let at = chunk.first as usize + 2 * usize::from(point);
                    less.packed.extend(&proxy.packed[at..at + 2]);
                }
                less.packed.extend(lists(proxy, chunk, level, &points));
            }
        }
        if chunk.flags & CHUNK_ONE_COLOR_KEY == 0 {
            let all = points(chunk, 0);
            let first = chunk.color_keys as usize;
            let keys = &proxy.color_keys[first..first + all];
            kept.color_keys = less.color_keys.len() as u32;
            match detail.points(proxy, chunk) {
                None => less.color_keys.extend(keys),
                Some(points) => {
                    let keys = points.iter().map(|&point| keys[usize::from(point)]);
                    less.color_keys.extend(keys);
                }
            }
        }
        less.chunks.push(kept);
    }
    less
}

/// Counts and errors of a chunk without its polylines before this one. The byte after the errors marks it: its finest
/// polyline is not its path, so that it is of no use to halve segments.
fn without(chunk: &Chunk, level: usize) -> ([u32; 2], [u32; 2]) {
    let (counts, errors) = (bytes_of(chunk.counts), bytes_of(chunk.errors));
    let mut fewer = ([0; 8], [NO_LOD; 8]);
    fewer.0[..LEVELS - level].copy_from_slice(&counts[level..LEVELS]);
    fewer.1[..LEVELS - level].copy_from_slice(&errors[level..LEVELS]);
    fewer.1[LEVELS] = 0;
    (u32s_of(fewer.0), u32s_of(fewer.1))
}

/// The lists of the polylines after this one, as indices of its points, four bytes a u32.
fn lists(proxy: &Proxy, chunk: &Chunk, level: usize, points: &[u8]) -> Vec<u32> {
    let coarser = (level + 1..LEVELS).flat_map(|k| list(proxy, chunk, k));
    // Polylines are nested, and their points ascend.
    let index = |point: u8| points.partition_point(|&kept| kept < point) as u8;
    packed_bytes(coarser.map(index).collect())
}

/// The points of a polyline after the first one: none if the chunk does not have it.
fn list(proxy: &Proxy, chunk: &Chunk, level: usize) -> impl Iterator<Item = u8> {
    let before: usize = (1..level).map(|k| listed(chunk, k)).sum();
    let lists = chunk.first as usize + 2 * points(chunk, 0);
    let byte = move |at: usize| proxy.packed[lists + at / 4].to_le_bytes()[at % 4];
    (before..before + listed(chunk, level)).map(byte)
}

/// u32s of a chunk from this polyline on.
fn u32s(chunk: &Chunk, finest: Option<usize>) -> usize {
    match (chunk.flags & CHUNK_SOMA, finest) {
        (_, None) => 0,
        (0, Some(level)) => {
            let coarser: usize = (level + 1..LEVELS).map(|k| listed(chunk, k)).sum();
            2 * points(chunk, level) + coarser.div_ceil(4)
        }
        // One that is too large to be kept as a mesh has no quads, and no vertices are stored.
        _ if chunk.counts[0] == 0 => 0,
        _ => 2 * (chunk.counts[0] + chunk.counts[1]) as usize,
    }
}

/// Points of a chunk's polyline that a list has.
fn listed(chunk: &Chunk, level: usize) -> usize {
    match bytes_of(chunk.counts)[level] {
        0 => 0,
        segments => usize::from(segments) + 1,
    }
}

/// Points of a chunk's polyline that have a color: one of a soma.
fn points(chunk: &Chunk, level: usize) -> usize {
    match chunk.flags & CHUNK_SOMA {
        0 => usize::from(bytes_of(chunk.counts)[level]) + 1,
        _ => 1,
    }
}
