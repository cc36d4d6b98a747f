//! Tables of circuits: their nodes, and the values of reports.

mod figure;
mod nodes;
mod places;
mod recording;

pub(crate) use nodes::{NodesArgs, run as nodes};
pub(crate) use recording::{ReportArgs, run as report};
