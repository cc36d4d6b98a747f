//! The device: opening it, its errors, buffers and times.

pub(crate) mod device;
pub(crate) mod error;
pub(crate) mod store;
pub(crate) mod timing;
