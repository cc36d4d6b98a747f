//! Leaves out added points that the branch does not need for its bends.

use glam::DVec3;

use super::rods::Rods;
use crate::skeleton::{NONE, off_segment};

/// A point stays if the branch without it would be farther from it than this share of its radius. Without
/// this step rings lie so densely in bends that the generator leaves points out as it likes.
const TOLERANCE: f64 = 0.05;

/// Leaves out added points (Douglas, Peucker, 1973), each run of them between two traced points by itself.
pub(super) fn thin_out(rods: &mut Rods) {
    let mut keep: Vec<bool> = rods.points.iter().map(|p| p.traced).collect();
    for end in rods.segments().filter(|&i| rods.points[i as usize].traced) {
        let run = run_up(rods, end);
        if run.len() > 2 {
            keep_bends(rods, &run, &mut keep);
        }
    }
    if keep.contains(&false) {
        rods.retain(&keep);
    }
}

/// From a traced point to the next one above.
fn run_up(rods: &Rods, end: u32) -> Vec<u32> {
    let mut run = vec![end];
    let mut here = rods.parent(end);
    while here != NONE {
        run.push(here);
        if rods.points[here as usize].traced {
            break;
        }
        here = rods.parent(here);
    }
    run
}

fn keep_bends(rods: &Rods, run: &[u32], keep: &mut [bool]) {
    let center = |at: usize| -> DVec3 { rods.points[run[at] as usize].node.center };
    let mut pending = vec![(0, run.len() - 1)];
    while let Some((first, last)) = pending.pop() {
        let off = |at: usize| {
            off_segment(center(at), center(first), center(last)) / rods.radius(run[at])
        };
        let farthest = (first + 1..last)
            .map(|at| (off(at), at))
            .max_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((off, at)) = farthest
            && off > TOLERANCE
        {
            keep[run[at] as usize] = true;
            pending.extend([(first, at), (at, last)]);
        }
    }
}
