//! Instances of templates: what a scene is made of.

use neurotess_mesh::CoarseMesh;
use thiserror::Error;

use crate::placement::Placement;

/// Index of a template among those of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct TemplateId(pub u32);

/// A coarse mesh that instances show.
#[derive(Clone, Copy, Debug)]
pub struct Template<'t> {
    /// The mesh.
    pub mesh: &'t CoarseMesh,
    /// A color key for each tracing point. Missing ones are 0.
    pub color_keys: &'t [u32],
    /// A level for each tracing point, for
    /// [`LodCriterion::PerPoint`](neurotess_refine::LodCriterion::PerPoint). Missing ones are 1.
    pub values: &'t [u8],
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
///
/// # Errors
/// There is no such template, or the placement is not valid.
pub fn check_placement(
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
