//! No piece of a tube inside out: rings are drawn in where their tubes fold over or cross themselves.
//!
//! **Theory.** A tube of the traced radii cannot follow a path that bends more tightly than they are thick,
//! or branches that run on within one another: neighboring rings cross, and pieces between them turn inside
//! out. Which rings must give way, and how much, no rule on radii and angles foretells, since the refined
//! surface decides. So it is looked at, but only where it may be at fault.
//!
//! **Practice.** Tests of a few products find suspect rings (suspects.rs). Those that belong together are a
//! stretch (stretches.rs), whose patches are refined and searched for facets that cross or fold
//! (refined_patches.rs). Where there are any, its rings are drawn in (draw_in.rs), or stay as they were if that
//! makes no fewer faults. Only positions, radii and normals of vertices change: never what they are joined
//! to, nor which tracing point they belong to. Work is bounded by stretch; crowds are left as they are.
//!
//! Why not by leaving points out, as planes.rs does: a branch cannot leave out its fork, and the path
//! would move by radii. Why not by turning rings: planes.rs has turned them as far as that helps; turning
//! them further changed what is left in `Neuron`, `astrocyte` and 172993 by 4 % at most, for better or worse.

mod draw_in;
mod graph;
mod ring;
mod stretches;
mod suspects;

use std::cmp::Reverse;
use std::ops::Range;

use neurotess_mesh::{CoarseMesh, Role, Watch};
use rayon::prelude::*;

use crate::judge::refined_patches::RefinedPatches;
use crate::tubes::average_normals;
use draw_in::DrawIn;
use graph::RingGraph;
use stretches::Stretches;
use suspects::Suspects;

/// Patches of a stretch from which on it is left as it is.
const MAX_PATCHES: usize = 4_000;
/// Patches around suspect rings are few if the stretch has this many times as many: then they are looked at alone
/// first, since most stretches are sound.
const FEW: usize = 2;

/// Draws in rings of a mesh. `forks`: patches around each; `is_sound`: whether a fork was judged and has no faults.
/// Returns the tracing points that are drawn in, ascending.
pub(crate) fn draw_in_rings(
    mesh: &mut CoarseMesh,
    forks: &[(u32, Range<u32>)],
    is_sound: impl Fn(u32) -> bool,
    watch: &Watch<'_>,
) -> Vec<u32> {
    let graph = RingGraph::new(mesh);
    let mut suspects = Suspects::new(mesh, &graph);
    // By patch: the sound forks that it is around. Forks were judged without their soma, beside which all is looked at.
    let mut sound_forks: Vec<Vec<u32>> = vec![Vec::new(); mesh.patches.len()];
    let is_beside_soma = |ring: &u32| {
        let role = mesh.tracing[*ring as usize].role;
        matches!(role, Role::Soma | Role::Insertion)
    };
    for (fork, patches) in forks {
        let is_sound = is_sound(*fork);
        for patch in patches.clone() {
            let corners = mesh.patches[patch as usize].corners;
            let rings = corners.map(|v| mesh.vertices[v as usize].tracing);
            if !is_sound {
                suspects.add(rings);
            } else if !rings.iter().any(is_beside_soma) {
                sound_forks[patch as usize].push(*fork);
            }
        }
    }
    let stretches = Stretches::new(mesh, &graph, &suspects);
    // What lies around one sound fork was looked at.
    let is_known = |number: &usize| {
        let (first, rest) = match stretches.suspect[*number].split_first() {
            Some((first, rest)) => (*first, rest),
            None => return true,
        };
        let around = |fork: &u32| {
            rest.iter()
                .all(|&patch| sound_forks[patch as usize].contains(fork))
        };
        sound_forks[first as usize].iter().any(around)
    };
    // Long ones first, so that no thread has one left when the others are done.
    let mut order: Vec<usize> = (0..stretches.patches.len()).collect();
    order.retain(|number| !is_known(number));
    order.sort_by_key(|&number| Reverse(stretches.patches[number].len()));
    let mut drawn: Vec<(usize, DrawIn)> = order
        .into_par_iter()
        .with_max_len(1)
        .filter(|_| !watch.is_stopped())
        .filter_map(|number| Some((number, draw_in(mesh, &stretches, number)?)))
        .collect();
    drawn.sort_unstable_by_key(|&(number, _)| number);
    let drawn = drawn.into_iter().map(|(_, drawn)| drawn);
    let mut rings: Vec<u32> = drawn.flat_map(|d| d.write(mesh)).collect();
    rings.sort_unstable();
    if !rings.is_empty() {
        average_normals(mesh);
    }
    rings
}

/// The stretch drawn in; none if it has no faults, or cannot have fewer.
fn draw_in(mesh: &CoarseMesh, stretches: &Stretches, number: usize) -> Option<DrawIn> {
    let patches = &stretches.patches[number];
    if patches.len() > MAX_PATCHES {
        return None;
    }
    let suspect = &stretches.suspect[number];
    let look_there_first = FEW * suspect.len() <= patches.len();
    if look_there_first {
        let suspect = RefinedPatches::new(mesh, suspect.clone());
        if suspect.faults_unless_crowd()?.is_empty() {
            return None;
        }
    }
    let stretch = RefinedPatches::new(mesh, patches.clone());
    let faults = stretch.faults_unless_crowd()?;
    let is_suspect = |patch: &u32| suspect.binary_search(&patches[*patch as usize]).is_ok();
    let is_sound = || !faults.iter().any(|f| f.patches.iter().all(is_suspect));
    if !look_there_first && is_sound() {
        return None;
    }
    let mut draw_in = DrawIn::new(stretch, |ring| stretches.has(number, ring));
    draw_in.run(faults).then_some(draw_in)
}
