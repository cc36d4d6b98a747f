//! Steps of a stage of work, which whoever watches it is told of.

use std::cell::Cell;

use crate::{Stage, Watch};

/// Parts of a step that are told apart: a bar that is a few hundred pixels wide shows no finer ones. A guard.
const PARTS: usize = 100;

/// The steps of a stage. All are counted alike, whatever time they take.
pub struct Steps<'w> {
    watch: Watch<'w>,
    stage: Stage,
    /// Steps that are done.
    done: usize,
    all: usize,
    /// The most that was told: what is begun anew does not go back.
    told: Cell<usize>,
}

impl<'w> Steps<'w> {
    /// Tells that a stage of so many steps begins.
    pub fn begin(watch: &Watch<'w>, stage: Stage, all: usize) -> Self {
        let steps = Self {
            watch: *watch,
            stage,
            done: 0,
            all,
            told: Cell::new(0),
        };
        steps.part(0, 1);
        steps
    }

    /// Who watches.
    pub fn watch(&self) -> &Watch<'w> {
        &self.watch
    }

    /// Tells how much of the step that is being done is done.
    pub fn part(&self, done: usize, all: usize) {
        let part = (PARTS * done).checked_div(all).unwrap_or(0).min(PARTS);
        let done = (PARTS * self.done + part).min(PARTS * self.all);
        self.told.set(self.told.get().max(done));
        self.watch
            .tell(self.stage, self.told.get(), PARTS * self.all);
    }

    /// Tells that a step is done.
    pub fn next(&mut self) {
        self.done += 1;
        self.part(0, 1);
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;

    use super::*;

    #[test]
    fn steps_and_their_parts_ascend_to_all() {
        let told = Mutex::new(Vec::new());
        let tell = |progress: crate::Progress| {
            told.lock()
                .expect("kept")
                .push((progress.done, progress.all));
        };
        let watch = Watch::default().with_progress(&tell);
        let mut steps = Steps::begin(&watch, Stage::Merge, 2);
        steps.part(1, 4);
        steps.part(0, 0);
        steps.next();
        steps.part(9, 4);
        steps.next();
        let told = told.into_inner().expect("kept");
        let done: Vec<usize> = told.iter().map(|&(done, _)| done).collect();
        assert_eq!(done, [0, 25, 25, 100, 200, 200]);
        assert!(told.iter().all(|&(_, all)| all == 200));
    }
}
