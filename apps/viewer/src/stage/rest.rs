//! The full picture, when nothing has moved for a while.

use std::time::Duration;

use eframe::egui;
use neurotess::render::{DeviceError, Frame, Refining, Shot, Steps, Tile, VertexMaker};

use super::{Rest, Stage};
use crate::command::Tab;
use crate::state::{Counters, State};

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
            Rest::Waits => {
                if self.live.is_busy(&self.gpu) {
                    ctx.request_repaint_after(Duration::from_millis(5));
                    return Ok(());
                }
                self.maker.set_refining(Refining {
                    choice: detail.choice(),
                    smallest: detail.smallest,
                    wires: shot.look.wire > 0.0,
                    ..Refining::default()
                });
                let steps = Steps {
                    steps: 4,
                    slices: self.slices,
                };
                self.live.begin(shot, steps);
                self.rest = Rest::Slices;
                ctx.request_repaint();
            }
            Rest::Slices => self.slice(shot, ctx)?,
            Rest::Done => self.count(state)?,
        }
        Ok(())
    }

    fn slice(&mut self, shot: Shot, ctx: &egui::Context) -> Result<(), DeviceError> {
        if self.live.is_busy(&self.gpu) {
            ctx.request_repaint_after(Duration::from_millis(5));
            return Ok(());
        }
        if self.live.progress().is_some_and(|share| share > 0.0) {
            let took = self.live.last_ms();
            self.note_frame(took);
            // For the next picture: slices of this one are laid out.
            let wanted = f64::from(self.slices) * took / SLICE_MS;
            self.slices = ((f64::from(self.slices) + wanted) / 2.0).clamp(1.0, MOST_SLICES) as u32;
        }
        let whole = self.live.slice(&self.gpu, &mut self.maker)?;
        if whole && self.namer.is_none() && self.picks.is_none() {
            // As soon as the first step shows, the cursor may ask.
            self.live.identify(&self.gpu, &mut self.maker, &shot)?;
            self.namer = Some((self.maker.namer(), shot));
        }
        if self.live.progress().is_none() {
            self.rest = Rest::Done;
        }
        ctx.request_repaint();
        Ok(())
    }

    /// Triangles and patches of the picture at rest, while somebody looks at their panel.
    fn count(&mut self, state: &mut State) -> Result<(), DeviceError> {
        let Some(drawn) = self.drawn.as_ref().filter(|_| !self.counted) else {
            return Ok(());
        };
        if state.tab != Tab::Detail || !state.panels {
            return Ok(());
        }
        self.counted = true;
        let shot = drawn.shot;
        let (camera, near) = shot.frozen.unwrap_or((shot.camera, shot.near));
        let frame = Frame {
            camera,
            near,
            size: shot.size,
            tile: Tile {
                x: 0,
                y: 0,
                width: shot.size[0],
                height: shot.size[1],
            },
        };
        self.maker.prepare(&self.gpu, &frame)?;
        let stats = self.maker.stats(&self.gpu)?;
        let cells: u64 = self.maker.bytes().iter().map(|(_, bytes)| bytes).sum();
        state.counters = Counters {
            triangles: stats.triangles,
            patches: [stats.patches_drawn, stats.patches],
            bytes: [cells, self.live.bytes()],
            ..std::mem::take(&mut state.counters)
        };
        Ok(())
    }
}
