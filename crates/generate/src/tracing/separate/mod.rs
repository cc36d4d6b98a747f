//! Branches that were traced through one another are moved apart.
//!
//! # Theory
//! Branches are elastic rods, round cones between their points. All contacts of branches that do not belong
//! together are solved at once, as one static step of XPBD: inertia holds each point where it was traced,
//! bending stiffness spreads a push along its branch, lengths stay, and thin gives way to thick. A
//! contact of a branch with its own parent near their fork is no fault: surfaces meet there.
//!
//! Why not thinner tubes? In real cells a third of the places would need less than a quarter of the
//! radius.
//!
//! # Practice
//! [`separate`] goes through these files, in rounds until nothing touches:
//!
//! | step | file |
//! | --- | --- |
//! | the skeleton as rods | `rods`, with `paths` along the tree |
//! | what touches and may not | `search`, with `boxes` and `geometry` |
//! | how far a push is spread | `spread` |
//! | points added to bend at | `cut` |
//! | the solver | `solver`, with `elastic` and `side` |
//! | points left out again | `thin_out` |
//! | what it took | `report` |
//! | what may be left out later | `clearance` |
//!
//! Time is n log n for n points, and a bounded number of searches and sweeps for the branches
//! concerned. A cell in which nothing touches stays as it is, to the bit; so does a branch that is far from all
//! contacts.

mod boxes;
mod clearance;
mod cut;
mod elastic;
mod geometry;
mod paths;
mod report;
mod rods;
mod search;
mod side;
mod solver;
mod spread;
#[cfg(test)]
mod tests;
mod thin_out;

pub use report::{SeparatedPlace, Separation};

use neurotess_mesh::Watch;

use crate::tracing::Skeleton;
use crate::tracing::SomaSphere;
use crate::warning::Warnings;

use clearance::Clearance;
use report::Depths;
use rods::Rods;
use search::{Margin, search};
use spread::{GAP, Spread};

/// Times that branches are moved apart: points that are left out again can make contacts. A guard.
const MAX_ROUNDS: usize = 4;
/// Times that segments are cut: pieces can be nearer to one another than the whole. A guard.
const MAX_CUTS: usize = 3;
/// Points that may be added, for each traced one, and in any cell. A guard.
const MAX_ADDED: (usize, usize) = (2, 4096);
/// A point whose free room is more than this many radii of the thicker one has as much as it likes.
const ROOM: f64 = 2.0;

/// A skeleton whose branches are apart.
pub(crate) struct Separated {
    pub(crate) report: Separation,
    /// What steps that leave nodes out have to respect.
    pub(crate) clearance: Clearance,
}

/// Moves branches apart. `soma_samples`: the first sample of each soma.
pub(crate) fn separate(
    skeleton: &mut Skeleton,
    soma_spheres: &[Option<SomaSphere>],
    soma_samples: &[i64],
    warnings: &mut Warnings,
    watch: &Watch<'_>,
) -> Separated {
    let mut rods = Rods::new(skeleton, soma_spheres);
    let traced = std::mem::take(skeleton);
    let report = move_apart(&mut rods, Depths::new(&traced, soma_samples), watch);
    warn(&report, warnings);
    *skeleton = rods.skeleton();
    Separated {
        report,
        clearance: Clearance::new(rods),
    }
}

fn move_apart(rods: &mut Rods, mut depths: Depths<'_>, watch: &Watch<'_>) -> Separation {
    let mut complete = true;
    let mut may_add = MAX_ADDED.0 * rods.count() + MAX_ADDED.1;
    for round in 0..MAX_ROUNDS {
        let spread = spread_and_cut(rods, &mut may_add);
        let found = search(rods, &rods.centers(), Margin::NONE, None);
        complete &= found.complete;
        if round == 0 {
            depths.before(rods, &found);
        }
        if !found.touches() {
            break;
        }
        complete &= solver::solve(rods, &spread, watch);
        let free = room(rods);
        thin_out::thin_out(rods, &free);
        // No number of rounds sorts a crowd.
        if !complete || watch.is_stopped() {
            break;
        }
    }
    let free = room(rods);
    thin_out::thin_out(rods, &free);
    let found = search(rods, &rods.centers(), Margin::NONE, None);
    depths.after(rods, &found);
    depths.report(rods, complete && found.complete)
}

/// Cuts segments near contacts; the spread of what is there then.
fn spread_and_cut(rods: &mut Rods, may_add: &mut usize) -> Spread {
    let margin = Margin {
        thin: GAP,
        thick: 0.0,
    };
    let spread = |rods: &Rods| {
        let now = search(rods, &rods.centers(), margin, None);
        let traced = search(rods, &rods.rests(), margin, None);
        Spread::new(rods, &now, &traced)
    };
    let mut now = spread(rods);
    for _ in 0..MAX_CUTS {
        if !cut::cut_near_contacts(rods, &now, may_add) {
            break;
        }
        now = spread(rods);
    }
    now
}

/// Free room at each point (µm); infinite where nothing is near.
fn room(rods: &Rods) -> Vec<f64> {
    let margin = Margin {
        thin: 0.0,
        thick: ROOM,
    };
    let mut room = vec![f64::INFINITY; rods.count()];
    for contact in search(rods, &rods.centers(), margin, None).contacts {
        for segment in [contact.a, contact.b] {
            for point in [segment, rods.parent(segment)] {
                let room = &mut room[point as usize];
                *room = room.min(-contact.depth).max(0.0);
            }
        }
    }
    room
}

fn warn(report: &Separation, warnings: &mut Warnings) {
    for place in &report.places {
        let [a, b] = place.samples;
        if place.after == 0.0 {
            let message = "branches were traced through one another: moved apart";
            warnings.add("branches_separated", Some(a), message);
        } else {
            let message = format!(
                "branches could not be moved apart and cross, for one at samples {a} and {b} by {:.3} µm",
                place.after
            );
            warnings.add("branches_touch", Some(a), &message);
        }
    }
    if !report.complete {
        warnings.add(
            "crowded_branches",
            None,
            "hundreds of branches lie in one spot: not all contacts were looked at",
        );
    }
}
