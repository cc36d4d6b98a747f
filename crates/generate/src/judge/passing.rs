//! Forks that another branch runs through or touches: of the choices as sound, that which it crosses least.
//!
//! Branches that were traced through one another cross whatever a fork is made of, but not equally. An inset is
//! lifted off its trunk and a joint is not, so a branch that passes within the lift crosses the one and not the
//! other: one passes sample 1671 of `bio_neuron-000` at 2.1 of its radii, one crosses `IF4_140201` at 82.
//!
//! Boxes tell which forks have such patches near them, nearly always none. For these alone all choices are
//! made, in the forks' neighborhoods, and compared.

use std::collections::{BTreeMap, BTreeSet};

use glam::Vec3A;
use neurotess_mesh::{CoarseMesh, PatchKind};
use rayon::prelude::*;

use super::layout::Layout;
use crate::judge::facets::Bounds;
use crate::judge::fork_trials::{ChoiceNumber, ForkFaults, ForkTrials};
use crate::judge::neighborhood::Neighborhood;
use crate::judge::part::Part;
use crate::judge::refined_patches::RefinedPatches;
use crate::plan::{ForkChoice, MayJoin};
use crate::stop::Stop;
use crate::tracing::Skeleton;

/// Most patches of others that a fork is compared with: in crowds nothing can be gained.
const MOST_PASSING: usize = 200;
/// Most forks whose boxes are compared with one patch, and most that it is taken to pass.
const MOST_LOOKED_AT: usize = 256;
const MOST_FORKS: usize = 16;
/// A fork's box is wide from this many times the median width on. Wide ones are compared with all patches, so
/// more of them than this are left out.
const WIDE: f32 = 8.0;
const MOST_WIDE: usize = 32;

/// Where more forks than this are passed, and most forks are at fault, branches are everywhere: another choice crosses
/// others instead (of `astrocyte`'s 2,396 crossing pairs 13 fewer, for a quarter of its time). Grown cells whose sound
/// forks are passed as often have 2 % fewer.
const CROWD: usize = 32;

/// A fork, and patches of other branches that pass it.
struct Passed {
    fork: u32,
    passing: CoarseMesh,
    /// The present choice first.
    alternatives: Vec<(ChoiceNumber, ForkChoice)>,
}

/// What is wrong with a fork that branches pass.
#[derive(Clone, Copy)]
struct Found {
    /// Facets of it and of branches that pass it that cross.
    crossings: usize,
    faults: ForkFaults,
}

/// Gives sound forks the choice as sound that the branches that pass them cross least. `made`: the whole with the
/// choices that were tried first.
pub(crate) fn choose(
    trials: &mut ForkTrials,
    skeleton: &Skeleton,
    made: &Layout,
    may_join: &MayJoin<'_>,
    stop: Stop<'_>,
) {
    let is_mostly_faulty = 2 * trials.sound().count() < trials.forks();
    let most = if is_mostly_faulty { CROWD } else { usize::MAX };
    let Some(passed) = passed(made, trials, most).filter(|passed| !passed.is_empty()) else {
        return;
    };
    let forks: Vec<u32> = passed.iter().map(|passed| passed.fork).collect();
    let parts = Neighborhood::parts(skeleton, &forks);
    let found = parts.par_iter().map(|near| {
        let here = passed.iter().filter(|passed| near.has(passed.fork));
        least_crossed_near(&here.collect::<Vec<_>>(), trials, near, may_join, stop)
    });
    let found: Vec<Vec<_>> = found.collect();
    if stop.asked() {
        return;
    }
    for (fork, choice, faults) in found.into_iter().flatten() {
        trials.replace(fork, choice, faults);
    }
}

/// Forks of one part that another choice is better for, with it and its faults.
fn least_crossed_near(
    passed: &[&Passed],
    trials: &ForkTrials,
    near: &Neighborhood,
    may_join: &MayJoin<'_>,
    stop: Stop<'_>,
) -> Vec<(u32, ChoiceNumber, ForkFaults)> {
    let round = |round: usize, present: &[Option<Found>]| match stop.asked() {
        true => vec![None; passed.len()],
        false => found_in_round(passed, round, present, trials, near, may_join),
    };
    let present = round(0, &[]);
    let rounds = passed.iter().map(|passed| passed.alternatives.len()).max();
    let others = (1..rounds.unwrap_or(0)).into_par_iter().with_max_len(1);
    let others: Vec<Vec<_>> = others.map(|number| round(number, &present)).collect();
    let forks = passed.iter().enumerate();
    let best = forks.filter_map(|(index, passed)| {
        let found: Vec<Option<Found>> = others.iter().map(|round| round[index]).collect();
        let (choice, faults) = least_crossed(passed, present[index]?, &found)?;
        Some((passed.fork, choice, faults))
    });
    best.collect()
}

