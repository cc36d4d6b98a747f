//! Graphics hardware: a bundle that tests and measures on a machine with nothing but a driver, and the page of its
//! figures.
//!
//! [`bundle`] makes it, here. Its `run.sh` starts [`run`] there, which runs one of the [`parts`] after the other and
//! keeps what they say as [`results`]. [`page`] writes those as Markdown with [`plots`], and [`publish`] adds them to
//! `benchmarks/gpu.md`.

pub(crate) mod bundle;
mod drawn;
mod goals;
mod page;
mod parts;
mod plots;
pub(crate) mod publish;
mod results;
pub(crate) mod run;
mod sections;
mod started;
mod tables;
mod verdicts;
