//! The full picture, which is drawn when nothing has moved for a while.

use std::time::Duration;

use eframe::egui;
use neurotess::render::{
    AdaptiveSettings, Combined, DeviceError, Frame, Steps, VertexSource, ViewParams,
};

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
const MAX_SLICES: f64 = 3.0;

/// The source of the picture at rest and the markers and meshes beside it, without borrowing the whole stage; none if exploration mode cannot
/// draw it any more. `fine`: neurons that are then refined.
macro_rules! rest_source {
    ($stage:ident, $fine:expr) => {{
        let fine: std::sync::Arc<[usize]> = $fine;
        let rest_budget = $stage.rest_budget();
        let key = $stage.drawn.as_ref().and_then(|drawn| drawn.markers);
        let mut finer: Option<&mut dyn VertexSource> = None;
        let source: Option<&mut dyn VertexSource> = match $stage.pace.rest_mode {
            RestMode::Refined | RestMode::Coarser => {
                $stage.adaptive.set_only(None);
                Some(&mut $stage.adaptive)
            }
            RestMode::Explored => {
                if !fine.is_empty() {
                    $stage.adaptive.set_only(Some(std::sync::Arc::clone(&fine)));
                    finer = Some(&mut $stage.adaptive);
                }
                let (gpu, content) = (&$stage.gpu, &$stage.content);
                let budget = $stage.pace.cost_model.budget;
                let instances = $stage.on_device.instances;
                let explored = $stage
                    .explorer
                    .exploration(gpu, content, instances, budget, &fine, None);
                explored.map(|source| source as &mut dyn VertexSource)
            }
        };
        let markers = $stage.markers.drawn(key, 1.0, rest_budget);
        let meshes = $stage.meshes.drawn();
        source.map(|source| {
            Combined::new(source)
                .with_finer(finer)
                .with_markers(markers)
                .with_meshes(meshes)
        })
    }};
}
pub(super) use rest_source;

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
        let phase = self.pace.phase;
        if matches!(phase, RestPhase::Done | RestPhase::Collects) {
            self.count(state)?;
        }
        if phase != RestPhase::Done && self.progressive.is_busy(&self.gpu) {
            ctx.request_repaint_after(Duration::from_millis(5));
            return Ok(());
        }
        let waits = phase == RestPhase::Waits && self.pace.moved.elapsed() < REST;
        self.pace.drafted &= waits || phase == RestPhase::Done;
        match phase {
            RestPhase::Done => {}
            RestPhase::Waits if waits => {
                ctx.request_repaint_after(REST.saturating_sub(self.pace.moved.elapsed()));
            }
            RestPhase::Waits => {
                self.pace.rest_mode = self.select_rest_mode(&params, detail.at_rest);
                // While a recording is played, a picture would be of many times.
                self.pace.phase = match state.playback.playing {
                    true => RestPhase::Collects,
                    false if self.draws_by_processor(&params, detail) => {
                        self.begin_by_processor(state, (params, detail), ctx)
                    }
                    false => self.begin(params, detail)?,
                };
                ctx.request_repaint();
            }
            RestPhase::Draws => self.take_resting(state, (params, detail), ctx)?,
            RestPhase::Slices => {
                self.slice(params, detail)?;
                ctx.request_repaint();
            }
            RestPhase::Surveys => {
                self.survey()?;
                ctx.request_repaint();
            }
            RestPhase::Collects if self.completes(&params, detail) && !self.lacks_ids() => {
                self.pace.phase = self.begin_by_processor(state, (params, detail), ctx);
            }
            RestPhase::Collects => {
                self.collect(params, detail)?;
                ctx.request_repaint();
            }
        }
        Ok(())
    }

    pub(super) fn begin(
        &mut self,
        params: ViewParams,
        detail: Detail,
    ) -> Result<RestPhase, DeviceError> {
        self.bring_what_shows()?;
        self.set_rest_detail(&params, detail);
        self.progressive.begin(params, self.steps());
        self.pace.cost_model.begin();
        self.pace.timed = false;
        Ok(RestPhase::Slices)
    }

    /// Brings what is in view to the device, as far as it fits, if the picture at rest refines it.
    pub(super) fn bring_what_shows(&mut self) -> Result<(), DeviceError> {
        if self.pace.rest_mode == RestMode::Explored {
            return Ok(());
        }
        let in_view = std::mem::take(&mut self.room.in_view);
        let brought = self.bring(&in_view);
        self.room.in_view = in_view;
        brought
    }

    /// Sets the detail of the picture at rest.
    pub(super) fn set_rest_detail(&mut self, params: &ViewParams, detail: Detail) {
        let lod = match self.pace.rest_mode {
            RestMode::Coarser => detail.lod().coarser(self.pace.coarser),
            RestMode::Refined | RestMode::Explored => detail.lod(),
        };
        self.adaptive.set_settings(AdaptiveSettings {
            lod,
            smallest: detail.smallest,
            wireframe: params.look.wire > 0.0,
            ..AdaptiveSettings::default()
        });
        let key = self.drawn.as_ref().and_then(|drawn| drawn.markers);
        let budget = self.rest_budget();
        self.count_markers(params, key, budget);
    }

    pub(super) fn steps(&self) -> Steps {
        Steps {
            steps: 4,
            slices: self.pace.slices,
        }
    }

    fn slice(&mut self, params: ViewParams, detail: Detail) -> Result<(), DeviceError> {
        if self.pace.timed {
            self.learn();
            if self.pace.rest_mode == RestMode::Refined
                && self.select_rest_mode(&params, detail.at_rest) != RestMode::Refined
            {
                // The next slices would be as slow: stops, and begins again in another mode.
                self.progressive.stop();
                self.pace.phase = RestPhase::Waits;
                return Ok(());
            }
        }
        // Ids for picking are drawn as soon as the first step is shown.
        let identifies = !self.progressive.shows_draft() && self.lacks_ids();
        self.pace.timed = !identifies;
        if identifies {
            return self.identify(&params);
        }
        let Some(mut source) = rest_source!(self, self.fine(true)) else {
            self.pace.phase = RestPhase::Waits;
            return Ok(());
        };
        self.progressive.slice(&self.gpu, &mut source)?;
        if self.progressive.progress().is_none() {
            self.pace.phase = match self.pace.rest_mode {
                RestMode::Explored => RestPhase::Surveys,
                RestMode::Refined | RestMode::Coarser => RestPhase::Collects,
            };
        }
        Ok(())
    }

    /// Whether ids for picking are neither there nor on their way.
    pub(super) fn lacks_ids(&self) -> bool {
        self.pointing.resolver.is_none() && !self.can_pick()
    }

    /// Draws the ids of the picture at rest.
    pub(super) fn identify(&mut self, params: &ViewParams) -> Result<(), DeviceError> {
        // Ids of all neurons come from one source.
        let Some(mut source) = rest_source!(self, self.fine(false)) else {
            return Ok(());
        };
        self.progressive.identify(&self.gpu, &mut source, params)?;
        self.pointing.resolver = match self.pace.rest_mode {
            RestMode::Refined | RestMode::Coarser => {
                Some(Resolver::Refined(self.adaptive.resolver()))
            }
            RestMode::Explored => self.explorer.resolver().map(Resolver::Explored),
        };
        Ok(())
    }

    /// Updates estimates from the slice that was drawn last.
    fn learn(&mut self) {
        let took = self.progressive.last_ms();
        self.note_frame(took);
        self.note_slice(took);
        if self.pace.rest_mode == RestMode::Refined {
            // For the next picture, since the slices of this one are fixed.
            let fitting = f64::from(self.pace.slices) * took / SLICE_MS;
            self.pace.slices =
                ((f64::from(self.pace.slices) + fitting) / 2.0).clamp(1.0, MAX_SLICES) as u32;
        }
    }

    /// Finds out what exploration mode left out. If there is time for more triangles, the picture
    /// is drawn again.
    fn survey(&mut self) -> Result<(), DeviceError> {
        self.learn();
        self.pace.phase = RestPhase::Collects;
        let (budget, fine) = (self.pace.cost_model.budget, self.fine(true));
        let Some(adaptive) = self.explorer.exploration(
            &self.gpu,
            &self.content,
            self.on_device.instances,
            budget,
            &fine,
            None,
        ) else {
            return Ok(());
        };
        let stats = adaptive.stats(&self.gpu)?;
        self.pace.surveyed = Some([stats.triangles, stats.requested]);
        if self.pace.cost_model.adapt(stats.requested) {
            self.pace.phase = RestPhase::Waits;
        }
        Ok(())
    }

    /// Counts triangles and patches of the picture at rest, while their panel is open.
    fn count(&mut self, state: &State) -> Result<(), DeviceError> {
        let Some(drawn) = self.drawn.as_ref().filter(|_| self.pace.counts.is_none()) else {
            return Ok(());
        };
        let looked_at = state.layout.tab == Tab::Detail && state.layout.panels;
        // In exploration mode, counting would take as long as drawing.
        if !looked_at || self.pace.rest_mode != RestMode::Refined {
            return Ok(());
        }
        let params = drawn.params;
        let (camera, near) = params.frozen.unwrap_or((params.camera, params.near));
        let frame = Frame::whole(camera, near, params.size);
        self.adaptive.set_only(None);
        self.adaptive.prepare(&self.gpu, &frame)?;
        let stats = self.adaptive.stats(&self.gpu)?;
        self.pace.counts = Some([stats.triangles, stats.patches_drawn, stats.patches]);
        Ok(())
    }
}
