//! Tracings that were opened: read, meshed, measured. They are kept, since an undo may bring them
//! back.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::SystemTime;

use glam::DVec3;
use neurotess::generate::Generated;
use neurotess::mesh::{CoarseMesh, Role};
use neurotess::morphology::edit::SPINE;
use neurotess::morphology::{Measures, Morphology};
use neurotess::render::bounds::{bounds, merged};
use neurotess::render::{BoundingSphere, Proxy};
use neurotess::synth::Kind;

use crate::model::document::{SomaEdit, SpineEdit};
use crate::model::ids::SourceId;
use crate::model::revision::Revision;

/// Most bounding spheres of a neuron in scenes with many: 1,000 neurons with 1,000 spheres each
/// would take 10 ms in every frame.
const FEW_SPHERES: usize = 48;

/// Prefix of the path of a built-in sample.
pub(crate) const SAMPLE: &str = "sample:";

/// An open tracing.
#[derive(Clone, Debug)]
pub struct Source {
    /// Its file, or `sample:KIND`.
    pub file: PathBuf,
    /// Name in the window.
    pub name: String,
    /// The tracing as it was read.
    pub traced: Arc<Morphology>,
    /// The tracing with its spines.
    pub morphology: Arc<Morphology>,
    /// The spines that it has.
    pub spines: Option<SpineEdit>,
    /// Its coarse mesh with the soma's figures.
    pub generated: Arc<Generated>,
    /// What exploration draws of the mesh, if it came with the mesh; all its color keys are 0.
    pub proxy: Option<Arc<Proxy>>,
    /// How the soma of the mesh was generated.
    pub soma: SomaEdit,
    /// Morphometrics.
    pub measures: Arc<Measures>,
    /// Warnings about the file, and about repairs of the mesh.
    pub warnings: Vec<Remark>,
    /// When the file was last written; none for samples.
    pub written: Option<SystemTime>,
    /// Bounding spheres of the mesh (µm).
    pub spheres: Vec<BoundingSphere>,
    /// A few spheres that hold them, for scenes of many neurons.
    pub few_spheres: Vec<BoundingSphere>,
    /// Radius (µm) of the thickest point of its neurites.
    pub thickest: f64,
    /// Whether its file was changed or removed since.
    pub stale: Option<Stale>,
    /// By section: length (µm) and branch order.
    pub sections: Arc<Vec<SectionFacts>>,
}

/// A warning.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Remark {
    /// Its text, with the line of the file if there is one.
    pub text: String,
    /// Whether the user should look into it: something is missing or was guessed.
    pub concerns: bool,
}

impl Remark {
    pub(crate) fn new(code: &str, text: String) -> Self {
        let concerns = CONCERNS.contains(&code);
        Self { text, concerns }
    }
}

/// Codes of warnings that the user should look into. Others are about usual repairs: nearly every
/// tracing has points that are closer together than they are thick, for example.
const CONCERNS: [&str; 21] = [
    "disconnected",
    "far_from_soma",
    "negative_radius",
    "no_seat",
    "one_point_tree",
    "other_cells_left_out",
    "radius_mended",
    "radius_unknown",
    "ring_unused",
    "rings_cross",
    "simplified",
    "several_somata",
    "soma_folded",
    "soma_inside_neurite",
    "soma_of_one_point",
    "soma_radius_mended",
    "soma_zero_radius",
    "unit_not_applied",
    "unknown_expression",
    "untyped_tree",
    "zero_radius",
];

/// What happened to a file after it was read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stale {
    /// It was changed.
    Changed,
    /// It was removed.
    Gone,
}

/// Figures of a section.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SectionFacts {
    /// Length (µm).
    pub length: f64,
    /// Number of forks between the neurite's start and the section.
    pub order: u32,
    /// Path distance (µm) from the neurite's start to the section's end.
    pub path: f64,
    /// Number of the neurite, from 0.
    pub neurite: u32,
}

impl Source {
    /// Number of spines that have grown on it.
    pub fn spine_count(&self) -> usize {
        let count = |morphology: &Morphology| {
            let sections = morphology.sections.iter();
            sections.filter(|section| section.kind == SPINE).count()
        };
        count(&self.morphology).saturating_sub(count(&self.traced))
    }
}

/// A tracing that was meshed again.
#[derive(Debug)]
pub(crate) struct Meshed {
    pub(crate) generated: Generated,
    /// The tracing, if its spines are others now.
    pub(crate) grown: Option<Grown>,
}

/// A tracing with its spines, or without.
#[derive(Debug)]
pub(crate) struct Grown {
    pub(crate) morphology: Arc<Morphology>,
    pub(crate) measures: Measures,
    pub(crate) sections: Vec<SectionFacts>,
    /// How many spines there was no room for.
    pub(crate) left: usize,
}

/// All tracings that were opened.
#[derive(Clone, Debug, Default)]
pub struct Sources {
    list: Vec<Source>,
    stale: usize,
    geometry: Revision,
}

/// Radius (µm) of the thickest point of a mesh's neurites.
pub(crate) fn thickest(mesh: &CoarseMesh) -> f64 {
    let neurites = mesh.tracing.iter().filter(|p| p.role != Role::Soma);
    neurites.map(|p| f64::from(p.radius)).fold(0.0, f64::max)
}

/// The bounding spheres of a mesh, and a few spheres that hold them.
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

    /// All tracings with their ids.
    pub fn iter(&self) -> impl Iterator<Item = (SourceId, &Source)> {
        (0..).map(SourceId).zip(&self.list)
    }

    /// The revision of tracings and meshes.
    pub fn geometry(&self) -> Revision {
        self.geometry
    }

    /// Number of tracings whose files were changed or removed.
    pub fn stale(&self) -> usize {
        self.stale
    }

    /// Replaces a tracing that was read again.
    pub(crate) fn replace(&mut self, id: SourceId, source: Source) {
        if let Some(there) = self.list.get_mut(id.0 as usize) {
            *there = source;
            self.geometry = Revision::next();
            self.count_stale();
        }
    }

    /// Sets how a tracing is meshed; `meshed`: its mesh, unless nothing is left to draw.
    pub(crate) fn set_meshed(
        &mut self,
        id: SourceId,
        (soma, spines): (SomaEdit, Option<SpineEdit>),
        meshed: Option<Meshed>,
    ) {
        let Some(source) = self.list.get_mut(id.0 as usize) else {
            return;
        };
        (source.soma, source.spines) = (soma, spines);
        if let Some(meshed) = meshed {
            let generated = meshed.generated;
            (source.spheres, source.few_spheres) = spheres(&generated.mesh);
            source.thickest = thickest(&generated.mesh);
            source.generated = Arc::new(generated);
            source.proxy = None;
            if let Some(grown) = meshed.grown {
                source.morphology = grown.morphology;
                source.measures = Arc::new(grown.measures);
                source.sections = Arc::new(grown.sections);
            }
        }
        self.geometry = Revision::next();
    }

    /// Notes whether a tracing's file was changed or removed.
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

/// Corners of the bounding box (µm) of spheres.
pub fn extent(spheres: &[BoundingSphere]) -> (DVec3, DVec3) {
    let corners = spheres.iter().map(|&(c, r)| (c - r, c + r));
    corners
        .reduce(|(low, high), (a, b)| (low.min(a), high.max(b)))
        .unwrap_or_default()
}
