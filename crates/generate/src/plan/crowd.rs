//! Crowded joints, whose branches are too close for one joint, split over several that paths without rings between
//! them join.
//!
//! More than [`MAX_NEIGHBORS`] arms are halved by direction, again and again, so that thousands of them take n log n
//! steps. Of fewer the nearest pair moves to a new joint where it is too near for one.

use std::collections::BTreeSet;

use glam::DVec3;

use super::MAX_NEIGHBORS;
use super::joint::plane;
use super::path::{Arm, Joint, Origin, Path, PathEnd, Plan};
use crate::warning::Warnings;

/// Least angle about the joint's normal between two of four or more neighbors (radians).
const MIN_ANGLE: f64 = 0.35;

/// Splits joints of four and more arms until these are far enough apart. Each split takes arms from a joint and makes
/// one of three, which is never split, so that this ends.
pub(crate) fn split_crowded_joints(plan: &mut Plan, warnings: &mut Warnings) {
    let crowded = |joint: &u32| plan.joints[*joint as usize].arms.len() > 3;
    let mut pending: BTreeSet<u32> = (0..plan.joints.len() as u32).filter(crowded).collect();
    while !pending.is_empty() {
        let mut touched = BTreeSet::new();
        for joint in std::mem::take(&mut pending) {
            if plan.split(joint, &mut touched) {
                warnings.add(
                    "fork_split",
                    Some(plan.joints[joint as usize].label.sample),
                    "fork with branches too close to tell apart: split in two by a short segment",
                );
            }
        }
        pending = touched;
    }
}

impl Plan {
    /// Splits a joint once if it is crowded; the joints that see another neighbor now go to `touched`.
    fn split(&mut self, joint: u32, touched: &mut BTreeSet<u32>) -> bool {
        let arms = self.joints[joint as usize].arms.clone();
        if arms.len() < 4 {
            return false;
        }
        let directions = self.directions(joint, &arms);
        if arms.len() > MAX_NEIGHBORS {
            self.halve_all(joint, touched);
        } else if plane(&directions).1 < MIN_ANGLE {
            let pair = nearest_pair(&directions).map(|slot| arms[slot]);
            let new = self.branch_off(joint, &pair);
            let beyond = pair.into_iter().filter_map(|arm| self.joint_beyond(arm));
            touched.extend(beyond.chain([joint, new]));
        } else {
            return false;
        }
        true
    }

    /// Unit directions from a joint along arms of it.
    fn directions(&self, joint: u32, arms: &[Arm]) -> Vec<DVec3> {
        let center = self.joints[joint as usize].center;
        let direction = |&arm: &Arm| {
            let way = self.first_center(arm) - center;
            way.try_normalize().unwrap_or(DVec3::Y)
        };
        arms.iter().map(direction).collect()
    }

    /// Center of the first ring of an arm.
    fn first_center(&self, arm: Arm) -> DVec3 {
        self.paths[arm.path as usize].rings[self.first_ring(arm)].center
    }

    /// The joint at the other end of an arm without rings between.
    fn joint_beyond(&self, arm: Arm) -> Option<u32> {
        let path = &self.paths[arm.path as usize];
        match path.end_at(self.first_ring(arm)) {
            PathEnd::Joint(joint) => Some(joint),
            PathEnd::Free | PathEnd::Soma(_) | PathEnd::Inset(_) => None,
        }
    }

    /// Halves a joint, and those that come of it, until each is small enough.
    fn halve_all(&mut self, joint: u32, touched: &mut BTreeSet<u32>) {
        let mut large = vec![joint];
        while let Some(joint) = large.pop() {
            let arms = self.joints[joint as usize].arms.clone();
            // The parent's arm stays, or one of the children: a joint of two arms would be a path.
            for new in self.halve(joint, &arms[1..]) {
                match self.joints[new as usize].arms.len() <= MAX_NEIGHBORS {
                    true => touched.extend([new]),
                    false => large.push(new),
                }
            }
            touched.insert(joint);
        }
    }

