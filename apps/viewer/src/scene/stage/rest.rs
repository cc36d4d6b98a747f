//! The full picture, when nothing has moved for a while.

use std::time::Duration;

use eframe::egui;
use neurotess::render::{AdaptiveSettings, DeviceError, Steps, VertexSource, ViewParams};

use super::cost_model::Full;
use super::pointing::Names;
use super::{Rest, Stage, whole};
use crate::model::command::Tab;
use crate::model::document::Detail;
use crate::model::state::State;

/// How long nothing must have moved before the full picture is made.
pub(super) const REST: Duration = Duration::from_millis(130);
/// A slice of a picture should take no longer.
const SLICE_MS: f64 = 120.0;
/// Most slices of a step: beyond a million patches each is chosen for itself, so many would take longer
/// together.
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
        let (shot, detail) = (drawn.shot, drawn.detail);
        match self.rest {
            Rest::Waits if self.moved.elapsed() < REST => {
                ctx.request_repaint_after(REST.saturating_sub(self.moved.elapsed()));
            }
            Rest::Done => self.count(state)?,
            _ if self.live.is_busy(&self.gpu) => {
                ctx.request_repaint_after(Duration::from_millis(5));
            }
            Rest::Waits => {
                self.begin(shot, detail);
                ctx.request_repaint();
            }
            Rest::Slices => {
                self.slice(shot)?;
                ctx.request_repaint();
            }
            Rest::Surveys => {
                self.survey()?;
                ctx.request_repaint();
            }
        }
        Ok(())
    }

    fn begin(&mut self, shot: ViewParams, detail: Detail) {
        self.full = self.choose_full(&shot);
        let lod = match self.full {
            Full::Coarser => detail.lod().coarser(self.coarser),
            Full::Refined | Full::Explored => detail.lod(),
        };
        self.maker.set_settings(AdaptiveSettings {
            lod,
            smallest: detail.smallest,
            wireframe: shot.look.wire > 0.0,
            ..AdaptiveSettings::default()
        });
        let steps = Steps {
            steps: 4,
            slices: self.slices,
        };
        self.live.begin(shot, steps);
        self.means.begin();
        self.timed = false;
        self.rest = Rest::Slices;
    }

    fn slice(&mut self, shot: ViewParams) -> Result<(), DeviceError> {
        if self.timed {
            self.learn();
            if self.full == Full::Refined && self.choose_full(&shot) != Full::Refined {
                // It would go on like this: begun anew, it is drawn otherwise.
                self.live.stop();
                self.rest = Rest::Waits;
                return Ok(());
            }
        }
        // As soon as the first step shows, the cursor may ask.
        let asks = !self.live.shows_draft() && self.namer.is_none() && self.picks.is_none();
        self.timed = !asks;
        let budget = self.means.budget;
        let maker: &mut dyn VertexSource = match self.full {
            Full::Refined | Full::Coarser => &mut self.maker,
            Full::Explored => match self.explorer.maker(&self.gpu, &self.shown, budget) {
                Some(maker) => maker,
                None => {
                    self.rest = Rest::Waits;
                    return Ok(());
                }
            },
        };
        if asks {
            self.live.identify(&self.gpu, maker, &shot)?;
            self.namer = match self.full {
                Full::Refined | Full::Coarser => Some(Names::Refined(self.maker.namer())),
                Full::Explored => self.explorer.namer().map(Names::Explored),
            };
            return Ok(());
        }
        self.live.slice(&self.gpu, maker)?;
        if self.live.progress().is_none() {
            self.rest = match self.full {
                Full::Explored => Rest::Surveys,
                Full::Refined | Full::Coarser => Rest::Done,
            };
        }
        Ok(())
    }

    /// From the slice that is done.
    fn learn(&mut self) {
        let took = self.live.last_ms();
        self.note_frame(took);
        self.note_slice(took);
        if self.full == Full::Refined {
            // For the next picture: slices of this one are laid out.
            let wanted = f64::from(self.slices) * took / SLICE_MS;
            self.slices = ((f64::from(self.slices) + wanted) / 2.0).clamp(1.0, MOST_SLICES) as u32;
        }
    }

    /// What the explored picture left out; where there is time for more, it is drawn once more.
    fn survey(&mut self) -> Result<(), DeviceError> {
        self.learn();
        self.rest = Rest::Done;
        let budget = self.means.budget;
        let Some(maker) = self.explorer.maker(&self.gpu, &self.shown, budget) else {
            return Ok(());
        };
        let stats = maker.stats(&self.gpu)?;
        self.surveyed = Some([stats.triangles, stats.wanted]);
        if self.means.adapt(stats.wanted) {
            self.rest = Rest::Waits;
        }
        Ok(())
    }

    /// Triangles and patches of the picture at rest, while somebody looks at their panel.
    fn count(&mut self, state: &State) -> Result<(), DeviceError> {
        let Some(drawn) = self.drawn.as_ref().filter(|_| self.counts.is_none()) else {
            return Ok(());
        };
        let looked_at = state.tab == Tab::Detail && state.panels;
        // Where it is explored, counting would take as long as drawing.
        if !looked_at || self.full != Full::Refined {
            return Ok(());
        }
        let shot = drawn.shot;
        let (camera, near) = shot.frozen.unwrap_or((shot.camera, shot.near));
        let frame = whole(camera, near, shot.size);
        self.maker.prepare(&self.gpu, &frame)?;
        let stats = self.maker.stats(&self.gpu)?;
        self.counts = Some([stats.triangles, stats.patches_drawn, stats.patches]);
        Ok(())
    }
}
