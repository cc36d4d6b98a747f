//! HDF5 behind a small window: what circuits and reports ask of a file.
//!
//! Reports are larger than memory: of them only parts are read, where they lie.

use std::collections::{BTreeSet, HashMap};
use std::path::Path;

use hdf5_pure::{Dataset, Datatype, DatatypeByteOrder, File, VlenStringReadOptions};

use neurotess_formats::budget::{Budget, Overdrawn};
use neurotess_formats::capacity::{self, Excess};
use neurotess_formats::indices::{self, IndexError};
use neurotess_formats::{layout_5, regular};

use crate::{CircuitError, Fault};

/// A file, open for reading.
pub(crate) struct Store {
    file: File,
    name: String,
    /// Bytes of the file.
    size: u64,
    budget: Budget,
}

/// A dataset of one value per row.
pub(crate) enum Column {
    /// Numbers.
    Numbers(Vec<f64>),
    /// Text, each as its place in a list.
    Text {
        library: Vec<String>,
        indices: Vec<u32>,
    },
}

/// What a number becomes.
const BYTES_OF_NUMBER: u64 = 8;

/// Most rows that one dataset of nodes may have: their number is 32 bits wide.
const MAX_ROWS: u64 = u32::MAX as u64;

impl Store {
    /// Opens a file that is read in parts, where they lie.
    pub(crate) fn open(path: &Path) -> Result<Self, CircuitError> {
        Self::open_by(path, layout_5::open_streaming)
    }

    /// Opens a file that is read nearly whole. Up to a gigabyte is read at once: strings lie one by
    /// one, and a million calls to the system for each column of them take longer than all else.
    pub(crate) fn open_whole(path: &Path) -> Result<Self, CircuitError> {
        let size = std::fs::metadata(path).map_or(0, |data| data.len());
        if size <= 1 << 30 {
            Self::open_by(path, layout_5::open)
        } else {
            Self::open(path)
        }
    }

    fn open_by<'a>(
        path: &'a Path,
        open: impl FnOnce(&'a Path) -> Result<File, hdf5_pure::Error>,
    ) -> Result<Self, CircuitError> {
        let name = path.display().to_string();
        regular(path).map_err(|e| CircuitError::io(path, e))?;
        match open(path) {
            Ok(file) => Ok(Self {
                size: file.file_size(),
                budget: Budget::new(file.file_size()),
                file,
                name,
            }),
            Err(e) => Err(CircuitError::of_file(&name, hdf5(&e))),
        }
    }

    pub(crate) fn name(&self) -> &str {
        &self.name
    }

    pub(crate) fn fault(&self, path: &str, fault: Fault) -> CircuitError {
        CircuitError::new(&self.name, path, fault)
    }

    pub(crate) fn has(&self, path: &str) -> bool {
        self.file.dataset(path).is_ok()
    }

    pub(crate) fn has_group(&self, path: &str) -> bool {
        self.file.group(path).is_ok()
    }

    /// Names of the groups in a group, sorted; none where there is no such group.
    pub(crate) fn groups(&self, path: &str) -> Vec<String> {
        let mut names = self
            .file
            .group(path)
            .and_then(|g| g.groups())
            .unwrap_or_default();
        names.sort();
        names
    }

    /// Paths of all groups that have these datasets, in groups up to so many deep. One pass over the file: to look
    /// for thousands of paths one by one takes seconds.
    pub(crate) fn groups_with(&self, datasets: &[&str], depth: u32) -> BTreeSet<String> {
        let mut found = BTreeSet::new();
        let mut to_see = vec![(String::new(), self.file.root(), 0)];
        // Links may lead around in circles.
        let mut left: u32 = 1 << 22;
        while let Some((path, group, deep)) = to_see.pop() {
            left -= 1;
            if left == 0 {
                break;
            }
            let own = group.datasets().unwrap_or_default();
            if datasets.iter().all(|name| own.iter().any(|o| o == name)) {
                found.insert(path);
            } else if deep < depth {
                let inner = group.iter_groups().into_iter().flatten();
                to_see.extend(inner.map(|(name, group)| match &*path {
                    "" => (name, group, deep + 1),
                    path => (format!("{path}/{name}"), group, deep + 1),
                }));
            }
        }
        found
    }

    /// Names of the datasets in a group, sorted; none where there is no such group.
    pub(crate) fn datasets(&self, path: &str) -> Vec<String> {
        let mut names = self
            .file
            .group(path)
            .and_then(|g| g.datasets())
            .unwrap_or_default();
        names.sort();
        names
    }

