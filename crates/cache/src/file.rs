//! The file: entries, an index of them, and an end that says how long all is.
//!
//! ```text
//! magic (16) │ entries, one after the other │ index: 80 bytes for each entry │ end (64)
//!                                             key, offset, length, checksum    number of entries, checksum of
//!                                                                              the index, length of the file, magic
//! ```
//!
//! Numbers are 64-bit and little-endian, checksums and keys BLAKE3. The end is written last, so a file that was cut
//! off has none; no number is believed that the file's size contradicts.

use std::collections::HashMap;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use neurotess_output::{OutputError, own_file};
use thiserror::Error;

use crate::key::Key;

/// What every cache begins with, and those of other formats too.
const NAME: &[u8; 15] = b"neurotess cache";
/// The format.
const FORMAT: u8 = 1;
const MAGIC: usize = 16;
const RECORD: usize = 80;
const END: usize = 64;
/// Longest entry: a cell of a million points has 160 MB.
const LONGEST: u64 = 1 << 30;

/// Why a file is not used.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum FileError {
    /// It is not a cache, and is never replaced.
    #[error("it is no cache of neurotess")]
    Foreign,
    /// It is a link, which may lead to anything, and is never followed.
    #[error("it is a link, which is not followed: remove it")]
    Link,
    /// It is a cache of another version of this format.
    #[error("it is of another version")]
    Format,
    /// It was cut off, or changed.
    #[error("it is damaged: {0}")]
    Damaged(&'static str),
    /// It cannot be read.
    #[error("it cannot be read: {0}")]
    Io(#[from] io::Error),
}

/// Where an entry is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Record {
    offset: u64,
    length: u64,
    checksum: [u8; 32],
}

/// A file that is there, open for reading.
#[derive(Debug)]
pub(crate) struct CacheFile {
    file: Mutex<File>,
    records: HashMap<Key, Record>,
    /// Keys in the order of the file: those that were written last come first.
    keys: Vec<Key>,
}

impl CacheFile {
    /// Opens a file and reads its index; `None` if there is none.
    pub(crate) fn open(path: &Path) -> Result<Option<Self>, FileError> {
        match own_file(path) {
            Ok(None) => return Ok(None),
            Ok(Some(_)) => {}
            Err(OutputError::NotOurs { what: "a link", .. }) => return Err(FileError::Link),
            Err(OutputError::Broken { source, .. }) => return Err(source.into()),
            Err(_) => return Err(FileError::Foreign),
        }
        let mut file = match File::open(path) {
            Ok(file) => file,
            Err(e) if e.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(e) => return Err(e.into()),
        };
        let metadata = file.metadata()?;
        if !metadata.is_file() {
            return Err(FileError::Foreign);
        }
        let index = read_index(&mut file, metadata.len())?;
        let (mut records, mut keys) = (HashMap::new(), Vec::new());
        for (key, record) in index {
            if records.insert(key, record).is_none() {
                keys.push(key);
            }
        }
        Ok(Some(Self {
            file: Mutex::new(file),
            records,
            keys,
        }))
    }

    pub(crate) fn keys(&self) -> &[Key] {
        &self.keys
    }

    /// Bytes of an entry; `None` if there is none.
    pub(crate) fn length(&self, key: &Key) -> Option<u64> {
        Some(self.records.get(key)?.length)
    }

    /// The content of an entry; `None` if there is none.
    pub(crate) fn get(&self, key: &Key) -> Option<Result<Vec<u8>, FileError>> {
        let record = self.records.get(key)?;
        Some(self.read(record))
    }

    fn read(&self, record: &Record) -> Result<Vec<u8>, FileError> {
        let mut bytes = vec![0; record.length as usize];
        {
            let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
            file.seek(SeekFrom::Start(record.offset))?;
            file.read_exact(&mut bytes)?;
        }
        match *blake3::hash(&bytes).as_bytes() == record.checksum {
            true => Ok(bytes),
            false => Err(FileError::Damaged("an entry has another checksum")),
        }
    }
}

