//! The surface as it is worked on: its triangles, what is near on it, and edits that keep it closed.

pub(crate) mod stars;
pub(crate) mod vicinity;
pub(crate) mod work;
