//! Tracings that are open: read, meshed, measured. They stay while an undo could want them.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::SystemTime;

use glam::DVec3;
use neurotess::generate::Generated;
use neurotess::mesh::CoarseMesh;
use neurotess::morphology::{Measures, Morphology};
use neurotess::render::BoundingSphere;
use neurotess::render::bounds::{bounds, merged};
use neurotess::synth::Kind;

use crate::model::document::SomaEdit;
use crate::model::ids::SourceId;
use crate::model::revision::Revision;

/// Balls of a neuron in scenes of many: 1,000 neurons of 1,000 balls would take every frame 10 ms.
const FEW_SPHERES: usize = 48;

/// Before the name of a built-in sample.
pub(crate) const SAMPLE: &str = "sample:";

/// An open tracing.
#[derive(Clone, Debug)]
pub struct Source {
    /// Its file, or `sample:KIND`.
    pub file: PathBuf,
    /// Name for people.
    pub name: String,
    /// The tracing.
    pub morphology: Arc<Morphology>,
    /// Its coarse mesh with the soma's figures.
    pub generated: Arc<Generated>,
    /// What the mesh was made with.
    pub soma: SomaEdit,
    /// Morphometrics.
    pub measures: Arc<Measures>,
    /// What was odd in the file, and what was mended in the mesh.
    pub warnings: Vec<Remark>,
    /// When the file was written last; none: a sample.
    pub written: Option<SystemTime>,
    /// Bounding spheres around the mesh (µm).
    pub spheres: Vec<BoundingSphere>,
    /// A few that hold them, for scenes of many neurons.
    pub few_spheres: Vec<BoundingSphere>,
    /// Its file has changed since, or is gone.
    pub stale: Option<Stale>,
    /// By section: length (µm) and branch order.
    pub sections: Arc<Vec<SectionFacts>>,
}

/// Something that was odd or was mended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Remark {
    /// For people, with its line if it has one.
    pub text: String,
    /// Whether somebody should look into it: something is missing or was guessed.
    pub concerns: bool,
}

impl Remark {
    pub(crate) fn new(code: &str, text: String) -> Self {
        let concerns = CONCERNS.contains(&code);
        Self { text, concerns }
    }
}

/// Names of what somebody should look into. What else readers and the generator tell of is the daily work of
/// making a mesh: points closer together than they are thick, say, of which nearly every tracing has some.
const CONCERNS: [&str; 18] = [
    "disconnected",
    "far_from_soma",
    "negative_radius",
    "no_seat",
    "one_point_tree",
    "other_cells_left_out",
    "radius_mended",
    "ring_unused",
    "rings_cross",
    "several_somata",
    "soma_folded",
    "soma_inside_neurite",
    "soma_of_one_point",
    "soma_radius_mended",
    "soma_zero_radius",
    "unknown_expression",
    "untyped_tree",
    "zero_radius",
];

/// What a file has become.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stale {
    /// Something else is in it.
    Changed,
    /// It is gone.
    Gone,
}

/// Figures of a section.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SectionFacts {
    /// Length (µm).
    pub length: f64,
    /// Forks between the neurite's start and it.
    pub order: u32,
    /// Distance along the path (µm) from the neurite's start to its end.
    pub path: f64,
    /// Number of the neurite, from 0.
    pub neurite: u32,
}

/// All tracings that are open or were.
#[derive(Clone, Debug, Default)]
pub struct Sources {
    list: Vec<Source>,
    stale: usize,
    geometry: Revision,
}

/// All balls around a mesh, and a few that hold them.
pub(crate) fn spheres(mesh: &CoarseMesh) -> (Vec<BoundingSphere>, Vec<BoundingSphere>) {
    let all = bounds(mesh);
    let few = merged(&all, FEW_SPHERES);
    (all, few)
}

impl Sources {
    /// Adds a tracing.
    pub fn add(&mut self, source: Source) -> SourceId {
        self.list.push(source);
        self.geometry = Revision::next();
        SourceId(self.list.len() as u32 - 1)
    }

    /// A tracing.
    pub fn get(&self, id: SourceId) -> Option<&Source> {
        self.list.get(id.0 as usize)
    }

    /// All with their numbers.
    pub fn iter(&self) -> impl Iterator<Item = (SourceId, &Source)> {
        (0..).map(SourceId).zip(&self.list)
    }

    /// The stamp of tracings and meshes.
    pub fn geometry(&self) -> Revision {
        self.geometry
    }

    /// Number of tracings whose files changed or are gone.
    pub fn stale(&self) -> usize {
        self.stale
    }

    /// Puts a tracing that was read again in place of what was read before.
    pub(crate) fn replace(&mut self, id: SourceId, source: Source) {
        if let Some(there) = self.list.get_mut(id.0 as usize) {
            *there = source;
            self.geometry = Revision::next();
            self.count_stale();
        }
    }

    /// Another soma for a tracing; `generated`: the mesh with it, unless it leaves nothing to draw.
    pub(crate) fn set_soma(&mut self, id: SourceId, edit: SomaEdit, generated: Option<Generated>) {
        let Some(source) = self.list.get_mut(id.0 as usize) else {
            return;
        };
        source.soma = edit;
        if let Some(generated) = generated {
            (source.spheres, source.few_spheres) = spheres(&generated.mesh);
            source.generated = Arc::new(generated);
        }
        self.geometry = Revision::next();
    }

    /// What has become of a tracing's file.
    pub(crate) fn set_stale(&mut self, id: SourceId, stale: Option<Stale>) {
        if let Some(source) = self.list.get_mut(id.0 as usize) {
            source.stale = stale;
            self.count_stale();
        }
    }

    fn count_stale(&mut self) {
        self.stale = self.list.iter().filter(|s| s.stale.is_some()).count();
    }
}

/// Path of a built-in sample.
pub fn sample(kind: Kind) -> PathBuf {
    PathBuf::from(format!("{SAMPLE}{kind}"))
}

/// Corners of the box (µm) around balls.
pub fn extent(spheres: &[BoundingSphere]) -> (DVec3, DVec3) {
    let corners = spheres.iter().map(|&(c, r)| (c - r, c + r));
    corners
        .reduce(|(low, high), (a, b)| (low.min(a), high.max(b)))
        .unwrap_or_default()
}
