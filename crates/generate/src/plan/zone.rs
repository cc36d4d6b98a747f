//! The zone of a branch on its trunk: where it leaves, in which direction, and between which two
//! rings of the trunk the quad lies that it leaves through.

use glam::DVec3;

use super::clearance::FREE_WAY;
use super::cone::{RoundCone, distance, outwards};
use super::polyline::Polyline;
use super::shape::{InsetShape, InsetSite, MIN_STEEP, not_too_steep};

/// Stretch of the trunk that is looked at to either side, in its radii.
pub(super) const TRUNK_REACH: f64 = 8.0;
/// Stretch of the branch, in the same radii; and where all of that lies within the trunk, as of siblings side by
/// side. With 40 `vd130423` has a third more folds at forks, with 200 no fewer.
const BRANCH_REACH: f64 = 12.0;
const FARTHEST: f64 = 80.0;
/// Stretch of the branch before its exit and after it that tells its direction, in its radii. With 1 and 1, 5 % more facets
/// cross near forks at level 4, and with 1 and 2, 9 %.
const DIRECTION_WAY: [f64; 2] = [0.75, 1.5];
/// Steps of the walk out of the trunk at most: thin branches of thick trunks take finer ones. A guard.
const MAX_STEPS: f64 = 2000.0;
/// What leaves a trunk through an inset is at most so thick, as a share of the trunk: else there is a joint. A fork whose
/// children are its trunk counts as the trunk up to as much thicker than they are. Up to 1.05, as branches of parents, six
/// forks of twelve cells have 3.7 % more of their area off the blended surface in the mean, and none less.
pub(super) const MAX_RATIO: f64 = 1.2;

/// A branch on a trunk.
#[derive(Clone, Debug)]
pub(crate) struct Zone {
    /// Arc length on the trunk of the point nearest to the exit.
    pub(crate) foot: f64,
    /// Where the branch's axis leaves the trunk.
    pub(crate) exit: DVec3,
    /// Unit direction in which it does.
    pub(crate) direction: DVec3,
    /// Radius of the branch, and of the trunk at the foot.
    pub(crate) radius: f64,
    pub(crate) trunk_radius: f64,
    /// Arc lengths of the two rings.
    pub(crate) low: f64,
    pub(crate) high: f64,
    /// Arc lengths between which they may be.
    pub(crate) room: [f64; 2],
    /// Fork and first node of the branch.
    pub(crate) fork: u32,
    pub(crate) child: u32,
    /// Whether that node is the fork's parent.
    pub(crate) upward: bool,
    pub(crate) lift: f64,
    /// The inset's shape and how the branch goes on from it, once known; not any more where the zone was moved.
    pub(super) onward: Option<(InsetShape, Beginning)>,
}

/// How a branch goes on from its inset.
#[derive(Clone, Copy, Debug)]
pub(super) enum Beginning {
    /// At a node that is clear of the trunk.
    At(u32),
    /// It ends before: at a ring right ahead, with the last node's attributes.
    Ends(u32),
}

impl Beginning {
    /// Whether it is at this node.
    pub(super) fn is_at(self, node: u32) -> bool {
        matches!(self, Self::At(at) if at == node)
    }
}

/// What there is instead of a zone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NoZone {
    /// All of the branch that was looked at lies within the trunk.
    Inside,
    /// The trunk has no room for it.
    NoRoom,
}

/// A branch as it leaves its trunk.
pub(crate) struct Branch<'a> {
    pub(crate) fork: u32,
    pub(crate) child: u32,
    /// Whether that node is the fork's parent.
    pub(crate) upward: bool,
    /// From the fork along its main children, or up its parents, with the radius of its first point throughout.
    pub(crate) path: &'a Polyline,
    pub(crate) radius: f64,
    pub(crate) lift: f64,
}