    /// The path of the first dataset that is there.
    pub(crate) fn first_of(&self, paths: &[String]) -> Option<String> {
        paths.iter().find(|path| self.has(path)).cloned()
    }

    pub(crate) fn dataset(&self, path: &str) -> Result<Dataset, CircuitError> {
        let dataset = self.file.dataset(path);
        dataset.map_err(|e| self.fault(path, hdf5(&e)))
    }

    pub(crate) fn shape(&self, path: &str) -> Result<Vec<u64>, CircuitError> {
        let shape = self.dataset(path)?.shape();
        shape.map_err(|e| self.fault(path, hdf5(&e)))
    }

    /// Bytes of the file.
    pub(crate) fn size(&self) -> u64 {
        self.size
    }

    /// An error if the file cannot hold what a dataset declares.
    pub(crate) fn believe(&self, path: &str) -> Result<(), CircuitError> {
        match capacity::excess(&self.dataset(path)?, self.size) {
            Ok(None) => Ok(()),
            Ok(Some(Excess { declared, possible })) => {
                Err(self.fault(path, Fault::Declared { declared, possible }))
            }
            Err(e) => Err(self.fault(path, hdf5(&e))),
        }
    }

    /// Takes so many bytes for what is made of a dataset.
    pub(crate) fn afford(&self, path: &str, bytes: u64) -> Result<(), CircuitError> {
        let taken = self.budget.take(bytes);
        taken.map_err(|overdrawn| self.fault(path, large(overdrawn)))
    }

    /// An error if one chunk of a dataset becomes more than is allowed. Whoever reads one number of it unpacks all.
    pub(crate) fn afford_chunk(&self, path: &str) -> Result<(), CircuitError> {
        let dataset = self.dataset(path)?;
        let fault = |e: hdf5_pure::Error| self.fault(path, hdf5(&e));
        let Some(chunk) = dataset.chunk_shape().map_err(fault)? else {
            return Ok(());
        };
        let bytes = dataset.element_size().map_err(fault)?.max(1);
        let made = chunk.iter().fold(bytes, |all, &n| all.saturating_mul(n));
        let allowed = self.budget.allows(made);
        allowed.map_err(|overdrawn| self.fault(path, large(overdrawn)))
    }

    /// Rows of a dataset that must have one dimension, and no more than the file can hold.
    pub(crate) fn rows(&self, path: &str) -> Result<u64, CircuitError> {
        match self.shape(path)?[..] {
            [rows] if rows <= MAX_ROWS => self.believe(path).map(|()| rows),
            [count] => Err(self.fault(path, Fault::TooMany { count })),
            ref other => {
                let (found, expected) = (other.to_vec(), "one dimension".into());
                Err(self.fault(path, Fault::Shape { found, expected }))
            }
        }
    }

    pub(crate) fn reals(&self, path: &str) -> Result<Vec<f64>, CircuitError> {
        self.read(path, |dataset| dataset.read_f64().map_err(|e| hdf5(&e)))
    }

    /// Whole numbers, which may be negative.
    pub(crate) fn wholes(&self, path: &str) -> Result<Vec<i64>, CircuitError> {
        self.read(path, |dataset| {
            indices::wholes(dataset, None).map_err(|e| index(e, 0))
        })
    }

    /// Indices: whole numbers of 0 or more.
    pub(crate) fn naturals(&self, path: &str) -> Result<Vec<u64>, CircuitError> {
        self.read(path, |dataset| {
            indices::naturals(dataset, None).map_err(|e| index(e, 0))
        })
    }

    /// Shares of a length, from 0 to 1.
    pub(crate) fn shares(&self, path: &str) -> Result<Vec<f64>, CircuitError> {
        let values = self.reals(path)?;
        let outside = |value: &f64| !(0.0..=1.0).contains(value);
        match values.iter().position(outside) {
            None => Ok(values),
            Some(row) => Err(self.fault(
                path,
                Fault::Row {
                    row: row as u64,
                    value: values[row].to_string(),
                    expected: "a share from 0 to 1",
                },
            )),
        }
    }

    /// A table of real numbers, row by row.
    pub(crate) fn matrix(
        &self,
        path: &str,
        rows: u64,
        columns: u64,
    ) -> Result<Vec<f64>, CircuitError> {
        let shape = self.shape(path)?;
        if shape != [rows, columns] {
            let (found, expected) = (shape, format!("[{rows}, {columns}]"));
            return Err(self.fault(path, Fault::Shape { found, expected }));
        }
        self.believe(path)?;
        self.afford(
            path,
            rows.saturating_mul(columns).saturating_mul(BYTES_OF_NUMBER),
        )?;
        let values = self.dataset(path)?.read_f64();
        values.map_err(|e| self.fault(path, hdf5(&e)))
    }

