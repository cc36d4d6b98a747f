//! Forks that another branch runs through or touches: of the sound choices, that which it crosses least.
//!
//! Branches that were traced through one another cross whatever a fork is made of, but not equally. An inset is
//! lifted off its trunk and a joint is not, so a branch that passes within the lift crosses the one and not the
//! other: one passes sample 1671 of `bio_neuron-000` at 2.1 of its radii, one crosses `IF4_140201` at 82.
//!
//! Boxes tell which forks have such patches near them, nearly always none. For these alone all choices are
//! made, each in the fork's neighborhood, and compared.

use std::collections::BTreeMap;

use glam::Vec3A;
use neurotess_mesh::{CoarseMesh, PatchKind};
use rayon::prelude::*;

use crate::facets::Bounds;
use crate::fork_trials::{ChoiceNumber, ForkTrials};
use crate::inset::ForkChoice;
use crate::made::{Made, MayJoin};
use crate::neighborhood::Neighborhood;
use crate::part::Part;
use crate::refined_patches::{RefinedPatches, count};
use crate::skeleton::Skeleton;
use crate::stop::Stop;

/// Most patches of others that a fork is compared with: in crowds nothing can be gained.
const MOST_PASSING: usize = 200;

/// A fork, and patches of other branches that pass it.
struct Passed {
    fork: u32,
    passing: Vec<u32>,
}

/// Gives sound forks the sound choice that the branches that pass them cross least. `made`: the whole with the
/// choices that were tried first.
pub(crate) fn choose(
    trials: &mut ForkTrials,
    skeleton: &Skeleton,
    made: &Made,
    may_join: &MayJoin<'_>,
    stop: Stop<'_>,
) {
    let passed = passed(made, trials.sound());
    let better: Vec<(u32, ChoiceNumber)> = passed
        .iter()
        .filter(|_| !stop.asked())
        .filter_map(|passed| {
            let choice = least_crossed(passed, trials, skeleton, &made.mesh, may_join)?;
            Some((passed.fork, choice))
        })
        .collect();
    for (fork, choice) in better {
        trials.replace(fork, choice);
    }
}

/// Forks whose boxes overlap those of patches of other branches.
fn passed(made: &Made, forks: impl Iterator<Item = u32>) -> Vec<Passed> {
    let mesh = &made.mesh;
    let mut own: BTreeMap<u32, Vec<u32>> = forks.map(|fork| (fork, Vec::new())).collect();
    for (fork, range) in &made.patches {
        if let Some(patches) = own.get_mut(fork) {
            patches.extend(range.clone());
        }
    }
    let mut boxes: Vec<(Bounds, u32)> = own
        .iter()
        .filter_map(|(&fork, patches)| Some((around(mesh, patches)?, fork)))
        .collect();
    boxes.sort_by(|(a, _), (b, _)| a.low.x.total_cmp(&b.low.x));
    let width = |(bounds, _): &(Bounds, u32)| bounds.high.x - bounds.low.x;
    let widest = boxes.iter().map(width).fold(0.0, f32::max);
    let near: Vec<(u32, u32)> = (0..mesh.patches.len() as u32)
        .into_par_iter()
        .filter(|&patch| mesh.patches[patch as usize].kind != PatchKind::Soma)
        .flat_map_iter(|patch| {
            let bounds = patch_bounds(mesh, patch);
            let first = boxes.partition_point(|(b, _)| b.low.x < bounds.low.x - widest);
            let until = boxes.partition_point(|(b, _)| b.low.x <= bounds.high.x);
            let overlapping = boxes[first..until.max(first)].iter();
            let overlapping = overlapping.filter(move |(b, _)| b.overlaps(&bounds));
            overlapping.map(move |&(_, fork)| (fork, patch))
        })
        .collect();
    let mut near_fork: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for (fork, patch) in near {
        near_fork.entry(fork).or_default().push(patch);
    }
    let passed = near_fork.into_par_iter().filter_map(|(fork, near)| {
        let own = own.get(&fork)?;
        let passing = of_others(mesh, own, &near);
        let few = (1..=MOST_PASSING).contains(&passing.len());
        let crossed = |passing: &[u32]| {
            let part = Part::new(mesh, own.clone());
            crossings(part.mesh, &Part::new(mesh, passing.to_vec()).mesh) > 0
        };
        (few && crossed(&passing)).then_some(Passed { fork, passing })
    });
    passed.collect()
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

/// Another choice than the present one, if it is sound and crossed less.
fn least_crossed(
    passed: &Passed,
    trials: &ForkTrials,
    skeleton: &Skeleton,
    whole: &CoarseMesh,
    may_join: &MayJoin<'_>,
) -> Option<ChoiceNumber> {
    let near = Neighborhood::new(skeleton, &[passed.fork]);
    let old = |node: u32| near.nodes[node as usize];
    let may_join = |from: u32, to: u32| may_join(old(from), old(to));
    let passing = Part::new(whole, passed.passing.clone()).mesh;
    let crossed = |choice: ForkChoice| {
        let choices = near.nodes.iter().map(|&node| match node == passed.fork {
            true => choice,
            false => trials.choices()[node as usize],
        });
        let choices: Vec<ForkChoice> = choices.collect();
        let made = Made::new(&near.skeleton, &choices, None, &may_join);
        let is_fork = |node: u32| old(node) == passed.fork;
        let refused = made.refused.iter().any(|&fork| is_fork(fork));
        let own = made.patches.iter().filter(|(fork, _)| is_fork(*fork));
        let own: Vec<u32> = own.flat_map(|(_, range)| range.clone()).collect();
        let own = RefinedPatches::new(&made.mesh, own);
        let sound = !refused && count(&own.faults()) == 0;
        sound.then(|| crossings(own.part.mesh, &passing))
    };
    let mut alternatives = trials.alternatives(passed.fork).into_iter();
    let (_, present) = alternatives.next()?;
    let present = crossed(present)?;
    let others = alternatives.filter_map(|(number, choice)| Some((crossed(choice)?, number)));
    let best = others.min_by_key(|(crossings, _)| *crossings);
    best.filter(|(crossings, _)| *crossings < present)
        .map(|(_, number)| number)
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
