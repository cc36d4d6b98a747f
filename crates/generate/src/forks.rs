//! What becomes of each fork: an inset of some lift, or a joint. Each is tried and judged by its refined
//! patches, and the best is kept.
//!
//! No rule from angles and radii foretells which does best on a real tracing: points are too dense, bend
//! too tightly, or another branch is in the way. So forks whose patches cross or fold over get the next
//! choice, until all are sound or all choices were tried.

use std::collections::BTreeMap;
use std::ops::Range;

use neurotess_mesh::CoarseMesh;
use rayon::prelude::*;

use crate::assemble::{Assembly, Somata};
use crate::inset::{self, ForkChoice};
use crate::judge::faults;
use crate::skeleton::Skeleton;
use crate::warning::Warnings;
use crate::{crowd, fork, uncross};

/// What is tried, in this order. The lift decides most: 0.4 keeps the branch closest to the tracing,
/// higher ones cross the trunk's bends less.
const CHOICES: [ForkChoice; 6] = [
    inset(0.4, false),
    inset(0.7, false),
    inset(1.0, false),
    inset(0.4, true),
    inset(1.0, true),
    ForkChoice::Joint,
];
const JOINT: usize = CHOICES.len() - 1;

/// The mesh of a skeleton with the best choice for each fork. `may_join`: whether a path may go straight
/// from one node to another below it.
pub(crate) fn mesh(
    skeleton: &Skeleton,
    somata: &Somata<'_>,
    may_join: &dyn Fn(u32, u32) -> bool,
    warnings: &mut Warnings,
) -> CoarseMesh {
    let mut trials = ForkTrials::new(skeleton);
    loop {
        let mut found = Warnings::default();
        let mut layout = inset::lay_out(skeleton, trials.choices());
        for &twig in &layout.buried {
            buried(skeleton.node(twig).sample, &mut found);
        }
        crowd::split_crowded_forks(&mut layout.skeleton, &mut found);
        fork::clear_the_way(&mut layout.skeleton, &mut found);
        let orientations =
            uncross::uncross_rings(&mut layout, somata.soma_spheres, may_join, &mut found);
        let mut assembly = Assembly::new(&layout, &orientations);
        assembly.somata(somata);
        let (mesh, patches) = assembly.finish();
        if !trials.advance(&mesh, patches, &layout.refused) {
            warnings.extend(found);
            return mesh;
        }
    }
}

fn buried(sample: i64, warnings: &mut Warnings) {
    warnings.add(
        "buried_twig",
        Some(sample),
        "twig ends inside the neurite that it branches from: left out of the mesh",
    );
}

/// A fork of more children is split over several joints, and not judged: its patches are too many.
const MOST_CHILDREN: usize = 5;

const fn inset(lift: f64, thickened: bool) -> ForkChoice {
    ForkChoice::Inset { lift, thickened }
}

/// Choices as they are tried.
pub(crate) struct ForkTrials {
    choices: Vec<ForkChoice>,
    /// By fork.
    trials: BTreeMap<u32, Trial>,
}

#[derive(Clone, Copy, Debug, Default)]
struct Trial {
    current: usize,
    /// Faults of each choice that was tried.
    faults: [Option<usize>; CHOICES.len()],
    settled: bool,
}

impl ForkTrials {
    pub(crate) fn new(skeleton: &Skeleton) -> Self {
        let children = skeleton.children();
        let mut choices = vec![CHOICES[0]; skeleton.nodes().len()];
        let mut trials = BTreeMap::new();
        for fork in 0..skeleton.nodes().len() as u32 {
            match children.of(fork).len() {
                0 | 1 => {}
                2..=MOST_CHILDREN => {
                    trials.insert(fork, Trial::default());
                }
                _ => choices[fork as usize] = ForkChoice::Joint,
            }
        }
        Self { choices, trials }
    }

    /// By node of the skeleton.
    pub(crate) fn choices(&self) -> &[ForkChoice] {
        &self.choices
    }

    /// Judges the forks that are not settled, and goes on to what is tried next. Whether anything is.
    /// `refused`: forks that became joints for lack of room.
    pub(crate) fn advance(
        &mut self,
        mesh: &CoarseMesh,
        patches: Vec<(u32, Range<u32>)>,
        refused: &[u32],
    ) -> bool {
        for fork in refused {
            if let Some(trial) = self.trials.get_mut(fork) {
                trial.refuse();
            }
        }
        let mut near: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for (fork, range) in patches {
            let open = self.trials.get(&fork).is_some_and(|trial| !trial.settled);
            if open {
                near.entry(fork).or_default().extend(range);
            }
        }
        let near: Vec<(u32, Vec<u32>)> = near.into_iter().collect();
        let judged: Vec<(u32, usize)> = near
            .par_iter()
            .map(|(fork, patches)| (*fork, faults(mesh, patches)))
            .collect();
        let faults: BTreeMap<u32, usize> = judged.into_iter().collect();
        let mut changed = false;
        for (fork, trial) in self.trials.iter_mut().filter(|(_, trial)| !trial.settled) {
            let before = CHOICES[trial.current];
            // A fork without patches was left out with its branch.
            trial.faults[trial.current] = Some(faults.get(fork).copied().unwrap_or(0));
            trial.next();
            self.choices[*fork as usize] = CHOICES[trial.current];
            changed |= CHOICES[trial.current] != before;
        }
        changed
    }
}

impl Trial {
    /// There is no room for an inset of this thickness, whatever its lift.
    fn refuse(&mut self) {
        let thick = |choice: &ForkChoice| {
            matches!(
                choice,
                ForkChoice::Inset {
                    thickened: true,
                    ..
                }
            )
        };
        for (choice, faults) in CHOICES.iter().zip(&mut self.faults).take(JOINT) {
            if thick(choice) == thick(&CHOICES[self.current]) {
                faults.get_or_insert(usize::MAX);
            }
        }
        self.current = JOINT;
    }

    /// Goes on to the first choice that was not tried, or back to the best if all were or one is sound.
    fn next(&mut self) {
        let sound = self.faults[self.current] == Some(0);
        let untried = self.faults.iter().position(Option::is_none);
        match untried.filter(|_| !sound) {
            Some(next) => self.current = next,
            None => {
                self.settled = true;
                let tried = self.faults.iter().enumerate();
                let best = tried.min_by_key(|(i, faults)| (faults.unwrap_or(usize::MAX), *i));
                self.current = best.map_or(self.current, |(i, _)| i);
            }
        }
    }
}
