//! How much of what an HDF5 header declares a file can hold.
//!
//! **Theory.** Shapes are numbers in a header: a file of 2 KB may declare 40 million rows. So before
//! anything of that size is made, what is stored for the dataset is added up: its run of bytes, or its
//! chunks as the index lists them. Deflate makes no more than 1032 bytes of one (each symbol takes at
//! least two bits and stands for 258 bytes, D. Adler and J.-l. Gailly, zlib technical details), and
//! no other usual filter makes more of real numbers. What was never written reads as the fill value;
//! of that a file may declare eight times its own size, which covers columns that a tool left at
//! their default beside others that it wrote.
//!
//! **Why not** the file's size times 1032 alone: a megabyte of zeros behind the header would then
//! declare a gigabyte.

use hdf5_pure::{ChunkIndex, Dataset, Error, Layout};

/// Bytes that deflate makes of one, at most.
const DEFLATE: u64 = 1032;
/// Bytes of fill values for one of the file.
const UNWRITTEN: u64 = 8;
/// What any file may declare.
const FREE: u64 = 1 << 16;

/// A dataset that declares more than its file can hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Excess {
    /// Bytes that it declares.
    pub declared: u64,
    /// Bytes that it can have, at most.
    pub possible: u64,
}

/// Whether a dataset can have the size that it declares. `file`: bytes of the file.
///
/// # Errors
/// What the library says of a broken header.
pub fn excess(dataset: &Dataset, file: u64) -> Result<Option<Excess>, Error> {
    let shape = dataset.shape()?;
    let rows = shape.iter().try_fold(1u64, |all, &n| all.checked_mul(n));
    let declared = rows.and_then(|n| n.checked_mul(dataset.element_size().unwrap_or(1).max(1)));
    let declared = declared.unwrap_or(u64::MAX);
    let always = FREE.saturating_add(file.saturating_mul(UNWRITTEN));
    if declared <= always {
        return Ok(None);
    }
    let possible = always.saturating_add(stored(dataset, &shape, file)?);
    Ok((declared > possible).then_some(Excess { declared, possible }))
}

/// Bytes that what is stored of a dataset can become.
fn stored(dataset: &Dataset, shape: &[u64], file: u64) -> Result<u64, Error> {
    let growth = match dataset.filters()[..] {
        [] => 1,
        _ => DEFLATE,
    };
    let bytes = match dataset.layout()? {
        Layout::Compact { size } => size,
        Layout::Contiguous { address: None, .. } => 0,
        Layout::Contiguous { size, .. } => size,
        // Which chunks are stored is not listed by the library.
        Layout::Chunked {
            index: ChunkIndex::BTreeV2,
            ..
        } => file,
        Layout::Chunked { chunk_shape, .. } if listable(shape, &chunk_shape, file) => {
            let chunks = dataset.chunks()?;
            let sizes = chunks.iter().map(|chunk| chunk.storage_size);
            sizes.fold(0, u64::saturating_add)
        }
        _ => 0,
    };
    // Chunks may lie upon one another in a file that means harm.
    Ok(bytes.min(file).saturating_mul(growth))
}

/// Whether listing the chunks takes no more memory than the file: some indices have a place for every
/// chunk that the shape has room for.
pub fn listable(shape: &[u64], chunk: &[u64], file: u64) -> bool {
    let along = |(&length, &chunk): (&u64, &u64)| length.div_ceil(chunk.max(1));
    let mut counts = shape.iter().zip(chunk).map(along);
    let count = counts.try_fold(1u64, u64::checked_mul);
    count.is_some_and(|count| count <= file.saturating_mul(UNWRITTEN).saturating_add(FREE))
}
