//! Some columns of one row of a table that may be larger than memory.
//!
//! hdf5-pure reads whole rows: 40 MB for a frame of 10⁷ compartments, whatever of it is wanted. So where
//! the numbers lie is asked of it once, and then only the chunks (or, without chunks, the runs of
//! bytes) that hold wanted compartments are read. Filters other than deflate and shuffle, and kinds of
//! index that cannot be listed, are left to hdf5-pure, whole rows at a time.

mod filters;
mod series;

use std::collections::{BTreeMap, HashMap};
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

use hdf5_pure::{ChunkIndex, Dataset, Datatype, DatatypeByteOrder, Layout};
use neurotess_formats::capacity;
use rayon::prelude::*;

use crate::hdf5::{Store, hdf5};
use crate::{CircuitError, Fault};
use filters::{inflate, unshuffle};

/// A table of numbers, `rows × columns`.
pub(crate) struct Table {
    file: String,
    path: String,
    dataset: Dataset,
    pub(crate) rows: u64,
    pub(crate) columns: u64,
    access: Access,
    bytes: Mutex<File>,
    bytes_len: u64,
    number: Option<Number>,
    cache: Mutex<Cache>,
}

/// Where the numbers lie.
enum Access {
    /// One after another from this byte on.
    Contiguous(u64),
    /// In chunks of this many rows and columns.
    Chunked {
        shape: [u64; 2],
        filters: Vec<u16>,
        chunks: HashMap<[u64; 2], Stored>,
    },
    /// As only hdf5-pure knows.
    Rows,
}

/// A chunk in the file.
#[derive(Clone, Copy)]
struct Stored {
    address: u64,
    size: u64,
    filter_mask: u32,
}

/// How a number is written.
#[derive(Clone, Copy)]
struct Number {
    size: usize,
    big_endian: bool,
}

/// Chunks of the last row of chunks that was asked for: frames of one animation follow one another.
#[derive(Default)]
struct Cache {
    row: u64,
    bytes: usize,
    chunks: HashMap<u64, Arc<Vec<u8>>>,
}

/// Most bytes of chunks that are kept.
const CACHE: usize = 64 << 20;
/// Wanted compartments that are no further apart than this are read at once: 4 kB, a page of a disk.
const GAP: u64 = 1024;
/// Greatest chunk, by the format's own limit.
const MAX_CHUNK: u64 = 1 << 32;

impl Table {
    pub(crate) fn open(store: &Store, file: &Path, path: &str) -> Result<Self, CircuitError> {
        let dataset = store.dataset(path)?;
        let [rows, columns] = match store.shape(path)?[..] {
            [rows, columns] => [rows, columns],
            ref other => {
                let (found, expected) = (other.to_vec(), "frames × compartments".into());
                return Err(store.fault(path, Fault::Shape { found, expected }));
            }
        };
        let chunk = dataset.chunk_shape();
        let chunk = chunk.map_err(|e| store.fault(path, hdf5(&e)))?;
        if chunk.is_some_and(|chunk| !capacity::listable(&[rows, columns], &chunk, store.size())) {
            let reason = "it declares more chunks than the file can hold".into();
            return Err(store.fault(path, Fault::Hdf5 { reason }));
        }
        store.afford_chunk(path)?;
        let datatype = dataset.datatype();
        let datatype = datatype.map_err(|e| store.fault(path, hdf5(&e)))?;
        let number = number(&datatype);
        if let (Datatype::FloatingPoint { size, .. }, None) = (&datatype, number) {
            let reason = format!("its floating-point numbers of {size} bytes are none of IEEE 754");
            return Err(store.fault(path, Fault::Hdf5 { reason }));
        }
        let access = match number {
            Some(number) => access(&dataset, number).map_err(|e| store.fault(path, hdf5(&e)))?,
            None => Access::Rows,
        };
        let bytes = File::open(file).map_err(|e| CircuitError::io(file, e))?;
        let bytes_len = bytes.metadata().map_or(0, |data| data.len());
        Ok(Self {
            file: store.name().into(),
            path: path.into(),
            dataset,
            rows,
            columns,
            access,
            bytes: Mutex::new(bytes),
            bytes_len,
            number,
            cache: Mutex::default(),
        })
    }

