//! What a full picture may cost. Where refining everything would hold the window up, exploration draws the
//! picture at rest too, with as many triangles as there is time for.

use neurotess::render::{ViewParams, any_shows};

use super::{Stage, whole};
use crate::model::state::{Lowered, State};
use crate::scene::content::Standing;

/// No slice of a full picture may be expected to take longer: no input is answered meanwhile.
const LIMIT_MS: f64 = 600.0;
/// A slice of an explored picture should take no longer.
const EXPLORED_MS: f64 = 150.0;
/// Triangles of an explored picture: at first, at least and at most.
const FIRST_BUDGET: u32 = 200_000;
const LEAST_BUDGET: u32 = 50_000;
const MOST_BUDGET: u32 = 2_000_000;
/// Milliseconds of a slice for each patch that may show, until it was measured: in software, else.
const SOFTWARE_PATCH_MS: f64 = 2.5e-4;
const PATCH_MS: f64 = 1e-5;
/// Fewer patches are never too many: what a slice takes is not theirs.
const FEW: u64 = 100_000;

/// How the picture at rest is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Full {
    /// As it is saved.
    Refined,
    /// By the explorer, within a budget.
    Explored,
    /// As coarsely as drafts: what the explorer cannot draw.
    Coarser,
}

/// What was measured, and what follows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Means {
    /// Milliseconds of a slice for each patch: now, and before anything was measured.
    patch_ms: f64,
    first_ms: f64,
    /// Patches that are too many, if that is not to be measured.
    most_patches: Option<u64>,
    /// Triangles of an explored picture.
    pub(super) budget: u32,
    /// The quickest slice (ms) of the explored picture under way: the first also chooses and looks for
    /// dark corners, and other work on the machine holds up one or another.
    best_ms: f64,
}

impl Means {
    pub(super) fn new(software: bool) -> Self {
        let first_ms = match software {
            true => SOFTWARE_PATCH_MS,
            false => PATCH_MS,
        };
        Self {
            patch_ms: first_ms,
            first_ms,
            most_patches: None,
            budget: FIRST_BUDGET,
            best_ms: f64::MAX,
        }
    }

    /// Whether a slice of so many patches is expected to take too long.
    pub(super) fn too_many(&self, patches: u64) -> bool {
        match self.most_patches {
            Some(most) => patches > most,
            None => patches >= FEW && self.patch_ms * patches as f64 > LIMIT_MS,
        }
    }

    /// Learns from a slice of the refined picture. The mean with what was known: shaders that are
    /// compiled, or other work on the machine, hold up one slice, not all.
    pub(super) fn note_refined(&mut self, took_ms: f64, patches: u64) {
        if patches >= FEW {
            self.patch_ms = (self.patch_ms * took_ms / patches as f64).sqrt();
        }
    }

    /// Another picture is begun.
    pub(super) fn begin(&mut self) {
        self.best_ms = f64::MAX;
    }

    /// Learns from a slice of the explored picture.
    pub(super) fn note_explored(&mut self, took_ms: f64) {
        self.best_ms = self.best_ms.min(took_ms);
    }

    /// Another budget for the next explored picture; whether that is worth a picture now. `wanted`:
    /// triangles that half a pixel everywhere would take.
    pub(super) fn adapt(&mut self, wanted: u64) -> bool {
        let (before, took) = (self.budget, self.best_ms.max(1.0));
        self.best_ms = f64::MAX;
        // What was slow once is tried again some time.
        self.patch_ms = (0.95 * self.patch_ms).max(self.first_ms);
        let room = EXPLORED_MS / took;
        if room < 0.67 {
            let fits = f64::from(before) * room.max(0.25);
            self.budget = (fits as u32).max(LEAST_BUDGET);
        } else if room > 1.5 && wanted > u64::from(before) {
            let fits = f64::from(before) * room.min(4.0);
            self.budget = (fits as u32).min(MOST_BUDGET);
        }
        f64::from(self.budget) > 1.2 * f64::from(before)
    }
}

