//! How much of templates is always there, and how much room is left for their details.

use std::sync::Arc;

use super::reduced::Detail;
use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;
use crate::sources::budgeted::buffers::{Buffers, Counts};
use crate::sources::budgeted::layout::Chunk;
use crate::sources::budgeted::proxy::Proxy;

/// Bases, fine ones first: the first that takes at most half of the memory.
const BASES: [Detail; 6] = [
    Detail::of_all(8),
    Detail::of_all(4),
    Detail::of_all(1),
    Detail {
        chunks: 64,
        segments: 1,
    },
    Detail {
        chunks: 16,
        segments: 1,
    },
    Detail {
        chunks: 4,
        segments: 1,
    },
];

/// The finest base that leaves half of the memory for details, and its elements.
pub(super) fn base_of(
    gpu: &Gpu,
    buffers: &Buffers,
    proxies: &[Arc<Proxy>],
    memory: u64,
) -> Result<(Detail, Counts), DeviceError> {
    let most = gpu.largest_binding();
    let mut bytes = 0;
    for (number, base) in BASES.into_iter().enumerate() {
        let counts = total(proxies, base);
        let share = if number + 1 < BASES.len() { 2 } else { 1 };
        let bindings = buffers.used().plus(&counts).by_buffer();
        if counts.bytes() <= memory / share && bindings.iter().all(|&bytes| bytes <= most / share) {
            return Ok((base, counts));
        }
        bytes = counts.bytes();
    }
    Err(DeviceError::TooManyTracings {
        bytes,
        most: memory.min(most),
    })
}

/// Elements of the details that `memory` (bytes) has room for behind the bases, in the proportions of all details.
pub(super) fn room_for(
    gpu: &Gpu,
    buffers: &Buffers,
    full: &Counts,
    bases: &Counts,
    memory: u64,
) -> Counts {
    let share = (memory as f64 / full.bytes().max(1) as f64).min(1.0);
    let most = gpu.largest_binding();
    let [chunks, packed, color_keys] = buffers.used().plus(bases).by_buffer();
    let room = |count: u64, used: u64, size: usize| {
        let left = most.saturating_sub(used) / size as u64;
        ((count as f64 * share) as u64).min(left)
    };
    Counts {
        chunks: room(full.chunks, chunks, size_of::<Chunk>()),
        packed: room(full.packed, packed, size_of::<u32>()),
        color_keys: room(full.color_keys, color_keys, size_of::<u32>()),
    }
}

/// Elements of all proxies with this much detail.
pub(super) fn total(proxies: &[Arc<Proxy>], detail: Detail) -> Counts {
    let counts = proxies.iter().map(|proxy| detail.counts(proxy));
    counts.fold(Counts::default(), |sum, counts| sum.plus(&counts))
}