    /// The text of a dataset that has one; none where there is no such text.
    pub(crate) fn text(&self, path: &str) -> Option<String> {
        self.believe(path).ok()?;
        let dataset = self.dataset(path).ok()?;
        let texts = match dataset.datatype().ok()? {
            Datatype::VariableLength { .. } => dataset.read_vlen_strings(self.payload()),
            _ => dataset.read_string(),
        };
        texts.ok()?.into_iter().next()
    }

    fn read<T>(
        &self,
        path: &str,
        read: impl FnOnce(&Dataset) -> Result<Vec<T>, Fault>,
    ) -> Result<Vec<T>, CircuitError> {
        let rows = self.rows(path)?;
        self.afford(path, rows.saturating_mul(BYTES_OF_NUMBER))?;
        let values = read(&self.dataset(path)?).map_err(|fault| self.fault(path, fault))?;
        if values.len() as u64 != rows {
            let (found, expected) = (vec![values.len() as u64], format!("[{rows}]"));
            return Err(self.fault(path, Fault::Shape { found, expected }));
        }
        Ok(values)
    }

    /// Some rows of natural numbers.
    pub(crate) fn naturals_of(
        &self,
        path: &str,
        from: u64,
        count: u64,
    ) -> Result<Vec<u64>, CircuitError> {
        self.afford_chunk(path)?;
        let rows = indices::naturals(&self.dataset(path)?, Some((from, count)));
        rows.map_err(|e| self.fault(path, index(e, from)))
    }

    /// Some rows of a table of whole numbers with as many columns.
    pub(crate) fn wholes_of(
        &self,
        path: &str,
        (from, count): (u64, u64),
        width: usize,
    ) -> Result<Vec<i64>, CircuitError> {
        self.afford_chunk(path)?;
        let rows = indices::wholes(&self.dataset(path)?, Some((from, count)));
        rows.map_err(|e| {
            let e = match e {
                IndexError::Number {
                    place,
                    value,
                    expected,
                } => IndexError::Number {
                    place: place / width.max(1) as u64,
                    value,
                    expected,
                },
                other => other,
            };
            self.fault(path, index(e, from))
        })
    }

    /// Some rows of real numbers.
    pub(crate) fn reals_of(
        &self,
        path: &str,
        from: u64,
        count: u64,
    ) -> Result<Vec<f64>, CircuitError> {
        self.afford_chunk(path)?;
        let rows = self.dataset(path)?.read_f64_rows(from, count);
        rows.map_err(|e| self.fault(path, hdf5(&e)))
    }

    /// A dataset of numbers, strings or an enumeration. `library`: path of the texts that its numbers
    /// stand for, where there are such.
    pub(crate) fn column(&self, path: &str, library: &str) -> Result<Column, CircuitError> {
        let datatype = self.dataset(path)?.datatype();
        let datatype = datatype.map_err(|e| self.fault(path, hdf5(&e)))?;
        if let Datatype::Enumeration { .. } = datatype {
            return self.coded(path, &enumeration(&datatype));
        }
        if is_string(&datatype) {
            return self.texts(path);
        }
        if self.has(library) {
            let texts = self.strings(library)?;
            return self.coded(path, &(0..).zip(texts).collect());
        }
        Ok(Column::Numbers(self.reals(path)?))
    }

    /// Strings, each distinct one kept once: a million of four letters are not a million allocations.
    fn texts(&self, path: &str) -> Result<Column, CircuitError> {
        let rows = self.rows(path)?;
        self.afford(path, rows.saturating_mul(BYTES_OF_NUMBER))?;
        let dataset = self.dataset(path)?;
        let mut distinct = Distinct::default();
        let visited = dataset.visit_vlen_strings(self.payload(), |text| distinct.push(text));
        if visited.is_err() {
            // Strings of a fixed length; or whatever is wrong, told again.
            distinct = Distinct::default();
            for text in self.strings(path)? {
                distinct.push(&text);
            }
        }
        let Distinct {
            library, indices, ..
        } = distinct;
        if indices.len() as u64 != rows {
            let (found, expected) = (vec![indices.len() as u64], format!("[{rows}]"));
            return Err(self.fault(path, Fault::Shape { found, expected }));
        }
        Ok(Column::Text { library, indices })
    }