    /// Moves arms to two new joints, by the axis along which their directions differ most.
    fn halve(&mut self, joint: u32, arms: &[Arm]) -> [u32; 2] {
        let directions = self.directions(joint, arms);
        let axis = widest_axis(&directions);
        let mut slots: Vec<usize> = (0..arms.len()).collect();
        let middle = slots.len() / 2;
        slots.select_nth_unstable_by(middle, |&a, &b| {
            let along = directions[a][axis].total_cmp(&directions[b][axis]);
            along.then(a.cmp(&b))
        });
        let (low, high) = slots.split_at_mut(middle);
        [low, high].map(|half| {
            half.sort_unstable(); // arms keep their order
            let arms: Vec<Arm> = half.iter().map(|&slot| arms[slot]).collect();
            self.branch_off(joint, &arms)
        })
    }

    /// Moves arms of a joint, the parent's perhaps the first of them, to a new joint a little way towards them, and
    /// links the two.
    fn branch_off(&mut self, joint: u32, arms: &[Arm]) -> u32 {
        let directions = self.directions(joint, arms);
        let at = self.joints[joint as usize].clone();
        let distances = arms
            .iter()
            .map(|&arm| self.first_center(arm).distance(at.center));
        let shortest = distances.fold(f64::INFINITY, f64::min);
        let mean = directions.iter().sum::<DVec3>().try_normalize();
        let towards = mean.unwrap_or(directions[0]);
        let (new, link) = (self.joints.len() as u32, self.paths.len() as u32);
        let moved: BTreeSet<u32> = arms.iter().map(|arm| arm.path).collect();
        let mut left = at.arms.clone();
        left.retain(|arm| !moved.contains(&arm.path));
        // The new joint lies between the parent and the old one, or between that and children.
        let is_above = arms[0].at_end;
        let [upper, lower] = if is_above { [new, joint] } else { [joint, new] };
        let arm = |at_end: bool| Arm { path: link, at_end };
        let mut arms = arms.to_vec();
        match is_above {
            true => {
                left.insert(0, arm(true));
                arms.insert(1, arm(false));
            }
            false => {
                left.push(arm(false));
                arms.insert(0, arm(true));
            }
        }
        self.joints[joint as usize].arms = left;
        self.joints.push(Joint {
            center: at.center + towards * at.radius.min(0.5 * shortest),
            arms,
            ..at
        });
        self.origins.push(Origin::Joint(new));
        self.paths.push(Path {
            start: PathEnd::Joint(upper),
            rings: [upper, lower]
                .map(|n| self.joints[n as usize].ring())
                .to_vec(),
            end: PathEnd::Joint(lower),
            changes: Vec::new(),
            zones: Vec::new(),
        });
        self.attach(new);
        new
    }

    /// Lets the paths of a joint's arms begin and end in it.
    fn attach(&mut self, joint: u32) {
        let at = &self.joints[joint as usize];
        let ring = at.ring();
        for &Arm { path, at_end } in &at.arms {
            let path = &mut self.paths[path as usize];
            let (end, slot) = match at_end {
                true => (&mut path.end, path.rings.last_mut()),
                false => (&mut path.start, path.rings.first_mut()),
            };
            *end = PathEnd::Joint(joint);
            if let Some(slot) = slot {
                *slot = ring;
            }
        }
    }
}

/// The pair of directions that enclose the least angle.
fn nearest_pair(directions: &[DVec3]) -> [usize; 2] {
    let (mut pair, mut nearest) = ([0, 1], f64::NEG_INFINITY);
    for a in 0..directions.len() {
        for b in a + 1..directions.len() {
            let near = directions[a].dot(directions[b]);
            if near > nearest {
                (pair, nearest) = ([a, b], near);
            }
        }
    }
    pair
}

/// The axis along which directions differ most.
fn widest_axis(directions: &[DVec3]) -> usize {
    let low = directions.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = directions
        .iter()
        .copied()
        .fold(DVec3::NEG_INFINITY, DVec3::max);
    let extent = high - low;
    let axes = [0, 1, 2].into_iter();
    axes.max_by(|&a, &b| extent[a].total_cmp(&extent[b]))
        .expect("there are three axes")
}
