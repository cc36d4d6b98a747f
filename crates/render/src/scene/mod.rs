//! What is drawn: templates, and instances of them.
//!
//! A **template** is a coarse mesh that the device holds once. An **instance** is a placement of a
//! template with a state: ten thousand neurons of a thousand morphologies take a thousand
//! templates.

pub(crate) mod color;
pub(crate) mod templates;

use glam::{DMat3, DQuat, DVec3};
use thiserror::Error;

use crate::gpu::device::Gpu;
use crate::gpu::error::DeviceError;
use crate::scene::templates::{Template, Templates};
use crate::view::frustum::BoundingSphere;

/// Index of a template among those of a [`Templates`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct TemplateId(pub u32);

/// Where an instance is: `world = translation + scale · rotation · cell`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Unit quaternion.
    pub rotation: DQuat,
    /// Scale, the same in all directions; positive.
    pub scale: f64,
    /// Translation (µm).
    pub translation: DVec3,
}

impl Default for Placement {
    fn default() -> Self {
        Self {
            rotation: DQuat::IDENTITY,
            scale: 1.0,
            translation: DVec3::ZERO,
        }
    }
}

impl Placement {
    /// Rotation and scale as a matrix.
    pub fn linear(&self) -> DMat3 {
        DMat3::from_quat(self.rotation) * self.scale
    }

    /// A point of the cell in the world (µm).
    pub fn world_from_cell(&self, p: DVec3) -> DVec3 {
        self.translation + self.rotation * p * self.scale
    }

    /// A point of the world in the cell (µm).
    pub fn cell_from_world(&self, p: DVec3) -> DVec3 {
        self.rotation.inverse() * (p - self.translation) / self.scale
    }
}

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
