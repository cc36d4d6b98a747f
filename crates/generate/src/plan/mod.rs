//! Branches that leave a quad of their trunk through an inset, instead of a joint of tubes.
//!
//! ```text
//!        ring low            ring high        the trunk runs on undisturbed
//!    ──────●───────────────────●──────
//!          │╲                 ╱│              between two of its rings, the quad
//!          │  ●─────────────●  │              that faces the branch gets an inner quad
//!          │  │   inset     │  │              of the branch's size, lifted off the trunk,
//!          │  ●─────────────●  │              with four lofts around it
//!          │╱                 ╲│
//!    ──────●───────────────────●──────
//! ```
//!
//! Planned here: which child of a fork continues the trunk (trunk.rs), where each other child leaves it (zone.rs), and how
//! several share it (arrange.rs). All of it becomes paths (path.rs): the branch's begins in an inset, and two rings of the
//! trunk's stand for the zone. Where the two children of a fork are the trunk, it is the parent that leaves it, and its path
//! ends in the inset (across.rs). A branch for which there is no room stays with its fork, which becomes a joint. Rings that
//! are in each other's way give way (planes.rs, joint_room.rs). The quads are made when all that is known: shape.rs and
//! `tubes`.

mod across;
mod arrange;
mod bends;
mod clearance;
mod cone;
mod creases;
mod crowd;
mod joint;
mod joint_room;
mod leave;
mod path;
mod path_insets;
mod planes;
mod planner;
mod polyline;
mod shape;
mod trunk;
mod trunk_rings;
mod zone;

use crate::tracing::{Skeleton, SomaSphere};
use crate::warning::Warnings;

pub(crate) use across::is_straight_across;
pub(crate) use clearance::Disk;
pub(crate) use cone::{RoundCone, outwards};
pub(crate) use joint::JointShape;
pub(crate) use path::{Inset, Joint, Label, Origin, Path, PathEnd, Plan, PlannedRing, RingKind};
pub(crate) use shape::{InsetSite, not_too_steep, unit_across};

/// What a fork becomes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ForkChoice {
    /// Its tubes meet at one point.
    Joint,
    /// All children but the one that continues the trunk leave through insets, lifted this many radii
    /// off the trunk.
    Inset {
        /// Radii of the branch.
        lift: f64,
        /// Whether the two children are the trunk and the parent is the branch.
        across: bool,
        /// Whether the trunk's rings around a branch lean towards it, twice as much as outwards. Where the trunk bends
        /// there that shows as edges, but keeps the quads between the rings straight.
        leaning: bool,
        /// Whether the fork becomes as thick as the second thickest of its neighbors: a single thin sample
        /// between thick ones leaves them no room.
        thickened: bool,
    },
}

impl ForkChoice {
    /// Whether it is an inset in which the parent ends.
    pub(crate) fn is_across(self) -> bool {
        matches!(self, Self::Inset { across: true, .. })
    }

    /// Whether it is an inset whose trunk's rings lean towards it.
    pub(crate) fn is_leaning(self) -> bool {
        matches!(self, Self::Inset { leaning: true, .. })
    }

    /// Whether it is an inset on a thickened fork.
    pub(crate) fn is_thickened(self) -> bool {
        matches!(
            self,
            Self::Inset {
                thickened: true,
                ..
            }
        )
    }
}

/// A fork of more neighbors is split over several joints: one has so many directions in a plane that are far enough
/// apart, and each is judged by the patches of all.
pub(crate) const MAX_NEIGHBORS: usize = 6;

/// Whether a path may go straight from one node of the tracing to another below it.
pub(crate) type MayJoin<'a> = dyn Fn(u32, u32) -> bool + Sync + 'a;

/// Plans the paths of a tracing. `choices`: by node, those that are no forks included; `soma_spheres`: none where
/// neurites are to be closed by caps.
pub(crate) fn plan(
    skeleton: &Skeleton,
    choices: &[ForkChoice],
    soma_spheres: &[Option<SomaSphere>],
    may_join: &MayJoin<'_>,
    warnings: &mut Warnings,
) -> Plan {
    let mut plan = planner::Planner::new(skeleton, choices).plan();
    warn(&plan, skeleton, warnings);
    crowd::split_crowded_joints(&mut plan, warnings);
    joint_room::clear_the_way(&mut plan, warnings);
    planes::set_planes(&mut plan, soma_spheres, may_join, warnings);
    creases::set_creases(&mut plan);
    bends::split_sharp_bends(&mut plan);
    plan
}

fn warn(plan: &Plan, skeleton: &Skeleton, warnings: &mut Warnings) {
    for &twig in &plan.buried {
        warnings.add(
            "buried_twig",
            Some(skeleton.node(twig).sample),
            "twig ends inside the neurite that it branches from: left out of the mesh",
        );
    }
    for &fork in &plan.thickened {
        warnings.add(
            "fork_thickened",
            Some(skeleton.node(fork).sample),
            "sample at a fork is thinner than two of its neighbors: meshed as thick as the thinner of them",
        );
    }
}