    /// Numbers of a row at these columns, in the order that they are asked for.
    ///
    /// Takes time for the chunks that hold them, not for the row.
    pub(crate) fn pick(&self, row: u64, columns: &[u64]) -> Result<Vec<f32>, CircuitError> {
        self.beyond("frame", row, self.rows)?;
        for &column in columns {
            self.beyond("compartment", column, self.columns)?;
        }
        match (&self.access, self.number) {
            (Access::Contiguous(address), Some(number)) => {
                self.runs(*address, number, row, columns)
            }
            (Access::Chunked { shape, .. }, Some(number)) => {
                self.chunked(*shape, number, row, columns)
            }
            _ => self.whole_row(row, columns),
        }
    }

    fn beyond(&self, what: &'static str, asked: u64, count: u64) -> Result<(), CircuitError> {
        if asked < count {
            return Ok(());
        }
        Err(self.fault(Fault::Beyond { what, asked, count }))
    }

    fn fault(&self, fault: Fault) -> CircuitError {
        CircuitError::new(&self.file, &self.path, fault)
    }

    fn whole_row(&self, row: u64, columns: &[u64]) -> Result<Vec<f32>, CircuitError> {
        let numbers = match self.number {
            // hdf5-pure knows no such numbers, but where they are.
            Some(number @ Number { size: 2, .. }) => {
                let bytes = self.dataset.read_raw_rows(row, 1);
                let bytes = bytes.map_err(|e| self.fault(hdf5(&e)))?;
                let values = 0..bytes.len() / number.size;
                values.map(|i| f64::from(number.read(&bytes, i))).collect()
            }
            _ => {
                let numbers = self.dataset.read_f64_rows(row, 1);
                numbers.map_err(|e| self.fault(hdf5(&e)))?
            }
        };
        let pick = |&column: &u64| numbers.get(column as usize).map(|&n| n as f32);
        let picked: Option<Vec<f32>> = columns.iter().map(pick).collect();
        picked.ok_or_else(|| {
            let (found, expected) = (vec![numbers.len() as u64], format!("[{}]", self.columns));
            self.fault(Fault::Shape { found, expected })
        })
    }

    /// Reads runs of bytes that lie near to one another.
    fn runs(
        &self,
        address: u64,
        number: Number,
        row: u64,
        columns: &[u64],
    ) -> Result<Vec<f32>, CircuitError> {
        let size = number.size as u64;
        let start = row
            .checked_mul(self.columns)
            .and_then(|first| first.checked_mul(size)?.checked_add(address));
        let start = start.ok_or_else(|| self.cut_short())?;
        let mut order: Vec<usize> = (0..columns.len()).collect();
        order.sort_unstable_by_key(|&i| columns[i]);
        let mut values = vec![0.0; columns.len()];
        for run in order.chunk_by(|&a, &b| columns[b] - columns[a] <= GAP) {
            let (from, to) = (columns[run[0]], columns[run[run.len() - 1]] + 1);
            let bytes = self.bytes_at(start + from * size, (to - from) * size)?;
            for &i in run {
                values[i] = number.read(&bytes, (columns[i] - from) as usize);
            }
        }
        Ok(values)
    }

