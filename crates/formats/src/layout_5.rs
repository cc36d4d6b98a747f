//! Opening HDF5 whose datasets have layout messages of version 5, which HDF5 2.0 writes for chunks under filters whenever
//! `libver="latest"` is asked for (h5py 3.16 and newer bring it: Snudda's networks are such files).
//!
//! **Theory.** Version 5 of the message is version 4 but for one thing: in the index of filtered chunks a chunk's size has
//! always eight bytes, instead of as many as the size without filters needs (HDF5 File Format Specification 4.0, "Data Layout
//! Message"). hdf5-pure 0.47 refuses the version, yet takes the width from the index itself. **Practice.** The file is read
//! through a source that says 4 where a message says 5, with the checksum of the object header that goes along. Headers are
//! found by their signature and believed if their own checksum holds, so data that looks alike stays as it is. **Why not**
//! another library: those in pure Rust that read version 5 lack streaming or bounds on what a header declares.

use std::path::Path;

use hdf5_pure::{Error, File, FormatError, ReadSeekSource, Source};
use memchr::memmem;

const HEADER: &[u8] = b"OHDR";
const CONTINUATION: &[u8] = b"OCHK";
/// Bytes of a signature and a checksum.
const WORD: usize = 4;
/// Types of messages.
const LAYOUT: u8 = 0x08;
const CONTINUED: u8 = 0x10;
/// Most bytes of a header's block that are looked at; those of datasets have some hundreds.
const LARGEST_BLOCK: u64 = 1 << 20;
/// Most blocks of one header.
const MOST_BLOCKS: usize = 64;
/// Bytes that a search for headers takes at once.
const WINDOW: usize = 1 << 22;

/// Bytes to take the place of those of a file, in ascending order.
type Patches = Vec<(u64, [u8; 1])>;

/// A file that is in memory.
///
/// # Errors
/// Those of the library.
pub fn from_bytes(mut bytes: Vec<u8>) -> Result<File, Error> {
    if has_new_headers(&bytes) {
        for (at, [byte]) in patches(&*bytes) {
            bytes[at as usize] = byte;
        }
    }
    File::from_bytes(bytes)
}

/// A file that is read at once.
///
/// # Errors
/// Those of the library.
pub fn open(path: &Path) -> Result<File, Error> {
    from_bytes(std::fs::read(path).map_err(Error::Io)?)
}

/// A file that is read where its parts lie. One with layout messages of version 5 is gone through once.
///
/// # Errors
/// Those of the library.
pub fn open_streaming(path: &Path) -> Result<File, Error> {
    let file = File::open_streaming(path)?;
    if !has_layout_5(&file) {
        return Ok(file);
    }
    let handle = std::fs::File::open(path).map_err(Error::Io)?;
    let inner = ReadSeekSource::new(handle).map_err(Error::Format)?;
    let patches = patches(&inner);
    File::from_source(Patched { inner, patches })
}

/// Whether the superblock is of a version whose objects may have such messages.
fn has_new_headers(bytes: &[u8]) -> bool {
    bytes.get(..8) != Some(b"\x89HDF\r\n\x1a\n") || bytes.get(8).is_none_or(|&version| version >= 2)
}

/// Whether one of the first datasets cannot be opened for the version of its layout.
fn has_layout_5(file: &File) -> bool {
    let mut to_see = vec![(file.root(), 0)];
    let mut left = 256;
    while let Some((group, deep)) = to_see.pop() {
        for name in group.datasets().unwrap_or_default() {
            // The layout is read when it is asked for.
            match group
                .dataset(&name)
                .and_then(|dataset| dataset.chunk_shape())
            {
                Err(Error::Format(FormatError::InvalidLayoutVersion(5))) => return true,
                _ => left -= 1,
            }
            if left <= 0 {
                return false;
            }
        }
        if deep < 8 {
            let inner = group.iter_groups().into_iter().flatten();
            to_see.extend(inner.take(64).map(|(_, group)| (group, deep + 1)));
        }
    }
    false
}

/// A source with some bytes of its own.
struct Patched<S> {
    inner: S,
    patches: Patches,
}

impl<S: Source> Source for Patched<S> {
    fn len(&self) -> u64 {
        self.inner.len()
    }

    fn read_at(&self, offset: u64, buf: &mut [u8]) -> Result<(), FormatError> {
        self.inner.read_at(offset, buf)?;
        let first = self.patches.partition_point(|(at, _)| *at < offset);
        for (at, [byte]) in &self.patches[first..] {
            match buf.get_mut((at - offset) as usize) {
                Some(place) => *place = *byte,
                None => break,
            }
        }
        Ok(())
    }
}