impl Branch<'_> {
    /// The zone on `trunk`, whose fork lies at arc length `at`; `room`: arc lengths that are free.
    pub(crate) fn zone(&self, trunk: &Polyline, at: f64, room: [f64; 2]) -> Result<Zone, NoZone> {
        let (exit_arc, cones, around) = self.way_out(trunk, at)?;
        let exit = self.path.at(exit_arc);
        let [before, after] = DIRECTION_WAY.map(|way| way * self.radius);
        let way = self.path.at(exit_arc + after) - self.path.at((exit_arc - before).max(0.0));
        let normal = outwards(&cones, exit, self.radius);
        let direction = not_too_steep(way.try_normalize().unwrap_or(normal), normal);
        let around = [around[0].max(0.0), around[1].min(trunk.length())];
        let foot = trunk.foot(exit, around);
        let trunk_radius = trunk.radius(foot);
        if self.radius >= MAX_RATIO * trunk_radius {
            return Err(NoZone::NoRoom);
        }
        let tangent = trunk.tangent(foot, 0.5 * trunk_radius);
        let slant = 1.0 / direction.dot(normal).max(MIN_STEEP);
        let leaning = direction.dot(tangent);
        let half = (self.radius * (slant + 0.5)).max(0.5 * trunk_radius);
        let center = foot + 0.5 * self.lift * self.radius * leaning * slant;
        let beside = FREE_WAY * trunk_radius;
        let room = [room[0] + beside, room[1] - beside];
        if room[1] - room[0] < 2.0 * half {
            return Err(NoZone::NoRoom);
        }
        let middle = center.clamp(room[0] + half, room[1] - half);
        let shift = middle - center;
        if shift.abs() > 2.0 * trunk_radius + self.radius {
            return Err(NoZone::NoRoom);
        }
        let mut zone = Zone {
            foot,
            exit,
            direction,
            radius: self.radius,
            trunk_radius,
            low: middle - half,
            high: middle + half,
            room,
            fork: self.fork,
            child: self.child,
            upward: self.upward,
            lift: self.lift,
            onward: None,
        };
        zone.move_exit(shift, trunk);
        Ok(zone)
    }

    /// Arc length at which the branch leaves the trunk, and the trunk's cones around, with their arc lengths.
    fn way_out(
        &self,
        trunk: &Polyline,
        at: f64,
    ) -> Result<(f64, Vec<RoundCone>, [f64; 2]), NoZone> {
        let near = trunk.radius(at);
        let within = |branch_reach: f64, trunk_reach: f64| {
            let around = [at - trunk_reach * near, at + trunk_reach * near];
            let cones = trunk.cones(around);
            let exit = self.exit(near, branch_reach, |p| distance(&cones, p))?;
            Ok((exit, cones, around))
        };
        match within(BRANCH_REACH, TRUNK_REACH) {
            Err(NoZone::NoRoom) => {
                let far = FARTHEST.min(self.path.length() / near);
                within(far, far + TRUNK_REACH)
            }
            known => known,
        }
    }

    /// Arc length at which the branch leaves the trunk for good, or for twice the trunk's radius; within `most` of
    /// these radii.
    fn exit(
        &self,
        trunk_radius: f64,
        most: f64,
        outside: impl Fn(DVec3) -> f64,
    ) -> Result<f64, NoZone> {
        let reach = self.path.length().min(most * trunk_radius);
        let step = (0.25 * self.radius.min(trunk_radius)).max(most * trunk_radius / MAX_STEPS);
        let lasting = (2.0 * trunk_radius / step) as usize + 1;
        let count = (reach / step).ceil() as usize;
        let (mut first, mut inside) = (None, None);
        let mut run = 0;
        let mut walk = self.path.walk();
        for i in 0..=count {
            if outside(walk(i as f64 * step)) > 0.0 {
                first = first.or(Some(i));
                run += 1;
                if run == lasting {
                    break;
                }
            } else {
                inside = Some(i);
                run = 0;
            }
        }
        let Some(first) = first else {
            // Farther out it may well leave the trunk.
            let all = self.path.length() <= reach;
            return Err(if all { NoZone::Inside } else { NoZone::NoRoom });
        };
        // Outside up to the end of what was looked at, however short, counts as for good.
        let first = match inside {
            Some(inside) if run > 0 => inside + 1,
            _ => first,
        };
        let (mut low, mut high) = (first.saturating_sub(1) as f64 * step, first as f64 * step);
        for _ in 0..20 {
            let middle = 0.5 * (low + high);
            if outside(self.path.at(middle)) > 0.0 {
                high = middle;
            } else {
                low = middle;
            }
        }
        Ok(high)
    }
}

impl Zone {
    /// Cones of the trunk around it.
    pub(crate) fn cones(&self, trunk: &Polyline) -> Vec<RoundCone> {
        let reach = TRUNK_REACH * self.trunk_radius;
        trunk.cones([self.foot - reach, self.foot + reach])
    }

    /// What the inset's ring is made of, on the trunk as traced.
    pub(crate) fn site(&self, trunk: &Polyline) -> InsetSite {
        InsetSite {
            exit: self.exit,
            direction: self.direction,
            radius: self.radius,
            lift: self.lift,
            along: trunk.tangent(self.foot, 0.5 * self.trunk_radius),
        }
    }

    /// Moves the exit along the trunk, and the foot with it.
    fn move_exit(&mut self, by: f64, trunk: &Polyline) {
        let to = (self.foot + by).clamp(0.0, trunk.length());
        self.exit += trunk.at(to) - trunk.at(self.foot);
        self.foot = to;
    }

    /// Moves all of it along the trunk.
    pub(crate) fn shift(&mut self, by: f64, trunk: &Polyline) {
        self.move_exit(by, trunk);
        self.onward = None;
        self.low += by;
        self.high += by;
    }

    /// Unit direction of the exit from the trunk's axis.
    pub(crate) fn side(&self, trunk: &Polyline) -> DVec3 {
        let way = self.exit - trunk.at(self.foot);
        way.try_normalize().unwrap_or(DVec3::Y)
    }
}
