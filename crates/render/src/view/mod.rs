//! From where one looks: cameras, frames and their tiles, what fits into a picture.

pub(crate) mod bounds;
pub(crate) mod camera;
pub(crate) mod frame;
pub(crate) mod framing;
pub(crate) mod frustum;
