//! A mesh of a skeleton whose forks were each given a choice.

use std::ops::Range;

use neurotess_mesh::CoarseMesh;

use super::assembly::{Assembly, Somata};
use crate::plan::{self, ForkChoice};
use crate::plan::{bends, crowd, fork, uncross};
use crate::tracing::Skeleton;
use crate::warning::Warnings;

/// Whether a path may go straight from one node to another below it.
pub(crate) type MayJoin<'a> = dyn Fn(u32, u32) -> bool + Sync + 'a;

/// A mesh, and what became of the forks.
pub(crate) struct Made {
    pub(crate) mesh: CoarseMesh,
    /// Patches near a fork, by the fork's node.
    pub(crate) patches: Vec<(u32, Range<u32>)>,
    /// Forks that were to have insets, and have no room for them.
    pub(crate) refused: Vec<u32>,
    pub(crate) warnings: Warnings,
}

impl Made {
    /// Without somata their neurites are closed by caps.
    pub(crate) fn new(
        skeleton: &Skeleton,
        choices: &[ForkChoice],
        somata: Option<&Somata<'_>>,
        may_join: &MayJoin<'_>,
    ) -> Self {
        let mut warnings = Warnings::default();
        let mut layout = plan::lay_out(skeleton, choices);
        warn(&layout, skeleton, &mut warnings);
        crowd::split_crowded_forks(&mut layout.skeleton, &mut warnings);
        fork::clear_the_way(&mut layout.skeleton, &mut warnings);
        let spheres = somata.map_or(&[][..], |somata| somata.soma_spheres);
        let mut orientations =
            uncross::uncross_rings(&mut layout, spheres, may_join, &mut warnings);
        bends::split_sharp_bends(&mut layout.skeleton, &mut orientations);
        let mut assembly = Assembly::new(&layout, &orientations);
        if let Some(somata) = somata {
            assembly.somata(somata);
        }
        let (mesh, patches) = assembly.finish();
        Self {
            mesh,
            patches,
            refused: layout.refused,
            warnings,
        }
    }
}

fn warn(layout: &plan::Layout, skeleton: &Skeleton, warnings: &mut Warnings) {
    for &twig in &layout.buried {
        warnings.add(
            "buried_twig",
            Some(skeleton.node(twig).sample),
            "twig ends inside the neurite that it branches from: left out of the mesh",
        );
    }
    for &fork in &layout.thickened {
        warnings.add(
            "fork_thickened",
            Some(skeleton.node(fork).sample),
            "sample at a fork is thinner than two of its neighbors: meshed as thick as the thinner of them",
        );
    }
}
