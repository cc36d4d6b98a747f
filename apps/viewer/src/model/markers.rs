//! Synapses and points that were read, and what is known of each.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::DVec3;
use neurotess::circuit::{PointTable, SynapseSide};
use neurotess::coloring::{EdgeSynapses, MarkerRow, SynapseFacts};
use neurotess::render::BoundingSphere;

use crate::model::circuits::Circuits;
use crate::model::ids::CircuitId;
use crate::model::numbers::significant;
use crate::model::revision::Revision;

/// Which synapses are to be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct SynapseKey {
    /// Circuits of the cells in the list.
    pub(crate) circuits: Vec<CircuitId>,
    /// Names of populations of edges; none: all.
    pub(crate) edges: Vec<String>,
    pub(crate) side: SynapseSide,
    pub(crate) property: Option<String>,
}

/// What is to be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum MarkerSource {
    Synapses(SynapseKey),
    Points(PathBuf),
}

/// Synapses of a population of edges of a circuit.
#[derive(Clone, Debug)]
pub(crate) struct CircuitSynapses {
    pub(crate) circuit: CircuitId,
    pub(crate) edges: EdgeSynapses,
    /// Names of the numbers that the file has of each.
    pub(crate) properties: Vec<String>,
}

/// What was read.
#[derive(Clone, Debug)]
pub(crate) enum MarkerContent {
    Synapses(Vec<CircuitSynapses>),
    Points(PointTable),
}

/// A marker: a synapse or a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MarkerRef {
    /// A synapse, by the number of its population among those that were read, and its own in that.
    Synapse(MarkerRow),
    /// A point, by its number in the table.
    Point(u64),
}

/// What the window tells of a marker.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MarkerFacts {
    /// What it is.
    pub title: String,
    /// Names and values.
    pub rows: Vec<(String, String)>,
    /// The cell that a synapse lies on and the one at its other side, where they are in the list:
    /// indices of neurons.
    pub neurons: [Option<usize>; 2],
}

/// Something that was read from `of`, or why that failed.
type Read<K, T> = Option<(K, Result<Arc<T>, String>)>;

/// All synapses and points that were read.
#[derive(Clone, Debug, Default)]
pub struct MarkerData {
    synapses: Read<SynapseKey, Vec<CircuitSynapses>>,
    points: Read<PathBuf, PointTable>,
    sphere: Option<BoundingSphere>,
    revision: Revision,
}

impl MarkerData {
    /// The revision of what was read.
    pub(crate) fn revision(&self) -> Revision {
        self.revision
    }

    /// Whether this was read already, or could not be read.
    pub(crate) fn was_read(&self, source: &MarkerSource) -> bool {
        match source {
            MarkerSource::Synapses(key) => self.synapses.as_ref().is_some_and(|(of, _)| of == key),
            MarkerSource::Points(file) => self.points.as_ref().is_some_and(|(of, _)| of == file),
        }
    }

    /// Takes what was read.
    pub(crate) fn set(&mut self, source: MarkerSource, content: Result<MarkerContent, String>) {
        self.revision = Revision::next();
        match (source, content) {
            (MarkerSource::Synapses(key), Ok(MarkerContent::Synapses(read))) => {
                self.synapses = Some((key, Ok(Arc::new(read))));
            }
            (MarkerSource::Synapses(key), content) => {
                self.synapses = Some((key, Err(content.err().unwrap_or_default())));
            }
            (MarkerSource::Points(file), Ok(MarkerContent::Points(table))) => {
                self.sphere = sphere(&table.positions);
                self.points = Some((file, Ok(Arc::new(table))));
            }
            (MarkerSource::Points(file), content) => {
                self.sphere = None;
                self.points = Some((file, Err(content.err().unwrap_or_default())));
            }
        }
    }

    /// Forgets points, so that their file is read again.
    pub(crate) fn forget_points(&mut self) {
        (self.points, self.sphere) = (None, None);
        self.revision = Revision::next();
    }

    /// Forgets what could not be read, so that it is tried again.
    pub(crate) fn forget_failed_synapses(&mut self) {
        if matches!(self.synapses, Some((_, Err(_)))) {
            self.synapses = None;
        }
    }

    /// Synapses that were read.
    pub(crate) fn synapses(&self) -> Option<&Arc<Vec<CircuitSynapses>>> {
        self.synapses.as_ref()?.1.as_ref().ok()
    }

