//! Instances of templates, and the scene of all of them.

use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;
use neurotess_picture::{
    BoundingSphere, Instance, SceneError, Template, TemplateId, check_placement,
};

use crate::scene::templates::Templates;

/// Checked instances of templates that are resident on a device.
#[derive(Debug, Default)]
pub struct Scene {
    templates: Templates,
    instances: Vec<Instance>,
}

impl Scene {
    /// Checks every instance. Shaders know an instance by its index in this list.
    ///
    /// # Errors
    /// An instance refers to a template that does not exist, or has an invalid placement.
    pub fn new(templates: Templates, instances: Vec<Instance>) -> Result<Self, SceneError> {
        for (i, instance) in instances.iter().enumerate() {
            check_placement(i, instance, templates.count_of_templates())?;
        }
        Ok(Self {
            templates,
            instances,
        })
    }

    /// The templates.
    pub fn templates(&self) -> &Templates {
        &self.templates
    }

    /// The instances.
    pub fn instances(&self) -> &[Instance] {
        &self.instances
    }

    /// Hides or shows instances; a value for each, in their order.
    pub fn set_hidden(&mut self, hidden: impl IntoIterator<Item = bool>) {
        for (instance, hidden) in self.instances.iter_mut().zip(hidden) {
            instance.hidden = hidden;
        }
    }

    /// Replaces a template's mesh; its instances show the new one.
    ///
    /// # Errors
    /// The device has no memory left, or reports another error; the old mesh stays.
    pub fn replace(
        &mut self,
        gpu: &Gpu,
        id: TemplateId,
        template: &Template<'_>,
    ) -> Result<(), DeviceError> {
        self.templates.replace(gpu, id, template)
    }

    /// Takes the scene apart, to change it.
    pub fn into_parts(self) -> (Templates, Vec<Instance>) {
        (self.templates, self.instances)
    }

    /// Bounding spheres that hold all instances that are not hidden, in the world (µm): to fit a
    /// camera to.
    pub fn spheres(&self) -> Vec<BoundingSphere> {
        let shown = self.instances.iter().filter(|instance| !instance.hidden);
        shown
            .flat_map(|instance| {
                let template = self.templates.template(instance.template);
                template.into_iter().flat_map(|t| {
                    t.parts
                        .iter()
                        .flat_map(|part| &part.spheres)
                        .map(|&(center, radius)| {
                            let center = instance
                                .placement
                                .world_from_cell(t.origin + center.as_dvec3());
                            (center, f64::from(radius) * instance.placement.scale)
                        })
                })
            })
            .collect()
    }
}
