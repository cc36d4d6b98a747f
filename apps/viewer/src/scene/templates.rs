//! Tracings as templates of the picture.

use std::sync::Arc;

use neurotess::generate::{GenerateOptions, Generated};
use neurotess::morphology::Morphology;
use neurotess::render::Proxy;

use crate::model::ids::SourceId;
use crate::model::state::State;

/// A tracing as a template.
#[derive(Clone, Debug)]
pub(crate) struct SceneTemplate {
    pub(crate) id: SourceId,
    pub(crate) name: String,
    pub(crate) morphology: Arc<Morphology>,
    pub(crate) generated: Arc<Generated>,
    /// What exploration draws of `generated`, if it is there; all its color keys are 0.
    pub(crate) proxy: Option<Arc<Proxy>>,
    /// The mesh of the tracing itself; it differs from `generated` if points were inserted for a
    /// report's values, or radii are drawn larger.
    pub(crate) traced: Arc<Generated>,
    /// Options of its mesh.
    pub(crate) options: GenerateOptions,
}

impl SceneTemplate {
    /// Whether another one was made from the same mesh, in the same way but for a report's values.
    pub(crate) fn same_as(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.traced, &other.traced) && self.options == other.options
    }

    /// The factor that the radii of its mesh have: 1 also where they could not be drawn larger.
    pub(crate) fn drawn_factor(&self) -> f64 {
        match Arc::ptr_eq(&self.generated, &self.traced) {
            true => 1.0,
            false => self.options.radius_factor,
        }
    }

    /// Whether its mesh is that of the tracing itself.
    pub(crate) fn is_as_traced(&self) -> bool {
        self.options.radius_factor == 1.0
    }
}

/// Templates of the neurons in the list, by the ids of their tracings.
pub(crate) fn templates(state: &State) -> Vec<SceneTemplate> {
    let used = state.document.neurons.sources();
    let templates = used.filter_map(|id| {
        let source = state.sources.get(id)?;
        Some(SceneTemplate {
            id,
            name: source.name.clone(),
            morphology: Arc::clone(&source.morphology),
            generated: Arc::clone(&source.generated),
            proxy: source.proxy.clone(),
            traced: Arc::clone(&source.generated),
            options: GenerateOptions {
                radius_factor: state.document.look.radius_factor(),
                ..source.soma.options()
            },
        })
    });
    templates.collect()
}
