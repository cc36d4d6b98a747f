//! What is on the device: templates, instances, colors.

use std::sync::Arc;

use glam::DVec3;
use neurotess::coloring::{Coloring, Recording};
use neurotess::render::{
    Adaptive, AdaptiveSettings, BoundingSphere, Clip, ColorTable, DeviceError, GHOSTED, Gpu,
    HIGHLIGHTED, Instance, Legend, Placement, Scene, SceneError, Template, TemplateId, Templates,
    WITHOUT_NEURITES, WITHOUT_SOMA,
};
use thiserror::Error;

use crate::model::document::{Document, Look, Parts};
use crate::model::sources::extent;
use crate::model::state::State;
use crate::scene::colors::Colored;
use crate::scene::templates::SceneTemplate;

/// Width (pixels) of wires.
const WIRE: f32 = 1.0;
/// Color of what is selected.
pub(crate) const SELECTION: [u8; 3] = [255, 140, 0];

/// Why there is no scene.
#[derive(Clone, Debug, Error, PartialEq)]
pub(crate) enum BuildError {
    #[error(transparent)]
    Device(#[from] DeviceError),
    #[error(transparent)]
    Scene(#[from] SceneError),
}

/// What a scene is made of.
#[derive(Clone, Debug)]
pub(crate) struct Shown {
    pub(crate) sources: Vec<SceneTemplate>,
    pub(crate) instances: Vec<Standing>,
    /// What points say on the device.
    pub(crate) coloring: Arc<Coloring>,
    /// What that means now.
    pub(crate) table: ColorTable,
    pub(crate) legend: Legend,
    /// A recording, with the range of all its values.
    pub(crate) replay: Option<(Arc<Recording>, [f32; 2])>,
}

impl Shown {
    pub(crate) fn new(
        sources: Vec<SceneTemplate>,
        instances: Vec<Standing>,
        colored: Colored,
    ) -> Self {
        let Colored {
            coloring, replay, ..
        } = colored;
        Self {
            sources,
            instances,
            table: coloring.table.clone(),
            legend: coloring.legend.clone(),
            coloring: Arc::new(coloring),
            replay,
        }
    }
}

/// A neuron: which source, where, and whether it is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Standing {
    pub(crate) source: usize,
    pub(crate) placement: Placement,
    pub(crate) hidden: bool,
}

/// Where all neurons stand. `sources`: as on the device, sorted.
pub(crate) fn standing(state: &State, sources: &[SceneTemplate]) -> Vec<Standing> {
    let neurons = state.document.neurons.iter().zip(state.placements());
    let standing = neurons.map(|(neuron, placement)| {
        let source = sources.binary_search_by_key(&neuron.source, |s| s.id);
        Standing {
            source: source.unwrap_or(0),
            placement,
            // What is not there yet is not drawn, but keeps its place.
            hidden: neuron.hidden || source.is_err(),
        }
    });
    standing.collect()
}

/// Uploads all sources; their numbers are their places.
pub(crate) fn templates(
    gpu: &Gpu,
    sources: &[SceneTemplate],
    coloring: &Coloring,
) -> Result<Templates, DeviceError> {
    let list: Vec<Template<'_>> = sources
        .iter()
        .zip(&coloring.color_keys)
        .map(|(source, words)| Template {
            mesh: &source.generated.mesh,
            color_keys: words,
            values: &[],
        })
        .collect();
    let mut templates = Templates::new();
    if !list.is_empty() {
        templates.add(gpu, &list)?;
    }
    Ok(templates)
}

/// Instances of templates that were uploaded.
pub(crate) fn instances(standing: &[Standing]) -> Vec<Instance> {
    let instance = |s: &Standing| Instance {
        placement: s.placement,
        hidden: s.hidden,
        ..Instance::new(TemplateId(s.source as u32))
    };
    standing.iter().map(instance).collect()
}

/// A maker for a whole scene, for pictures that are saved.
pub(crate) fn maker(gpu: &Gpu, shown: &Shown, sub_pixels: u32) -> Result<Adaptive, BuildError> {
    let templates = templates(gpu, &shown.sources, &shown.coloring)?;
    let scene = Scene::new(templates, instances(&shown.instances))?;
    Ok(Adaptive::new(
        gpu,
        scene,
        AdaptiveSettings::default(),
        sub_pixels,
    )?)
}

/// States of all neurons, as the shading wants them.
pub(crate) fn states(document: &Document) -> Vec<u32> {
    let look = &document.look;
    let any = document.selected().next().is_some();
    let parts = match look.parts {
        Parts::All => 0,
        Parts::Soma => WITHOUT_NEURITES,
        Parts::Neurites => WITHOUT_SOMA,
    };
    let state = |selected: bool| {
        let marked = if selected && look.mark_selected {
            HIGHLIGHTED
        } else {
            0
        };
        let faint = if any && !selected && look.faint_others {
            GHOSTED
        } else {
            0
        };
        parts | marked | faint
    };
    document.neurons.iter().map(|n| state(n.selected)).collect()
}

/// Light, wires and colors of states.
pub(crate) fn surface_look(look: &Look) -> neurotess::render::Look {
    neurotess::render::Look {
        light: look.light.light(),
        wire: if look.wireframe { WIRE } else { 0.0 },
        clip: None,
        highlighted: (SELECTION, 0.75),
        ghosted: look.faint.clamp(0.0, 1.0),
        contrast: Some(look.background),
    }
}

/// The plane of the cut through what shows.
pub(crate) fn clip(look: &Look, balls: &[BoundingSphere]) -> Option<Clip> {
    let cut = look.cut?;
    let (low, high) = extent(balls);
    let mut normal = DVec3::ZERO;
    normal[cut.axis.min(2)] = if cut.flipped { 1.0 } else { -1.0 };
    let point = low + (high - low) * f64::from(cut.place.clamp(0.0, 1.0));
    Some(Clip { point, normal })
}