/// Another choice than the present one, if it is as sound and crossed less. `others`: what was found of each of the
/// other alternatives that is.
fn least_crossed(
    passed: &Passed,
    present: Found,
    others: &[Option<Found>],
) -> Option<(ChoiceNumber, ForkFaults)> {
    let numbers = passed.alternatives[1..].iter().map(|(number, _)| *number);
    let others = others.iter().zip(numbers);
    let others = others.filter_map(|(found, number)| Some(((*found)?, number)));
    let as_sound = others.filter(|(found, _)| found.faults <= present.faults);
    let best = as_sound.min_by_key(|(found, _)| found.crossings);
    best.map(|(found, number)| (number, found.faults))
}

/// Makes the same alternative of all forks at once. For each: what was found, if it is sound at level 2 and crossed
/// less than what is `present`; that is not known in the first round.
fn found_in_round(
    passed: &[&Passed],
    round: usize,
    present: &[Option<Found>],
    trials: &ForkTrials,
    near: &Neighborhood,
    may_join: &MayJoin<'_>,
) -> Vec<Option<Found>> {
    let old = |node: u32| near.nodes[node as usize];
    let may_join = |from: u32, to: u32| may_join(old(from), old(to));
    let alternative = |fork: u32| {
        let number = passed.binary_search_by_key(&fork, |passed| passed.fork);
        let of_fork = &passed[number.ok()?].alternatives;
        of_fork.get(round).map(|(_, choice)| *choice)
    };
    let choice_now = |node: u32| trials.choices()[node as usize];
    let choices = near.nodes.iter();
    let choices = choices.map(|&node| alternative(node).unwrap_or_else(|| choice_now(node)));
    let choices: Vec<ForkChoice> = choices.collect();
    let made = Layout::new(&near.skeleton, &choices, None, &may_join);
    let refused: BTreeSet<u32> = made.refused.iter().map(|&fork| old(fork)).collect();
    let mut own: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for (fork, range) in &made.patches {
        own.entry(old(*fork)).or_default().extend(range.clone());
    }
    let found = passed.par_iter().enumerate().map(|(index, passed)| {
        passed.alternatives.get(round)?;
        if refused.contains(&passed.fork) {
            return None;
        }
        let most = match present.get(index) {
            Some(present) => (*present)?.crossings,
            None => usize::MAX,
        };
        let own = own.get(&passed.fork)?;
        // Whether it is sound takes longer to tell, and is of no use for most.
        let crossings = crossings(Part::new(&made.mesh, own.clone()).mesh, &passed.passing);
        if crossings >= most {
            return None;
        }
        let faults = ForkFaults::of(&RefinedPatches::new(&made.mesh, own.clone()));
        faults.is_sound().then_some(Found { crossings, faults })
    });
    found.collect()
}

/// Sound forks that patches of other branches cross, ascending; none if there are more than `most`.
fn passed(made: &Layout, trials: &ForkTrials, most: usize) -> Option<Vec<Passed>> {
    let mesh = &made.mesh;
    let mut own: BTreeMap<u32, Vec<u32>> = trials.sound().map(|fork| (fork, Vec::new())).collect();
    for (fork, range) in &made.patches {
        if let Some(patches) = own.get_mut(fork) {
            patches.extend(range.clone());
        }
    }
    let mut near: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for (fork, patch) in patches_near(mesh, &own) {
        near.entry(fork).or_default().push(patch);
    }
    let passed_by = |(fork, near): &(u32, Vec<u32>)| {
        let (fork, own) = (*fork, own.get(fork)?);
        let passing = of_others(mesh, own, near);
        if !(1..=MOST_PASSING).contains(&passing.len()) {
            return None;
        }
        let passing = Part::new(mesh, passing).mesh;
        let crossed = crossings(Part::new(mesh, own.clone()).mesh, &passing) > 0;
        crossed.then(|| Passed {
            fork,
            passing,
            alternatives: trials.alternatives(fork),
        })
    };
    let near: Vec<(u32, Vec<u32>)> = near.into_iter().collect();
    let mut passed = Vec::new();
    // Piece by piece, so that a crowd is not looked at as a whole only to be left as it is.
    for near in near.chunks(2 * CROWD) {
        passed.par_extend(near.par_iter().filter_map(passed_by));
        if passed.len() > most {
            return None;
        }
    }
    Some(passed)
}

