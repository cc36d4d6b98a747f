//! Dimensions: what was measured and is kept on the picture.

use glam::DVec3;
use neurotess::morphology::Morphology;
use neurotess::morphology::paths::Location;
use serde::{Deserialize, Serialize};

/// How far (µm) a tracing's location may be from where it was when the dimension was made: files
/// have positions as `f32`.
const SAME: f64 = 1e-2;

/// What is measured.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase", deny_unknown_fields)]
pub enum Dimension {
    /// The distance of two locations, and the length of the path between them.
    Distance {
        /// One end.
        from: Anchor,
        /// The other end.
        to: Anchor,
    },
    /// The diameter of the neurite, or of the soma.
    Diameter {
        /// Where.
        at: Anchor,
    },
    /// The angles between the branches of a fork.
    Angle {
        /// The fork.
        at: Anchor,
    },
}

impl Dimension {
    /// The locations that it refers to.
    pub fn anchors(&self) -> impl Iterator<Item = Anchor> {
        let (first, second) = match *self {
            Self::Distance { from, to } => (from, Some(to)),
            Self::Diameter { at } | Self::Angle { at } => (at, None),
        };
        std::iter::once(first).chain(second)
    }

    /// The same dimension where neurons have other numbers; none if one of its neurons has none.
    pub(crate) fn renumbered(self, number: impl Fn(usize) -> Option<usize>) -> Option<Self> {
        let moved = |anchor: Anchor| {
            let neuron = number(anchor.neuron)?;
            Some(Anchor { neuron, ..anchor })
        };
        Some(match self {
            Self::Distance { from, to } => Self::Distance {
                from: moved(from)?,
                to: moved(to)?,
            },
            Self::Diameter { at } => Self::Diameter { at: moved(at)? },
            Self::Angle { at } => Self::Angle { at: moved(at)? },
        })
    }
}

/// A location on the tracing of a neuron, and where that was when it was clicked.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "AnchorEntry", into = "AnchorEntry")]
pub struct Anchor {
    /// Index among the neurons.
    pub neuron: usize,
    /// The location on its tracing.
    pub location: Location,
    /// Its position (µm) in the coordinates of the tracing's file.
    pub position: DVec3,
}

impl Anchor {
    /// A location on the tracing of a neuron; none if it is not on it.
    pub fn new(neuron: usize, location: Location, morphology: &Morphology) -> Option<Self> {
        location.is_on(morphology).then(|| Self {
            neuron,
            location,
            position: location.position(morphology),
        })
    }

    /// Whether the tracing still has this location at this position.
    pub fn is_on(&self, morphology: &Morphology) -> bool {
        let apart = || self.location.position(morphology).distance(self.position);
        self.location.is_on(morphology) && apart() <= SAME
    }
}

/// An anchor in a session's file.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct AnchorEntry {
    neuron: usize,
    /// Index of a point, from 0, depth-first; none: the center of a soma.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    point: Option<u32>,
    /// Share of the link that leads to the point.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    fraction: Option<f64>,
    /// Index of the soma; none: the main one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    soma: Option<u32>,
    position: [f64; 3],
}

impl From<AnchorEntry> for Anchor {
    fn from(entry: AnchorEntry) -> Self {
        let location = match entry.point {
            Some(point) => Location::Neurite {
                point,
                fraction: entry.fraction.unwrap_or(1.0),
            },
            None => Location::Soma(entry.soma.unwrap_or(0)),
        };
        Self {
            neuron: entry.neuron,
            location,
            position: DVec3::from_array(entry.position),
        }
    }
}

impl From<Anchor> for AnchorEntry {
    fn from(anchor: Anchor) -> Self {
        let (point, fraction, soma) = match anchor.location {
            Location::Soma(soma) => (None, None, (soma > 0).then_some(soma)),
            Location::Neurite { point, fraction } => {
                (Some(point), (fraction != 1.0).then_some(fraction), None)
            }
        };
        Self {
            neuron: anchor.neuron,
            point,
            fraction,
            soma,
            position: anchor.position.to_array(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dimensions_go_with_their_neurons() {
        let anchor = |neuron| Anchor {
            neuron,
            location: Location::of_point(3),
            position: DVec3::ONE,
        };
        let distance = Dimension::Distance {
            from: anchor(0),
            to: anchor(2),
        };
        let without_1 = |n: usize| [Some(0), None, Some(1)][n];
        let moved = distance.renumbered(without_1).expect("both are there");
        let neurons: Vec<usize> = moved.anchors().map(|a| a.neuron).collect();
        assert_eq!(neurons, [0, 1]);
        let diameter = Dimension::Diameter { at: anchor(1) };
        assert_eq!(diameter.renumbered(without_1), None);
    }

    #[test]
    fn files_leave_out_what_is_usual() {
        let at = Anchor {
            neuron: 1,
            location: Location::Soma(0),
            position: DVec3::new(1.0, 2.0, 3.0),
        };
        let text = toml::to_string(&Dimension::Diameter { at }).expect("written");
        assert!(!text.contains("point") && !text.contains("soma"), "{text}");
        let back: Dimension = toml::from_str(&text).expect("read");
        assert_eq!(back, Dimension::Diameter { at });
        assert!(toml::from_str::<Dimension>(&format!("color = 3\n{text}")).is_err());
    }
}
