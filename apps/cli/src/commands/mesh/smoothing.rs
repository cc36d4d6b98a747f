//! How far smoothing moved points, as JSON.

use neurotess::generate::Smoothing;
use serde::Serialize;

#[derive(Clone, Debug, Serialize)]
pub(crate) struct SmoothingReport {
    /// Points between roots, forks and ends, which were free to move.
    points: usize,
    /// µm.
    median_move: f64,
    largest_move: f64,
    /// In radii.
    median_move_radii: f64,
    largest_move_radii: f64,
    /// Share of the length of all neurites.
    length_change: f64,
}

impl From<&Smoothing> for SmoothingReport {
    fn from(report: &Smoothing) -> Self {
        Self {
            points: report.points,
            median_move: report.median_move,
            largest_move: report.largest_move,
            median_move_radii: report.median_move_radii,
            largest_move_radii: report.largest_move_radii,
            length_change: report.length_change,
        }
    }
}
