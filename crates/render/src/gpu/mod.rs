//! The device: opening it, its errors, buffers and times.

pub(crate) mod adapter;
pub(crate) mod buffers;
pub(crate) mod capabilities;
pub(crate) mod device;
pub(crate) mod error;
pub(crate) mod growable;
mod heap;
pub(crate) mod parallel;
pub(crate) mod requirements;
mod scopes;
pub(crate) mod shader;
pub(crate) mod timing;
