//! Refined patches are judged: which shape each fork gets, and which rings give way where a tube crosses itself.

mod choose;
mod facets;
mod fork_trials;
mod layout;
mod neighborhood;
mod part;
mod refined_patches;
mod repair;
mod sound;

use neurotess_mesh::{CoarseMesh, Steps};

use crate::plan::MayJoin;
use crate::tracing::Skeleton;
use crate::tubes::Somata;
use crate::warning::Warnings;
use sound::Simpler;

/// The mesh of a tracing, simplified where tubes would be inside out; unfinished where another thread asks to stop.
pub(crate) fn sound_mesh(
    skeleton: &Skeleton,
    somata: &Somata<'_>,
    may_join: &MayJoin<'_>,
    warnings: &mut Warnings,
    steps: &Steps<'_>,
) -> CoarseMesh {
    let mut found = Warnings::default();
    let mut mesh = choose::mesh(skeleton, somata, may_join, &mut found, steps);
    for simpler in Simpler::ALL {
        let faulty = sound::faulty_samples(&mesh);
        if faulty.is_empty() || steps.watch().is_stopped() {
            break;
        }
        found = Warnings::default();
        found.add(
            "simplified",
            None,
            "path turns back within its own tube, which would be inside out: meshed without these turns",
        );
        let simpler = simpler.of(skeleton, &faulty);
        mesh = choose::mesh(&simpler, somata, &|_, _| true, &mut found, steps);
    }
    warnings.extend(found);
    mesh
}
