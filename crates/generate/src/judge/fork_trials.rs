//! Which choice each fork has, and what is tried next.

use std::collections::BTreeMap;

use crate::judge::refined_patches::{FinerFaults, RefinedPatches, count};
use crate::plan::{self, ForkChoice, MAX_NEIGHBORS};
use crate::tracing::Skeleton;

/// What is tried, in this order. The lift decides most: 0.4 keeps the branch closest to the tracing,
/// higher ones cross the trunk's bends less. With 1.5 radii, which are tried before joints only, 29 files have 2 % fewer
/// pairs near forks and folds, and forks lose a joint's creases. That rings lean is tried for the least lift only: for
/// all lifts 172993 and `Neuron` had more crossings, and the forks of twelve cells were no nearer to their blended
/// branches.
const CHOICES: [ForkChoice; 11] = [
    across(0.4),
    across(0.7),
    across(1.0),
    inset(0.4, false, false),
    inset(0.4, true, false),
    inset(0.7, false, false),
    inset(1.0, false, false),
    inset(0.4, false, true),
    inset(1.0, false, true),
    inset(1.5, false, false),
    ForkChoice::Joint,
];
/// The first choice of all forks but those whose children are straighter to one another than to the parent.
const FIRST: usize = 3;
const JOINT: usize = CHOICES.len() - 1;

const fn across(lift: f64) -> ForkChoice {
    ForkChoice::Inset {
        lift,
        across: true,
        leaning: false,
        thickened: false,
    }
}

const fn inset(lift: f64, leaning: bool, thickened: bool) -> ForkChoice {
    ForkChoice::Inset {
        lift,
        across: false,
        leaning,
        thickened,
    }
}

/// Faults of a fork's shape, in the order in which they count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct ForkFaults {
    level_2: usize,
    /// Where there are none at level 2: what only level 4 shows.
    level_4: FinerFaults,
}

impl ForkFaults {
    /// More than any shape has.
    const MOST: Self = Self {
        level_2: usize::MAX,
        level_4: FinerFaults {
            crossings: 0,
            folds: 0,
        },
    };

    /// The faults of patches around a fork.
    pub(crate) fn of(patches: &RefinedPatches) -> Self {
        let level_2 = count(&patches.faults());
        let level_4 = match level_2 {
            0 => patches.finer_faults(),
            _ => FinerFaults::default(),
        };
        Self { level_2, level_4 }
    }

    /// Whether there are none at level 2.
    pub(crate) fn is_sound(self) -> bool {
        self.level_2 == 0
    }

    /// Whether there are none but folds that only level 4 shows: they are small.
    fn is_nearly_none(self) -> bool {
        self.is_sound() && self.level_4.crossings == 0
    }
}

/// What the choices of some forks made of them.
pub(crate) struct Judged {
    /// Forks that became joints for lack of room.
    pub(crate) refused: Vec<u32>,
    /// By fork.
    pub(crate) faults: Vec<(u32, ForkFaults)>,
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
    faults: [Option<ForkFaults>; CHOICES.len()],
    settled: bool,
}

