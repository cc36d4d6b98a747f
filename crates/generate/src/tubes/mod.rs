//! Paths become patches: rings of four corners, tubes between them, lofts and caps.

mod assembly;
mod facing;
mod frame;
mod normals;
mod path;
mod path_rings;
mod soma;
mod taper;
mod twist;

pub(crate) use assembly::{SomaLabel, Somata, Tubes, tubes};
pub(crate) use normals::average_normals;
pub(crate) use taper::{Straight, taper};
