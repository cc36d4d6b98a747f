//! Which choice each fork has, and what is tried next.

use std::collections::BTreeMap;

use crate::inset::ForkChoice;
use crate::skeleton::Skeleton;

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

/// Number of a choice, in the order in which they are tried.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ChoiceNumber(usize);

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

    /// Forks whose choice is not settled.
    pub(crate) fn open(&self) -> Vec<u32> {
        let open = self.trials.iter().filter(|(_, trial)| !trial.settled);
        open.map(|(&fork, _)| fork).collect()
    }

    /// Whether a fork's present choice was judged and has no faults.
    pub(crate) fn is_sound(&self, fork: u32) -> bool {
        let trial = self.trials.get(&fork);
        trial.is_some_and(|trial| trial.faults[trial.current] == Some(0))
    }

    /// Forks whose present choice has no faults.
    pub(crate) fn sound(&self) -> impl Iterator<Item = u32> {
        let sound = self.trials.keys().copied();
        sound.filter(|&fork| self.is_sound(fork))
    }

    /// The present choice of a fork and all others that may be sound.
    pub(crate) fn alternatives(&self, fork: u32) -> Vec<(ChoiceNumber, ForkChoice)> {
        let Some(trial) = self.trials.get(&fork) else {
            return Vec::new();
        };
        let others =
            (0..CHOICES.len()).filter(|&n| trial.faults[n].is_none_or(|faults| faults == 0));
        let others = others.filter(|&n| n != trial.current);
        let all = std::iter::once(trial.current).chain(others);
        all.map(|n| (ChoiceNumber(n), CHOICES[n])).collect()
    }

    /// Gives a fork another sound choice.
    pub(crate) fn replace(&mut self, fork: u32, choice: ChoiceNumber) {
        if let Some(trial) = self.trials.get_mut(&fork) {
            trial.current = choice.0;
            trial.faults[choice.0] = Some(0);
            self.choices[fork as usize] = CHOICES[choice.0];
        }
    }

    /// A fork became a joint for lack of room.
    pub(crate) fn refuse(&mut self, fork: u32) {
        if let Some(trial) = self.trials.get_mut(&fork).filter(|t| !t.settled) {
            trial.refuse();
        }
    }

    /// Goes on to what is tried next. `faults`: by fork, of its present choice.
    pub(crate) fn advance(&mut self, faults: &BTreeMap<u32, usize>) {
        for (fork, trial) in self.trials.iter_mut().filter(|(_, trial)| !trial.settled) {
            // A fork without patches was left out with its branch.
            trial.faults[trial.current] = Some(faults.get(fork).copied().unwrap_or(0));
            trial.next();
            self.choices[*fork as usize] = CHOICES[trial.current];
        }
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
