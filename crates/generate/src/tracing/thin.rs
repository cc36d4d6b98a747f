//! Leaves out what a tube of the traced radius cannot show: twigs inside a thicker neurite, forks
//! on top of one another, points closer together than the radius allows.

use glam::DVec3;

use crate::tracing::{Children, NONE, Root, Skeleton, SkeletonNode};
use crate::warning::Warnings;

/// Consecutive rings are at least this share of the larger radius apart; forks that are nearer become one.
const SPACING: f64 = 0.5;
/// The first ring after a fork is at least this share of the fork's radius away.
const FORK_SPACING: f64 = 1.0;

/// Points of which one is so many times as thick as others to both sides within the least way are a swelling, and no noise of
/// the radii: all stay where their rings have room. Radii that vary by 30 % to both sides reach 1.86.
const SWELLING: f64 = 1.9;
/// Points that are looked at for that, to either side. A guard.
const MAX_BESIDE: usize = 12;

/// Leaves out twigs that end inside the tubes that they branch from.
pub(crate) fn drop_buried_twigs(skeleton: &mut Skeleton, warnings: &mut Warnings) {
    for _ in 0..3 {
        let children = skeleton.children();
        let mut keep = vec![true; skeleton.nodes().len()];
        let mut dropped = false;
        for fork in 0..skeleton.nodes().len() as u32 {
            let branches = children.of(fork);
            if branches.len() < 2 {
                continue;
            }
            let mut left = branches.len();
            let thickest = thickest(skeleton, branches);
            for &branch in branches {
                let tip = run_end(children, branch);
                if left == 1 || !children.of(tip).is_empty() {
                    continue;
                }
                if buried(skeleton, fork, branch, tip, &thickest) {
                    left -= 1;
                    dropped = true;
                    mark_run(children, branch, &mut keep);
                    warnings.add(
                        "buried_twig",
                        Some(skeleton.node(tip).sample),
                        "twig ends inside the neurite that it branches from: left out of the mesh",
                    );
                }
            }
        }
        skeleton.retain(&keep);
        if !dropped {
            break;
        }
    }
}

/// Last node of the unbranched run that starts at `node`.
fn run_end(children: &Children, mut node: u32) -> u32 {
    while let [only] = children.of(node) {
        node = *only;
    }
    node
}

fn mark_run(children: &Children, mut node: u32, keep: &mut [bool]) {
    keep[node as usize] = false;
    while let [only] = children.of(node) {
        node = *only;
        keep[node as usize] = false;
    }
}

/// A twig is looked for inside this many of its siblings, the thickest ones: what is buried lies inside a
/// thick neurite, and a fork of thousands costs no square of them. A guard.
const MAX_SIBLINGS: usize = 16;

fn thickest(skeleton: &Skeleton, branches: &[u32]) -> Vec<u32> {
    let mut thickest = branches.to_vec();
    if thickest.len() > MAX_SIBLINGS {
        let thinner = |a: &u32, b: &u32| {
            let radius = |n: u32| skeleton.node(n).radius;
            radius(*b).total_cmp(&radius(*a)).then(a.cmp(b))
        };
        thickest.select_nth_unstable_by(MAX_SIBLINGS, thinner);
        thickest.truncate(MAX_SIBLINGS);
    }
    thickest
}

fn buried(skeleton: &Skeleton, fork: u32, branch: u32, tip: u32, siblings: &[u32]) -> bool {
    let (at, end) = (skeleton.node(fork), skeleton.node(tip));
    if end.center.distance(at.center) <= at.radius {
        return true;
    }
    let inside = |other: u32| {
        let other = skeleton.node(other);
        let axis = other.center - at.center;
        let t = ((end.center - at.center).dot(axis) / axis.length_squared()).clamp(0.0, 1.0);
        let radius = at.radius + t * (other.radius - at.radius);
        t.is_finite() && end.center.distance(at.center + axis * t) < radius
    };
    let siblings = siblings.iter().copied().filter(|&c| c != branch);
    let parent = Some(at.parent).filter(|&p| p != NONE);
    siblings.chain(parent).any(inside)
}