/// Patches whose boxes overlap those of forks, which are given by their patches: pairs of fork and patch. Where
/// very many are in one place not all are found, so that crowds cost no square.
fn patches_near(mesh: &CoarseMesh, forks: &BTreeMap<u32, Vec<u32>>) -> Vec<(u32, u32)> {
    let mut boxes: Vec<(Bounds, u32)> = forks
        .iter()
        .filter_map(|(&fork, patches)| Some((around(mesh, patches)?, fork)))
        .collect();
    let axis = longest_axis(&boxes);
    let width = |(bounds, _): &(Bounds, u32)| bounds.high[axis] - bounds.low[axis];
    let mut widths: Vec<f32> = boxes.iter().map(width).collect();
    widths.sort_by(f32::total_cmp);
    let widest = WIDE * widths.get(widths.len() / 2).copied().unwrap_or(0.0);
    let mut wide: Vec<(Bounds, u32)> = boxes.extract_if(.., |b| width(b) > widest).collect();
    wide.truncate(MOST_WIDE);
    boxes.sort_by(|(a, _), (b, _)| a.low[axis].total_cmp(&b.low[axis]));
    let near = (0..mesh.patches.len() as u32).into_par_iter();
    let near = near.filter(|&patch| mesh.patches[patch as usize].kind != PatchKind::Soma);
    let near = near.flat_map_iter(|patch| {
        let bounds = patch_bounds(mesh, patch);
        let (low, high) = (bounds.low[axis] - widest, bounds.high[axis]);
        let first = boxes.partition_point(|(b, _)| b.low[axis] < low);
        let until = boxes.partition_point(|(b, _)| b.low[axis] <= high);
        let beside = boxes[first..until.max(first)].iter().take(MOST_LOOKED_AT);
        let overlapping = beside
            .chain(&wide)
            .filter(move |(b, _)| b.overlaps(&bounds));
        let overlapping = overlapping.take(MOST_FORKS);
        overlapping.map(move |&(_, fork)| (fork, patch))
    });
    near.collect()
}

/// The axis along which boxes are spread out most.
fn longest_axis(boxes: &[(Bounds, u32)]) -> usize {
    let all = boxes.iter().map(|(bounds, _)| *bounds);
    let Some(all) = all.reduce(|a, b| a.with(&b)) else {
        return 0;
    };
    let size = all.high - all.low;
    let longer = |a: usize, b: usize| if size[b] > size[a] { b } else { a };
    longer(longer(0, 1), 2)
}

/// Those of the patches `near` that belong to no section of the fork's own patches, and touch none of them.
fn of_others(mesh: &CoarseMesh, own: &[u32], near: &[u32]) -> Vec<u32> {
    let corners = |patch: u32| mesh.patches[patch as usize].corners;
    let section = |v: u32| mesh.tracing[mesh.vertices[v as usize].tracing as usize].section;
    let mut vertices: Vec<u32> = own.iter().flat_map(|&patch| corners(patch)).collect();
    vertices.sort_unstable();
    vertices.dedup();
    let mut sections: Vec<_> = vertices.iter().map(|&v| section(v)).collect();
    sections.sort_unstable();
    sections.dedup();
    let is_own =
        |v: u32| vertices.binary_search(&v).is_ok() || sections.binary_search(&section(v)).is_ok();
    let others = near.iter().copied();
    others
        .filter(|&patch| !corners(patch).into_iter().any(is_own))
        .collect()
}

/// How many facets of two meshes without a common vertex cross.
fn crossings(own: CoarseMesh, others: &CoarseMesh) -> usize {
    let count = own.patches.len() as u32;
    let mesh = joined(own, others);
    let all = (0..mesh.patches.len() as u32).collect();
    RefinedPatches::new(&mesh, all).crossings_across(count)
}

/// Two meshes as one, the patches of the first one first.
fn joined(mut mesh: CoarseMesh, others: &CoarseMesh) -> CoarseMesh {
    let (vertices, tracing) = (mesh.vertices.len() as u32, mesh.tracing.len() as u32);
    mesh.vertices
        .extend(others.vertices.iter().copied().map(|mut vertex| {
            vertex.tracing += tracing;
            vertex
        }));
    mesh.tracing.extend(&others.tracing);
    mesh.patches
        .extend(others.patches.iter().copied().map(|mut patch| {
            patch.corners = patch.corners.map(|v| v + vertices);
            patch
        }));
    mesh
}

/// A box that holds some patches; none of no patches.
fn around(mesh: &CoarseMesh, patches: &[u32]) -> Option<Bounds> {
    let bounds = patches.iter().map(|&patch| patch_bounds(mesh, patch));
    bounds.reduce(|a, b| a.with(&b))
}

/// A box that holds the rings at a patch's corners, and nearly always what is between them.
fn patch_bounds(mesh: &CoarseMesh, patch: u32) -> Bounds {
    let corners = mesh.patches[patch as usize].corners.map(|v| {
        let vertex = &mesh.vertices[v as usize];
        let ring = &mesh.tracing[vertex.tracing as usize];
        let reach = Vec3A::splat(ring.radius);
        let center = Vec3A::from(ring.center);
        let corner = Vec3A::from(vertex.position);
        Bounds {
            low: corner.min(center - reach),
            high: corner.max(center + reach),
        }
    });
    let [a, b, c, d] = corners;
    a.with(&b).with(&c).with(&d)
}
