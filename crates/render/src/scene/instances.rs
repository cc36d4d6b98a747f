//! Instances of templates, and the scene of all of them.

use thiserror::Error;

use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;
use crate::scene::placement::Placement;
use crate::scene::templates::{Template, TemplateId, Templates};
use crate::view::frustum::BoundingSphere;

/// One neuron in the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instance {
    /// The template that it shows.
    pub template: TemplateId,
    /// Where it is.
    pub placement: Placement,
    /// Whether it is left out.
    pub hidden: bool,
    /// Bits of [`state`](crate::state) for the shading.
    pub state: u32,
}

impl Instance {
    /// A template in its own coordinates.
    pub fn new(template: TemplateId) -> Self {
        Self {
            template,
            placement: Placement::default(),
            hidden: false,
            state: 0,
        }
    }
}

/// Why an instance cannot be shown: `what: what to do`.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum SceneError {
    /// The placement has numbers that are not finite, or a scale that is not positive.
    #[error("instance {0} has a placement that is not finite or a scale of 0 or less: correct it")]
    Placement(usize),
    /// There is no such template.
    #[error(
        "instance {instance} is of template {template}, but there are {templates}: add it first"
    )]
    Template {
        /// Index of the instance.
        instance: usize,
        /// Index of its template.
        template: u32,
        /// Number of templates.
        templates: usize,
    },
}

/// Checks the template and the placement of an instance; `index`: its own, `templates`: their
/// number.
pub(crate) fn check_placement(
    index: usize,
    instance: &Instance,
    templates: usize,
) -> Result<(), SceneError> {
    let Placement {
        rotation,
        scale,
        translation,
    } = instance.placement;
    if instance.template.0 as usize >= templates {
        return Err(SceneError::Template {
            instance: index,
            template: instance.template.0,
            templates,
        });
    }
    let somewhere = rotation.is_finite() && translation.is_finite() && scale.is_finite();
    if !somewhere || scale <= 0.0 || !rotation.is_normalized() {
        return Err(SceneError::Placement(index));
    }
    Ok(())
}

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
