//! Inputs, outputs and threads.

pub(crate) mod batch;
pub(crate) mod circuits;
pub(crate) mod inputs;
pub(crate) mod morphologies;
pub(crate) mod output;
pub(crate) mod table;
pub(crate) mod workers;
