//! What is drawn.

use glam::Vec3;
use neurotess_mesh::CoarseMesh;
use neurotess_picture::color::CATEGORY_BIT;
use neurotess_picture::{AdaptiveSettings, Instance, SceneError, Template, check_placement};
use neurotess_refine::{patch_sphere, sphere_around};
use rayon::prelude::*;

use crate::markers::SceneMarkers;
use crate::meshes::SceneMesh;

/// Templates and instances of them, with what is beside them.
pub struct Scene<'a> {
    pub(crate) templates: Vec<SceneTemplate<'a>>,
    pub(crate) instances: Vec<Instance>,
    pub(crate) settings: AdaptiveSettings,
    pub(crate) markers: Option<&'a SceneMarkers>,
    pub(crate) meshes: &'a [SceneMesh],
    /// By category: whether it is left out.
    hidden: &'a [bool],
}

/// A template and where it is.
pub(crate) struct SceneTemplate<'a> {
    pub(crate) template: Template<'a>,
    /// A sphere that holds it, relative to its origin (µm).
    pub(crate) sphere: (Vec3, f32),
}

impl<'a> Scene<'a> {
    /// Checks every instance.
    ///
    /// # Errors
    /// An instance refers to a template that does not exist, or has an invalid placement.
    pub fn new(
        templates: Vec<Template<'a>>,
        instances: Vec<Instance>,
        settings: AdaptiveSettings,
    ) -> Result<Self, SceneError> {
        for (index, instance) in instances.iter().enumerate() {
            check_placement(index, instance, templates.len())?;
        }
        let around = |mesh: &CoarseMesh| {
            sphere_around(mesh.patches.iter().map(|patch| patch_sphere(mesh, patch)))
        };
        let templates = templates.into_par_iter().map(|template| SceneTemplate {
            sphere: around(template.mesh),
            template,
        });
        Ok(Self {
            templates: templates.collect(),
            instances,
            settings,
            markers: None,
            meshes: &[],
            hidden: &[],
        })
    }

    /// The same with markers beside it.
    #[must_use]
    pub fn with_markers(mut self, markers: Option<&'a SceneMarkers>) -> Self {
        self.markers = markers;
        self
    }

    /// The same with meshes that are no cells.
    #[must_use]
    pub fn with_meshes(mut self, meshes: &'a [SceneMesh]) -> Self {
        self.meshes = meshes;
        self
    }

    /// The same without the parts of cells that have hidden categories: the border is at the last tracing point that has
    /// another. Twin of `is_hidden` in shade.wgsl.
    #[must_use]
    pub fn without(mut self, hidden: &'a [bool]) -> Self {
        self.hidden = hidden;
        self
    }

    pub(crate) fn hides(&self, color_key: u32) -> bool {
        let category = (color_key & !CATEGORY_BIT) as usize;
        color_key & CATEGORY_BIT != 0 && self.hidden.get(category) == Some(&true)
    }

    /// Number of patches of all instances.
    pub fn patches(&self) -> u64 {
        let shown = self.instances.iter().filter(|instance| !instance.hidden);
        shown.map(|instance| self.patches_of(instance) as u64).sum()
    }

    pub(crate) fn patches_of(&self, instance: &Instance) -> usize {
        let template = &self.templates[instance.template.0 as usize];
        template.template.mesh.patches.len()
    }
}