/// Joins a fork that lies on top of the one before it to that one.
pub(crate) fn merge_close_forks(skeleton: &mut Skeleton, warnings: &mut Warnings) {
    let children = skeleton.children();
    let mut keep = vec![true; skeleton.nodes().len()];
    // Nearest fork above each node, if the run down to the node may all be left out.
    let mut fork_above: Vec<u32> = vec![NONE; skeleton.nodes().len()];
    for i in 0..skeleton.nodes().len() as u32 {
        let node = *skeleton.node(i);
        let above = match node.parent {
            NONE => NONE,
            p if children.of(p).len() > 1 && keep[p as usize] => p,
            p => fork_above[p as usize],
        };
        fork_above[i as usize] = above;
        if children.of(i).len() < 2 || above == NONE {
            continue;
        }
        let fork = *skeleton.node(above);
        let apart = SPACING * fork.radius.max(node.radius);
        if node.center.distance(fork.center) >= apart {
            continue;
        }
        let mut here = i;
        // What is left out already was so up to the same fork.
        while here != above && here != NONE && keep[here as usize] {
            keep[here as usize] = false;
            here = skeleton.node(here).parent;
        }
        warnings.add(
            "close_forks",
            Some(node.sample),
            "fork lies on top of the one before it: joined to it",
        );
    }
    skeleton.retain(&keep);
}

/// Gathers ordinary points that are closer to a neighbor than their radius allows: one stands for them, in their middle
/// and with their mean cross-section. Which one is kept must not tell how thick a neurite is: thin points leave
/// room for one another where thick ones do not, so of radii that vary by 30 % the thin ones stayed.
pub(crate) fn space_points(skeleton: &mut Skeleton, warnings: &mut Warnings) {
    let children = skeleton.children();
    let mut keep = vec![true; skeleton.nodes().len()];
    // Nearest kept node above each node, and the ordinary node that each node is gathered by.
    let mut above: Vec<u32> = vec![NONE; skeleton.nodes().len()];
    let mut gathered: Vec<(u32, u32)> = Vec::new();
    for i in 0..skeleton.nodes().len() as u32 {
        let node = *skeleton.node(i);
        let Some(parent) = Some(node.parent).filter(|&p| p != NONE) else {
            continue;
        };
        let mut last = if keep[parent as usize] {
            parent
        } else {
            above[parent as usize]
        };
        let hub = children.of(i).len() != 1;
        let least = |a: u32, b: u32| {
            let fork = |n: u32| children.of(n).len() > 1;
            let share = if fork(a) || fork(b) {
                FORK_SPACING
            } else {
                SPACING
            };
            share * skeleton.node(a).radius.max(skeleton.node(b).radius)
        };
        let apart = |a: u32| skeleton.node(a).center.distance(node.center);
        let swells = |a: u32| {
            let reach = SPACING * skeleton.node(a).radius.max(node.radius);
            is_at_swelling(skeleton, children, i, reach)
        };
        // Rings beside one another cross where their planes are at an angle.
        let have_room = |a: u32| {
            let angle = half_turn(skeleton, children, a) + half_turn(skeleton, children, i);
            let thick = skeleton.node(a).radius.max(node.radius);
            apart(a) > thick * angle.sin()
        };
        let near = |a: u32| apart(a) < least(a, i) && !(swells(a) && have_room(a));
        if hub {
            // A fork or end stays: what is too near before it goes.
            while ordinary(skeleton, children, last) && near(last) {
                keep[last as usize] = false;
                last = above[last as usize];
            }
        } else if near(last) {
            keep[i as usize] = false;
            if ordinary(skeleton, children, last) {
                gathered.push((last, i));
            }
        }
        above[i as usize] = last;
    }
    let dropped = keep.iter().filter(|&&k| !k).count();
    warnings.add_many(
        "dense_points",
        dropped,
        "point nearer to its neighbor than the radius allows: one stands for several",
    );
    gathered.sort_unstable();
    for group in gathered.chunk_by(|a, b| a.0 == b.0) {
        let points = [group[0].0]
            .into_iter()
            .chain(group.iter().map(|&(_, i)| i));
        gather(skeleton, &points.collect::<Vec<u32>>());
    }
    skeleton.retain(&keep);
    lower_peaks(skeleton);
}

