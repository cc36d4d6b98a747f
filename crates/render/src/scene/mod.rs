//! What is drawn: templates, and instances of them.
//!
//! A **template** is a coarse mesh that the device holds once. An **instance** is a placement of a
//! template with a state: ten thousand neurons of a thousand morphologies take a thousand
//! templates.

pub(crate) mod color;
#[cfg(feature = "gpu")]
mod instances;
mod placement;
#[cfg(feature = "gpu")]
pub(crate) mod templates;

#[cfg(feature = "gpu")]
pub(crate) use instances::check_placement;
#[cfg(feature = "gpu")]
pub use instances::{Instance, Scene, SceneError};
pub use placement::Placement;
#[cfg(feature = "gpu")]
pub use templates::TemplateId;