impl ForkTrials {
    pub(crate) fn new(skeleton: &Skeleton) -> Self {
        let children = skeleton.children();
        let mut choices = vec![CHOICES[FIRST]; skeleton.nodes().len()];
        let mut trials = BTreeMap::new();
        for fork in 0..skeleton.nodes().len() as u32 {
            match children.of(fork).len() {
                0 | 1 => {}
                2..MAX_NEIGHBORS => {
                    let trial = Trial::new(plan::is_straight_across(skeleton, fork));
                    choices[fork as usize] = CHOICES[trial.current];
                    trials.insert(fork, trial);
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

    /// Number of forks.
    pub(crate) fn len(&self) -> usize {
        self.trials.len()
    }

    /// Forks whose choice is not settled.
    pub(crate) fn open(&self) -> Vec<u32> {
        let open = self.trials.iter().filter(|(_, trial)| !trial.settled);
        open.map(|(&fork, _)| fork).collect()
    }

    /// Whether a fork's choice is not settled.
    pub(crate) fn is_open(&self, fork: u32) -> bool {
        let trial = self.trials.get(&fork);
        trial.is_some_and(|trial| !trial.settled)
    }

    /// Whether a fork's present choice was judged and has no faults at level 2.
    pub(crate) fn is_sound(&self, fork: u32) -> bool {
        let trial = self.trials.get(&fork);
        let faults = trial.and_then(|trial| trial.faults[trial.current]);
        faults.is_some_and(ForkFaults::is_sound)
    }

    /// Goes on to what is tried next. `judged`: the present choices, in parts.
    pub(crate) fn advance(&mut self, judged: impl IntoIterator<Item = Judged>) {
        let mut all = BTreeMap::new();
        for Judged { refused, faults } in judged {
            for fork in refused {
                if let Some(trial) = self.trials.get_mut(&fork).filter(|t| !t.settled) {
                    trial.refuse();
                }
            }
            all.extend(faults);
        }
        for (fork, trial) in self.trials.iter_mut().filter(|(_, trial)| !trial.settled) {
            // A fork without patches was left out with its branch.
            trial.faults[trial.current] = Some(all.get(fork).copied().unwrap_or_default());
            trial.next();
            self.choices[*fork as usize] = CHOICES[trial.current];
        }
    }
}

impl Trial {
    fn new(is_straight_across: bool) -> Self {
        let mut trial = Self::default();
        if !is_straight_across {
            trial.faults[..FIRST].fill(Some(ForkFaults::MOST));
            trial.current = FIRST;
        }
        trial
    }

    /// There is no room for an inset of this thickness on this trunk, whatever its lift.
    fn refuse(&mut self) {
        let of = |choice: ForkChoice| (choice.is_thickened(), choice.is_across());
        for (choice, faults) in CHOICES.iter().zip(&mut self.faults).take(JOINT) {
            if of(*choice) == of(CHOICES[self.current]) {
                faults.get_or_insert(ForkFaults::MOST);
            }
        }
        self.current = JOINT;
    }

    /// Goes on to the first choice that was not tried, or back to the best if all were or one has no faults.
    fn next(&mut self) {
        // A fork that has no room for one trunk may have it for the other.
        let flawless = self.faults[self.current] == Some(ForkFaults::default())
            && (self.current < FIRST || self.faults[FIRST].is_some());
        // A joint's creases are larger than the folds that it would avoid.
        let mut tried = self.faults.iter().flatten();
        let needs_joint = !tried.any(|faults| faults.is_nearly_none());
        let choices = if needs_joint { CHOICES.len() } else { JOINT };
        let untried = self.faults[..choices].iter().position(Option::is_none);
        match untried.filter(|_| !flawless) {
            Some(next) => self.current = next,
            None => {
                self.settled = true;
                let tried = self.faults.iter().enumerate();
                let best = tried.min_by_key(|(i, faults)| (faults.unwrap_or(ForkFaults::MOST), *i));
                self.current = best.map_or(self.current, |(i, _)| i);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The choice that is kept, and how many were tried. `faults`: level 2, crossings and folds at level 4, by choice.
    fn tried(faults: [[usize; 3]; CHOICES.len()]) -> (usize, usize) {
        let mut trial = Trial::new(true);
        let mut tried = 0;
        while !trial.settled {
            let [level_2, crossings, folds] = faults[trial.current];
            let level_4 = FinerFaults { crossings, folds };
            trial.faults[trial.current] = Some(ForkFaults { level_2, level_4 });
            tried += 1;
            trial.next();
        }
        (trial.current, tried)
    }

    #[test]
    fn the_first_choice_without_faults_is_kept() {
        let mut faults = [[3, 0, 0]; CHOICES.len()];
        faults[2] = [0; 3];
        faults[3] = [0; 3];
        assert_eq!(tried(faults), (2, 3));
        assert_eq!(tried([[0; 3]; CHOICES.len()]), (0, 1));
    }

    #[test]
    fn without_room_across_the_other_trunk_is_tried() {
        let mut trial = Trial::new(true);
        trial.refuse();
        trial.faults[trial.current] = Some(ForkFaults::default());
        trial.next();
        assert_eq!((trial.current, trial.settled), (FIRST, false));
        trial.faults[FIRST] = Some(ForkFaults::default());
        trial.next();
        assert_eq!((trial.current, trial.settled), (FIRST, true));
    }

    #[test]
    fn faults_at_level_2_count_first_then_crossings_then_folds() {
        let mut faults = [[1, 0, 0]; CHOICES.len()];
        faults[1] = [0, 2, 0];
        faults[3] = [0, 1, 9];
        assert_eq!(tried(faults), (3, CHOICES.len()));
        faults[4] = [0, 1, 3];
        assert_eq!(tried(faults), (4, CHOICES.len()));
    }

    #[test]
    fn only_small_folds_make_no_joint() {
        let mut faults = [[1, 0, 0]; CHOICES.len()];
        faults[JOINT] = [0; 3];
        assert_eq!(tried(faults), (JOINT, CHOICES.len()));
        faults[1] = [0, 0, 4];
        assert_eq!(tried(faults), (1, JOINT));
        faults[1] = [0, 1, 0];
        assert_eq!(tried(faults), (JOINT, CHOICES.len()));
    }
}
