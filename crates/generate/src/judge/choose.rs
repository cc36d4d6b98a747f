//! What becomes of each fork: an inset of some lift, or a joint. Each is tried and judged by its refined
//! patches, and the best is kept.
//!
//! No rule from angles and radii foretells which does best on a real tracing: points are too dense, bend
//! too tightly, or another branch is in the way. So forks whose patches cross or fold over get the next
//! choice, until all are sound or all choices were tried. After the first try only the neighborhoods of
//! such forks are laid out again, and in the end the whole once more.

use std::collections::BTreeMap;

use neurotess_mesh::{CoarseMesh, Steps, Watch};
use rayon::prelude::*;

use super::layout::Layout;
use super::repair;
use crate::judge::fork_trials::{ForkFaults, ForkTrials, Judged};
use crate::judge::neighborhood::Neighborhood;
use crate::judge::refined_patches::RefinedPatches;
use crate::plan::{ForkChoice, MayJoin};
use crate::tracing::Skeleton;
use crate::tubes::Somata;
use crate::warning::Warnings;

/// The mesh of a skeleton with the best choice for each fork.
pub(crate) fn mesh(
    skeleton: &Skeleton,
    somata: &Somata<'_>,
    may_join: &MayJoin<'_>,
    warnings: &mut Warnings,
    steps: &Steps<'_>,
) -> CoarseMesh {
    let watch = steps.watch();
    let mut trials = ForkTrials::new(skeleton);
    let made = Layout::new(skeleton, trials.choices(), Some(somata), may_join);
    let first = trials.choices().to_vec();
    let judged = judge(&trials, &made, &|fork| fork, watch);
    trials.advance([judged]);
    loop {
        let open = trials.open();
        steps.part(trials.len() - open.len(), trials.len());
        if open.is_empty() || watch.is_stopped() {
            break;
        }
        let parts = Neighborhood::parts(skeleton, &open);
        let judged = parts.par_iter().map(|near| {
            let old = |node: u32| near.nodes[node as usize];
            let choices = near.nodes.iter();
            let choices = choices.map(|&node| trials.choices()[node as usize]);
            let choices: Vec<ForkChoice> = choices.collect();
            let may_join = |from: u32, to: u32| may_join(old(from), old(to));
            let made = Layout::new(&near.skeleton, &choices, None, &may_join);
            judge(&trials, &made, &old, watch)
        });
        let judged: Vec<Judged> = judged.collect();
        trials.advance(judged);
    }
    let made = if trials.choices() == first || watch.is_stopped() {
        made
    } else {
        Layout::new(skeleton, trials.choices(), Some(somata), may_join)
    };
    warnings.extend(made.warnings);
    let mut mesh = made.mesh;
    let is_sound = |fork| trials.is_sound(fork);
    for ring in repair::draw_in_rings(&mut mesh, &made.patches, is_sound, watch) {
        warnings.add(
            "drawn_in",
            Some(i64::from(mesh.tracing[ring as usize].sample.0)),
            "tube in its own way at a bend or fork: thinner there than it was traced",
        );
    }
    mesh
}

/// Judges the forks of a mesh that are not settled. `old`: a node of the skeleton by that of the mesh's.
fn judge(
    trials: &ForkTrials,
    made: &Layout,
    old: &dyn Fn(u32) -> u32,
    watch: &Watch<'_>,
) -> Judged {
    let mut near: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for (fork, range) in &made.patches {
        if trials.is_open(old(*fork)) {
            near.entry(old(*fork)).or_default().extend(range.clone());
        }
    }
    let near: Vec<(u32, Vec<u32>)> = near.into_iter().collect();
    let faults = near
        .par_iter()
        .map(|(fork, patches)| match watch.is_stopped() {
            true => (*fork, ForkFaults::default()),
            false => {
                let patches = RefinedPatches::new(&made.mesh, patches.clone());
                (*fork, ForkFaults::of(&patches))
            }
        });
    Judged {
        refused: made.refused.iter().map(|&fork| old(fork)).collect(),
        faults: faults.collect(),
    }
}
