//! What is drawn: templates, and instances of them.
//!
//! A **template** is a coarse mesh that the device holds once. An **instance** is a placement of a
//! template with a state: ten thousand neurons of a thousand morphologies take a thousand
//! templates.

pub(crate) mod color;
mod instances;
mod placement;
pub(crate) mod templates;

pub(crate) use instances::check_placement;
pub use instances::{Instance, Scene, SceneError};
pub use placement::Placement;
pub use templates::TemplateId;
