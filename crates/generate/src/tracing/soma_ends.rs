//! Somata that are meshed as neurites: where neurites leave them, and their ends.
//!
//! Neurites hang on any sample in files, at a place far from where they begin. The way there is none of theirs: they leave
//! the tube where they are nearest to it.
//!
//! A soma's frusta end at the last sample with a flat face, tubes with half a ball beyond their last ring. So the last ring
//! is moved in by what the half ball holds, two thirds of a radius. Where a neurite goes on along the axis there is a cone
//! instead, which holds a third of the cylinder around it.

use glam::DVec3;
use neurotess_mesh::SectionNumber;

use super::skeleton::{NONE, Skeleton, SkeletonNode};

/// Length of a cylinder as large as the half ball on it, in radii.
const HALF_BALL: f64 = 2.0 / 3.0;
/// Way, in radii, by which the last ring of an end is moved in that a neurite goes on from; the cone is three times as long.
const CONE: f64 = 0.25;
/// Nearest that a neurite leaves the tube to an end, in radii of the tube.
const BEFORE_END: f64 = 0.7;
/// A neurite goes on along the axis up to this angle from it: its cosine.
const AXIAL: f64 = 0.7;
/// It is at most so thick, as a share of the end's radius.
const THINNER: f64 = 0.7;

/// Hangs neurites of somata where they leave them, and moves ends in.
pub(crate) fn finish(skeleton: &mut Skeleton) {
    let is_soma = |node: &SkeletonNode| node.section == SectionNumber::SOMA;
    if skeleton.nodes().iter().any(is_soma) {
        attach(skeleton);
        draw_in(skeleton);
    }
}

/// A link of a soma, or the end of one.
struct Place {
    /// The node that the link leads to.
    to: u32,
    share: f64,
}

