//! The plan as data: paths of rings, the joints and insets that they begin and end in.

use glam::DVec3;
use neurotess_mesh::{SectionNumber, SwcType};

use super::joint::Neighbor;
use crate::tracing::SkeletonNode;

/// All that becomes tubes.
#[derive(Debug, Default)]
pub(crate) struct Plan {
    pub(crate) paths: Vec<Path>,
    pub(crate) joints: Vec<Joint>,
    pub(crate) insets: Vec<Inset>,
    /// Where tubes begin that do not wait for a trunk, in the order of the tracing.
    pub(crate) origins: Vec<Origin>,
    /// Forks that were to have insets, and have no room for them.
    pub(crate) refused: Vec<u32>,
    /// Forks that became thicker than they were traced.
    pub(crate) thickened: Vec<u32>,
    /// First nodes of branches that end inside their trunk, and are left out.
    pub(crate) buried: Vec<u32>,
}

/// Where paths begin.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Origin {
    /// The path of a root of the tracing.
    Root(u32),
    /// The paths that leave a joint.
    Joint(u32),
}

/// Rings in a row, from one end to the other.
#[derive(Clone, Debug)]
pub(crate) struct Path {
    pub(crate) start: PathEnd,
    /// Two or more. The first and the last stand for what the path begins and ends in: a joint's is at its center.
    pub(crate) rings: Vec<PlannedRing>,
    pub(crate) end: PathEnd,
    /// Where along the tracing the section changes (µm, as `arc` of the rings).
    pub(crate) changes: Vec<f64>,
    /// Insets of each zone, the stretch between two rings where branches leave.
    pub(crate) zones: Vec<Vec<u32>>,
}

/// What a path begins or ends in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PathEnd {
    /// Nothing: the tube is closed by a cap.
    Free,
    /// A soma's surface.
    Soma(u32),
    Joint(u32),
    Inset(u32),
}

impl PathEnd {
    pub(crate) fn is_joint(self) -> bool {
        matches!(self, Self::Joint(_))
    }

    pub(crate) fn inset(self) -> Option<u32> {
        match self {
            Self::Inset(inset) => Some(inset),
            Self::Free | Self::Soma(_) | Self::Joint(_) => None,
        }
    }
}

impl Path {
    /// Index of the last ring.
    pub(crate) fn last(&self) -> usize {
        self.rings.len() - 1
    }

    /// What the path begins or ends in at a ring; nothing between the ends.
    pub(crate) fn end_at(&self, ring: usize) -> PathEnd {
        match ring {
            0 => self.start,
            _ if ring == self.last() => self.end,
            _ => PathEnd::Free,
        }
    }

    /// Zones with their first rings.
    pub(crate) fn zones(&self) -> impl Iterator<Item = (usize, &[u32])> {
        let begins = self.rings.iter().enumerate();
        begins.filter_map(|(ring, planned)| match planned.kind {
            RingKind::Zone {
                begins: Some(zone), ..
            } => Some((ring, &self.zones[zone as usize][..])),
            _ => None,
        })
    }
}

/// A ring to be.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlannedRing {
    /// µm.
    pub(crate) center: DVec3,
    /// µm.
    pub(crate) radius: f64,
    /// Unit normal of its plane, along the path; of a joint's end without meaning.
    pub(crate) normal: DVec3,
    pub(crate) label: Label,
    /// Node of the tracing that it stands for, or the nearest.
    pub(crate) node: u32,
    /// How far along the path it is, as traced (µm); of a ring that a joint or an inset stands for without meaning but at
    /// the start.
    pub(crate) arc: f64,
    pub(crate) kind: RingKind,
    /// At a bend, from the center to the corner on its inner side, in radii: see creases.rs.
    pub(crate) crease: Option<DVec3>,
}

