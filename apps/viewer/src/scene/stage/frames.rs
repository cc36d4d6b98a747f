//! The current frame of a recording: values of the neurons that are shown, once they have been
//! read.

use std::sync::Arc;
use std::time::Duration;

use eframe::egui;
use neurotess::coloring::{Recording, VisibleValues};
use neurotess::render::color::ColorTable;

use super::Stage;
use crate::io::frames::{FrameReader, FrameValues, ValueInputs, ValuesOf};
use crate::model::document::Document;
use crate::model::playback::Facts;
use crate::model::state::State;
use crate::scene::colors::{ColorInputs, color_scheme};

/// Values of the recording's current frame.
#[derive(Default)]
pub(super) struct RecordedValues {
    /// Reads the recording.
    pub(super) reader: Option<FrameReader>,
    pub(super) values: Option<Arc<FrameValues>>,
    /// Where the recording has what shows in the static picture.
    pub(super) visible: Option<Arc<VisibleValues>>,
    /// Whether values of the current frame are still to be read.
    pub(super) due: bool,
    /// Whether values, or colors of markers, have changed since they were drawn.
    pub(super) changed: bool,
}

impl Stage {
    /// Starts to read another recording, or none.
    pub(super) fn recording(&mut self, state: &mut State, ctx: &egui::Context) {
        let recording = self
            .content
            .recording
            .as_ref()
            .map(|(recording, _)| recording);
        let same =
            |reader: &FrameReader| recording.is_some_and(|r| Arc::ptr_eq(reader.recording(), r));
        if !self.recorded.reader.as_ref().is_some_and(same) {
            self.recorded.reader = recording.map(|recording| {
                let ctx = ctx.clone();
                FrameReader::new(Arc::clone(recording), move || ctx.request_repaint())
            });
            self.recorded.values = None;
            self.find_visible();
        }
        self.tell(state);
    }

    /// The recording that shows, if it was matched with the document's neurons.
    pub(crate) fn recording_of(&self, document: &Document) -> Option<&Arc<Recording>> {
        let (recording, _) = self.content.recording.as_ref()?;
        let colors = self.on_device.colors.as_ref()?;
        (colors.subject == ColorInputs::new(document).subject).then_some(recording)
    }

    /// Passes what is known of the recording to the window's state.
    fn tell(&self, state: &mut State) {
        let range = color_scheme(&state.document.look).range;
        let facts = self
            .content
            .recording
            .as_ref()
            .map(|(recording, all)| Facts {
                title: recording.title.clone(),
                unit: recording.unit.clone(),
                time: recording.time,
                spikes: recording.is_of_spikes(),
                range: range.unwrap_or(*all),
                without: [recording.without(), recording.places()],
                warnings: {
                    let unknown = recording.unknown_sections().map(ToString::to_string);
                    recording.warnings.iter().cloned().chain(unknown).collect()
                },
            });
        if facts != state.playback.facts {
            state.playback.set_facts(facts);
        }
    }

    /// Uses other colors for the same values; nothing else of the scene changes.
    pub(super) fn restyle_values(&mut self, state: &mut State, key: ColorInputs) {
        let Some((recording, all)) = &self.content.recording else {
            return;
        };
        let color_scheme = color_scheme(&state.document.look);
        let restyled = recording.coloring(color_scheme.range.unwrap_or(*all), &color_scheme);
        let values = std::mem::take(&mut self.content.table.values);
        self.content.table = ColorTable {
            values,
            ..restyled.table
        };
        self.content.legend = restyled.legend;
        self.set_colors();
        self.on_device.colors = Some(key);
        self.rebuilds.colors += 1;
        self.drawn = None;
        self.tell(state);
    }

    /// Whether values belong to the current neurons.
    pub(super) fn is_in_order(&self, state: &State) -> bool {
        let valued = self.content.table.values.instances();
        valued == 0 || valued == state.document.neurons.len()
    }

    /// Takes the values of the current frame if they have been read: those that show in the static
    /// picture, or those of all neurons that are shown. True if they differ from those before.
    pub(super) fn take_values(&mut self, state: &mut State, ctx: &egui::Context) -> bool {
        self.recorded.due = false;
        let (Some(reader), Some(facts)) = (&self.recorded.reader, &state.playback.facts) else {
            return false;
        };
        let Some(frame) = state.playback.frame() else {
            return false;
        };
        let of = match &self.recorded.visible {
            Some(visible) => ValuesOf::Visible(Arc::clone(visible)),
            None => ValuesOf::Neurons {
                shows: Arc::clone(&self.on_device.shows),
                range: facts.range,
            },
        };
        let value_inputs = ValueInputs {
            of,
            decay: state.document.look.decay,
        };
        let stride = match state.playback.playing {
            true => state.playback.stride(),
            false => 0,
        };
        let values = reader.get(frame, stride, &value_inputs);
        if let Some(why) = reader.problem() {
            state.problem(reader.recording().file.clone(), why);
        }
        if let Some(seconds) = state.playback.next() {
            ctx.request_repaint_after(Duration::from_secs_f64(seconds.min(1.0)));
        }
        let Some(values) = values else {
            self.recorded.due = true;
            return false;
        };
        if self
            .recorded
            .values
            .as_ref()
            .is_some_and(|v| Arc::ptr_eq(v, &values))
        {
            return false;
        }
        if let FrameValues::Neurons(values) = &*values {
            self.progressive.set_values(values.clone());
            self.content.table.values = values.clone();
        }
        self.recorded.values = Some(values);
        true
    }
}
