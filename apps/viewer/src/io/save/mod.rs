//! Writes meshes, and videos of numbered pictures.

mod meshes;
pub(crate) mod video;

use neurotess::output::Existing;

pub(crate) use meshes::{MeshPlan, meshes};

pub(crate) fn existing(replace: bool) -> Existing {
    match replace {
        true => Existing::Replace,
        false => Existing::Refuse("allow it to be replaced"),
    }
}
