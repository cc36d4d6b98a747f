//! Shards (`neuroglancer_uint64_sharded_v1`): files that hold many objects by their ids.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::{broken, murmur};
use crate::packed::unpacked;
use crate::{Fault, regular};

/// How objects are divided into shards, and shards into minishards.
#[derive(Clone, Debug, Deserialize, PartialEq, Eq)]
pub struct Shards {
    preshift_bits: u32,
    hash: Hash,
    minishard_bits: u32,
    shard_bits: u32,
    #[serde(default)]
    minishard_index_encoding: Encoding,
    #[serde(default)]
    data_encoding: Encoding,
}

#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
enum Hash {
    #[serde(rename = "identity")]
    Identity,
    #[serde(rename = "murmurhash3_x86_128")]
    Murmur,
}

#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
enum Encoding {
    #[default]
    Raw,
    Gzip,
}

/// Where the bytes of an object are.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Located {
    /// The shard.
    pub file: PathBuf,
    /// The first of them.
    pub start: u64,
    /// How many they are.
    pub size: u64,
}

/// An object of a minishard: its id, and where its bytes are in the file.
type Entry = (u64, u64, u64);

/// Most minishards of a shard that are believed: an index of 16 MB.
const MOST_MINISHARD_BITS: u32 = 20;

impl Shards {
    /// Refuses what no file can be.
    ///
    /// # Errors
    /// More bits than files can have.
    pub fn check(&self) -> Result<(), Fault> {
        if self.minishard_bits > MOST_MINISHARD_BITS
            || self.shard_bits > 40
            || self.preshift_bits > 63
        {
            return Err(broken("its sharding has more bits than files can have"));
        }
        Ok(())
    }

    /// Shard and minishard of an id.
    fn place(&self, id: u64) -> (u64, u64) {
        let shifted = id >> self.preshift_bits;
        let hash = match self.hash {
            Hash::Identity => shifted,
            Hash::Murmur => murmur(&shifted.to_le_bytes()),
        };
        let low = |value: u64, bits: u32| value & ((1 << bits) - 1);
        (
            low(hash >> self.minishard_bits, self.shard_bits),
            low(hash, self.minishard_bits),
        )
    }

    /// The file that an object is in.
    pub(super) fn file(&self, folder: &Path, id: u64) -> PathBuf {
        let (shard, _) = self.place(id);
        let digits = self.shard_bits.div_ceil(4).max(1) as usize;
        folder.join(format!("{shard:0digits$x}.shard"))
    }

    /// The bytes of an object, unpacked; none if no shard has it.
    ///
    /// # Errors
    /// A shard that cannot be read, or is broken.
    pub fn object(&self, folder: &Path, id: u64) -> Result<Option<Vec<u8>>, Fault> {
        let Some(Located { file, start, size }) = self.locate(folder, id)? else {
            return Ok(None);
        };
        let bytes = self.open(&file)?.bytes(start, size)?;
        match self.data_encoding {
            Encoding::Raw => Ok(Some(bytes)),
            Encoding::Gzip => unpacked(bytes).map(Some),
        }
    }

    /// Where an object is, as it is stored; none if no shard has it.
    ///
    /// # Errors
    /// As [`object`](Self::object).
    pub fn locate(&self, folder: &Path, id: u64) -> Result<Option<Located>, Fault> {
        let (file, (_, minishard)) = (self.file(folder, id), self.place(id));
        if !file.exists() {
            return Ok(None);
        }
        let entries = self.open(&file)?.entries(minishard)?;
        let found = entries.into_iter().find(|(own, ..)| *own == id);
        Ok(found.map(|(_, start, size)| Located { file, start, size }))
    }

    /// The ids of all objects of a file.
    ///
    /// # Errors
    /// As [`object`](Self::object).
    pub(super) fn ids(&self, path: &Path) -> Result<Vec<u64>, Fault> {
        let mut shard = self.open(path)?;
        let mut ids = Vec::new();
        for minishard in 0..1_u64 << self.minishard_bits {
            ids.extend(shard.entries(minishard)?.into_iter().map(|(id, ..)| id));
        }
        Ok(ids)
    }

    fn open(&self, path: &Path) -> Result<Shard<'_>, Fault> {
        regular(path).map_err(Fault::Io)?;
        let file = File::open(path).map_err(Fault::Io)?;
        let bytes = file.metadata().map_err(Fault::Io)?.len();
        Ok(Shard {
            file,
            bytes,
            shards: self,
        })
    }
}

/// A file of shards.
struct Shard<'a> {
    file: File,
    bytes: u64,
    shards: &'a Shards,
}

impl Shard<'_> {
    /// Bytes of the file; what an index says is believed as far as the file reaches.
    fn bytes(&mut self, start: u64, size: u64) -> Result<Vec<u8>, Fault> {
        let end = start.checked_add(size);
        if end.is_none_or(|end| end > self.bytes) {
            return Err(broken("a shard's index points beyond its end"));
        }
        let mut bytes = vec![0; size as usize];
        self.file.seek(SeekFrom::Start(start)).map_err(Fault::Io)?;
        self.file.read_exact(&mut bytes).map_err(Fault::Io)?;
        Ok(bytes)
    }

    /// The objects of a minishard.
    fn entries(&mut self, minishard: u64) -> Result<Vec<Entry>, Fault> {
        let index_bytes = 16 << self.shards.minishard_bits;
        let bounds = numbers(&self.bytes(16 * minishard, 16)?);
        let [start, end] = bounds[..] else {
            return Ok(Vec::new());
        };
        let Some(size) = end.checked_sub(start) else {
            return Err(broken("a minishard ends before it begins"));
        };
        if size == 0 {
            return Ok(Vec::new());
        }
        let index = self.bytes(start.saturating_add(index_bytes), size)?;
        let index = match self.shards.minishard_index_encoding {
            Encoding::Raw => index,
            Encoding::Gzip => unpacked(index)?,
        };
        let rows = numbers(&index);
        let count = rows.len() / 3;
        let (mut id, mut at) = (0_u64, index_bytes);
        let mut entries = Vec::with_capacity(count);
        for n in 0..count {
            let size = rows[2 * count + n];
            // Differences to the id before, and to the end before.
            id = id.wrapping_add(rows[n]);
            at = at.wrapping_add(rows[count + n]);
            entries.push((id, at, size));
            at = at.wrapping_add(size);
        }
        Ok(entries)
    }
}

fn numbers(bytes: &[u8]) -> Vec<u64> {
    let numbers = bytes.as_chunks::<8>().0.iter();
    numbers.map(|&eight| u64::from_le_bytes(eight)).collect()
}
