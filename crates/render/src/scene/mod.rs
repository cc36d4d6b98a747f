//! What is drawn: templates, and instances of them.
//!
//! A **template** is a coarse mesh that the device holds once. An **instance** is a placement of a
//! template with a state: ten thousand neurons of a thousand morphologies take a thousand
//! templates.

mod instances;
pub(crate) mod templates;

pub use instances::Scene;