fn read_index(file: &mut File, size: u64) -> Result<Vec<(Key, Record)>, FileError> {
    let damaged = |what| Err(FileError::Damaged(what));
    let mut begin = Vec::new();
    Read::by_ref(file)
        .take(MAGIC as u64)
        .read_to_end(&mut begin)?;
    if !begin.iter().zip(NAME).all(|(a, b)| a == b) {
        return Err(FileError::Foreign);
    }
    if begin.len() == MAGIC && begin[NAME.len()] != FORMAT {
        return Err(FileError::Format);
    }
    let Some(inner) = size.checked_sub((MAGIC + END) as u64) else {
        return damaged("it ends early");
    };
    file.seek(SeekFrom::Start(size - END as u64))?;
    let mut end = [0; END];
    file.read_exact(&mut end)?;
    if end[48..] != begin || number(&end[40..48]) != size {
        return damaged("it ends early");
    }
    let length = number(&end[..8]).checked_mul(RECORD as u64);
    let Some(length) = length.filter(|&length| length <= inner) else {
        return damaged("more entries than bytes");
    };
    let first = size - END as u64 - length;
    file.seek(SeekFrom::Start(first))?;
    let mut index = vec![0; length as usize];
    file.read_exact(&mut index)?;
    if blake3::hash(&index).as_bytes()[..] != end[8..40] {
        return damaged("its index has another checksum");
    }
    let mut entries = Vec::with_capacity(index.len() / RECORD);
    for bytes in index.chunks_exact(RECORD) {
        let record = Record {
            offset: number(&bytes[32..40]),
            length: number(&bytes[40..48]),
            checksum: array(&bytes[48..]),
        };
        let end = record.offset.checked_add(record.length);
        let within = record.offset >= MAGIC as u64 && end.is_some_and(|end| end <= first);
        if !within || record.length > LONGEST {
            return damaged("an entry beyond its end");
        }
        entries.push((Key(array(&bytes[..32])), record));
    }
    Ok(entries)
}

/// Writes entries, one after the other.
#[derive(Debug)]
pub(crate) struct FileWriter<W> {
    to: W,
    index: Vec<u8>,
    place: u64,
}

impl<W: Write> FileWriter<W> {
    pub(crate) fn begin(mut to: W) -> io::Result<Self> {
        to.write_all(&magic())?;
        Ok(Self {
            to,
            index: Vec::new(),
            place: MAGIC as u64,
        })
    }

    /// How long the file is, without its index.
    pub(crate) fn place(&self) -> u64 {
        self.place
    }

    /// Appends an entry; one that is too long to be read again is left out.
    pub(crate) fn put(&mut self, key: &Key, bytes: &[u8]) -> io::Result<()> {
        let length = bytes.len() as u64;
        if length > LONGEST {
            return Ok(());
        }
        self.to.write_all(bytes)?;
        self.index.extend(key.0);
        self.index.extend(self.place.to_le_bytes());
        self.index.extend(length.to_le_bytes());
        self.index.extend(blake3::hash(bytes).as_bytes());
        self.place += length;
        Ok(())
    }

    /// Writes index and end.
    pub(crate) fn end(mut self) -> io::Result<W> {
        let size = self.place + (self.index.len() + END) as u64;
        self.to.write_all(&self.index)?;
        let count = (self.index.len() / RECORD) as u64;
        self.to.write_all(&count.to_le_bytes())?;
        self.to.write_all(blake3::hash(&self.index).as_bytes())?;
        self.to.write_all(&size.to_le_bytes())?;
        self.to.write_all(&magic())?;
        self.to.flush()?;
        Ok(self.to)
    }
}

fn magic() -> [u8; MAGIC] {
    std::array::from_fn(|i| NAME.get(i).copied().unwrap_or(FORMAT))
}

fn number(bytes: &[u8]) -> u64 {
    u64::from_le_bytes(array(bytes))
}