    fn chunked(
        &self,
        shape: [u64; 2],
        number: Number,
        row: u64,
        columns: &[u64],
    ) -> Result<Vec<f32>, CircuitError> {
        let chunk_row = row / shape[0];
        let mut wanted: BTreeMap<u64, Vec<usize>> = BTreeMap::new();
        for (i, column) in columns.iter().enumerate() {
            wanted.entry(column / shape[1]).or_default().push(i);
        }
        let wanted: Vec<(u64, Vec<usize>)> = wanted.into_iter().collect();
        let first = (row % shape[0]) * shape[1];
        let read = |(column, places): &(u64, Vec<usize>)| {
            let chunk = self.chunk([chunk_row, *column])?;
            let Some(chunk) = chunk else {
                return Ok(None);
            };
            let value = |&i: &usize| {
                let within = first + columns[i] % shape[1];
                (i, number.read(&chunk, within as usize))
            };
            Ok(Some(places.iter().map(value).collect::<Vec<_>>()))
        };
        let parts: Result<Option<Vec<_>>, CircuitError> = wanted.par_iter().map(read).collect();
        // A chunk that was never written reads as the fill value, which hdf5-pure knows.
        let Some(parts) = parts? else {
            return self.whole_row(row, columns);
        };
        let mut values = vec![0.0; columns.len()];
        for (i, value) in parts.into_iter().flatten() {
            values[i] = value;
        }
        Ok(values)
    }

    /// The numbers of a chunk as they are in memory; `None` if it was never written. It is kept for the frames that
    /// follow.
    fn chunk(&self, at: [u64; 2]) -> Result<Option<Arc<Vec<u8>>>, CircuitError> {
        let lock = || self.cache.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = lock().get(at) {
            return Ok(Some(known));
        }
        let Some(bytes) = self.stored(at)?.map(Arc::new) else {
            return Ok(None);
        };
        if matches!(self.access, Access::Chunked { shape, .. } if shape[0] > 1) {
            lock().put(at, &bytes);
        }
        Ok(Some(bytes))
    }

    /// The numbers of a chunk from the file.
    fn stored(&self, at: [u64; 2]) -> Result<Option<Vec<u8>>, CircuitError> {
        let Access::Chunked {
            shape,
            filters,
            chunks,
        } = &self.access
        else {
            return Ok(None);
        };
        let Some(stored) = chunks.get(&at) else {
            return Ok(None);
        };
        let size = self.number.map_or(0, |n| n.size);
        let whole = shape[0] * shape[1] * size as u64;
        let mut bytes = self.bytes_at(stored.address, stored.size)?;
        for (place, filter) in filters.iter().enumerate().rev() {
            if stored.filter_mask >> place & 1 == 1 {
                continue;
            }
            bytes = match filter {
                1 => inflate(&bytes, whole).map_err(|e| {
                    let reason = format!("chunk {at:?}: {e}");
                    self.fault(Fault::Hdf5 { reason })
                })?,
                _ => unshuffle(&bytes, size),
            };
        }
        if bytes.len() as u64 != whole {
            let reason = format!("chunk {at:?} has {} bytes instead of {whole}", bytes.len());
            return Err(self.fault(Fault::Hdf5 { reason }));
        }
        Ok(Some(bytes))
    }

    fn bytes_at(&self, address: u64, count: u64) -> Result<Vec<u8>, CircuitError> {
        if address
            .checked_add(count)
            .is_none_or(|end| end > self.bytes_len)
        {
            return Err(self.cut_short());
        }
        let mut bytes = vec![0; count as usize];
        let mut file = self.bytes.lock().unwrap_or_else(PoisonError::into_inner);
        file.seek(SeekFrom::Start(address))
            .and_then(|_| file.read_exact(&mut bytes))
            .map_err(|e| self.fault(Fault::Io(e)))?;
        Ok(bytes)
    }

    fn cut_short(&self) -> CircuitError {
        let reason = "the numbers lie beyond the file's end".into();
        self.fault(Fault::Hdf5 { reason })
    }
}

impl Cache {
    fn get(&self, [row, column]: [u64; 2]) -> Option<Arc<Vec<u8>>> {
        let chunk = self.chunks.get(&column).filter(|_| self.row == row);
        chunk.cloned()
    }

