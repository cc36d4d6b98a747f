//! Sharded files (`neuroglancer_uint64_sharded_v1`): objects by their ids, many in a file.
//!
//! A shard is an index of its minishards, the objects, and for each minishard an index of its objects. Which shard and
//! minishard an id belongs to is a hash of the id; **always murmur**: some programs know no other.

use std::io::{self, Seek, SeekFrom, Write};

use serde_json::{Value, json};

use crate::gzip::gzip;
use neurotess_formats::precomputed::murmur;

/// Objects that a shard is to have: so a million cells are in two thousand files.
const PER_SHARD: u64 = 512;

/// Of which 64 share an index, which readers fetch for one of them.
const MINISHARD_BITS: u32 = 3;

/// Into how many shards objects are divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sharding {
    /// Binary logarithm of the number of minishards in a shard.
    pub minishard_bits: u32,
    /// Binary logarithm of the number of shards.
    pub shard_bits: u32,
}

/// Where an object belongs. Sorted, they are in the order of the files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ShardPlace {
    /// Number of the shard.
    pub shard: u64,
    /// Number of the minishard in it.
    pub minishard: u64,
}

impl Sharding {
    /// Shards for so many objects.
    pub fn for_count(count: usize) -> Self {
        let shards = (count as u64).div_ceil(PER_SHARD).max(1);
        Self {
            minishard_bits: MINISHARD_BITS,
            shard_bits: shards.next_power_of_two().trailing_zeros(),
        }
    }

    /// Where an id belongs.
    pub fn place(self, id: u64) -> ShardPlace {
        let hash = murmur(&id.to_le_bytes());
        let low = |value: u64, bits: u32| value & ((1 << bits) - 1);
        ShardPlace {
            shard: low(hash >> self.minishard_bits, self.shard_bits),
            minishard: low(hash, self.minishard_bits),
        }
    }

    /// The name of a shard's file: its number in lower-case hexadecimal, with as many digits as the largest one has.
    pub fn file_name(self, shard: u64) -> String {
        let digits = self.shard_bits.div_ceil(4).max(1) as usize;
        format!("{shard:0digits$x}.shard")
    }

    /// As `info` files have it.
    pub fn json(self) -> Value {
        json!({
            "@type": "neuroglancer_uint64_sharded_v1",
            "preshift_bits": 0,
            "hash": "murmurhash3_x86_128",
            "minishard_bits": self.minishard_bits,
            "shard_bits": self.shard_bits,
            "minishard_index_encoding": "gzip",
            "data_encoding": "gzip",
        })
    }
}

/// An object of a shard.
struct Entry {
    id: u64,
    /// From the end of the shard's index.
    start: u64,
    bytes: u64,
}

/// A shard while it is written: objects come in the order of their minishards and ids, and none is held.
pub(crate) struct ShardWriter<W> {
    to: W,
    minishards: Vec<Vec<Entry>>,
    sharding: Sharding,
    /// Bytes after the shard's index.
    end: u64,
}

impl<W: Write + Seek> ShardWriter<W> {
    /// Begins a shard.
    pub(crate) fn begin(mut to: W, sharding: Sharding) -> io::Result<Self> {
        let minishards = 1_usize << sharding.minishard_bits;
        to.write_all(&vec![0; 16 * minishards])?;
        Ok(Self {
            to,
            minishards: (0..minishards).map(|_| Vec::new()).collect(),
            sharding,
            end: 0,
        })
    }

    /// Adds an object: `raw` bytes that no index names, since they are found from what follows them, and `packed` ones.
    ///
    /// # Errors
    /// What the file system says.
    pub(crate) fn add(&mut self, id: u64, raw: &[u8], packed: &[u8]) -> io::Result<u64> {
        let packed = gzip(packed)?;
        self.to.write_all(raw)?;
        self.to.write_all(&packed)?;
        let (start, bytes) = (self.end + raw.len() as u64, packed.len() as u64);
        let minishard = self.sharding.place(id).minishard as usize;
        self.minishards[minishard].push(Entry { id, start, bytes });
        self.end = start + bytes;
        Ok(raw.len() as u64 + bytes)
    }

    /// Writes the indices.
    ///
    /// # Errors
    /// What the file system says.
    pub(crate) fn finish(mut self) -> io::Result<()> {
        let mut index = Vec::with_capacity(16 * self.minishards.len());
        for entries in &self.minishards {
            let start = self.end;
            if !entries.is_empty() {
                let packed = gzip(&minishard_index(entries))?;
                self.to.write_all(&packed)?;
                self.end += packed.len() as u64;
            }
            index.extend([start, self.end].map(u64::to_le_bytes).as_flattened());
        }
        self.to.seek(SeekFrom::Start(0))?;
        self.to.write_all(&index)?;
        self.to.flush()
    }
}

