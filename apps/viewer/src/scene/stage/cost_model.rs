//! Estimates the time of a full picture. If refining everything would make the window unresponsive,
//! exploration mode draws the picture at rest too, with as many triangles as there is time for.

use neurotess::render::bounds::any_shows;
use neurotess::render::{Frame, ViewParams};

use super::Stage;
use crate::model::document::RestChoice;
use crate::model::state::{Lowered, State};
use crate::scene::content::SceneInstance;

/// Longest time (ms) that a slice of a full picture may be expected to take, since the window does
/// not respond meanwhile.
const LIMIT_MS: f64 = 600.0;
/// Longest time (ms) that a slice should take in exploration mode.
const EXPLORED_MS: f64 = 150.0;
/// Triangles of a picture at rest in exploration mode: at first, at least and at most.
const FIRST_BUDGET: u32 = 200_000;
const MIN_BUDGET: u32 = 50_000;
const MAX_BUDGET: u32 = 2_000_000;
/// Milliseconds of a slice for each patch in view, until it was measured: in software, and on a
/// GPU.
const SOFTWARE_PATCH_MS: f64 = 2.5e-4;
const PATCH_MS: f64 = 1e-5;
/// Fewer patches are never too many, since a slice then takes its time elsewhere.
const FEW: u64 = 100_000;

/// How the picture at rest is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum RestMode {
    /// Refined, as it would be saved.
    Refined,
    /// In exploration mode, within a budget.
    Explored,
    /// As coarsely as drafts, if exploration mode cannot draw it.
    Coarser,
}

/// Measured times, and what follows from them.
#[derive(Clone, Copy, Debug)]
pub(super) struct CostModel {
    /// Milliseconds of a slice for each patch: current estimate, and the one before anything was
    /// measured.
    patch_ms: f64,
    first_ms: f64,
    /// Most patches that are not too many, if that is set instead of measured.
    most_patches: Option<u64>,
    /// Triangles of a picture at rest in exploration mode.
    pub(super) budget: u32,
    /// The fastest slice (ms) of the picture under way in exploration mode. Others may be slower,
    /// since the first also selects and computes occlusion, and other programs use the machine.
    best_ms: f64,
}

impl CostModel {
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

    /// Whether a slice of this number of patches is expected to take too long.
    pub(super) fn too_many(&self, patches: u64) -> bool {
        match self.most_patches {
            Some(most) => patches > most,
            None => patches >= FEW && self.patch_ms * patches as f64 > LIMIT_MS,
        }
    }

    /// Updates the estimate from a slice of a refined picture. It is averaged with the old one,
    /// since a single slice may be slow because of shader compilation or other programs.
    pub(super) fn note_refined(&mut self, took_ms: f64, patches: u64) {
        if patches >= FEW {
            self.patch_ms = (self.patch_ms * took_ms / patches as f64).sqrt();
        }
    }

    /// Notes that another picture begins.
    pub(super) fn begin(&mut self) {
        self.best_ms = f64::MAX;
    }

    /// Updates the estimate from a slice in exploration mode.
    pub(super) fn note_explored(&mut self, took_ms: f64) {
        self.best_ms = self.best_ms.min(took_ms);
    }

    /// Adapts the budget of exploration mode. True if it is worth drawing the picture again.
    /// `requested`: triangles that it would take to draw everything within half a pixel.
    pub(super) fn adapt(&mut self, requested: u64) -> bool {
        let (before, took) = (self.budget, self.best_ms.max(1.0));
        self.best_ms = f64::MAX;
        // The estimate falls slowly, so that refining is tried again some time after it was too
        // slow.
        self.patch_ms = (0.95 * self.patch_ms).max(self.first_ms);
        let room = EXPLORED_MS / took;
        if room < 0.67 {
            let fits = f64::from(before) * room.max(0.25);
            self.budget = (fits as u32).max(MIN_BUDGET);
        } else if room > 1.5 && requested > u64::from(before) {
            let fits = f64::from(before) * room.min(4.0);
            self.budget = (fits as u32).min(MAX_BUDGET);
        }
        f64::from(self.budget) > 1.2 * f64::from(before)
    }
}

impl Stage {
    /// Sets the number of patches above which a picture is too expensive, whatever was measured:
    /// for tests.
    pub fn limit_patches(&mut self, most: Option<u64>) {
        self.pace.cost_model.most_patches = most;
    }