/// Whether the path through a node swells and thins again, up to a distance (µm) from it to either side, or the least way of
/// what is thicker there, and one point beyond.
fn is_at_swelling(skeleton: &Skeleton, children: &Children, from: u32, reach: f64) -> bool {
    let center = skeleton.node(from).center;
    let beside = |next: &dyn Fn(u32) -> Option<u32>| {
        let (mut here, mut radii, mut reach) = (from, Vec::with_capacity(MAX_BESIDE), reach);
        while let Some(there) = next(here).filter(|_| radii.len() < MAX_BESIDE) {
            radii.push(skeleton.node(there).radius);
            let way = skeleton.node(there).center.distance(center);
            if way > reach {
                break;
            }
            reach = reach.max(way + SPACING * skeleton.node(there).radius);
            here = there;
        }
        radii
    };
    let mut radii = beside(&|node| Some(skeleton.node(node).parent).filter(|&p| p != NONE));
    radii.reverse();
    radii.push(skeleton.node(from).radius);
    radii.extend(beside(&|node| match *children.of(node) {
        [next] => Some(next),
        _ => None,
    }));
    let peak = (0..radii.len()).max_by(|&a, &b| radii[a].total_cmp(&radii[b]));
    peak.is_some_and(|peak| {
        let least = |side: &[f64]| side.iter().copied().fold(f64::INFINITY, f64::min);
        let valley = least(&radii[..peak]).max(least(&radii[peak..]));
        radii[peak] > SWELLING * valley
    })
}

/// Lowers points that are far thicker than both neighbors: drawn round, they hold more than their two cones. Polygons of the
/// usual level hold less than circles by half of that. From a thin point with radius a to a peak d above it and back,
/// the radius is a cubic without a slope at its ends, whose square has the mean a² + a d + 13/35 d²; a cone's is
/// a² + a d + d²/3.
fn lower_peaks(skeleton: &mut Skeleton) {
    const ROUND: f64 = 13.0 / 35.0;
    let count = skeleton.nodes().len() as u32;
    let (mut shapes, children) = skeleton.shapes();
    let mut lowered = Vec::new();
    for index in 0..count {
        let node = shapes.node(index);
        let &[next] = children.of(index) else {
            continue;
        };
        if node.parent == NONE {
            continue;
        }
        let beside = [node.parent, next].map(|near| shapes.node(near).radius);
        let thickest = beside[0].max(beside[1]);
        if node.radius > SWELLING * thickest {
            let thin = f64::midpoint(beside[0], beside[1]);
            let above = node.radius - thin;
            let cone = thin * above + above * above / 3.0;
            let round = ((thin * thin + 4.0 * ROUND * cone).sqrt() - thin) / (2.0 * ROUND);
            lowered.push((index, f64::midpoint(thin + round, node.radius)));
        }
    }
    for (index, radius) in lowered {
        shapes.set_radius(index, radius);
    }
}

/// Moves the first of some points to the middle of all, and gives it their mean cross-section and the label of the one
/// nearest there.
fn gather(skeleton: &mut Skeleton, points: &[u32]) {
    let nodes = points.iter().map(|&point| *skeleton.node(point));
    let count = points.len() as f64;
    let center = nodes.clone().map(|node| node.center).sum::<DVec3>() / count;
    let square = nodes.clone().map(|node| node.radius.powi(2)).sum::<f64>() / count;
    let off = |node: &SkeletonNode| node.center.distance_squared(center);
    let Some(nearest) = nodes.min_by(|a, b| off(a).total_cmp(&off(b))) else {
        return;
    };
    skeleton.set_point(points[0], nearest, center, square.sqrt());
}

/// Half of the angle (radians) by which an ordinary node's path turns there; none at others.
fn half_turn(skeleton: &Skeleton, children: &Children, node: u32) -> f64 {
    let (parent, &[next]) = (skeleton.node(node).parent, children.of(node)) else {
        return 0.0;
    };
    if parent == NONE {
        return 0.0;
    }
    let center = |node: u32| skeleton.node(node).center;
    let [before, after] = [center(node) - center(parent), center(next) - center(node)];
    let angle = before.angle_between(after);
    if angle.is_finite() { 0.5 * angle } else { 0.0 }
}

fn ordinary(skeleton: &Skeleton, children: &Children, node: u32) -> bool {
    let root = skeleton.node(node).root;
    skeleton.node(node).parent != NONE && root == Root::Free && children.of(node).len() == 1
}
