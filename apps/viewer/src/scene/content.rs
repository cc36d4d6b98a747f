//! The scene on the device: templates, instances, colors.

use std::sync::Arc;

use glam::DVec3;
use itertools::Itertools;
use neurotess::coloring::{ClosestColors, Coloring, Recording, closest};
use neurotess::mesh::CoarseMesh;
use neurotess::render::bounds::{bounds, merged};
use neurotess::render::color::{ColorTable, Rgb};
use neurotess::render::overlay::Legend;
use neurotess::render::state::{GHOSTED, HIGHLIGHTED, WITHOUT_NEURITES, WITHOUT_SOMA};
use neurotess::render::{
    Adaptive, AdaptiveSettings, BoundingSphere, Clip, DeviceError, Gpu, Instance, Placement, Scene,
    SceneError, Template, TemplateId, Templates,
};
use rayon::prelude::*;
use thiserror::Error;

use crate::model::document::{Document, Look, VisibleParts};
use crate::model::revision::Revision;
use crate::model::sources::extent;
use crate::model::state::{PlacementsKey, State};
use crate::scene::colors::ColorResult;
use crate::scene::templates::SceneTemplate;

/// Width (pixels) of a wireframe's lines.
const WIRE: f32 = 1.0;
/// Color of selected neurons.
pub(crate) const SELECTION: Rgb = [255, 140, 0];

/// Why there is no scene.
#[derive(Clone, Debug, Error, PartialEq)]
pub(crate) enum BuildError {
    #[error(transparent)]
    Device(#[from] DeviceError),
    #[error(transparent)]
    Scene(#[from] SceneError),
}

/// Templates, instances and colors of a scene.
#[derive(Clone, Debug)]
pub(crate) struct SceneContent {
    /// Revision of meshes and color keys, which are uploaded as templates.
    pub(crate) revision: Revision,
    pub(crate) sources: Vec<SceneTemplate>,
    pub(crate) instances: Vec<SceneInstance>,
    /// Color keys, which are on the device, and the things that have colors.
    pub(crate) coloring: Arc<Coloring>,
    /// The current colors of the keys.
    pub(crate) table: ColorTable,
    pub(crate) legend: Legend,
    /// Number of categories that the cells' color keys have.
    pub(crate) categories: usize,
    /// The colors of the legend that are closest to one another.
    pub(crate) closest: Option<ClosestColors>,
    /// A recording, with the range of all its values.
    pub(crate) recording: Option<(Arc<Recording>, [f32; 2])>,
}

impl SceneContent {
    pub(crate) fn new(
        sources: Vec<SceneTemplate>,
        instances: Vec<SceneInstance>,
        colored: ColorResult,
    ) -> Self {
        let ColorResult {
            coloring,
            recording,
            ..
        } = colored;
        Self {
            revision: Revision::next(),
            sources,
            instances,
            table: coloring.table.clone(),
            legend: coloring.legend.clone(),
            categories: coloring.categories(),
            closest: closest(coloring.legend.entries()),
            coloring: Arc::new(coloring),
            recording,
        }
    }
}

impl SceneContent {
    /// Coarse patches of all instances that show.
    pub(crate) fn patches(&self) -> u64 {
        let shown = self.instances.iter().filter(|instance| !instance.hidden);
        let patches = shown.filter_map(|shown| {
            let source = self.sources.get(shown.source)?;
            Some(source.generated.mesh.patches.len() as u64)
        });
        patches.sum()
    }

    /// Takes the colors of other content that has the same meshes and color keys.
    pub(crate) fn recolor(&mut self, other: Self) {
        (self.table, self.legend) = (other.table, other.legend);
        self.categories = other.categories;
        (self.coloring, self.closest) = (other.coloring, other.closest);
        self.recording = other.recording;
    }
}

/// What the instances on the device depend on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct InstancesKey {
    placements: PlacementsKey,
    hidden: Revision,
    content: Revision,
}

impl InstancesKey {
    /// The key of the current instances. `content`: revision of the templates.
    pub(crate) fn new(state: &State, content: Revision) -> Self {
        Self {
            placements: state.placements_key(),
            hidden: state.document.neurons.revisions().hidden,
            content,
        }
    }

    /// The key of the same instances with other templates.
    pub(crate) fn of_content(self, content: Revision) -> Self {
        Self { content, ..self }
    }
}

/// What the states of instances depend on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StatesKey {
    members: Revision,
    selection: Revision,
    parts: VisibleParts,
    highlights: bool,
    ghosts: bool,
}

impl StatesKey {
    pub(crate) fn new(document: &Document) -> Self {
        let revisions = document.neurons.revisions();
        Self {
            members: revisions.members,
            selection: revisions.selection,
            parts: document.look.parts,
            highlights: document.look.highlight_selected,
            ghosts: document.look.ghost_others,
        }
    }
}

/// What states change besides colors: which parts show, and which neurons are ghosts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CoverageKey {
    members: Revision,
    parts: VisibleParts,
    /// Revision of the selection, if what is not selected is a ghost.
    ghosts: Option<Revision>,
}

impl StatesKey {
    pub(crate) fn coverage(&self) -> CoverageKey {
        CoverageKey {
            members: self.members,
            parts: self.parts,
            ghosts: self.ghosts.then_some(self.selection),
        }
    }
}

/// An instance: the source and the placement of a neuron, and whether it is hidden.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SceneInstance {
    pub(crate) source: usize,
    pub(crate) placement: Placement,
    pub(crate) hidden: bool,
}