    /// Finds the patches and the templates of all neurons that may be in view.
    pub(super) fn look(&mut self, state: &State, params: &ViewParams) {
        let (camera, near) = params.frozen.unwrap_or((params.camera, params.near));
        let frame = Frame::whole(camera, near, params.size);
        let shows = |instance: &&SceneInstance| {
            let Some(source) = self.content.sources.get(instance.source) else {
                return false;
            };
            let placement = &instance.placement;
            let spheres = state
                .sources
                .get(source.id)
                .map_or(&[][..], |s| &s.few_spheres);
            let sphere = |&(c, r)| (placement.world_from_cell(c), r * placement.scale);
            any_shows(&spheres.iter().map(sphere).collect::<Vec<_>>(), &frame)
        };
        let seen = self
            .content
            .instances
            .iter()
            .filter(|s| !s.hidden)
            .filter(shows);
        let (mut patches, mut templates) = (0, vec![false; self.content.sources.len()]);
        for instance in seen {
            let mesh = &self.content.sources[instance.source].generated.mesh;
            patches += mesh.patches.len() as u64;
            templates[instance.source] = true;
        }
        self.room.patches = patches;
        let templates = (0..).zip(templates);
        self.room.in_view = templates.filter(|t| t.1).map(|t| t.0).collect();
    }

    /// How the picture at rest is drawn.
    pub(super) fn select_rest_mode(&mut self, params: &ViewParams, choice: RestChoice) -> RestMode {
        let has_proxies = explorable(params) && self.explorer.fits(&self.content);
        let residency = self.room.residency.as_ref();
        let too_large = residency.is_some_and(|residency| !residency.fit(&self.room.in_view));
        let too_many = too_large || self.pace.cost_model.too_many(self.room.patches);
        match (choice, has_proxies) {
            (RestChoice::Full, true) if too_large => RestMode::Explored,
            (RestChoice::Full, _) => RestMode::Refined,
            (RestChoice::Budget, true) => RestMode::Explored,
            (RestChoice::Automatic, _) | (RestChoice::Budget, false) if !too_many => {
                RestMode::Refined
            }
            (_, true) => RestMode::Explored,
            (_, false) => RestMode::Coarser,
        }
    }

    /// Updates the estimates from the last slice.
    pub(super) fn note_slice(&mut self, took_ms: f64) {
        match self.pace.rest_mode {
            RestMode::Refined => self
                .pace
                .cost_model
                .note_refined(took_ms, self.room.patches),
            RestMode::Explored => self.pace.cost_model.note_explored(took_ms),
            RestMode::Coarser => {}
        }
    }

    /// How the quality of the picture at rest is reduced.
    pub(super) fn lowered(&self) -> Option<Lowered> {
        match self.pace.rest_mode {
            RestMode::Refined => None,
            RestMode::Explored => Some(Lowered::Triangles(self.pace.surveyed)),
            RestMode::Coarser => Some(Lowered::Error(self.pace.coarser)),
        }
    }
}

/// Whether exploration mode can draw the picture: it supports neither wireframes nor frozen levels.
pub(super) fn explorable(params: &ViewParams) -> bool {
    params.look.wire <= 0.0 && params.frozen.is_none()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_slow_is_too_much_and_less_of_it_is_not() {
        let mut cost_model = CostModel::new(true);
        assert!(cost_model.too_many(20_000_000) && !cost_model.too_many(1_000_000));
        cost_model.note_refined(300.0, 1_000_000);
        assert!(!cost_model.too_many(2_000_000) && cost_model.too_many(2_400_000));
        // A single slow slice does not count as slow.
        cost_model.note_refined(800.0, 1_000_000);
        assert!(!cost_model.too_many(1_000_000));
        cost_model.note_refined(1600.0, 1_000_000);
        assert!(cost_model.too_many(1_000_000) && !cost_model.too_many(99_000));
        cost_model.note_refined(3000.0, 20_000);
        assert!(!cost_model.too_many(500_000), "few patches tell nothing");
        // Some time later it may be tried again.
        for _ in 0..30 {
            cost_model.note_explored(150.0);
            cost_model.adapt(u64::MAX);
        }
        assert!(!cost_model.too_many(1_000_000) && cost_model.too_many(20_000_000));
    }

    #[test]
    fn budgets_grow_where_there_is_time_and_more_to_draw() {
        let mut cost_model = CostModel::new(true);
        cost_model.note_explored(30.0);
        assert!(cost_model.adapt(u64::MAX) && cost_model.budget == 4 * FIRST_BUDGET);
        cost_model.note_explored(30.0);
        assert!(cost_model.adapt(u64::MAX) && cost_model.budget == MAX_BUDGET);
        cost_model.note_explored(600.0);
        assert!(!cost_model.adapt(u64::MAX) && cost_model.budget == MAX_BUDGET / 4);
        cost_model.note_explored(140.0);
        assert!(!cost_model.adapt(u64::MAX) && cost_model.budget == MAX_BUDGET / 4);
        cost_model.note_explored(10.0);
        assert!(!cost_model.adapt(1_000), "all that is wanted is there");
    }
}
