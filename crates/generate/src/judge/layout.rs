//! A mesh of a tracing whose forks were each given a choice.

use std::ops::Range;

use neurotess_mesh::CoarseMesh;

use crate::plan::{self, ForkChoice, MayJoin};
use crate::tracing::Skeleton;
use crate::tubes::{Somata, Tubes, tubes};
use crate::warning::Warnings;

/// A mesh, and what became of the forks.
pub(crate) struct Layout {
    pub(crate) mesh: CoarseMesh,
    /// Patches near a fork, by the fork's node.
    pub(crate) patches: Vec<(u32, Range<u32>)>,
    /// Forks that were to have insets, and have no room for them.
    pub(crate) refused: Vec<u32>,
    pub(crate) warnings: Warnings,
}

impl Layout {
    /// Without somata their neurites are closed by caps.
    pub(crate) fn new(
        skeleton: &Skeleton,
        choices: &[ForkChoice],
        somata: Option<&Somata<'_>>,
        may_join: &MayJoin<'_>,
    ) -> Self {
        let mut warnings = Warnings::default();
        let soma_spheres = somata.map_or(&[][..], |somata| somata.soma_spheres);
        let plan = plan::plan(skeleton, choices, soma_spheres, may_join, &mut warnings);
        let Tubes { mesh, patches } = tubes(&plan, somata);
        Self {
            mesh,
            patches,
            refused: plan.refused,
            warnings,
        }
    }
}
