//! JSON with the file and the key at hand, so that every error names both.

use std::path::Path;

use neurotess_formats::{indices, read_regular};
use serde_json::Value;

use crate::{CircuitError, Fault};

/// A JSON file.
pub(crate) struct Document {
    file: String,
    root: Value,
}

impl Document {
    /// Reads and parses a file.
    pub(crate) fn open(path: &Path) -> Result<Self, CircuitError> {
        let bytes = read_regular(path).map_err(|e| CircuitError::io(path, e))?;
        Self::parse(&path.display().to_string(), &bytes)
    }

    /// Parses what is in memory. A byte-order mark is skipped.
    pub(crate) fn parse(file: &str, bytes: &[u8]) -> Result<Self, CircuitError> {
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        let root = serde_json::from_slice(bytes).map_err(|e| {
            let (line, reason) = place_and_reason(&e);
            CircuitError::at_line(file, line, "", Fault::Json { reason })
        })?;
        let file = file.into();
        Ok(Self { file, root })
    }

    /// The whole.
    pub(crate) fn root(&self) -> Json<'_> {
        Json {
            file: &self.file,
            key: String::new(),
            value: &self.root,
        }
    }
}

/// The line of an error, and what it says without that.
pub(crate) fn place_and_reason(error: &serde_json::Error) -> (u64, String) {
    let place = format!(" at line {} column {}", error.line(), error.column());
    let text = error.to_string();
    let reason = text.strip_suffix(&place).unwrap_or(&text);
    (error.line().max(1) as u64, reason.into())
}

/// A value and where it stands.
#[derive(Clone)]
pub(crate) struct Json<'a> {
    pub(crate) file: &'a str,
    pub(crate) key: String,
    pub(crate) value: &'a Value,
}

impl<'a> Json<'a> {
    /// The value of a key, if the key is there and not null.
    pub(crate) fn get(&self, key: &str) -> Option<Self> {
        let value = self.value.get(key)?;
        (!value.is_null()).then(|| self.inner(key, value))
    }

    /// The value of a key that must be there.
    pub(crate) fn need(&self, key: &str) -> Result<Self, CircuitError> {
        self.get(key)
            .ok_or_else(|| CircuitError::new(self.file, self.join(key), Fault::Missing))
    }

    pub(crate) fn text(&self) -> Result<&'a str, CircuitError> {
        self.value.as_str().ok_or_else(|| self.wrong("a string"))
    }

    pub(crate) fn real(&self) -> Result<f64, CircuitError> {
        self.value.as_f64().ok_or_else(|| self.wrong("a number"))
    }

    /// An index, however it is written: 7 or 7.0.
    pub(crate) fn natural(&self) -> Result<u64, CircuitError> {
        let whole = |v: f64| v.fract() == 0.0 && (0.0..=9e15).contains(&v);
        let real = || self.value.as_f64().filter(|&v| whole(v)).map(|v| v as u64);
        self.value.as_u64().or_else(real).ok_or_else(|| {
            self.fault(Fault::Type {
                found: self.value.to_string(),
                expected: indices::NATURAL,
            })
        })
    }

    /// Compartments of a list.
    pub(crate) fn items(&self) -> Result<Vec<Self>, CircuitError> {
        let list = self.value.as_array().ok_or_else(|| self.wrong("a list"))?;
        let item = |(index, value)| Self {
            file: self.file,
            key: format!("{}[{index}]", self.key),
            value,
        };
        Ok(list.iter().enumerate().map(item).collect())
    }

    /// Entries of an object, sorted by key.
    pub(crate) fn entries(&self) -> Result<Vec<(&'a str, Self)>, CircuitError> {
        let map = self.value.as_object();
        let map = map.ok_or_else(|| self.wrong("an object"))?;
        let mut entries: Vec<_> = map
            .iter()
            .map(|(key, value)| (key.as_str(), self.inner(key, value)))
            .collect();
        entries.sort_by_key(|&(key, _)| key);
        Ok(entries)
    }

    /// A fault of this value.
    pub(crate) fn fault(&self, fault: Fault) -> CircuitError {
        let key = (!self.key.is_empty()).then(|| self.key.clone());
        CircuitError {
            file: self.file.into(),
            line: None,
            key,
            fault,
        }
    }

    pub(crate) fn wrong(&self, expected: &'static str) -> CircuitError {
        let found = match self.value {
            Value::Null => "null",
            Value::Bool(_) => "true or false",
            Value::Number(_) => "a number",
            Value::String(_) => "a string",
            Value::Array(_) => "a list",
            Value::Object(_) => "an object",
        };
        let found = found.into();
        self.fault(Fault::Type { found, expected })
    }

    fn inner(&self, key: &str, value: &'a Value) -> Self {
        Self {
            file: self.file,
            key: self.join(key),
            value,
        }
    }

    fn join(&self, key: &str) -> String {
        if self.key.is_empty() {
            key.into()
        } else {
            format!("{}.{key}", self.key)
        }
    }
}
