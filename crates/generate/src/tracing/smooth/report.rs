//! What smoothing did.

use crate::tracing::{NONE, Skeleton, SkeletonNode};

/// How far [`Smooth`](crate::Smooth) moved points.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Smoothing {
    /// Points between roots, forks and ends, which may move; the others do not.
    pub points: usize,
    /// Half of these moved by less (µm).
    pub median_move: f64,
    /// None moved by more (µm).
    pub largest_move: f64,
    /// Half of these moved by less (radii, as traced).
    pub median_move_radii: f64,
    /// None moved by more (radii, as traced).
    pub largest_move_radii: f64,
    /// By what share all neurites together became longer; below 0 for shorter.
    pub length_change: f64,
}

impl Smoothing {
    /// `free`: nodes that were free to move.
    pub(super) fn new(traced: &[SkeletonNode], smooth: &Skeleton, free: &[u32]) -> Self {
        let way = |&i: &u32| traced[i as usize].center.distance(smooth.node(i).center);
        let ways = free.iter().map(way);
        let radii = free.iter().map(|i| way(i) / traced[*i as usize].radius);
        let (median_move, largest_move) = median_and_largest(ways);
        let (median_move_radii, largest_move_radii) = median_and_largest(radii);
        let before = length(traced);
        let change = length(smooth.nodes()) / before - 1.0;
        Self {
            points: free.len(),
            median_move,
            largest_move,
            median_move_radii,
            largest_move_radii,
            length_change: if before > 0.0 { change } else { 0.0 },
        }
    }
}

fn median_and_largest(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let mut values: Vec<f64> = values.collect();
    let largest = values.iter().copied().fold(0.0, f64::max);
    (median(&mut values).unwrap_or(0.0), largest)
}

/// The value in the middle, in linear time.
fn median(values: &mut [f64]) -> Option<f64> {
    let middle = values.len() / 2;
    let in_order =
        (middle < values.len()).then(|| values.select_nth_unstable_by(middle, f64::total_cmp));
    in_order.map(|(_, median, _)| *median)
}

/// Length of all segments (µm).
fn length(nodes: &[SkeletonNode]) -> f64 {
    let joined = nodes.iter().filter(|node| node.parent != NONE);
    let length = |node: &SkeletonNode| node.center.distance(nodes[node.parent as usize].center);
    joined.map(length).sum()
}
