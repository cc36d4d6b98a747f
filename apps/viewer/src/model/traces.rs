//! What was read for plots of values over time, and the value under the cursor.

use std::sync::Arc;

use neurotess::circuit::TimeAxis;
use neurotess::coloring::TracedCompartment;

use crate::model::document::TracePlace;
use crate::model::revision::Revision;

/// What a recording has of a place.
#[derive(Clone, Debug, PartialEq)]
pub enum TraceContent {
    /// Values of the compartment that is nearest.
    Values {
        /// The compartment.
        compartment: TracedCompartment,
        /// Times of the values.
        time: TimeAxis,
        /// Values from the first frame on; fewer than frames, if not all could be read.
        values: Vec<f32>,
    },
    /// Times (ms) at which the neuron fires.
    Spikes(Vec<f64>),
    /// Nothing.
    Nothing,
}

/// What was read of a place.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadTrace {
    /// What there is.
    pub content: TraceContent,
    /// Why it is not all.
    pub problem: Option<String>,
}

/// The value of a place in a frame of the recording; none if there is none.
#[derive(Clone, Debug, PartialEq)]
pub struct PointedValue {
    /// The place, and the frame.
    pub of: (TracePlace, u64),
    /// The compartment there, and its value.
    pub value: Option<(TracedCompartment, f32)>,
}

/// All that was read.
#[derive(Clone, Debug, Default)]
pub struct TraceData {
    /// Whether the plot is open.
    pub open: bool,
    /// The place under the cursor, if its cell is one of a recording.
    pub(crate) pointed: Option<TracePlace>,
    /// The value that was read last for the place under the cursor.
    pub(crate) value: Option<PointedValue>,
    read: Vec<(TracePlace, Arc<ReadTrace>)>,
    revision: Revision,
}

impl TraceData {
    /// The revision of what was read.
    pub(crate) fn revision(&self) -> Revision {
        self.revision
    }

    /// What was read of a place.
    pub fn of(&self, place: TracePlace) -> Option<&Arc<ReadTrace>> {
        let read = self.read.iter().find(|(of, _)| *of == place);
        read.map(|(_, read)| read)
    }

    /// Keeps what was read of a place.
    pub(crate) fn set(&mut self, place: TracePlace, read: ReadTrace) {
        self.read.retain(|(of, _)| *of != place);
        self.read.push((place, Arc::new(read)));
        self.revision = Revision::next();
    }

    /// Keeps only what was read of these places.
    pub(crate) fn keep(&mut self, keeps: impl Fn(TracePlace) -> bool) {
        self.read.retain(|(of, _)| keeps(*of));
    }

    /// Forgets what was read: the recording or the neurons are others.
    pub(crate) fn forget(&mut self) {
        if !self.read.is_empty() {
            self.read.clear();
            self.revision = Revision::next();
        }
        self.value = None;
    }
}

impl ReadTrace {
    /// The compartment, if there is one.
    pub fn compartment(&self) -> Option<&TracedCompartment> {
        match &self.content {
            TraceContent::Values { compartment, .. } => Some(compartment),
            _ => None,
        }
    }

    /// The value at a time (ms), if there is one.
    pub fn value_at(&self, at: f64) -> Option<f32> {
        match &self.content {
            TraceContent::Values { time, values, .. } => {
                let frame = usize::try_from(time.frame_at(at)?).ok()?;
                values.get(frame).copied()
            }
            _ => None,
        }
    }
}
