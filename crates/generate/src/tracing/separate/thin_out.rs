//! Leaves out added points that the branch does not need for its bends.

use glam::DVec3;

use super::rods::{Rods, Role};
use crate::tracing::{NONE, off_segment};

/// The branch may change by this share of its radius where a point is left out.
const TOLERANCE: f64 = 0.05;
/// And by this share of the free room there.
const ROOM: f64 = 0.4;
/// Changes below this one (radii) are rounding. A guard.
const ROUNDING: f64 = 1e-9;

/// Leaves out added points (Douglas, Peucker, 1973), each run of them between two traced points by itself.
/// `room`: free room (µm) at each point. Without this step rings lie so densely in bends that the generator
/// leaves points out as it likes.
pub(super) fn thin_out(rods: &mut Rods, room: &[f64]) {
    let added = |i: u32| rods.points[i as usize].role == Role::Added;
    let mut keep: Vec<bool> = (0..rods.count() as u32).map(|i| !added(i)).collect();
    for end in rods.segments().filter(|&i| !added(i)) {
        let run = run_up(rods, end);
        if run.len() > 2 {
            keep_bends(rods, &run, room, &mut keep);
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
        if rods.points[here as usize].role != Role::Added {
            break;
        }
        here = rods.parent(here);
    }
    run
}

fn keep_bends(rods: &Rods, run: &[u32], room: &[f64], keep: &mut [bool]) {
    let center = |at: usize| -> DVec3 { rods.points[run[at] as usize].node.center };
    let mut pending = vec![(0, run.len() - 1)];
    while let Some((first, last)) = pending.pop() {
        // How often the branch would change by more than it may.
        let excess = |at: usize| {
            let radius = rods.radius(run[at]);
            let most = (TOLERANCE * radius).min(ROOM * room[run[at] as usize]);
            off_segment(center(at), center(first), center(last)) / most.max(ROUNDING * radius)
        };
        let farthest = (first + 1..last)
            .map(|at| (excess(at), at))
            .max_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((excess, at)) = farthest
            && excess > 1.0
        {
            keep[run[at] as usize] = true;
            pending.extend([(first, at), (at, last)]);
        }
    }
}