/// Where bytes are read from.
trait Bytes {
    fn size(&self) -> u64;
    /// `len` bytes at a place; none if there are not so many.
    fn at(&self, offset: u64, len: u64) -> Option<Vec<u8>>;
}

impl Bytes for [u8] {
    fn size(&self) -> u64 {
        self.len() as u64
    }

    fn at(&self, offset: u64, len: u64) -> Option<Vec<u8>> {
        let start = usize::try_from(offset).ok()?;
        let end = start.checked_add(usize::try_from(len).ok()?)?;
        self.get(start..end).map(<[u8]>::to_vec)
    }
}

impl<R: std::io::Read + std::io::Seek> Bytes for ReadSeekSource<R> {
    fn size(&self) -> u64 {
        Source::len(self)
    }

    fn at(&self, offset: u64, len: u64) -> Option<Vec<u8>> {
        self.read_exact_at(offset, usize::try_from(len).ok()?).ok()
    }
}

/// What makes version 4 of all layout messages of version 5.
fn patches(bytes: &(impl Bytes + ?Sized)) -> Patches {
    let mut patches = Vec::new();
    let finder = memmem::Finder::new(HEADER);
    let mut start = 0;
    while start < bytes.size() {
        let len = (WINDOW as u64).min(bytes.size() - start);
        let Some(window) = bytes.at(start, len) else {
            break;
        };
        for place in finder.find_iter(&window) {
            header(bytes, start + place as u64, &mut patches);
        }
        // A signature may lie across the end of the window.
        start += len.max(WORD as u64) - (WORD as u64 - 1);
        if len < WINDOW as u64 {
            break;
        }
    }
    patches.sort_unstable();
    patches.dedup();
    patches
}

/// The object header of version 2 at a place, if there is one, and the blocks that continue it.
fn header(bytes: &(impl Bytes + ?Sized), at: u64, patches: &mut Patches) -> Option<()> {
    let prefix = bytes.at(at, (bytes.size() - at).min(64))?;
    let (&version, &flags) = (prefix.get(4)?, prefix.get(5)?);
    if version != 2 {
        return None;
    }
    let times = if flags & 0x20 != 0 { 16 } else { 0 };
    let phases = if flags & 0x10 != 0 { 4 } else { 0 };
    let size_at = 6 + times + phases;
    let width = 1 << (flags & 3);
    let size = little_endian(prefix.get(size_at..size_at + width)?);
    let first = (size_at + width) as u64;
    let tracked = flags & 0x04 != 0;
    let mut blocks = vec![(
        at,
        first,
        first.checked_add(size)?.checked_add(WORD as u64)?,
    )];
    let mut seen = 0;
    while let Some((at, first, len)) = blocks.pop() {
        seen += 1;
        if seen > MOST_BLOCKS || len > LARGEST_BLOCK {
            return None;
        }
        let block = bytes.at(at, len)?;
        continuations(&block, first as usize, tracked, &mut blocks);
        patch_block(block, at, first as usize, tracked, patches);
    }
    Some(())
}

/// The messages of a block: type and where its content lies.
fn messages(block: &[u8], first: usize, tracked: bool) -> Vec<(u8, std::ops::Range<usize>)> {
    let end = block.len().saturating_sub(WORD);
    let head = if tracked { 6 } else { 4 };
    let mut found = Vec::new();
    let mut at = first;
    while at + head <= end {
        let size = usize::from(block[at + 1]) | usize::from(block[at + 2]) << 8;
        let content = at + head..at + head + size;
        if content.end > end {
            break;
        }
        at = content.end;
        found.push((block[content.start - head], content));
    }
    found
}

/// The blocks that continue one whose checksum holds.
fn continuations(block: &[u8], first: usize, tracked: bool, blocks: &mut Vec<(u64, u64, u64)>) {
    if !holds(block) {
        return;
    }
    for (kind, content) in messages(block, first, tracked) {
        if let (CONTINUED, Some(place)) = (kind, block[content].get(..16)) {
            let (at, len) = (little_endian(&place[..8]), little_endian(&place[8..]));
            blocks.push((at, WORD as u64, len));
        }
    }
}

/// Whether a block is one, by its signature and checksum.
fn holds(block: &[u8]) -> bool {
    let Some((content, checksum)) = block.split_last_chunk::<WORD>() else {
        return false;
    };
    let known = block.starts_with(HEADER) || block.starts_with(CONTINUATION);
    known && lookup3(content) == u32::from_le_bytes(*checksum)
}

