//! Compartments whose values are plotted over time.

use glam::DVec3;
use neurotess::morphology::paths::Location;
use neurotess::morphology::{Morphology, SectionId, shape};
use neurotess::plot::COLORS;
use serde::{Deserialize, Serialize};

use super::Document;
use crate::model::index_set::IndexSet;

/// A place on a neuron; a report's compartment there is the nearest one of the section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TracePlace {
    /// Index among the neurons.
    pub neuron: usize,
    /// Index of the section on the tracing; none: the soma.
    pub section: Option<u32>,
    /// Share of the section's length, from 0 to 1; 0 at the soma.
    pub along: f32,
}

/// A compartment that is plotted.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "TraceEntry", into = "TraceEntry")]
pub struct Trace {
    /// Where it is.
    pub place: TracePlace,
    /// Color of its line (sRGB).
    pub color: [u8; 3],
}

/// A trace in a session's file.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct TraceEntry {
    neuron: usize,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    section: Option<u32>,
    #[serde(default, skip_serializing_if = "is_zero")]
    along: f32,
    color: [u8; 3],
}

fn is_zero(number: &f32) -> bool {
    *number == 0.0
}

impl From<TraceEntry> for Trace {
    fn from(entry: TraceEntry) -> Self {
        let TraceEntry {
            neuron,
            section,
            along,
            color,
        } = entry;
        let along = if along.is_finite() { along } else { 0.0 };
        Self {
            place: TracePlace {
                neuron,
                section,
                along: along.clamp(0.0, 1.0),
            },
            color,
        }
    }
}

impl From<Trace> for TraceEntry {
    fn from(trace: Trace) -> Self {
        let TracePlace {
            neuron,
            section,
            along,
        } = trace.place;
        Self {
            neuron,
            section,
            along,
            color: trace.color,
        }
    }
}

impl TracePlace {
    /// The place of a location of a neuron's tracing.
    ///
    /// # Panics
    /// If the location is not on the tracing.
    pub fn of(neuron: usize, location: Location, morphology: &Morphology) -> Self {
        let soma = Self {
            neuron,
            section: None,
            along: 0.0,
        };
        let (Some(section), Location::Neurite { point, fraction }) =
            (location.section(morphology), location)
        else {
            return soma;
        };
        let (mut length, mut before) = (0.0, 0.0);
        for (end, link) in links(morphology, section) {
            if end < point {
                before += link;
            } else if end == point {
                before += fraction.clamp(0.0, 1.0) * link;
            }
            length += link;
        }
        let along = if length > 0.0 { before / length } else { 0.5 };
        Self {
            section: Some(section.0),
            along: along as f32,
            ..soma
        }
    }

    /// Its location on the neuron's tracing, at a share of the section's length; none if there is no such section or soma.
    pub fn location(section: Option<u32>, along: f32, morphology: &Morphology) -> Option<Location> {
        let Some(section) = section else {
            let soma = (!morphology.somata.is_empty()).then_some(Location::Soma(0));
            return soma.or_else(|| (!morphology.points.is_empty()).then(|| Location::of_point(0)));
        };
        let range = morphology.sections.get(section as usize)?.range();
        let section = SectionId(section);
        let length: f64 = links(morphology, section).map(|(_, link)| link).sum();
        let mut left = f64::from(along).clamp(0.0, 1.0) * length;
        for (point, link) in links(morphology, section) {
            if left <= link && link > 0.0 {
                let fraction = left / link;
                return Some(Location::Neurite { point, fraction });
            }
            left -= link;
        }
        Some(Location::of_point(range.end.checked_sub(1)? as u32))
    }
}

/// Of each link of a section: the point that it leads to, and its length (µm).
fn links(morphology: &Morphology, section: SectionId) -> impl Iterator<Item = (u32, f64)> {
    let range = morphology.sections[section.index()].range();
    let at = |p: &neurotess::morphology::Point| -> DVec3 { p.position.as_dvec3() };
    let links = shape::links(morphology, section);
    let lengths: Vec<f64> = links.map(|(a, b)| at(a).distance(at(b))).collect();
    // A neurite's first section has a link less than points.
    let first = range.end - lengths.len();
    (first as u32..).zip(lengths)
}

impl Trace {
    /// The same trace where neurons have other numbers; none if its neuron has none.
    pub(crate) fn renumbered(self, number: impl Fn(usize) -> Option<usize>) -> Option<Self> {
        let place = TracePlace {
            neuron: number(self.place.neuron)?,
            ..self.place
        };
        Some(Self { place, ..self })
    }
}

