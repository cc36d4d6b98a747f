//! Tables of circuits: their nodes, and the values of reports.

mod nodes;
mod recording;

pub(crate) use nodes::{NodesArgs, run as nodes};
pub(crate) use recording::{ReportArgs, run as report};
