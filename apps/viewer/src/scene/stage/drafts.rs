//! What is drawn while something moves.

use std::time::{Duration, Instant};

use eframe::egui;
use neurotess::render::{
    AdaptiveSettings, DeviceError, OUTLINED, Occlusion, Outlines, Scene, ViewParams,
};

use super::cost_model::explorable;
use super::pointing::OUTLINES;
use super::rest::REST;
use super::{Drawn, Rest, Stage};
use crate::model::state::State;
use crate::scene::content::{self, Standing};

/// A draft should take no longer.
const DRAFT_MS: f64 = 40.0;
/// Drafts that are coarser than this have half as many pixels to each side.
const HALF_FROM: f32 = 6.0;
/// So many frame times are shown.
const FRAMES: usize = 90;

impl Stage {
    pub(super) fn wanted(&mut self, state: &State, size: [u32; 2]) -> Drawn {
        let look = &state.document.look;
        let camera = state.view.camera();
        let balls = state.balls(|_| true);
        let mut surface = content::surface_look(look);
        surface.clip = content::clip(look, &balls);
        let frozen = state.frozen.map(|view| {
            let camera = view.camera();
            (camera, camera.near(&balls))
        });
        Drawn {
            shot: ViewParams {
                camera,
                near: camera.near(&balls),
                size,
                look: surface,
                occlusion: if look.occlusion {
                    Occlusion::Fit
                } else {
                    Occlusion::Off
                },
                background: look.background,
                frozen,
            },
            detail: state.document.detail,
            states: content::states(&state.document),
            standing: content::standing(state, &self.shown.sources),
        }
    }

    /// Draws at once and coarsely, as coarsely as it takes to keep up.
    pub(super) fn draft(
        &mut self,
        state: &State,
        wanted: Drawn,
        ctx: &egui::Context,
    ) -> Result<(), DeviceError> {
        self.moved = Instant::now();
        self.rest = Rest::Waits;
        self.live.stop();
        if self.live.is_busy(&self.gpu) {
            // What was submitted must end first: drafts that pile up come too late.
            ctx.request_repaint_after(Duration::from_millis(3));
            return Ok(());
        }
        self.patches = self.patches_in(state, &wanted.shot, &wanted.standing);
        if self.explorer.is_making()
            && explorable(&wanted.shot)
            && self.means.too_many(self.patches)
        {
            // Refined, even a draft would take seconds.
            ctx.request_repaint_after(Duration::from_millis(15));
            return Ok(());
        }
        if self.drawn.is_some() && self.live.shows_draft() {
            self.keep_up();
        }
        let before = self.drawn.as_ref();
        if before.is_none_or(|d| d.standing != wanted.standing) {
            self.stand(&wanted.standing);
        }
        let selected = state.document.neurons.iter().map(|n| n.selected);
        let outlined = selected.map(|selected| if selected { OUTLINED } else { 0 });
        let states = wanted.states.iter().zip(outlined);
        self.live.set_states(states.map(|(a, b)| a | b).collect());
        self.picks = None;
        self.namer = None;
        self.counts = None;
        let any = state.document.selected().next().is_some();
        let outlines = Outlines {
            // Looking for outlines takes time.
            width: u32::from(any),
            ..OUTLINES
        };
        self.live.set_outlines(&self.gpu, outlines, None);
        self.mask = None;
        self.draw_draft(&wanted)?;
        self.drawn = Some(wanted);
        self.legend.clone_from(&self.shown.legend);
        self.revalued = false;
        ctx.request_repaint_after(REST);
        Ok(())
    }

    /// By the explorer where it can: it knows neither grids nor another camera.
    pub(super) fn draw_draft(&mut self, wanted: &Drawn) -> Result<(), DeviceError> {
        let mut shot = wanted.shot;
        let budget = self.explorer.budget();
        let explorer = match explorable(&shot) {
            true => self.explorer.maker(&self.gpu, &self.shown, budget),
            false => None,
        };
        self.explored = explorer.is_some();
        if let Some(maker) = explorer {
            return self.live.draft(&self.gpu, maker, &shot);
        }
        self.maker.set_settings(AdaptiveSettings {
            // Nothing is left out that would show at rest: holes that come and go look broken.
            lod: wanted.detail.lod().coarser(self.coarser),
            smallest: wanted.detail.smallest,
            wireframe: shot.look.wire > 0.0,
            ..AdaptiveSettings::default()
        });
        if self.coarser > HALF_FROM {
            shot.size = shot.size.map(|n| n.div_ceil(2));
        }
        self.live.draft(&self.gpu, &mut self.maker, &shot)
    }

    pub(super) fn stand(&mut self, standing: &[Standing]) {
        self.shown.instances = standing.to_vec();
        let (templates, _) = self.maker.take_scene().into_parts();
        match Scene::new(templates, content::instances(standing)) {
            Ok(scene) => self.maker.set_scene(scene),
            // Placements are finite by construction; if not, all is built anew.
            Err(_) => self.colors = None,
        }
    }

    /// Drafts become coarser where they take too long, and finer where there is time.
    pub(super) fn keep_up(&mut self) {
        let took = self.live.last_ms();
        self.note_frame(took);
        if self.explored {
            self.explorer.keep_up(took, DRAFT_MS);
        } else if took > 1.5 * DRAFT_MS {
            self.coarser = (self.coarser * 2.0).min(32.0);
        } else if took < 0.4 * DRAFT_MS {
            self.coarser = (self.coarser / 1.4).max(1.0);
        }
    }

    pub(super) fn note_frame(&mut self, took: f64) {
        self.frames.push_back(took as f32);
        if self.frames.len() > FRAMES {
            self.frames.pop_front();
        }
    }
}