    fn strings(&self, path: &str) -> Result<Vec<String>, CircuitError> {
        self.read(path, |dataset| {
            let texts = dataset.datatype().and_then(|datatype| match datatype {
                Datatype::VariableLength { .. } => dataset.read_vlen_strings(self.payload()),
                _ => dataset.read_string(),
            });
            texts.map_err(|e| hdf5(&e))
        })
    }

    /// References may all name one long string: what they give together is bounded by the file.
    fn payload(&self) -> VlenStringReadOptions {
        let most = self.size.saturating_mul(8).saturating_add(1 << 20);
        let most = usize::try_from(most).unwrap_or(usize::MAX);
        VlenStringReadOptions::new().with_max_payload_bytes(most)
    }

    /// Text by their numbers; a number without a text stands for itself.
    fn coded(&self, path: &str, texts: &HashMap<i64, String>) -> Result<Column, CircuitError> {
        let codes = self.wholes(path)?;
        let mut library: Vec<String> = Vec::new();
        let mut places: HashMap<i64, u32> = HashMap::new();
        let mut last = (i64::MIN, 0);
        let mut indices = Vec::with_capacity(codes.len());
        for code in codes {
            if code != last.0 || indices.is_empty() {
                let place = *places.entry(code).or_insert_with(|| {
                    let text = texts.get(&code).cloned();
                    library.push(text.unwrap_or_else(|| code.to_string()));
                    library.len() as u32 - 1
                });
                last = (code, place);
            }
            indices.push(last.1);
        }
        Ok(Column::Text { library, indices })
    }

    /// A text attribute of a dataset or a group.
    pub(crate) fn text_attribute(&self, path: &str, name: &str) -> Option<String> {
        let of_dataset = self.file.dataset(path).and_then(|d| d.attrs());
        let all = of_dataset.or_else(|_| self.file.group(path).and_then(|g| g.attrs()));
        all.ok()?.get(name)?.as_str().map(str::to_owned)
    }
}

fn large(overdrawn: Overdrawn) -> Fault {
    let Overdrawn { made, file, most } = overdrawn;
    Fault::Large { made, file, most }
}

/// The fault of an index; `from`: the row of the first that was asked for.
fn index(error: IndexError, from: u64) -> Fault {
    match error {
        IndexError::Hdf5(e) => hdf5(&e),
        IndexError::Number {
            place,
            value,
            expected,
        } => Fault::Row {
            row: from + place,
            value,
            expected,
        },
    }
}

/// The fault that the library's error stands for.
pub(crate) fn hdf5(error: &hdf5_pure::Error) -> Fault {
    Fault::Hdf5 {
        reason: error.to_string(),
    }
}

fn is_string(datatype: &Datatype) -> bool {
    matches!(
        datatype,
        Datatype::String { .. }
            | Datatype::VariableLength {
                is_string: true,
                ..
            }
    )
}

/// Names of an enumeration by their numbers, of which members hold the bytes.
fn enumeration(datatype: &Datatype) -> HashMap<i64, String> {
    let Datatype::Enumeration {
        base_type, members, ..
    } = datatype
    else {
        return HashMap::new();
    };
    let big = matches!(
        **base_type,
        Datatype::FixedPoint {
            byte_order: DatatypeByteOrder::BigEndian,
            ..
        }
    );
    let mut names = HashMap::new();
    for member in members {
        let mut bytes: Vec<u8> = member.value.iter().take(8).copied().collect();
        if big {
            bytes.reverse();
        }
        // With and without a sign: which of them is meant, the numbers in the dataset tell.
        for sign in [
            0,
            u8::from(bytes.last().is_some_and(|b| b & 0x80 != 0)) * 0xff,
        ] {
            let mut wide = [sign; 8];
            wide[..bytes.len()].copy_from_slice(&bytes);
            names.insert(i64::from_le_bytes(wide), member.name.clone());
        }
    }
    names
}

/// Text without their repetitions, in the order of their first appearance.
#[derive(Default)]
struct Distinct {
    places: HashMap<String, u32>,
    library: Vec<String>,
    indices: Vec<u32>,
}

impl Distinct {
    fn push(&mut self, text: &str) {
        let place = match self.places.get(text) {
            Some(&place) => place,
            None => {
                let place = self.library.len() as u32;
                self.library.push(text.into());
                self.places.insert(text.into(), place);
                place
            }
        };
        self.indices.push(place);
    }
}
