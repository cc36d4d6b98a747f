//! Options that several commands share.

pub(crate) mod cells;
pub(crate) mod rings;
