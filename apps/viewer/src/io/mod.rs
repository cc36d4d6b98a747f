//! Files, and the threads that read and write them.

pub(crate) mod autosave;
pub(crate) mod background;
pub(crate) mod circuit_caches;
pub(crate) mod find;
pub(crate) mod frames;
pub(crate) mod load;
pub(crate) mod markers;
pub(crate) mod meshes;
pub(crate) mod paths;
pub(crate) mod remesh;
pub(crate) mod save;
pub(crate) mod single;
pub(crate) mod task;
pub(crate) mod traces;
pub(crate) mod worker;