/// Makes version 4 of the layout message of a block, if it has one of version 5.
fn patch_block(mut block: Vec<u8>, at: u64, first: usize, tracked: bool, patches: &mut Patches) {
    if !holds(&block) {
        return;
    }
    let layouts = messages(&block, first, tracked).into_iter();
    let layouts =
        layouts.filter(|(kind, content)| *kind == LAYOUT && block.get(content.start) == Some(&5));
    let places: Vec<usize> = layouts.map(|(_, content)| content.start).collect();
    if places.is_empty() {
        return;
    }
    for &place in &places {
        block[place] = 4;
        patches.push((at + place as u64, [4]));
    }
    let end = block.len() - WORD;
    let checksum = lookup3(&block[..end]).to_le_bytes();
    patches.extend((at + end as u64..).zip(checksum.map(|byte| [byte])));
}

fn little_endian(bytes: &[u8]) -> u64 {
    let shifted = bytes.iter().rev();
    shifted.fold(0, |number, &byte| number << 8 | u64::from(byte))
}

/// The checksum of HDF5's metadata: Jenkins, lookup3.c, 2006, `hashlittle` with an initial value of 0.
fn lookup3(bytes: &[u8]) -> u32 {
    let start = 0xdead_beef_u32.wrapping_add(bytes.len() as u32);
    let [mut a, mut b, mut c] = [start; 3];
    // The last one to twelve bytes are mixed in otherwise.
    let whole = bytes.len().saturating_sub(1) / 12;
    let (blocks, rest) = bytes.split_at(12 * whole);
    let word = |block: &[u8], at: usize| {
        little_endian(&block[at.min(block.len())..(at + 4).min(block.len())]) as u32
    };
    for block in blocks.chunks_exact(12) {
        a = a.wrapping_add(word(block, 0));
        b = b.wrapping_add(word(block, 4));
        c = c.wrapping_add(word(block, 8));
        for (shift, [x, y, z]) in [(4, 0), (6, 1), (8, 2), (16, 0), (19, 1), (4, 2)]
            .map(|(shift, turn): (u32, usize)| (shift, [turn, turn + 1, turn + 2].map(|i| i % 3)))
        {
            // x −= z; x ^= rot(z, shift); z += y, the names turning with each step.
            let mut words = [a, b, c];
            words[x] = words[x].wrapping_sub(words[z]) ^ words[z].rotate_left(shift);
            words[z] = words[z].wrapping_add(words[y]);
            [a, b, c] = words;
        }
    }
    if rest.is_empty() {
        return c;
    }
    a = a.wrapping_add(word(rest, 0));
    b = b.wrapping_add(word(rest, 4));
    c = c.wrapping_add(word(rest, 8));
    for (shift, [x, y]) in [
        (14, [2, 1]),
        (11, [0, 2]),
        (25, [1, 0]),
        (16, [2, 1]),
        (4, [0, 2]),
        (14, [1, 0]),
        (24, [2, 1]),
    ] {
        let mut words = [a, b, c];
        words[x] = (words[x] ^ words[y]).wrapping_sub(words[y].rotate_left(shift));
        [a, b, c] = words;
    }
    c
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values that Jenkins gives in the comments of lookup3.c.
    #[test]
    fn checksums_are_those_of_lookup3() {
        assert_eq!(lookup3(b""), 0xdead_beef);
        assert_eq!(lookup3(b"Four score and seven years ago"), 0x1777_0551);
    }

    /// Large files are read where their parts lie.
    #[test]
    fn files_that_are_streamed_are_read_alike() {
        for index in ["fixed", "single", "extensible"] {
            let name = format!("tests/fixtures/layout_5_{index}.h5");
            let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(name);
            let [streamed, whole] = [open_streaming(&path), open(&path)].map(|file| {
                let dataset = file.expect("a file").dataset("points").expect("there");
                dataset.read_f64().expect("numbers")
            });
            assert!(streamed.len() == 112 && streamed == whole, "{index}");
        }
    }

    #[test]
    fn only_headers_whose_checksum_holds_are_changed() {
        let mut header = b"OHDR\x02\x00\x09".to_vec();
        header.extend(b"\x08\x05\x00\x00\x05\x02\x00\x01\x02");
        let checksum = lookup3(&header).to_le_bytes();
        header.extend(checksum);
        let mut file = vec![7; 100];
        file.extend(&header);
        file.extend(b"OHDR\x02\x00\x09\x08\x05\x00\x00\x05\x02\x00\x01\x02????");
        file.extend(b"OHDR\x02\x03");
        let found = patches(&*file);
        let mut changed = file.clone();
        for (at, [byte]) in found {
            changed[at as usize] = byte;
        }
        assert_eq!(changed[100 + 11], 4);
        assert!(holds(&changed[100..120]));
        assert_eq!(
            (&changed[..100], &changed[120..]),
            (&file[..100], &file[120..])
        );
    }
}
