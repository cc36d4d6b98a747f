//! Values of a recording, read ahead on a thread of their own, so that the window never waits.

use std::collections::BTreeMap;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};

use neurotess::coloring::{Recording, VisibleValues};
use neurotess::render::color::InstanceValues;

use crate::io::background::spawn;
use crate::io::task::caught;

/// Number of pictures that are read ahead.
const AHEAD: u64 = 8;
/// Most frames that are kept.
const MOST: usize = 64;

/// Reads frames of a recording until it is dropped.
pub(crate) struct FrameReader {
    shared: Arc<Shared>,
    recording: Arc<Recording>,
}

/// Values of a frame.
#[derive(Clone, Debug)]
pub(crate) enum FrameValues {
    /// Of all neurons that are shown, as fractions of the scale: for a picture that is drawn.
    Neurons(InstanceValues),
    /// Of what shows in a static picture, in the recording's unit.
    Visible(Vec<f32>),
}

/// Whose values are read.
#[derive(Clone, Debug)]
pub(crate) enum ValuesOf {
    /// Those of neurons.
    Neurons {
        /// By neuron: whether it is shown.
        shows: Arc<[bool]>,
        /// Numbers at both ends of the color map.
        range: [f32; 2],
    },
    /// Those that show in a static picture.
    Visible(Arc<VisibleValues>),
}

/// What values depend on besides the frame.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ValueInputs {
    pub(crate) of: ValuesOf,
    /// Decay of flashes (ms).
    pub(crate) decay: f64,
}

impl PartialEq for ValuesOf {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (
                Self::Neurons { shows, range },
                Self::Neurons {
                    shows: others,
                    range: other,
                },
            ) => (Arc::ptr_eq(shows, others) || shows == others) && range == other,
            (Self::Visible(visible), Self::Visible(other)) => Arc::ptr_eq(visible, other),
            _ => false,
        }
    }
}

impl ValueInputs {
    fn read(&self, recording: &Recording, frame: u64) -> Result<FrameValues, String> {
        let time = recording.time.time_of(frame);
        let values = match &self.of {
            ValuesOf::Neurons { shows, range } => {
                let shows = |place: usize| shows.get(place).copied().unwrap_or(true);
                let values = recording.at(time, self.decay, &shows);
                values.map(|values| FrameValues::Neurons(values.values(*range)))
            }
            ValuesOf::Visible(visible) => recording
                .visible_at(time, self.decay, visible)
                .map(FrameValues::Visible),
        };
        values.map_err(|e| e.to_string())
    }

    /// Instead of values that cannot be read: with these, neurons are gray.
    fn none(&self) -> FrameValues {
        match &self.of {
            ValuesOf::Neurons { shows, .. } => {
                let mut values = InstanceValues::default();
                shows.iter().for_each(|_| values.push(&[]));
                FrameValues::Neurons(values)
            }
            ValuesOf::Visible(visible) => FrameValues::Visible(vec![f32::NAN; visible.len()]),
        }
    }
}

#[derive(Default)]
struct Shared {
    inner: Mutex<Inner>,
    changed: Condvar,
}

