//! HDF5 behind a small window: what our readers ask of a file, and nothing of the library that
//! answers.

use std::path::Path;

use crate::budget::{Budget, Overdrawn};
use crate::indices::{self, IndexError};
use crate::{Fault, capacity, layout_5};

/// A file, open for reading.
pub(crate) struct Store {
    file: hdf5_pure::File,
    /// Bytes of the file.
    size: u64,
    budget: Budget,
    /// A group that most is asked of, with its path and a slash: to find it among thousands takes long, so it is done
    /// once.
    focus: Option<(String, hdf5_pure::Group)>,
}

/// What a number becomes: itself, and its part of a point, a section and a morphology.
const BYTES_OF_NUMBER: u64 = 24;

/// A table of numbers.
pub(crate) struct Table<T> {
    pub(crate) rows: usize,
    pub(crate) columns: usize,
    values: Vec<T>,
}

impl<T> Table<T> {
    pub(crate) fn row(&self, row: usize) -> &[T] {
        &self.values[row * self.columns..(row + 1) * self.columns]
    }
}

impl Store {
    /// # Errors
    /// [`Fault::Hdf5`] if the bytes are no HDF5 file.
    pub(crate) fn from_bytes(bytes: Vec<u8>) -> Result<Self, Fault> {
        let size = bytes.len() as u64;
        let file = layout_5::from_bytes(bytes).map_err(|e| hdf5("the file", &e))?;
        Ok(Self {
            file,
            size,
            budget: Budget::new(size),
            focus: None,
        })
    }

    /// Opens a file that is read where its parts lie.
    pub(crate) fn open(path: &Path) -> Result<Self, Fault> {
        let file = layout_5::open_streaming(path).map_err(|e| hdf5("the file", &e))?;
        let size = file.file_size();
        Ok(Self {
            file,
            size,
            budget: Budget::new(size),
            focus: None,
        })
    }

    /// Prepares for questions about what is in a group.
    pub(crate) fn focus(&mut self, group: &str) {
        let found = self.file.group(group).ok();
        self.focus = found.map(|found| (format!("{group}/"), found));
    }

    fn dataset(&self, path: &str) -> Result<hdf5_pure::Dataset, hdf5_pure::Error> {
        match self.focused(path) {
            Some((group, rest)) => group.dataset(rest),
            None => self.file.dataset(path),
        }
    }

    fn group(&self, path: &str) -> Result<hdf5_pure::Group, hdf5_pure::Error> {
        match self.focused(path) {
            Some((group, rest)) => group.group(rest),
            None => self.file.group(path),
        }
    }

    /// The group in focus, and the path within it.
    fn focused<'p>(&self, path: &'p str) -> Option<(&hdf5_pure::Group, &'p str)> {
        let (before, group) = self.focus.as_ref()?;
        Some((group, path.strip_prefix(before.as_str())?))
    }

    /// Whether there is a dataset of this path.
    pub(crate) fn has(&self, path: &str) -> bool {
        self.dataset(path).is_ok()
    }

    /// Whether there is a group of this path.
    pub(crate) fn has_group(&self, path: &str) -> bool {
        self.group(path).is_ok()
    }

    /// Names of the groups in the group of this path; none where there is no such group.
    pub(crate) fn groups(&self, path: &str) -> Vec<String> {
        let group = if path.is_empty() {
            Ok(self.file.root())
        } else {
            self.group(path)
        };
        group.and_then(|g| g.groups()).unwrap_or_default()
    }

    /// An attribute of a group as whole numbers; empty where there is none.
    pub(crate) fn whole_attribute(&self, group: &str, name: &str) -> Vec<i64> {
        use hdf5_pure::AttrValue as A;
        let attributes = self.group(group).and_then(|g| g.attrs());
        let Ok(Some(value)) = attributes.map(|mut all| all.remove(name)) else {
            return Vec::new();
        };
        match value {
            A::U8(v) => vec![v.into()],
            A::I8(v) => vec![v.into()],
            A::U32(v) => vec![v.into()],
            A::I32(v) => vec![v.into()],
            A::I64(v) => vec![v],
            A::U64(v) => vec![i64::try_from(v).unwrap_or(i64::MAX)],
            A::U8Array(v) => v.into_iter().map(i64::from).collect(),
            A::U32Array(v) => v.into_iter().map(i64::from).collect(),
            A::I32Array(v) => v.into_iter().map(i64::from).collect(),
            A::I64Array(v) => v,
            _ => Vec::new(),
        }
    }

    /// A dataset of real numbers. `columns`: how many there must be.
    pub(crate) fn reals(&self, path: &str, columns: usize) -> Result<Table<f64>, Fault> {
        let read = |dataset: &hdf5_pure::Dataset| dataset.read_f64().map_err(|e| hdf5(path, &e));
        self.table(path, columns, read)
    }

    /// A dataset of whole numbers. `columns`: how many there must be.
    pub(crate) fn wholes(&self, path: &str, columns: usize) -> Result<Table<i64>, Fault> {
        let read = |dataset: &hdf5_pure::Dataset| {
            indices::wholes(dataset, None).map_err(|e| match e {
                IndexError::Hdf5(e) => hdf5(path, &e),
                IndexError::Number { place, value, .. } => Fault::Row {
                    dataset: path.into(),
                    row: place / columns.max(1) as u64,
                    fault: Box::new(Fault::NotWhole {
                        column: "a number",
                        text: value,
                    }),
                },
            })
        };
        self.table(path, columns, read)
    }

    fn table<T>(
        &self,
        path: &str,
        columns: usize,
        read: impl FnOnce(&hdf5_pure::Dataset) -> Result<Vec<T>, Fault>,
    ) -> Result<Table<T>, Fault> {
        let dataset = self.dataset(path).map_err(|e| hdf5(path, &e))?;
        let shape = dataset.shape().map_err(|e| hdf5(path, &e))?;
        let rows = match *shape {
            [rows, found] if found == columns as u64 => rows,
            [rows] if columns == 1 => rows,
            _ => {
                return Err(Fault::Shape {
                    dataset: path.into(),
                    found: shape,
                    columns,
                });
            }
        };
        let excess = capacity::excess(&dataset, self.size).map_err(|e| hdf5(path, &e))?;
        if let Some(capacity::Excess { declared, possible }) = excess {
            return Err(Fault::Declared {
                dataset: path.into(),
                declared,
                possible,
            });
        }
        let numbers = rows.saturating_mul(columns as u64);
        let made = self.budget.take(numbers.saturating_mul(BYTES_OF_NUMBER));
        if let Err(Overdrawn { made, file, most }) = made {
            return Err(Fault::Large {
                dataset: path.into(),
                made,
                file,
                most,
            });
        }
        let values = read(&dataset)?;
        let rows = usize::try_from(rows).unwrap_or(usize::MAX);
        if rows.checked_mul(columns) != Some(values.len()) {
            return Err(Fault::Shape {
                dataset: path.into(),
                found: shape,
                columns,
            });
        }
        Ok(Table {
            rows,
            columns,
            values,
        })
    }
}

fn hdf5(place: &str, error: &hdf5_pure::Error) -> Fault {
    Fault::Hdf5 {
        place: place.into(),
        reason: error.to_string(),
    }
}
