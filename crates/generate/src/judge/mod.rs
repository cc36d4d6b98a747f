//! Refined patches are judged: which shape each fork gets, and which rings give way where a tube crosses itself.

pub(crate) mod choose;
mod facets;
mod fit;
mod fork_trials;
mod layout;
mod neighborhood;
mod part;
mod passing;
mod refined_patches;
pub(crate) mod sound;
