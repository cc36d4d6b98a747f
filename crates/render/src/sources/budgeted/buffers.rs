//! The buffers of templates on the device.

use std::ops::Range;

use super::layout::{Chunk, Shape};
use super::proxy::{Proxy, moved};
use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;
use crate::gpu::growable::GrowableBuffer;

/// Chunks, points and color keys of all templates, and the shape of each.
#[derive(Debug)]
pub(super) struct Buffers {
    pub(super) chunks: GrowableBuffer,
    pub(super) packed: GrowableBuffer,
    pub(super) color_keys: GrowableBuffer,
    pub(super) shapes: GrowableBuffer,
}

/// Elements of a proxy's arrays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Counts {
    pub(super) chunks: u64,
    pub(super) packed: u64,
    pub(super) color_keys: u64,
}

/// Where a proxy's arrays are, as indices of elements.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Room {
    pub(super) chunks: Range<u64>,
    pub(super) packed: Range<u64>,
    pub(super) color_keys: Range<u64>,
}

const CHUNK: u64 = size_of::<Chunk>() as u64;
const U32: u64 = size_of::<u32>() as u64;

impl Counts {
    pub(super) fn of(proxy: &Proxy) -> Self {
        Self {
            chunks: proxy.chunks.len() as u64,
            packed: proxy.packed.len() as u64,
            color_keys: proxy.color_keys.len() as u64,
        }
    }

    pub(super) fn bytes(&self) -> u64 {
        let [chunks, packed, color_keys] = self.by_buffer();
        chunks + packed + color_keys
    }

    /// Bytes of chunks, points and color keys.
    pub(super) fn by_buffer(&self) -> [u64; 3] {
        [
            CHUNK * self.chunks,
            U32 * self.packed,
            U32 * self.color_keys,
        ]
    }

    pub(super) fn plus(&self, other: &Self) -> Self {
        Self {
            chunks: self.chunks + other.chunks,
            packed: self.packed + other.packed,
            color_keys: self.color_keys + other.color_keys,
        }
    }

    pub(super) fn fit(&self, room: &Self) -> bool {
        self.chunks <= room.chunks
            && self.packed <= room.packed
            && self.color_keys <= room.color_keys
    }
}

impl Room {
    /// The room after so many elements.
    pub(super) fn behind(before: &Counts, counts: &Counts) -> Self {
        let range = |first: u64, count: u64| first..first + count;
        Self {
            chunks: range(before.chunks, counts.chunks),
            packed: range(before.packed, counts.packed),
            color_keys: range(before.color_keys, counts.color_keys),
        }
    }

    /// The proxy's chunks, with indices into the buffers.
    fn placed(&self, proxy: &Proxy) -> impl Iterator<Item = Chunk> {
        let at = (self.packed.start as usize, self.color_keys.start as usize);
        proxy.chunks.iter().map(move |chunk| moved(chunk, at))
    }
}

impl Buffers {
    pub(super) fn new(gpu: &Gpu) -> Self {
        Self {
            chunks: GrowableBuffer::new(gpu, "chunks", 0),
            packed: GrowableBuffer::new(gpu, "points of exploration", 0),
            color_keys: GrowableBuffer::new(gpu, "color_keys", 0),
            shapes: GrowableBuffer::new(gpu, "shapes", 0),
        }
    }

    /// Elements in use.
    pub(super) fn used(&self) -> Counts {
        Counts {
            chunks: self.chunks.used() / CHUNK,
            packed: self.packed.used() / U32,
            color_keys: self.color_keys.used() / U32,
        }
    }

    /// Bytes in use.
    pub(super) fn bytes(&self) -> u64 {
        self.used().bytes() + self.shapes.used()
    }

    /// Appends proxies without their shapes; tells where each is, and whether some buffer was replaced by a larger one.
    ///
    /// # Errors
    /// A buffer would be larger than the device can bind, or the device reports another error.
    pub(super) fn append<'p>(
        &mut self,
        gpu: &Gpu,
        proxies: impl IntoIterator<Item = &'p Proxy>,
    ) -> Result<(Vec<Room>, bool), DeviceError> {
        let mut rooms = Vec::new();
        let mut chunks: Vec<Chunk> = Vec::new();
        let (mut packed, mut color_keys): (Vec<u32>, Vec<u32>) = (Vec::new(), Vec::new());
        let mut at = self.used();
        for proxy in proxies {
            let counts = Counts::of(proxy);
            let room = Room::behind(&at, &counts);
            chunks.extend(room.placed(proxy));
            packed.extend(&proxy.packed);
            color_keys.extend(&proxy.color_keys);
            at = at.plus(&counts);
            rooms.push(room);
        }
        let grown = [
            self.chunks.append(gpu, &chunks)?,
            self.packed.append(gpu, &packed)?,
            self.color_keys.append(gpu, &color_keys)?,
        ];
        Ok((rooms, grown.contains(&true)))
    }

    /// Makes room for exactly so many elements more. True if some buffer was replaced by a larger one.
    ///
    /// # Errors
    /// As [`Buffers::append`].
    pub(super) fn reserve(&mut self, gpu: &Gpu, more: &Counts) -> Result<bool, DeviceError> {
        let [chunks, packed, color_keys] = self.used().plus(more).by_buffer();
        let grown = [
            self.chunks.reserve_exactly(gpu, chunks)?,
            self.packed.reserve_exactly(gpu, packed)?,
            self.color_keys.reserve_exactly(gpu, color_keys)?,
        ];
        Ok(grown.contains(&true))
    }

    /// Takes room that was reserved, with anything in it.
    pub(super) fn take(&mut self, counts: &Counts) -> Room {
        let room = Room::behind(&self.used(), counts);
        let [chunks, packed, color_keys] = counts.by_buffer();
        self.chunks.take(chunks);
        self.packed.take(packed);
        self.color_keys.take(color_keys);
        room
    }

    /// Overwrites what is in a room by a proxy that fits it exactly.
    pub(super) fn write(&self, gpu: &Gpu, room: &Room, proxy: &Proxy) {
        self.write_chunks(gpu, room, proxy);
        self.packed
            .write(gpu, room.packed.start as usize, &proxy.packed);
        self.color_keys
            .write(gpu, room.color_keys.start as usize, &proxy.color_keys);
    }

    /// Overwrites the chunks of a proxy whose points are in the room.
    pub(super) fn write_chunks(&self, gpu: &Gpu, room: &Room, proxy: &Proxy) {
        let chunks: Vec<Chunk> = room.placed(proxy).collect();
        self.chunks.write(gpu, room.chunks.start as usize, &chunks);
    }
}

/// What shaders read of a template that is in a room.
pub(super) fn shape_of(proxy: &Proxy, room: &Room) -> Shape {
    let (before_twigs, twig_length) = proxy.twigs();
    Shape {
        center: proxy.center.to_array(),
        reach: proxy.reach,
        first_chunk: room.chunks.start as u32,
        chunks: proxy.chunks.len() as u32,
        somata: proxy.somata().len() as u32,
        soma_radius: proxy.somata().iter().map(|c| c.radius).fold(0.0, f32::max),
        before_twigs: before_twigs as u32,
        twig_length,
        pad: [0; 2],
    }
}