/// Instances of all neurons. `sources`: the templates, sorted by id.
pub(crate) fn instances(state: &State, sources: &[SceneTemplate]) -> Vec<SceneInstance> {
    let placements = state.placements();
    let neurons = &state.document.neurons;
    let placed = neurons.iter().zip_eq(placements.iter()).enumerate();
    let instances = placed.map(|(index, (neuron, &placement))| {
        let source = sources.binary_search_by_key(&neuron.source, |s| s.id);
        SceneInstance {
            source: source.unwrap_or(0),
            placement,
            // A neuron without a template yet is not drawn, but keeps its index.
            hidden: !neurons.shows(index) || source.is_err(),
        }
    });
    instances.collect()
}

/// All sources with their color keys; the ids of templates are their indices. `instead`: the mesh of each, if not its own.
pub(crate) fn template_list<'a>(
    sources: &'a [SceneTemplate],
    coloring: &'a Coloring,
    instead: Option<&'a CoarseMesh>,
) -> Vec<Template<'a>> {
    let keyed = sources.iter().zip_eq(&coloring.color_keys);
    let template = |(source, color_keys): (&'a SceneTemplate, &'a Vec<u32>)| Template {
        mesh: instead.unwrap_or(&source.generated.mesh),
        color_keys,
        values: &[],
    };
    keyed.map(template).collect()
}

/// Uploads all sources, or if `empty` none of their points.
pub(crate) fn templates(
    gpu: &Gpu,
    sources: &[SceneTemplate],
    coloring: &Coloring,
    empty: bool,
) -> Result<Templates, DeviceError> {
    let none = CoarseMesh::default();
    let list = template_list(sources, coloring, empty.then_some(&none));
    let mut templates = Templates::new();
    if !list.is_empty() {
        templates.add(gpu, &list)?;
    }
    Ok(templates)
}

/// Instances of templates, without states.
pub(crate) fn device_instances(instances: &[SceneInstance]) -> Vec<Instance> {
    let instance = |s: &SceneInstance| Instance {
        placement: s.placement,
        hidden: s.hidden,
        ..Instance::new(TemplateId(s.source as u32))
    };
    instances.iter().map(instance).collect()
}

/// A vertex source of the whole scene, for pictures that are saved.
pub(crate) fn adaptive(
    gpu: &Gpu,
    content: &SceneContent,
    sub_pixels: u32,
) -> Result<Adaptive, BuildError> {
    let templates = templates(gpu, &content.sources, &content.coloring, false)?;
    let scene = Scene::new(templates, device_instances(&content.instances))?;
    let mut source = Adaptive::new(gpu, scene, AdaptiveSettings::default(), sub_pixels)?;
    source.set_bounds(bounding_spheres(content));
    Ok(source)
}

/// Most bounding spheres of a scene, and fewest of a cell.
const SPHERES: [usize; 2] = [400_000, 16];

/// Spheres that hold all that shows, as it is drawn.
fn bounding_spheres(content: &SceneContent) -> Vec<BoundingSphere> {
    let [most, fewest] = SPHERES;
    let most = (most / content.instances.len().max(1)).max(fewest);
    let sources = content.sources.par_iter();
    let own: Vec<Vec<BoundingSphere>> = sources
        .map(|source| merged(&bounds(&source.generated.mesh), most))
        .collect();
    let shown = content.instances.iter().filter(|instance| !instance.hidden);
    let placed = shown.flat_map(
        |SceneInstance {
             source, placement, ..
         }| {
            let spheres = own.get(*source).into_iter().flatten();
            spheres.map(|&(center, radius)| {
                (placement.world_from_cell(center), radius * placement.scale)
            })
        },
    );
    placed.collect()
}

/// States of all neurons, for the shading.
pub(crate) fn states(document: &Document) -> Vec<u32> {
    let look = &document.look;
    let selected = document.neurons.selected();
    let parts = match look.parts {
        VisibleParts::All => 0,
        VisibleParts::Soma => WITHOUT_NEURITES,
        VisibleParts::Neurites => WITHOUT_SOMA,
    };
    let state = |index: usize| {
        let is_selected = selected.contains(index);
        let highlighted = if is_selected && look.highlight_selected {
            HIGHLIGHTED
        } else {
            0
        };
        let ghosted = if !selected.is_empty() && !is_selected && look.ghost_others {
            GHOSTED
        } else {
            0
        };
        parts | highlighted | ghosted
    };
    (0..document.neurons.len()).map(state).collect()
}

/// Color of selected neurons and its share, and opacity of others beside them.
pub(crate) fn of_states(look: &Look) -> ((Rgb, f32), f32) {
    ((SELECTION, 0.75), look.ghost_opacity.clamp(0.0, 1.0))
}

/// Light, wireframe and colors of states. `least_width`: of neurites (pixels).
pub(crate) fn surface_look(look: &Look, least_width: f32) -> neurotess::render::Look {
    let (highlighted, ghosted) = of_states(look);
    neurotess::render::Look {
        light: look.light.light(),
        wire: if look.wireframe { WIRE } else { 0.0 },
        clip: None,
        highlighted,
        ghosted,
        contrast: Some(look.background),
        least_width,
    }
}

/// The plane of the cut through the scene.
pub(crate) fn clip(look: &Look, spheres: &[BoundingSphere]) -> Option<Clip> {
    let cut = look.cut?;
    let (low, high) = extent(spheres);
    let mut normal = DVec3::ZERO;
    normal[cut.axis.min(2)] = if cut.flipped { 1.0 } else { -1.0 };
    let point = low + (high - low) * f64::from(cut.place.clamp(0.0, 1.0));
    Some(Clip { point, normal })
}
