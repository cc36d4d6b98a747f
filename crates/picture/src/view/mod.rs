//! Views: cameras and their lenses, frames and their tiles, frustums, and cameras that fit a scene.

pub(crate) mod bounds;
pub(crate) mod camera;
pub(crate) mod frame;
pub(crate) mod framing;
pub(crate) mod frustum;
pub(crate) mod lens;
