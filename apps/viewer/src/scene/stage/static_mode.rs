//! Static mode: the picture at rest is made once more so that it can be colored anew. From then on
//! recordings, color maps, ranges, palettes and the highlight of the selection change the fine picture
//! at once, whatever the scene; and only values that show are read.

use std::sync::Arc;
use std::time::Duration;

use eframe::egui;
use neurotess::coloring::fractions;
use neurotess::render::{Combined, DeviceError, VertexSource, ViewParams};

use super::cost_model::RestMode;
use super::rest::rest_source;
use super::{DrawnMeshes, MarkersKey, PictureInputs, RestPhase, Stage};
use crate::io::frames::FrameValues;
use crate::model::document::Detail;
use crate::model::revision::Revision;
use crate::model::state::{State, StaticFigures};
use crate::scene::content::{CoverageKey, InstancesKey};

/// What a static picture depends on: all that a picture depends on but what changes only colors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct StaticKey {
    params: ViewParams,
    detail: Detail,
    coverage: CoverageKey,
    instances: InstancesKey,
    clamped: Revision,
    markers: Option<MarkersKey>,
    meshes: Option<DrawnMeshes>,
}

impl StaticKey {
    pub(super) fn new(inputs: &PictureInputs) -> Self {
        Self {
            params: inputs.params,
            detail: inputs.detail,
            coverage: inputs.states.coverage(),
            instances: inputs.instances,
            clamped: inputs.clamped,
            markers: inputs.markers,
            meshes: inputs.meshes,
        }
    }
}

impl Stage {
    /// Whether the picture can be colored anew without being drawn anew.
    pub fn is_static(&self) -> bool {
        self.progressive.static_picture().is_some()
    }

    /// Whether these inputs differ in colors only from those of the static picture.
    pub(super) fn recolors(&self, inputs: &PictureInputs) -> bool {
        self.is_static() && self.shape == Some(StaticKey::new(inputs))
    }

    /// Whether the static picture is worked at next, although colors have changed: in turns with drafts.
    pub(super) fn goes_on(&self, inputs: &PictureInputs) -> bool {
        let rests = match self.pace.phase {
            RestPhase::Collects => true,
            RestPhase::Waits => self.pace.moved.elapsed() >= super::rest::REST,
            _ => false,
        };
        // What stands must have been drawn: the scene may have been replaced since the draft.
        let stands = self.pace.drafted && self.drawn.is_some();
        rests && stands && self.shape == Some(StaticKey::new(inputs))
    }

    /// Makes the next part of the static picture.
    pub(super) fn collect(
        &mut self,
        params: ViewParams,
        detail: Detail,
    ) -> Result<(), DeviceError> {
        self.set_rest_detail(&params, detail);
        if self.is_static() {
            // Picking needs what a picture that was drawn before has already.
            if self.lacks_ids() {
                self.identify(&params)?;
            }
            self.pace.phase = RestPhase::Done;
            return Ok(());
        }
        let steps = self.steps();
        let Some(mut source) = rest_source!(self, self.fine(true)) else {
            self.pace.phase = RestPhase::Waits;
            return Ok(());
        };
        if self.progressive.static_progress().is_none() {
            let begun = self
                .progressive
                .begin_static(&self.gpu, &source, &params, steps)?;
            if !begun {
                self.pace.phase = RestPhase::Done;
            }
        } else if self.progressive.static_slice(&self.gpu, &mut source)? {
            self.find_visible();
        }
        Ok(())
    }

    /// Finds out which values of the recording show in the static picture.
    pub(super) fn find_visible(&mut self) {
        let recording = self.content.recording.as_ref();
        let picture = self.progressive.static_picture();
        self.recorded.visible = recording
            .zip(picture)
            .map(|((recording, _), picture)| Arc::new(recording.visible(picture.keys())));
        self.recorded.values = None;
    }

    /// Forgets the static picture.
    pub(super) fn leave_static(&mut self) {
        self.progressive.drop_static();
        if self.recorded.visible.take().is_some() {
            self.recorded.values = None;
        }
    }

    /// Shows the static picture in the current colors.
    pub(super) fn recolor(
        &mut self,
        state: &State,
        inputs: PictureInputs,
        ctx: &egui::Context,
    ) -> Result<(), DeviceError> {
        if self.progressive.is_busy(&self.gpu) {
            ctx.request_repaint_after(Duration::from_millis(3));
            return Ok(());
        }
        let values = match (
            &self.recorded.visible,
            self.recorded.values.as_deref(),
            &state.playback.facts,
        ) {
            (None, ..) => None,
            (_, Some(FrameValues::Visible(values)), Some(facts)) => {
                Some(fractions(values, facts.range))
            }
            // They are being read.
            _ => return Ok(()),
        };
        if self.progressive.is_recolored() {
            self.note_frame(self.progressive.last_ms());
        }
        if self.on_device.states != Some(inputs.states) {
            self.set_states(state, inputs.states);
        }
        self.progressive.recolor(&self.gpu, values.as_deref())?;
        self.recolor_due = false;
        self.drawn = Some(inputs);
        self.legend = self.whole_legend();
        self.recorded.changed = false;
        Ok(())
    }

    /// What the static picture holds and reads.
    pub(super) fn static_figures(&self) -> Option<StaticFigures> {
        let picture = self.progressive.static_picture()?;
        Some(StaticFigures {
            colors: picture.keys().len(),
            compartments: self
                .recorded
                .visible
                .as_ref()
                .map(|visible| visible.compartments()),
            bytes: picture.bytes(),
        })
    }
}
