//! A warning of a cell, as JSON.

use neurotess::recipe::Warning;
use serde::Serialize;

/// A warning about the file (with a line), or about a repair of the mesh (with a sample).
#[derive(Clone, Debug, Serialize)]
pub(crate) struct CellWarning {
    pub(crate) line: Option<u64>,
    pub(crate) sample: Option<i64>,
    pub(crate) code: &'static str,
    pub(crate) message: String,
    pub(crate) count: u64,
}

impl From<&Warning> for CellWarning {
    fn from(warning: &Warning) -> Self {
        Self {
            line: warning.line(),
            sample: warning.sample(),
            code: warning.code(),
            message: warning.to_string(),
            count: warning.count(),
        }
    }
}
