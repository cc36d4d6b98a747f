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
//! Planned here, on the skeleton: which child of a fork continues the trunk (trunk.rs), where each other child
//! leaves it (zone.rs), and how several share it (arrange.rs). A branch becomes a tree of its own, whose
//! root stands for the inset; two nodes of the trunk stand for the zone's rings. Where the two children of a fork
//! are the trunk, it is the parent that leaves it, and its path ends in the inset (across.rs). A branch for which
//! there is no room stays with its fork, which becomes a joint. The quads are made when the trunk's final
//! rings are known: shape.rs and assemble.

mod across;
mod arrange;
pub(crate) mod bends;
mod cone;
pub(crate) mod crowd;
pub(crate) mod fork;
pub(crate) mod joint;
mod leave;
mod path_insets;
mod planner;
mod polyline;
mod shape;
mod trunk;
mod trunk_rings;
pub(crate) mod uncross;
mod zone;

use glam::DVec3;

use crate::tracing::Skeleton;

pub(crate) use across::is_straight_across;
pub(crate) use cone::{RoundCone, outwards};
pub(crate) use shape::{InsetSite, collar, not_too_steep};

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

/// A branch that leaves through an inset.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Inset {
    /// Fork of the skeleton that was laid out.
    pub(crate) fork: u32,
    /// Where its axis leaves the trunk, and the unit direction in which it does.
    pub(crate) exit: DVec3,
    pub(crate) direction: DVec3,
    pub(crate) radius: f64,
    pub(crate) lift: f64,
    /// Whether the trunk's rings around it lean towards it.
    pub(crate) leaning: bool,
    /// Whether the branch's path ends here instead of beginning.
    pub(crate) at_end: bool,
}

impl Inset {
    /// Unit direction of the branch's path here.
    pub(crate) fn tangent(&self, direction: DVec3) -> DVec3 {
        if self.at_end { -direction } else { direction }
    }
}

/// A skeleton whose branches leave through insets where they can.
pub(crate) struct Layout {
    pub(crate) skeleton: Skeleton,
    /// By number of [`Root::Inset`](crate::tracing::Root) or
    /// [`Marks::ends_in`](crate::tracing::Marks).
    pub(crate) insets: Vec<Inset>,
    /// By number of the zone: its insets.
    pub(crate) zones: Vec<Vec<u32>>,
    /// Forks that were to have insets, and have no room for them.
    pub(crate) refused: Vec<u32>,
    /// Forks that became thicker than they were traced.
    pub(crate) thickened: Vec<u32>,
    /// First nodes of branches that end inside their trunk, and are left out.
    pub(crate) buried: Vec<u32>,
}

/// Lays a skeleton out. `choices`: by node of the skeleton, those that are no forks included.
pub(crate) fn lay_out(skeleton: &Skeleton, choices: &[ForkChoice]) -> Layout {
    planner::Planner::new(skeleton, choices).plan()
}