fn attach(skeleton: &mut Skeleton) {
    let nodes = skeleton.nodes();
    let is_soma =
        |index: u32| index != NONE && nodes[index as usize].section == SectionNumber::SOMA;
    let all = || 0..nodes.len() as u32;
    let links: Vec<u32> = all()
        .filter(|&node| is_soma(node) && is_soma(nodes[node as usize].parent))
        .collect();
    let starts = all().filter(|&node| !is_soma(node) && is_soma(nodes[node as usize].parent));
    let of_soma = |node: u32| {
        let near = skeleton.neighbors(node).into_iter();
        near.filter(|&near| is_soma(near)).count()
    };
    let nearest = |start: u32| {
        let place = nodes[start as usize].center;
        let on = links.iter().map(|&to| {
            let [a, b] = [nodes[to as usize].parent, to].map(|node| nodes[node as usize].center);
            let share = ((place - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
            let share = if share.is_finite() { share } else { 0.0 };
            (
                a.lerp(b, share).distance_squared(place),
                Place { to, share },
            )
        });
        on.min_by(|(a, _), (b, _)| a.total_cmp(b))
            .map(|(_, place)| place)
    };
    let mut placed: Vec<(u32, Place)> = Vec::new();
    let mut going_on: Vec<(u32, u32)> = Vec::new();
    for start in starts {
        let Some(mut place) = nearest(start) else {
            continue;
        };
        let ends = [nodes[place.to as usize].parent, place.to];
        let [a, b] = ends.map(|end| nodes[end as usize]);
        let length = a.center.distance(b.center);
        for (side, end) in ends
            .into_iter()
            .enumerate()
            .filter(|&(_, end)| of_soma(end) == 1)
        {
            let way = length * [place.share, 1.0 - place.share][side];
            let margin = BEFORE_END * nodes[end as usize].radius;
            if way >= margin {
                continue;
            }
            let axis = (b.center - a.center).normalize_or_zero() * [-1.0, 1.0][side];
            let goes_on = way == 0.0
                && nodes[start as usize].radius < THINNER * nodes[end as usize].radius
                && onwards(skeleton, start, nodes[end as usize].center).dot(axis) > AXIAL
                && going_on.iter().all(|&(taken, _)| taken != end);
            if goes_on {
                going_on.push((end, start));
            } else {
                let inside = (margin / length).min(0.5);
                place.share = [inside, 1.0 - inside][side];
            }
            break;
        }
        if going_on.last().is_none_or(|&(_, last)| last != start) {
            placed.push((start, place));
        }
    }
    placed.sort_by(|(_, a), (_, b)| a.to.cmp(&b.to).then(a.share.total_cmp(&b.share)));
    let nodes = skeleton.links();
    for link in placed.chunk_by(|(_, a), (_, b)| a.to == b.to) {
        let to = link[0].1.to as usize;
        let [a, b] = [nodes[nodes[to].parent as usize], nodes[to]];
        let mut before = 0.0;
        for (start, Place { share, .. }) in link {
            if *share > before {
                let radius = a.radius + share * (b.radius - a.radius);
                let center = a.center.lerp(b.center, *share);
                let parent = nodes[to].parent;
                nodes[to].parent = nodes.len() as u32;
                nodes.push(SkeletonNode {
                    center,
                    radius,
                    parent,
                    ..b
                });
                before = *share;
            }
            nodes[*start as usize].parent = nodes[to].parent;
        }
    }
    for (end, start) in going_on {
        nodes[start as usize].parent = end;
        go_on(nodes, end, start);
    }
    skeleton.reorder();
}

/// Unit direction of a neurite from the end that it begins at.
fn onwards(skeleton: &Skeleton, start: u32, end: DVec3) -> DVec3 {
    let next = skeleton.children().of(start).first().copied();
    let way = |node: u32| (skeleton.node(node).center - end).try_normalize();
    let far = next.and_then(way).or_else(|| way(start));
    far.unwrap_or(DVec3::ZERO)
}

/// Makes the cone between a soma's end and the neurite that goes on from there.
fn go_on(nodes: &mut Vec<SkeletonNode>, end: u32, start: u32) {
    let [tip, first] = [end, start].map(|node| nodes[node as usize]);
    let inner = (0..nodes.len() as u32).find(|&node| {
        let node = node as usize;
        nodes[node].section == SectionNumber::SOMA
            && (nodes[node].parent == end || tip.parent == node as u32)
    });
    let Some(inner) = inner.map(|inner| nodes[inner as usize]) else {
        return;
    };
    let length = tip.center.distance(inner.center);
    let cut = (CONE * tip.radius).min(0.4 * length);
    let axis = (tip.center - inner.center).normalize_or_zero();
    nodes[end as usize].center = tip.center - axis * cut;
    let narrow = tip.center + axis * (2.0 * cut);
    // What of the neurite lies beside the cone is left out, as points that coincide are.
    let mut here = start as usize;
    while (nodes[here].center - tip.center).dot(axis) < 3.0 * cut {
        nodes[here].center = narrow;
        let mut children = (0..nodes.len()).filter(|&node| nodes[node].parent == here as u32);
        match (children.next(), children.next()) {
            (Some(next), None) => here = next,
            _ => return,
        }
    }
    let parent = nodes[here].parent;
    nodes[here].parent = nodes.len() as u32;
    nodes.push(SkeletonNode {
        center: narrow,
        parent,
        ..first
    });
}

/// Moves free ends in, past samples that are nearer to them.
fn draw_in(skeleton: &mut Skeleton) {
    let nodes = skeleton.nodes();
    let is_soma = |index: u32| nodes[index as usize].section == SectionNumber::SOMA;
    let mut keep = vec![true; nodes.len()];
    let mut moved = Vec::new();
    let ends = (0..nodes.len() as u32).filter(|&index| is_soma(index));
    for end in ends.filter(|&end| skeleton.neighbors(end).len() == 1) {
        let mut left = HALF_BALL * skeleton.node(end).radius;
        let (mut here, mut before, mut passed) = (end, NONE, Vec::new());
        loop {
            let mut next = skeleton.neighbors(here).into_iter();
            let next = next.find(|&next| next != before && is_soma(next));
            let Some(next) = next else { break };
            let [a, b] = [here, next].map(|node| *skeleton.node(node));
            let length = a.center.distance(b.center);
            let is_last = skeleton.neighbors(next).len() != 2;
            if left < length || is_last {
                // Half of the last link stays, however short it is.
                let share = (left / length).min(if is_last { 0.5 } else { 1.0 });
                let share = if share.is_finite() { share } else { 0.0 };
                let radius = a.radius + share * (b.radius - a.radius);
                moved.push((end, a.center.lerp(b.center, share), radius));
                passed
                    .iter()
                    .for_each(|&node: &u32| keep[node as usize] = false);
                break;
            }
            left -= length;
            passed.push(next);
            (before, here) = (here, next);
        }
    }
    let (mut shapes, _) = skeleton.shapes();
    for (end, center, radius) in moved {
        shapes.set_center(end, center);
        shapes.set_radius(end, radius);
    }
    skeleton.retain(&keep);
}