impl Document {
    /// Plots a place and selects its neuron: alone, or with `add` beside the others. With `add`, a place that is plotted
    /// already is taken away.
    pub(crate) fn plot(&mut self, place: TracePlace, add: bool) {
        if place.neuron >= self.neurons.len() {
            return;
        }
        let mut selected = IndexSet::from_iter([place.neuron]);
        if add {
            selected = selected.with(self.neurons.selected());
        }
        let selected = selected.without(self.neurons.hidden());
        self.neurons.select(selected);
        let there = self.traces.iter().position(|trace| trace.place == place);
        match (there, add) {
            (Some(there), true) => {
                self.traces.remove(there);
            }
            (Some(_), false) if self.traces.len() == 1 => {}
            (_, false) => *self.traces = vec![self.trace(place, &[])],
            (None, true) => {
                let trace = self.trace(place, &self.traces);
                self.traces.push(trace);
            }
        }
    }

    /// A trace with the first color that none of the others has, or else the one that is in use least.
    fn trace(&self, place: TracePlace, others: &[Trace]) -> Trace {
        let used = |color: &[u8; 3]| others.iter().filter(|t| t.color == *color).count();
        let least = COLORS.into_iter().min_by_key(used);
        Trace {
            place,
            color: least.unwrap_or_default(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::document::{Neuron, SourceId};

    fn at(neuron: usize, along: f32) -> TracePlace {
        TracePlace {
            neuron,
            section: Some(3),
            along,
        }
    }

    #[test]
    fn places_along_a_section_are_locations_of_its_links() {
        use neurotess::morphology::{NeuriteKind, Node};
        let row = |id: i64, x: f64, y: f64, parent| Node {
            id,
            kind: NeuriteKind::AXON,
            position: DVec3::new(x, y, 0.0),
            radius: 1.0,
            parent,
            section: None,
        };
        let nodes = [
            row(1, 0.0, 0.0, None),
            row(2, 10.0, 0.0, Some(0)),
            row(3, 30.0, 0.0, Some(1)),
            row(4, 10.0, 40.0, Some(1)),
            row(5, 10.0, 50.0, Some(3)),
        ];
        let built = Morphology::from_nodes("cell", Vec::new(), &nodes);
        let cell = built.expect("built").morphology;
        for (section, along, x, y) in [
            (0, 0.25, 2.5, 0.0),
            (1, 1.0, 30.0, 0.0),
            (2, 0.4, 10.0, 20.0),
            (2, 0.9, 10.0, 45.0),
        ] {
            let location = TracePlace::location(Some(section), along, &cell);
            let location = location.expect("there");
            let at = location.position(&cell);
            assert!(at.distance(DVec3::new(x, y, 0.0)) < 1e-5, "{at}");
            let back = TracePlace::of(7, location, &cell);
            assert_eq!((back.neuron, back.section), (7, Some(section)));
            assert!((back.along - along).abs() < 1e-6, "{back:?}");
        }
        assert_eq!(TracePlace::location(Some(9), 0.5, &cell), None);
        // Without a soma, its place is where the first neurite begins.
        let start = TracePlace::location(None, 0.0, &cell);
        assert_eq!(start, Some(Location::of_point(0)));
    }

    #[test]
    fn traces_are_alone_or_beside_others_in_other_colors() {
        let neuron = |i| Neuron::new(SourceId(i), String::new());
        let mut document = Document {
            neurons: (0..3).map(neuron).collect(),
            ..Document::default()
        };
        for (place, add, count, selected) in [
            (at(0, 0.5), false, 1, vec![0]),
            (at(2, 0.5), true, 2, vec![0, 2]),
            (at(2, 0.7), true, 3, vec![0, 2]),
            (at(2, 0.5), true, 2, vec![0, 2]),
            (at(9, 0.5), true, 2, vec![0, 2]),
        ] {
            document.plot(place, add);
            let now: Vec<usize> = document.selected().collect();
            assert_eq!((document.traces.len(), now), (count, selected));
        }
        let colors: Vec<_> = document.traces.iter().map(|trace| trace.color).collect();
        assert_eq!(colors, [COLORS[0], COLORS[2]]);
        document.plot(at(1, 0.5), true);
        assert_eq!(document.traces[2].color, COLORS[1], "it is free again");
        // A neuron that is removed takes its traces with it.
        document.neurons.select(IndexSet::from_iter([0]));
        document.remove_selected();
        let left: Vec<usize> = document.traces.iter().map(|t| t.place.neuron).collect();
        assert_eq!(left, [1, 0]);
        document.plot(at(1, 0.5), false);
        assert_eq!(document.traces.len(), 1);
    }

    #[test]
    fn files_leave_out_what_is_usual() {
        let soma = Trace {
            place: TracePlace {
                neuron: 1,
                section: None,
                along: 0.0,
            },
            color: [1, 2, 3],
        };
        let text = toml::to_string(&soma).expect("written");
        assert!(
            !text.contains("section") && !text.contains("along"),
            "{text}"
        );
        assert_eq!(toml::from_str::<Trace>(&text).expect("read"), soma);
        assert!(toml::from_str::<Trace>(&format!("title = 3\n{text}")).is_err());
    }
}
