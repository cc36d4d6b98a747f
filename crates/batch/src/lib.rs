//! Many tracings, or the cells of a circuit, meshed into a folder: [`Batch`].
//!
//! ```text
//! paths ─▶ Inputs ─targets─▶ Jobs ─shard, record─▶ Plan ─▶ workers: claim, cell, record ─▶ files
//!                                                              └─▶ Events, BatchReport
//! ```
//!
//! A worker has one cell in memory. A cell is claimed before it is read, so that several processes can share a folder; what
//! its file was made from is written down, so that a later run leaves it alone. A file is there whole or not at all.
#![forbid(unsafe_code)]

mod batch;
mod cell;
#[cfg(feature = "circuit")]
pub mod circuit;
mod claims;
mod entry;
mod error;
mod event;
mod inputs;
mod key;
mod options;
mod plan;
mod record;
mod report;
mod run;
mod shard;
mod size;
mod stamp;
pub mod standard;
mod tables;
pub mod targets;
mod tracing;
pub mod workers;

pub use batch::Batch;
pub use entry::Entry;
pub use error::{BatchError, CellError, CellFault};
pub use event::{BatchReport, Event, Outcome};
pub use inputs::{Input, Inputs, NotFound};
pub use plan::Plan;
pub use record::OutputState;
pub use report::{CellReport, NodeName, Seconds};
pub use shard::{Shard, ShardError};
pub use size::LargeFile;
pub use tables::Tables;
pub use targets::{Job, TargetError};
pub use tracing::{InputError, MORPHOLOGIES, read, readable};
