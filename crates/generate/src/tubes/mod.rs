//! Paths become patches: rings of four corners, tubes between them, lofts and caps.

mod assembly;
mod facing;
mod frame;
mod made;
mod normals;
mod path;
mod path_rings;
mod twist;

pub(crate) use assembly::Somata;
pub(crate) use made::{Made, MayJoin};
pub(crate) use normals::average_normals;