    /// The key of the synapses that were read.
    pub(crate) fn synapse_key(&self) -> Option<&SynapseKey> {
        Some(&self.synapses.as_ref()?.0)
    }

    /// Points that were read, with their file.
    pub(crate) fn points(&self) -> Option<(&Path, &Arc<PointTable>)> {
        let (file, read) = self.points.as_ref()?;
        Some((file, read.as_ref().ok()?))
    }

    /// A sphere (µm) around the points that were read.
    pub(crate) fn sphere(&self) -> Option<BoundingSphere> {
        self.sphere
    }

    /// Names of the numbers that colors of synapses can tell: those that all populations have.
    pub(crate) fn properties(&self) -> Vec<String> {
        let mut all = self.synapses().into_iter().flat_map(|read| read.iter());
        let mut names = all.next().map_or(Vec::new(), |one| one.properties.clone());
        for other in all {
            names.retain(|name| other.properties.contains(name));
        }
        names
    }

    /// Why synapses or points do not show.
    pub(crate) fn failures(&self) -> [Option<&str>; 2] {
        let synapses = self.synapses.as_ref().and_then(|(_, r)| r.as_ref().err());
        let points = self.points.as_ref().and_then(|(_, r)| r.as_ref().err());
        [synapses, points].map(|why| why.map(String::as_str))
    }

    /// What is known of a synapse, and of which side its place is. `circuits`: those that are open.
    pub(crate) fn synapse(
        &self,
        marker: MarkerRef,
        circuits: &Circuits,
    ) -> Option<(SynapseFacts, SynapseSide)> {
        let MarkerRef::Synapse(MarkerRow { table, row }) = marker else {
            return None;
        };
        let of = self.synapses()?.get(table as usize)?;
        let facts = of.edges.facts(row, circuits.get(of.circuit)?)?;
        Some((facts, self.synapse_key()?.side))
    }

    /// What is known of a marker. `neuron`: the index of a cell's neuron, by circuit, population and id.
    pub(crate) fn facts(
        &self,
        marker: MarkerRef,
        circuits: &Circuits,
        neuron: impl Fn(CircuitId, &str, u64) -> Option<usize>,
    ) -> Option<MarkerFacts> {
        match marker {
            MarkerRef::Synapse(MarkerRow { table, row }) => {
                let of = self.synapses()?.get(table as usize)?;
                let key = self.synapse_key()?;
                let facts = of.edges.facts(row, circuits.get(of.circuit)?)?;
                let EdgeSynapses {
                    name,
                    cells,
                    partners,
                    ..
                } = &of.edges;
                let [here, there] = match key.side {
                    SynapseSide::Afferent => ["on", "from"],
                    SynapseSide::Efferent => ["on", "to"],
                };
                let mut rows = vec![
                    ("edges".into(), name.clone()),
                    (here.into(), format!("{cells} {}", facts.cell)),
                    (there.into(), format!("{partners} {}", facts.partner)),
                ];
                if let Some((name, number)) = key.property.as_ref().zip(facts.number) {
                    rows.push((name.clone(), significant(number)));
                }
                rows.push(("place".into(), place(facts.position)));
                let ends = [(cells, facts.cell), (partners, facts.partner)];
                Some(MarkerFacts {
                    title: format!("Synapse {row}"),
                    rows,
                    neurons: ends.map(|(population, id)| neuron(of.circuit, population, id)),
                })
            }
            MarkerRef::Point(row) => {
                let (file, table) = self.points()?;
                let at = usize::try_from(row).ok()?;
                let position = table.positions.get(at)?;
                let mut rows = vec![
                    ("table".into(), file.display().to_string()),
                    ("place".into(), place(*position)),
                ];
                let numbers = table.columns.iter();
                let numbers = numbers.filter_map(|(name, values)| Some((name, values.get(at)?)));
                rows.extend(numbers.map(|(name, value)| (name.clone(), significant(*value))));
                Some(MarkerFacts {
                    title: format!("Point {}", row + 1),
                    rows,
                    neurons: [None; 2],
                })
            }
        }
    }
}

fn place(at: DVec3) -> String {
    format!("{:.2}, {:.2}, {:.2} µm", at.x, at.y, at.z)
}

fn sphere(positions: &[DVec3]) -> Option<BoundingSphere> {
    let all = || positions.iter().copied();
    let low = all().reduce(DVec3::min)?;
    let center = low.midpoint(all().reduce(DVec3::max)?);
    let reach = all().map(|position| position.distance(center));
    Some((center, reach.fold(0.0, f64::max)))
}
