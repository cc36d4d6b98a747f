//! Leaves out what a tube of the traced radius cannot show: twigs inside a thicker neurite, forks
//! on top of one another, points closer together than the radius allows.

use glam::DVec3;

use crate::prepare::Ball;
use crate::skeleton::{Children, NONE, Root, Skeleton};
use crate::warning::Warnings;

/// Two forks nearer than this share of the larger radius become one.
const FORKS_APART: f64 = 0.6;
/// Consecutive rings are at least this share of the larger radius apart.
const SPACING: f64 = 0.5;
/// The first ring after a fork is at least this share of the fork's radius away.
const FORK_SPACING: f64 = 1.0;

/// Leaves out twigs that end inside the tubes that they branch from.
pub(crate) fn drop_buried_twigs(skeleton: &mut Skeleton, warnings: &mut Warnings) {
    for _ in 0..3 {
        let children = skeleton.children();
        let mut keep = vec![true; skeleton.nodes.len()];
        let mut dropped = false;
        for fork in 0..skeleton.nodes.len() as u32 {
            let branches = children.of(fork);
            if branches.len() < 2 {
                continue;
            }
            let mut left = branches.len();
            for &branch in branches {
                let tip = run_end(&children, branch);
                if left == 1 || !children.of(tip).is_empty() {
                    continue;
                }
                if buried(skeleton, &children, fork, branch, tip) {
                    left -= 1;
                    dropped = true;
                    mark_run(&children, branch, &mut keep);
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

fn buried(skeleton: &Skeleton, children: &Children, fork: u32, branch: u32, tip: u32) -> bool {
    let (at, end) = (skeleton.node(fork), skeleton.node(tip));
    let reach = end.center.distance(at.center);
    if reach <= at.radius {
        return true;
    }
    if reach > 6.0 * at.radius {
        return false;
    }
    let inside = |other: u32| {
        let other = skeleton.node(other);
        let axis = other.center - at.center;
        let t = ((end.center - at.center).dot(axis) / axis.length_squared()).clamp(0.0, 1.0);
        let radius = at.radius + t * (other.radius - at.radius);
        t.is_finite() && end.center.distance(at.center + axis * t) < 0.9 * radius
    };
    let siblings = children.of(fork).iter().copied().filter(|&c| c != branch);
    let parent = Some(at.parent).filter(|&p| p != NONE);
    siblings.chain(parent).any(inside)
}

/// Joins a fork that lies on top of the one before it to that one.
pub(crate) fn merge_close_forks(skeleton: &mut Skeleton, warnings: &mut Warnings) {
    let children = skeleton.children();
    let mut keep = vec![true; skeleton.nodes.len()];
    // Nearest fork above each node, if the run down to the node may all be left out.
    let mut fork_above: Vec<u32> = vec![NONE; skeleton.nodes.len()];
    for i in 0..skeleton.nodes.len() as u32 {
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
        let apart = FORKS_APART * fork.radius.max(node.radius);
        if node.center.distance(fork.center) >= apart {
            continue;
        }
        let mut here = i;
        while here != above && here != NONE {
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

/// Leaves out ordinary points that are closer to a neighbour than their radius allows.
pub(crate) fn space_points(skeleton: &mut Skeleton, warnings: &mut Warnings) {
    let children = skeleton.children();
    let mut keep = vec![true; skeleton.nodes.len()];
    // Nearest kept node above each node.
    let mut above: Vec<u32> = vec![NONE; skeleton.nodes.len()];
    for i in 0..skeleton.nodes.len() as u32 {
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
        let near = |a: u32| skeleton.node(a).center.distance(node.center) < least(a, i);
        if hub {
            // A fork or end stays: what is too near before it goes.
            while ordinary(skeleton, &children, last) && near(last) {
                keep[last as usize] = false;
                last = above[last as usize];
            }
        } else if near(last) {
            keep[i as usize] = false;
        }
        above[i as usize] = last;
    }
    let dropped = keep.iter().filter(|&&k| !k).count();
    warnings.add_many(
        "dense_points",
        dropped,
        "point nearer to its neighbour than the radius allows: left out of the mesh",
    );
    skeleton.retain(&keep);
}

fn ordinary(skeleton: &Skeleton, children: &Children, node: u32) -> bool {
    let root = skeleton.node(node).root;
    skeleton.node(node).parent != NONE && root == Root::Free && children.of(node).len() == 1
}

/// Passes of turning and leaving out before rings that still cross are accepted.
const PASSES: usize = 12;

/// Turns rings, or leaves points out, until consecutive rings do not cross. Returns the orientation
/// of every node, along the path.
///
/// Ring j must lie in front of ring i's plane and ring i behind ring j's. For circles in planes
/// across oᵢ and oⱼ, with L·e the way from i to j, that is `L e·oⱼ > rᵢ sin γ` and
/// `L e·oᵢ > rⱼ sin γ`, γ the angle between the two.
pub(crate) fn uncross_rings(
    skeleton: &mut Skeleton,
    balls: &[Option<Ball>],
    warnings: &mut Warnings,
) -> Vec<DVec3> {
    for pass in 0.. {
        let children = skeleton.children();
        let mut orientations = orientations(skeleton, &children, balls);
        let mut crossing = crossings(skeleton, &children, &orientations);
        for _ in 0..3 {
            if crossing.is_empty() {
                return orientations;
            }
            turn(skeleton, &children, &crossing, &mut orientations);
            crossing = crossings(skeleton, &children, &orientations);
        }
        let mut keep = vec![true; skeleton.nodes.len()];
        let mut dropped = 0;
        if pass < PASSES {
            for &(i, j) in &crossing {
                let candidates = [i, j].map(|n| cost_of_leaving(skeleton, &children, n));
                let (cost, node) = if candidates[0] <= candidates[1] {
                    (candidates[0], i)
                } else {
                    (candidates[1], j)
                };
                let free = |n: u32| keep[n as usize];
                let parent = skeleton.node(node).parent;
                let apart = parent == NONE || free(parent);
                let apart = apart && children.of(node).iter().all(|&c| free(c));
                if cost < 2.0 * skeleton.node(node).radius && apart && free(node) {
                    keep[node as usize] = false;
                    dropped += 1;
                }
            }
        }
        if dropped == 0 {
            warnings.add_many(
                "rings_cross",
                crossing.len(),
                "path folds back more sharply than its radius allows: the surface crosses itself",
            );
            return orientations;
        }
        warnings.add_many(
            "sharp_bend",
            dropped,
            "bend tighter than the radius: point left out of the mesh",
        );
        skeleton.retain(&keep);
    }
    Vec::new()
}

/// Paper's orientation: the sum of the unit directions in and out; at an end the one there is; at a
/// fork the sum of the children's directions.
fn orientations(skeleton: &Skeleton, children: &Children, balls: &[Option<Ball>]) -> Vec<DVec3> {
    let direction = |from: u32, to: u32| {
        (skeleton.node(to).center - skeleton.node(from).center).try_normalize()
    };
    (0..skeleton.nodes.len() as u32)
        .map(|i| {
            let node = skeleton.node(i);
            if let Root::Insertion(soma) = node.root
                && let Some(ball) = balls[soma as usize]
                && let Some(outwards) = (node.center - ball.center).try_normalize()
            {
                return outwards;
            }
            let incoming = if node.parent == NONE {
                None
            } else {
                direction(node.parent, i)
            };
            let outgoing: DVec3 = children.of(i).iter().filter_map(|&c| direction(i, c)).sum();
            let sum = match children.of(i).len() {
                1 => outgoing + incoming.unwrap_or(DVec3::ZERO),
                _ => outgoing,
            };
            if sum.length() > 0.1 {
                sum.try_normalize().unwrap_or(DVec3::Y)
            } else {
                incoming.or(outgoing.try_normalize()).unwrap_or(DVec3::Y)
            }
        })
        .collect()
}

/// Pairs of parent and child whose rings cross; forks have no ring of their own.
fn crossings(skeleton: &Skeleton, children: &Children, orientations: &[DVec3]) -> Vec<(u32, u32)> {
    let mut pairs = Vec::new();
    for j in 0..skeleton.nodes.len() as u32 {
        let i = skeleton.node(j).parent;
        if i == NONE || children.of(i).len() > 1 || children.of(j).len() > 1 {
            continue;
        }
        let (a, b) = (skeleton.node(i), skeleton.node(j));
        let (oi, oj) = (orientations[i as usize], orientations[j as usize]);
        let way = b.center - a.center;
        let sin = oi.cross(oj).length();
        let sin = if oi.dot(oj) < 0.0 { 1.0 } else { sin };
        let clear = |ahead: f64, radius: f64| ahead > 1.05 * radius * sin;
        if !clear(way.dot(oj), a.radius) || !clear(way.dot(oi), b.radius) {
            pairs.push((i, j));
        }
    }
    pairs
}

/// Turns the rings of crossing pairs half-way towards the segment between them.
fn turn(
    skeleton: &Skeleton,
    children: &Children,
    crossing: &[(u32, u32)],
    orientations: &mut [DVec3],
) {
    for &(i, j) in crossing {
        let way = skeleton.node(j).center - skeleton.node(i).center;
        let Some(way) = way.try_normalize() else {
            continue;
        };
        for n in [i, j] {
            let hub = children.of(n).len() > 1 || skeleton.node(n).parent == NONE;
            if !hub {
                let turned = (orientations[n as usize] + way).try_normalize();
                orientations[n as usize] = turned.unwrap_or(way);
            }
        }
    }
}

/// How far the path moves if a node is left out (µm); infinite for those that may not be.
fn cost_of_leaving(skeleton: &Skeleton, children: &Children, node: u32) -> f64 {
    if !ordinary(skeleton, children, node) {
        return f64::INFINITY;
    }
    skeleton.sideways(children, node)
}
