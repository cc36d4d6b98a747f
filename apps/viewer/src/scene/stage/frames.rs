//! The moment of a recording: values of the neurons that show, taken when they are there.

use std::sync::Arc;
use std::time::Duration;

use eframe::egui;
use neurotess::render::ColorTable;

use super::Stage;
use crate::io::frames::{CullView, Reader};
use crate::model::playback::Facts;
use crate::model::state::State;
use crate::scene::colors::{ColorKey, paint};

impl Stage {
    /// Another recording shows, or none: it is read from now on.
    pub(super) fn replay(&mut self, state: &mut State, ctx: &egui::Context) {
        let replay = self.shown.replay.as_ref().map(|(replay, _)| replay);
        let same = |reader: &Reader| replay.is_some_and(|r| Arc::ptr_eq(reader.replay(), r));
        if !self.reader.as_ref().is_some_and(same) {
            self.reader = replay.map(|replay| Reader::new(Arc::clone(replay), ctx));
            self.values = None;
        }
        self.tell(state);
    }

    /// What the window knows of the recording.
    fn tell(&self, state: &mut State) {
        let range = paint(&state.document.look).range;
        let facts = self.shown.replay.as_ref().map(|(replay, all)| Facts {
            title: replay.title.clone(),
            unit: replay.unit.clone(),
            time: replay.time,
            spikes: replay.is_of_spikes(),
            range: range.unwrap_or(*all),
            without: [replay.without(), replay.places()],
        });
        if facts != state.playback.facts {
            state.playback.set_facts(facts);
        }
    }

    /// Other colors of the same values: nothing of the scene changes.
    pub(super) fn tint(&mut self, state: &mut State, key: ColorKey) {
        let Some((replay, all)) = &self.shown.replay else {
            return;
        };
        let paint = paint(&state.document.look);
        let tinted = replay.coloring(paint.range.unwrap_or(*all), &paint);
        let values = std::mem::take(&mut self.shown.table.values);
        self.shown.table = ColorTable {
            values,
            ..tinted.table
        };
        self.shown.legend = tinted.legend;
        self.live.set_colors(self.shown.table.clone());
        self.colors = Some(key);
        self.drawn = None;
        self.tell(state);
    }

    /// Whether values are those of the neurons there are.
    pub(super) fn is_in_order(&self, state: &State) -> bool {
        let valued = self.shown.table.values.instances();
        valued == 0 || valued == state.document.neurons.len()
    }

    /// Takes the values of the moment if they are there; whether they are other ones than before.
    pub(super) fn take_values(&mut self, state: &mut State, ctx: &egui::Context) -> bool {
        self.values_due = false;
        let (Some(reader), Some(facts)) = (&self.reader, &state.playback.facts) else {
            return false;
        };
        let Some(frame) = state.playback.frame() else {
            return false;
        };
        let sight = CullView {
            shows: self.shown.instances.iter().map(|s| !s.hidden).collect(),
            range: facts.range,
            decay: state.document.look.decay,
        };
        let stride = match state.playback.playing {
            true => state.playback.stride(),
            false => 0,
        };
        let values = reader.get(frame, stride, &sight);
        if let Some(why) = reader.problem() {
            state.problem(reader.replay().file.clone(), why);
        }
        if let Some(seconds) = state.playback.next() {
            ctx.request_repaint_after(Duration::from_secs_f64(seconds.min(1.0)));
        }
        let Some(values) = values else {
            self.values_due = true;
            return false;
        };
        if self
            .values
            .as_ref()
            .is_some_and(|v| Arc::ptr_eq(v, &values))
        {
            return false;
        }
        self.live.set_values((*values).clone());
        self.shown.table.values = (*values).clone();
        self.values = Some(values);
        true
    }
}
