//! Circuits on the command line.

pub(crate) mod synth;
