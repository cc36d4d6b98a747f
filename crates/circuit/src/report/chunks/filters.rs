//! HDF5's filters of chunks that are undone here: deflate and shuffle.

use std::io::{self, Read};

/// The bytes that deflate packed, at most one more than `whole`.
pub(super) fn inflate(bytes: &[u8], whole: u64) -> io::Result<Vec<u8>> {
    let mut inflated = Vec::new();
    let decoder = flate2::read::ZlibDecoder::new(bytes);
    decoder.take(whole + 1).read_to_end(&mut inflated)?;
    Ok(inflated)
}

/// Undoes HDF5's shuffle: first bytes of all numbers, then second bytes, …
pub(super) fn unshuffle(bytes: &[u8], size: usize) -> Vec<u8> {
    let count = bytes.len() / size.max(1);
    let mut numbers = bytes.to_vec();
    for (k, plane) in bytes[..count * size].chunks_exact(count.max(1)).enumerate() {
        for (i, &byte) in plane.iter().enumerate() {
            numbers[i * size + k] = byte;
        }
    }
    numbers
}
