//! The full picture, which is drawn when nothing has moved for a while.

use std::time::Duration;

use eframe::egui;
use neurotess::render::{AdaptiveSettings, DeviceError, Frame, Steps, VertexSource, ViewParams};

use super::cost_model::RestMode;
use super::pointing::Resolver;
use super::{RestPhase, Stage};
use crate::model::command::Tab;
use crate::model::document::Detail;
use crate::model::state::State;

/// Time without movement after which the full picture is drawn.
pub(super) const REST: Duration = Duration::from_millis(130);
/// Longest time (ms) that a slice of a picture should take.
const SLICE_MS: f64 = 120.0;
/// Most slices of a step: beyond a million patches each slice selects anew, so that many slices
/// would take longer in all.
const MOST_SLICES: f64 = 3.0;

impl Stage {
    pub(super) fn refine(
        &mut self,
        state: &mut State,
        ctx: &egui::Context,
    ) -> Result<(), DeviceError> {
        let Some(drawn) = &self.drawn else {
            return Ok(());
        };
        let (params, detail) = (drawn.params, drawn.detail);
        match self.phase {
            RestPhase::Waits if self.moved.elapsed() < REST => {
                ctx.request_repaint_after(REST.saturating_sub(self.moved.elapsed()));
            }
            RestPhase::Done => self.count(state)?,
            _ if self.progressive.is_busy(&self.gpu) => {
                ctx.request_repaint_after(Duration::from_millis(5));
            }
            RestPhase::Waits => {
                self.begin(params, detail);
                ctx.request_repaint();
            }
            RestPhase::Slices => {
                self.slice(params)?;
                ctx.request_repaint();
            }
            RestPhase::Surveys => {
                self.survey()?;
                ctx.request_repaint();
            }
        }
        Ok(())
    }

    fn begin(&mut self, params: ViewParams, detail: Detail) {
        self.rest_mode = self.select_rest_mode(&params);
        let lod = match self.rest_mode {
            RestMode::Coarser => detail.lod().coarser(self.coarser),
            RestMode::Refined | RestMode::Explored => detail.lod(),
        };
        self.adaptive.set_settings(AdaptiveSettings {
            lod,
            smallest: detail.smallest,
            wireframe: params.look.wire > 0.0,
            ..AdaptiveSettings::default()
        });
        let steps = Steps {
            steps: 4,
            slices: self.slices,
        };
        self.progressive.begin(params, steps);
        self.cost_model.begin();
        self.timed = false;
        self.phase = RestPhase::Slices;
    }

    fn slice(&mut self, params: ViewParams) -> Result<(), DeviceError> {
        if self.timed {
            self.learn();
            if self.rest_mode == RestMode::Refined
                && self.select_rest_mode(&params) != RestMode::Refined
            {
                // The next slices would be as slow: stops, and begins again in another mode.
                self.progressive.stop();
                self.phase = RestPhase::Waits;
                return Ok(());
            }
        }
        // Ids for picking are drawn as soon as the first step is shown.
        let identifies =
            !self.progressive.shows_draft() && self.resolver.is_none() && !self.can_pick();
        self.timed = !identifies;
        let budget = self.cost_model.budget;
        let adaptive: &mut dyn VertexSource = match self.rest_mode {
            RestMode::Refined | RestMode::Coarser => &mut self.adaptive,
            RestMode::Explored => {
                match self
                    .explorer
                    .exploration(&self.gpu, &self.content, self.instances, budget)
                {
                    Some(adaptive) => adaptive,
                    None => {
                        self.phase = RestPhase::Waits;
                        return Ok(());
                    }
                }
            }
        };
        if identifies {
            self.progressive.identify(&self.gpu, adaptive, &params)?;
            self.resolver = match self.rest_mode {
                RestMode::Refined | RestMode::Coarser => {
                    Some(Resolver::Refined(self.adaptive.resolver()))
                }
                RestMode::Explored => self.explorer.resolver().map(Resolver::Explored),
            };
            return Ok(());
        }
        self.progressive.slice(&self.gpu, adaptive)?;
        if self.progressive.progress().is_none() {
            self.phase = match self.rest_mode {
                RestMode::Explored => RestPhase::Surveys,
                RestMode::Refined | RestMode::Coarser => RestPhase::Done,
            };
        }
        Ok(())
    }

    /// Updates estimates from the slice that was drawn last.
    fn learn(&mut self) {
        let took = self.progressive.last_ms();
        self.note_frame(took);
        self.note_slice(took);
        if self.rest_mode == RestMode::Refined {
            // For the next picture, since the slices of this one are fixed.
            let fitting = f64::from(self.slices) * took / SLICE_MS;
            self.slices = ((f64::from(self.slices) + fitting) / 2.0).clamp(1.0, MOST_SLICES) as u32;
        }
    }

    /// Finds out what exploration mode left out. If there is time for more triangles, the picture
    /// is drawn again.
    fn survey(&mut self) -> Result<(), DeviceError> {
        self.learn();
        self.phase = RestPhase::Done;
        let budget = self.cost_model.budget;
        let Some(adaptive) =
            self.explorer
                .exploration(&self.gpu, &self.content, self.instances, budget)
        else {
            return Ok(());
        };
        let stats = adaptive.stats(&self.gpu)?;
        self.surveyed = Some([stats.triangles, stats.requested]);
        if self.cost_model.adapt(stats.requested) {
            self.phase = RestPhase::Waits;
        }
        Ok(())
    }

    /// Counts triangles and patches of the picture at rest, while their panel is open.
    fn count(&mut self, state: &State) -> Result<(), DeviceError> {
        let Some(drawn) = self.drawn.as_ref().filter(|_| self.counts.is_none()) else {
            return Ok(());
        };
        let looked_at = state.tab == Tab::Detail && state.panels;
        // In exploration mode, counting would take as long as drawing.
        if !looked_at || self.rest_mode != RestMode::Refined {
            return Ok(());
        }
        let params = drawn.params;
        let (camera, near) = params.frozen.unwrap_or((params.camera, params.near));
        let frame = Frame::whole(camera, near, params.size);
        self.adaptive.prepare(&self.gpu, &frame)?;
        let stats = self.adaptive.stats(&self.gpu)?;
        self.counts = Some([stats.triangles, stats.patches_drawn, stats.patches]);
        Ok(())
    }
}
