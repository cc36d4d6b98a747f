//! Writes meshes, plots, pages, and videos of numbered pictures.

mod meshes;
mod page;
mod plots;
pub(crate) mod video;

use neurotess::output::Existing;

use crate::model::save::Written;
pub(crate) use meshes::{MeshPlan, SeenFrom, meshes};
pub(crate) use page::page;
pub(crate) use plots::plot;

pub(crate) fn existing(replace: bool) -> Existing {
    match replace {
        true => Existing::Replace,
        false => Existing::Refuse("allow it to be replaced"),
    }
}