/// Why there is a ring.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum RingKind {
    /// A traced point, or what the path begins or ends in.
    Traced,
    /// A zone begins or ends here, or one of each: it must stay.
    Zone {
        begins: Option<u32>,
        ends: Option<u32>,
    },
    /// The branch is clear of its trunk here, which its inset leans over.
    Upright,
    /// One of the two at a sharp bend.
    Bend,
}

impl PlannedRing {
    /// A ring at a node of the tracing.
    pub(crate) fn at(index: u32, node: &SkeletonNode) -> Self {
        Self {
            center: node.center,
            radius: node.radius,
            normal: DVec3::ZERO,
            label: Label::of(node),
            node: index,
            arc: 0.0,
            kind: RingKind::Traced,
            crease: None,
        }
    }

    /// Whether it is one of a zone's two rings.
    pub(crate) fn is_of_zone(&self) -> bool {
        matches!(self.kind, RingKind::Zone { .. })
    }
}

/// What a ring tells of the tracing.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Label {
    /// The file's own number of the sample.
    pub(crate) sample: i64,
    pub(crate) kind: SwcType,
    pub(crate) section: SectionNumber,
}

impl Label {
    pub(crate) fn of(node: &SkeletonNode) -> Self {
        Self {
            sample: node.sample,
            kind: node.kind,
            section: node.section,
        }
    }
}

/// Three or more paths that meet at a point.
#[derive(Clone, Debug)]
pub(crate) struct Joint {
    /// µm.
    pub(crate) center: DVec3,
    /// µm.
    pub(crate) radius: f64,
    /// Unit direction in which its tracing point looks: that of its children.
    pub(crate) normal: DVec3,
    pub(crate) label: Label,
    /// Its fork in the tracing.
    pub(crate) fork: u32,
    /// The one that ends in it, if any, is first.
    pub(crate) arms: Vec<Arm>,
}

/// An end of a path, in a joint.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arm {
    pub(crate) path: u32,
    /// Whether it is the path's last ring.
    pub(crate) at_end: bool,
}

impl Joint {
    /// The ring that stands for it in its paths.
    pub(crate) fn ring(&self) -> PlannedRing {
        PlannedRing {
            center: self.center,
            radius: self.radius,
            normal: self.normal,
            label: self.label,
            node: self.fork,
            arc: 0.0,
            kind: RingKind::Traced,
            crease: None,
        }
    }
}

impl Plan {
    /// The ring next to a joint on an arm: its number on the path.
    pub(crate) fn first_ring(&self, arm: Arm) -> usize {
        match arm.at_end {
            true => self.paths[arm.path as usize].last() - 1,
            false => 1,
        }
    }

    /// What a joint needs to know of what it joins, by arm.
    pub(crate) fn neighbors(&self, joint: &Joint) -> Vec<Neighbor> {
        let neighbor = |&arm: &Arm| {
            let (path, first) = (&self.paths[arm.path as usize], self.first_ring(arm));
            let ring = &path.rings[first];
            // Two joints share the way between them.
            let share = if path.end_at(first).is_joint() {
                0.5
            } else {
                1.0
            };
            Neighbor::new(joint.center, ring.center, ring.radius, share)
        };
        joint.arms.iter().map(neighbor).collect()
    }
}

/// The ring that a branch begins with, or a parent ends with, on its trunk.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Inset {
    /// Fork of the tracing.
    pub(crate) fork: u32,
    /// Where its axis leaves the trunk, and the unit direction in which it does.
    pub(crate) exit: DVec3,
    pub(crate) direction: DVec3,
    /// µm.
    pub(crate) radius: f64,
    /// Height over the trunk, in radii.
    pub(crate) lift: f64,
    /// Whether the trunk's rings around it lean towards it.
    pub(crate) leaning: bool,
    /// Whether the branch's path ends here instead of beginning.
    pub(crate) at_end: bool,
    /// The branch's path.
    pub(crate) path: u32,
}

impl Inset {
    /// Unit direction of the branch's path here.
    pub(crate) fn tangent(&self, direction: DVec3) -> DVec3 {
        if self.at_end { -direction } else { direction }
    }
}