#[derive(Default)]
struct Inner {
    inputs: Option<Arc<ValueInputs>>,
    frame: u64,
    /// Frames from one picture to the next; 0: a single frame is needed.
    stride: u64,
    ready: BTreeMap<u64, Arc<FrameValues>>,
    problem: Option<String>,
    ends: bool,
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, Inner> {
        self.inner.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl FrameReader {
    /// Starts the thread. `wake` is called when the requested frame has been read.
    pub(crate) fn new(recording: Arc<Recording>, wake: impl Fn() + Send + 'static) -> Self {
        let shared = Arc::new(Shared::default());
        let (own, of) = (Arc::clone(&shared), Arc::clone(&recording));
        spawn(move || read(&own, &of, &wake));
        Self { shared, recording }
    }

    /// The recording that it reads.
    pub(crate) fn recording(&self) -> &Arc<Recording> {
        &self.recording
    }

    /// The values of a frame if they have been read; if not they are read next. `stride`: frames
    /// from one picture to the next, by which later ones are read ahead; 0: none are.
    pub(crate) fn get(
        &self,
        frame: u64,
        stride: u64,
        inputs: &ValueInputs,
    ) -> Option<Arc<FrameValues>> {
        let mut inner = self.shared.lock();
        if inner.inputs.as_deref() != Some(inputs) {
            inner.inputs = Some(Arc::new(inputs.clone()));
            inner.ready.clear();
        }
        if (inner.frame, inner.stride) != (frame, stride) || !inner.ready.contains_key(&frame) {
            (inner.frame, inner.stride) = (frame, stride);
            self.shared.changed.notify_one();
        }
        inner.ready.get(&frame).cloned()
    }

    /// The error since the last call, if there was one.
    pub(crate) fn problem(&self) -> Option<String> {
        self.shared.lock().problem.take()
    }
}

impl Drop for FrameReader {
    fn drop(&mut self) {
        self.shared.lock().ends = true;
        self.shared.changed.notify_one();
    }
}

impl Inner {
    /// The frame to read next: the requested one, then those ahead.
    fn next(&self, frames: u64) -> Option<(u64, Arc<ValueInputs>)> {
        let inputs = self.inputs.as_ref()?;
        let ahead = if self.stride > 0 { AHEAD } else { 0 };
        let due = (0..=ahead).map(|i| {
            let frame = self.frame + i * self.stride;
            // Playback may start over at the end.
            if frame < frames {
                frame
            } else {
                (frame - frames) % frames.max(1)
            }
        });
        let mut missing = due.filter(|frame| !self.ready.contains_key(frame));
        Some((missing.next()?, Arc::clone(inputs)))
    }

    fn keep(&mut self, frame: u64, values: FrameValues, frames: u64) {
        self.ready.insert(frame, Arc::new(values));
        // Drops the frame that will not be needed for longest.
        let until = |&frame: &u64| (frame + frames - self.frame.min(frames)) % frames.max(1);
        if self.ready.len() > MOST
            && let Some(far) = self.ready.keys().copied().max_by_key(until)
        {
            self.ready.remove(&far);
        }
    }
}

fn read(shared: &Shared, recording: &Recording, wake: &impl Fn()) {
    let frames = recording.time.frames;
    loop {
        let mut inner = shared.lock();
        let (frame, inputs) = loop {
            if inner.ends {
                return;
            }
            if let Some(next) = inner.next(frames) {
                break next;
            }
            inner = match shared.changed.wait(inner) {
                Ok(inner) => inner,
                Err(poisoned) => poisoned.into_inner(),
            };
        };
        drop(inner);
        let (values, problem) = match caught(|| inputs.read(recording, frame)) {
            Ok(values) => (values, None),
            // Empty values are kept, so that the frame is not read again and again.
            Err(why) => (inputs.none(), Some(why)),
        };
        let mut inner = shared.lock();
        inner.problem = problem.or(inner.problem.take());
        if inner
            .inputs
            .as_ref()
            .is_some_and(|now| Arc::ptr_eq(now, &inputs))
        {
            inner.keep(frame, values, frames);
        }
        let due = inner.frame == frame;
        drop(inner);
        if due {
            wake();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn no_values() -> FrameValues {
        FrameValues::Visible(Vec::new())
    }

    fn inner(frame: u64, stride: u64, ready: &[u64]) -> Inner {
        let inputs = ValueInputs {
            of: ValuesOf::Neurons {
                shows: [true].into(),
                range: [0.0, 1.0],
            },
            decay: 5.0,
        };
        Inner {
            inputs: Some(Arc::new(inputs)),
            frame,
            stride,
            ready: ready.iter().map(|&f| (f, Arc::new(no_values()))).collect(),
            ..Inner::default()
        }
    }

    #[test]
    fn what_shows_is_read_first_and_then_what_will() {
        let next = |inner: Inner| inner.next(100).map(|(frame, _)| frame);
        assert_eq!(next(inner(5, 2, &[])), Some(5));
        assert_eq!(next(inner(5, 2, &[5, 7])), Some(9));
        assert_eq!(next(inner(97, 2, &[97, 99])), Some(1), "it begins again");
        assert_eq!(next(inner(5, 0, &[5])), None);
    }

    #[test]
    fn what_is_long_over_is_forgotten() {
        let mut inner = inner(50, 1, &[]);
        for frame in 0..=MOST as u64 + 20 {
            inner.keep(frame, no_values(), 100);
        }
        assert_eq!(inner.ready.len(), MOST);
        assert!(inner.ready.contains_key(&50) && !inner.ready.contains_key(&49));
    }
}
