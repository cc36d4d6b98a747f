//! Inputs, outputs and threads.

pub(crate) mod batch;
pub(crate) mod circuits;
pub(crate) mod claims;
pub(crate) mod inputs;
pub(crate) mod morphologies;
pub(crate) mod output;
pub(crate) mod record;
pub(crate) mod standard_input;
pub(crate) mod table;
pub(crate) mod targets;
pub(crate) mod workers;