impl Stage {
    /// Holds more than so many patches in the picture for too dear, whatever was measured: for tests.
    pub fn limit_patches(&mut self, most: Option<u64>) {
        self.means.most_patches = most;
    }

    /// Patches of all neurons of which something may show.
    pub(super) fn patches_in(
        &self,
        state: &State,
        shot: &ViewParams,
        standing: &[Standing],
    ) -> u64 {
        let (camera, near) = shot.frozen.unwrap_or((shot.camera, shot.near));
        let frame = whole(camera, near, shot.size);
        let shows = |standing: &&Standing| {
            let Some(source) = self.shown.sources.get(standing.source) else {
                return false;
            };
            let place = &standing.placement;
            let balls = state
                .sources
                .get(source.id)
                .map_or(&[][..], |s| &s.few_balls);
            let ball = |&(c, r)| (place.world_from_cell(c), r * place.scale);
            any_shows(&balls.iter().map(ball).collect::<Vec<_>>(), &frame)
        };
        let seen = standing.iter().filter(|s| !s.hidden).filter(shows);
        let patches =
            seen.map(|s| self.shown.sources[s.source].generated.mesh.patches.len() as u64);
        patches.sum()
    }

    /// Who draws the picture at rest.
    pub(super) fn choose_full(&mut self, shot: &ViewParams) -> Full {
        if !self.means.too_many(self.patches) {
            return Full::Refined;
        }
        let sketched = explorable(shot) && self.explorer.fits(&self.shown);
        match sketched {
            true => Full::Explored,
            false => Full::Coarser,
        }
    }

    /// Learns from the slice that is done.
    pub(super) fn note_slice(&mut self, took_ms: f64) {
        match self.full {
            Full::Refined => self.means.note_refined(took_ms, self.patches),
            Full::Explored => self.means.note_explored(took_ms),
            Full::Coarser => {}
        }
    }

    /// How the picture at rest is less than it should be.
    pub(super) fn lowered(&self) -> Option<Lowered> {
        match self.full {
            Full::Refined => None,
            Full::Explored => Some(Lowered::Triangles(self.surveyed)),
            Full::Coarser => Some(Lowered::Error(self.coarser)),
        }
    }
}

/// Exploration knows neither grids nor another camera.
pub(super) fn explorable(shot: &ViewParams) -> bool {
    shot.look.wire <= 0.0 && shot.frozen.is_none()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_slow_is_too_much_and_less_of_it_is_not() {
        let mut means = Means::new(true);
        assert!(means.too_many(20_000_000) && !means.too_many(1_000_000));
        means.note_refined(300.0, 1_000_000);
        assert!(!means.too_many(2_000_000) && means.too_many(2_400_000));
        // Once held up is not slow.
        means.note_refined(800.0, 1_000_000);
        assert!(!means.too_many(1_000_000));
        means.note_refined(1600.0, 1_000_000);
        assert!(means.too_many(1_000_000) && !means.too_many(99_000));
        means.note_refined(3000.0, 20_000);
        assert!(!means.too_many(500_000), "few patches tell nothing");
        // Some time later it may be tried again.
        for _ in 0..30 {
            means.note_explored(150.0);
            means.adapt(u64::MAX);
        }
        assert!(!means.too_many(1_000_000) && means.too_many(20_000_000));
    }

    #[test]
    fn budgets_grow_where_there_is_time_and_more_to_draw() {
        let mut means = Means::new(true);
        means.note_explored(30.0);
        assert!(means.adapt(u64::MAX) && means.budget == 4 * FIRST_BUDGET);
        means.note_explored(30.0);
        assert!(means.adapt(u64::MAX) && means.budget == MOST_BUDGET);
        means.note_explored(600.0);
        assert!(!means.adapt(u64::MAX) && means.budget == MOST_BUDGET / 4);
        means.note_explored(140.0);
        assert!(!means.adapt(u64::MAX) && means.budget == MOST_BUDGET / 4);
        means.note_explored(10.0);
        assert!(!means.adapt(1_000), "all that is wanted is there");
    }
}