/// Three rows of 64-bit integers: ids, starts and sizes. Ids are differences to the one before, and starts to the end of
/// the one before.
fn minishard_index(entries: &[Entry]) -> Vec<u8> {
    let before = || std::iter::once(None).chain(entries.iter().map(Some));
    let difference = |now: u64, before: u64| now.wrapping_sub(before);
    let pairs = || entries.iter().zip(before());
    let ids = pairs().map(|(entry, before)| difference(entry.id, before.map_or(0, |b| b.id)));
    let starts = pairs()
        .map(|(entry, before)| difference(entry.start, before.map_or(0, |b| b.start + b.bytes)));
    let sizes = entries.iter().map(|entry| entry.bytes);
    ids.chain(starts)
        .chain(sizes)
        .flat_map(u64::to_le_bytes)
        .collect()
}

#[cfg(test)]
mod tests {
    use std::io::{Cursor, Read};

    use flate2::read::GzDecoder;

    use super::*;

    fn unpacked(bytes: &[u8]) -> Vec<u8> {
        let mut all = Vec::new();
        GzDecoder::new(bytes).read_to_end(&mut all).expect("gzip");
        all
    }

    fn numbers(bytes: &[u8]) -> Vec<u64> {
        let numbers = bytes.as_chunks::<8>().0.iter();
        numbers.map(|&bytes| u64::from_le_bytes(bytes)).collect()
    }

    #[test]
    fn names_have_the_digits_of_the_largest_number() {
        let name = |shard_bits, shard| {
            let sharding = Sharding {
                minishard_bits: 3,
                shard_bits,
            };
            sharding.file_name(shard)
        };
        assert_eq!(name(0, 0), "0.shard");
        assert_eq!(name(4, 10), "a.shard");
        assert_eq!(name(5, 10), "0a.shard");
        assert_eq!(name(11, 0x7ff), "7ff.shard");
    }

    #[test]
    fn shards_have_some_hundred_objects() {
        let bits = |count| Sharding::for_count(count).shard_bits;
        assert_eq!(
            [0, 1, 512, 513, 100_000, 1_000_000].map(bits),
            [0, 0, 0, 1, 8, 11]
        );
    }

    #[test]
    fn low_bits_of_the_hash_are_the_minishard() {
        let sharding = Sharding {
            minishard_bits: 3,
            shard_bits: 8,
        };
        // Hash 0xe8bd67d616d4ce9a.
        let place = sharding.place(1);
        assert_eq!((place.minishard, place.shard), (0b010, 0xd3));
    }

    /// Every object is found as a reader looks for it, and lies directly behind its raw bytes.
    #[test]
    fn objects_are_found() {
        let sharding = Sharding {
            minishard_bits: 1,
            shard_bits: 0,
        };
        let mut ids: Vec<u64> = vec![7, 720_575_940_623_456_789, 3, 90, 91, 92];
        ids.sort_by_key(|&id| (sharding.place(id), id));
        let mut file = Cursor::new(Vec::new());
        let mut shard = ShardWriter::begin(&mut file, sharding).expect("begun");
        for id in &ids {
            let (raw, packed) = (format!("fragments of {id}"), format!("manifest of {id}"));
            shard
                .add(*id, raw.as_bytes(), packed.as_bytes())
                .expect("added");
        }
        shard.finish().expect("finished");
        let file = file.into_inner();
        let index_bytes = 32;
        let mut found = Vec::new();
        for bounds in numbers(&file[..index_bytes]).as_chunks::<2>().0 {
            let [start, end] = bounds.map(|at| at as usize + index_bytes);
            let rows = numbers(&unpacked(&file[start..end]));
            let count = rows.len() / 3;
            let (mut id, mut at) = (0_u64, index_bytes as u64);
            for n in 0..count {
                id = id.wrapping_add(rows[n]);
                at = at.wrapping_add(rows[count + n]);
                let size = rows[2 * count + n];
                let packed = &file[at as usize..(at + size) as usize];
                assert_eq!(unpacked(packed), format!("manifest of {id}").as_bytes());
                assert!(file[..at as usize].ends_with(format!("fragments of {id}").as_bytes()));
                at += size;
                found.push(id);
            }
        }
        assert_eq!(found, ids);
    }
}
