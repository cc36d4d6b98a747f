//! Values of what shows in a static picture, and of nothing else.

use std::collections::HashMap;
use std::ops::Range;

use itertools::Itertools;
use neurotess_picture::color::CATEGORY_BIT;
use neurotess_picture::recolor::VisibleKey;

use crate::recording::{Recording, RecordingError, Source};

/// Where a recording holds the values of the color keys that show in a picture.
#[derive(Clone, Debug, Default)]
pub struct VisibleValues {
    keys: Vec<VisibleKey>,
    parts: Vec<VisibleCompartments>,
}

/// Of a report's population: compartments that show, and which of the keys each is for.
#[derive(Clone, Debug, Default)]
struct VisibleCompartments {
    compartments: Vec<u64>,
    keys: Vec<usize>,
}

impl VisibleValues {
    /// Number of color keys.
    pub fn len(&self) -> usize {
        self.keys.len()
    }

    /// Whether nothing shows.
    pub fn is_empty(&self) -> bool {
        self.keys.is_empty()
    }

    /// Number of compartments that are read from a file for a time; 0 for spikes, which have none.
    pub fn compartments(&self) -> usize {
        self.parts.iter().map(|part| part.compartments.len()).sum()
    }
}

/// Values as fractions of a range, as [`KeyColors::values`](neurotess_picture::recolor::KeyColors::values) has
/// them.
pub fn fractions(values: &[f32], [low, high]: [f32; 2]) -> Vec<f32> {
    let fraction = |value: &f32| (value - low) / (high - low);
    values.iter().map(fraction).collect()
}

impl Recording {
    /// Finds the values of color keys, as [`Recording::color_keys`] gives them to cells.
    pub fn visible(&self, keys: &[VisibleKey]) -> VisibleValues {
        let parts = match &self.source {
            Source::Spikes(..) | Source::Memory(_) => Vec::new(),
            Source::Report(_, parts) => parts
                .iter()
                .map(|part| {
                    let spans: HashMap<usize, Range<usize>> = part.spans.iter().cloned().collect();
                    let mut found = VisibleCompartments::default();
                    for (place, key) in keys.iter().enumerate() {
                        let span = spans.get(&(key.instance as usize)).cloned();
                        let own = span.and_then(|span| part.compartments.get(span));
                        let Some(&compartment) =
                            own.and_then(|own| own.get(key.color_key as usize))
                        else {
                            continue;
                        };
                        found.compartments.push(compartment);
                        found.keys.push(place);
                    }
                    found
                })
                .collect(),
        };
        VisibleValues {
            keys: keys.to_vec(),
            parts,
        }
    }

    /// Values at a time (ms), one for each key; NaN where there is none. Reads what holds them: the
    /// time that it takes goes by what shows, not by the neurons of the recording. `decay`: as in
    /// [`Recording::at`].
    ///
    /// # Errors
    /// The recording has no values at that time, or the file is invalid.
    pub fn visible_at(
        &self,
        time: f64,
        decay: f64,
        visible: &VisibleValues,
    ) -> Result<Vec<f32>, RecordingError> {
        let mut values = vec![f32::NAN; visible.keys.len()];
        match &self.source {
            Source::Report(report, _) => {
                let mut any = false;
                for (population, part) in report.populations.iter().zip_eq(&visible.parts) {
                    let Some(frame) = population.time.frame_at(time) else {
                        continue;
                    };
                    any = true;
                    let read = population.values(frame, &part.compartments)?;
                    for (&key, value) in part.keys.iter().zip_eq(read) {
                        values[key] = value;
                    }
                }
                if !any {
                    return Err(self.no_values(time));
                }
            }
            Source::Memory(memory) => {
                if self.time.frame_at(time).is_none() {
                    return Err(self.no_values(time));
                }
                for (value, key) in values.iter_mut().zip_eq(&visible.keys) {
                    let own = memory.at(time, key.instance as usize).unwrap_or_default();
                    *value = own.get(key.color_key as usize).copied().unwrap_or(f32::NAN);
                }
            }
            Source::Spikes(spikes, firing) => {
                let mut flashes: HashMap<usize, f32> = HashMap::new();
                for (population, instances) in spikes.populations.iter().zip_eq(firing) {
                    for (id, flash) in population.flashes(time, decay) {
                        let shown = instances.get(&id).into_iter().flatten();
                        flashes.extend(shown.map(|&instance| (instance, flash)));
                    }
                }
                for (value, key) in values.iter_mut().zip_eq(&visible.keys) {
                    let instance = key.instance as usize;
                    if key.color_key & CATEGORY_BIT == 0 && self.has_values[instance] {
                        *value = flashes.get(&instance).copied().unwrap_or(0.0);
                    }
                }
            }
        }
        Ok(values)
    }
}