/// The first bytes, of which there are as many.
fn array<const N: usize>(bytes: &[u8]) -> [u8; N] {
    std::array::from_fn(|i| bytes[i])
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    fn key(number: u8) -> Key {
        Key([number; 32])
    }

    fn written() -> Vec<u8> {
        let mut writer = FileWriter::begin(Vec::new()).expect("memory");
        writer.put(&key(1), b"one entry").expect("memory");
        writer.put(&key(2), b"").expect("memory");
        writer.put(&key(3), &[7; 300]).expect("memory");
        writer.end().expect("memory")
    }

    /// What a file of these bytes gives: its entries.
    fn read(bytes: &[u8]) -> Result<Vec<Option<Vec<u8>>>, FileError> {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.ntcache");
        fs::write(&path, bytes).expect("written");
        let file = CacheFile::open(&path)?.expect("there");
        let get = |number| file.get(&key(number)).and_then(Result::ok);
        Ok((1..=4).map(get).collect())
    }

    #[test]
    fn entries_come_back_and_others_are_none() {
        let entries = read(&written()).expect("a cache");
        let there = [
            Some(b"one entry".to_vec()),
            Some(Vec::new()),
            Some(vec![7; 300]),
            None,
        ];
        assert_eq!(entries, there);
        let folder = tempfile::tempdir().expect("a folder");
        let none = CacheFile::open(&folder.path().join("none"));
        assert!(none.expect("no error").is_none());
    }

    #[cfg(unix)]
    #[test]
    fn a_link_is_not_followed() {
        let folder = tempfile::tempdir().expect("a folder");
        let [cache, link] = ["a.ntcache", "b.ntcache"].map(|name| folder.path().join(name));
        fs::write(&cache, written()).expect("written");
        std::os::unix::fs::symlink(&cache, &link).expect("linked");
        assert!(CacheFile::open(&cache).is_ok_and(|file| file.is_some()));
        assert!(matches!(CacheFile::open(&link), Err(FileError::Link)));
        fs::remove_file(&cache).expect("removed");
        assert!(matches!(CacheFile::open(&link), Err(FileError::Link)));
    }

    #[test]
    fn a_file_that_was_cut_off_at_any_length_is_refused() {
        let whole = written();
        for length in 0..whole.len() {
            assert!(
                matches!(read(&whole[..length]), Err(FileError::Damaged(_))),
                "{length}"
            );
        }
        let mut longer = whole;
        longer.push(0);
        assert!(matches!(read(&longer), Err(FileError::Damaged(_))));
    }

    #[test]
    fn a_changed_byte_loses_the_file_or_the_entry_that_it_is_of() {
        let whole = written();
        let entries = read(&whole).expect("a cache");
        for at in 0..whole.len() {
            let mut changed = whole.clone();
            changed[at] ^= 1 << (at % 8);
            let Ok(read) = read(&changed) else { continue };
            assert!(at >= MAGIC && at < whole.len() - END, "{at}");
            let lost = entries.iter().zip(&read).filter(|(a, b)| a != b);
            assert_eq!(lost.count(), 1, "{at}");
            assert!(
                entries
                    .iter()
                    .zip(&read)
                    .all(|(a, b)| b.is_none() || a == b)
            );
        }
    }

    #[test]
    fn numbers_that_the_size_contradicts_are_not_believed() {
        // An index with the right checksum whose entries are longer than the file.
        for (offset, length) in [(16, 1 << 40), (u64::MAX, 2), (0, 4), (16, u64::MAX)] {
            let mut index = vec![9; 32];
            index.extend(u64::to_le_bytes(offset));
            index.extend(u64::to_le_bytes(length));
            index.extend([0; 32]);
            let mut bytes = magic().to_vec();
            let writer = FileWriter {
                to: &mut bytes,
                index,
                place: MAGIC as u64,
            };
            writer.end().expect("memory");
            assert!(matches!(read(&bytes), Err(FileError::Damaged(_))));
        }
        let mut many = written();
        let at = many.len() - END;
        many[at..at + 8].copy_from_slice(&u64::MAX.to_le_bytes());
        assert!(matches!(read(&many), Err(FileError::Damaged(_))));
    }

    #[test]
    fn other_files_and_other_formats_are_told_apart() {
        assert!(matches!(read(b"my own notes"), Err(FileError::Foreign)));
        let mut newer = written();
        newer[NAME.len()] = FORMAT + 1;
        assert!(matches!(read(&newer), Err(FileError::Format)));
    }
}