    fn put(&mut self, [row, column]: [u64; 2], bytes: &Arc<Vec<u8>>) {
        if self.row != row {
            *self = Self {
                row,
                ..Self::default()
            };
        }
        if self.bytes + bytes.len() <= CACHE && self.chunks.insert(column, bytes.clone()).is_none()
        {
            self.bytes += bytes.len();
        }
    }
}

impl Number {
    fn read(self, bytes: &[u8], index: usize) -> f32 {
        let mut own = [0; 8];
        let own = &mut own[..self.size];
        own.copy_from_slice(&bytes[index * self.size..(index + 1) * self.size]);
        if self.big_endian {
            own.reverse();
        }
        match *own {
            [a, b] => half(u16::from_le_bytes([a, b])),
            [a, b, c, d] => f32::from_le_bytes([a, b, c, d]),
            [a, b, c, d, e, f, g, h] => f64::from_le_bytes([a, b, c, d, e, f, g, h]) as f32,
            _ => f32::NAN,
        }
    }
}

/// A number of IEEE 754 of 2 bytes: sign, 5 bits of the exponent, 10 of the fraction.
fn half(bits: u16) -> f32 {
    let sign = if bits >> 15 == 1 { -1.0 } else { 1.0 };
    let (exponent, fraction) = (i32::from(bits >> 10 & 0x1f), f32::from(bits & 0x3ff));
    match exponent {
        0 => sign * fraction * 2_f32.powi(-24),
        31 if fraction == 0.0 => sign * f32::INFINITY,
        31 => f32::NAN,
        _ => sign * (1024.0 + fraction) * 2_f32.powi(exponent - 25),
    }
}

/// How a datatype is written, if it is IEEE 754 of 2, 4 or 8 bytes.
fn number(datatype: &Datatype) -> Option<Number> {
    let Datatype::FloatingPoint {
        size,
        byte_order,
        layout,
    } = datatype
    else {
        return None;
    };
    // Others of as many bytes, like bfloat16.
    if *size == 2 && (layout.exponent_size, layout.mantissa_size) != (5, 10) {
        return None;
    }
    let big_endian = match byte_order {
        DatatypeByteOrder::LittleEndian => false,
        DatatypeByteOrder::BigEndian => true,
        _ => return None,
    };
    let size = *size as usize;
    matches!(size, 2 | 4 | 8).then_some(Number { size, big_endian })
}

fn access(dataset: &Dataset, number: Number) -> Result<Access, hdf5_pure::Error> {
    let (shape, index) = match dataset.layout()? {
        Layout::Contiguous {
            address: Some(address),
            ..
        } => return Ok(Access::Contiguous(address)),
        Layout::Chunked { chunk_shape, index } => (chunk_shape, index),
        _ => return Ok(Access::Rows),
    };
    let filters: Vec<u16> = dataset.filter_pipeline().iter().map(|f| f.id).collect();
    let fits = |[rows, columns]: [u64; 2]| {
        let count = rows.checked_mul(columns);
        count.is_some_and(|n| n > 0 && n <= MAX_CHUNK / number.size as u64)
    };
    let shape: [u64; 2] = match shape[..] {
        [rows, columns] if fits([rows, columns]) => [rows, columns],
        _ => return Ok(Access::Rows),
    };
    if index == ChunkIndex::BTreeV2 || filters.iter().any(|id| ![1, 2].contains(id)) {
        return Ok(Access::Rows);
    }
    let mut chunks = HashMap::new();
    for chunk in dataset.chunks()? {
        if let [row, column] = chunk.offset[..] {
            let stored = Stored {
                address: chunk.address,
                size: chunk.storage_size,
                filter_mask: chunk.filter_mask,
            };
            chunks.insert([row / shape[0], column / shape[1]], stored);
        }
    }
    Ok(Access::Chunked {
        shape,
        filters,
        chunks,
    })
}
