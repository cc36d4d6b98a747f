//! Files, and the threads that read and write them.

pub(crate) mod frames;
pub(crate) mod paths;
pub mod save;
pub mod sources;
pub mod tasks;
