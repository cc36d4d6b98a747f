//! Rings along a path: its own points, and two for each zone.

use glam::DVec3;

use super::arrange::Group;
use super::clearance::FREE_WAY;
use super::path::RingKind;
use super::polyline::Polyline;
use super::zone::Zone;

/// A zone is extended to a bend of more than 15° (its cosine) that is at most this many radii of the trunk before or
/// after it.
const NEAR_BEND: f64 = 0.75;
const BENT: f64 = 0.966;
/// Only where the points before and after the bend are at least so many radii away: where they are nearer the bend is
/// within a short way anyway, and two forks of the sample `motor` would begin with a cleft.
const SPARSE: f64 = 2.0;
/// Only for branches thinner than this share of the trunk: without a limit on it and on how sparse points are, 29 files
/// have 2 % more pairs near forks and 5 % more folds than with this one alone.
const THIN: f64 = 0.6;

/// Where a ring is on a path.
#[derive(Clone, Copy, Debug)]
pub(super) struct RingPlace {
    pub(super) arc: f64,
    pub(super) kind: PlaceKind,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum PlaceKind {
    /// At a point of the path, by its index.
    Point(usize),
    /// Between points.
    Ring(RingKind),
}

/// Point of a path nearest to an arc length.
pub(super) fn nearest(path: &Polyline, arc: f64) -> usize {
    let after = path
        .arcs
        .partition_point(|&a| a < arc)
        .min(path.arcs.len() - 1);
    let before = after.saturating_sub(1);
    if arc - path.arcs[before] < path.arcs[after] - arc {
        before
    } else {
        after
    }
}

/// Rings along a path after its start: its own points where they are far enough from zones and from
/// one another, and two for each zone. `is_fixed`: whether the last one is a joint's or an inset's, for which the room
/// leaves free what it needs.
pub(super) fn rings(
    path: &Polyline,
    groups: &[Group],
    room: [f64; 2],
    is_fixed: bool,
) -> Vec<RingPlace> {
    let last = path.arcs.len() - 1;
    let spans = spans(path, groups, room);
    let mut zones = zone_rings(path, &spans).into_iter().peekable();
    let mut rings: Vec<RingPlace> = Vec::with_capacity(last + 2 * groups.len());
    for index in 1..=last {
        let arc = path.arcs[index];
        while let Some(zone) = zones.next_if(|zone| zone.arc <= arc || index == last) {
            give_way(&mut rings, path, zone.arc, FREE_WAY);
            rings.push(zone);
        }
        let end = index == last;
        if !end {
            let in_room = arc >= room[0] && arc <= room[1];
            let beside = FREE_WAY * path.radius(arc);
            let next = spans.partition_point(|[_, high]| high + beside <= arc);
            let within = spans.get(next).is_some_and(|[low, _]| arc > low - beside);
            // Points of a path without zones stay as they are: later steps see to them.
            if !groups.is_empty() && (!in_room || within) {
                continue;
            }
        } else if !groups.is_empty() && !is_fixed {
            give_way(&mut rings, path, arc, 0.5);
        }
        rings.push(RingPlace {
            arc,
            kind: PlaceKind::Point(index),
        });
    }
    rings
}

/// Arc lengths between which each group's zones are. A zone that ends soon before or after a bend is extended up to it:
/// with a ring between them the bend would be within half a radius, a groove on its inner side.
fn spans(path: &Polyline, groups: &[Group], room: [f64; 2]) -> Vec<[f64; 2]> {
    let mut spans: Vec<[f64; 2]> = groups.iter().map(|group| [group.low, group.high]).collect();
    let is_thin = |zone: &Zone| zone.radius < THIN * zone.trunk_radius;
    for g in (0..spans.len()).filter(|&g| groups[g].zones.iter().all(is_thin)) {
        let [low, high] = spans[g];
        let room = [
            g.checked_sub(1).map_or(room[0], |before| spans[before][1]),
            spans.get(g + 1).map_or(room[1], |after| after[0]),
        ];
        let before = [low - NEAR_BEND * path.radius(low), low];
        let after = [high, high + NEAR_BEND * path.radius(high)];
        spans[g] = [
            bend_within(path, before, room).unwrap_or(low),
            bend_within(path, after, room).unwrap_or(high),
        ];
    }
    spans
}

/// A point of the path, its ends aside, within both ranges of arc lengths at which it bends.
fn bend_within(path: &Polyline, near: [f64; 2], room: [f64; 2]) -> Option<f64> {
    let [from, to] = [near[0].max(room[0]), near[1].min(room[1])];
    let first = path.arcs.partition_point(|&arc| arc < from).max(1);
    let end = path
        .arcs
        .partition_point(|&arc| arc <= to)
        .min(path.arcs.len() - 1);
    let bends = |&point: &usize| {
        let ways = [point - 1, point].map(|a| path.centers[a + 1] - path.centers[a]);
        let lengths = ways.map(DVec3::length);
        let is_sparse = lengths[0].min(lengths[1]) > SPARSE * path.radii[point];
        is_sparse && ways[0].dot(ways[1]) < BENT * lengths[0] * lengths[1]
    };
    (first..end).find(bends).map(|point| path.arcs[point])
}

/// Two rings for each group, or one where the next begins right behind it.
fn zone_rings(path: &Polyline, spans: &[[f64; 2]]) -> Vec<RingPlace> {
    let zone = |begins: Option<usize>, ends: Option<usize>| {
        let [begins, ends] = [begins, ends].map(|group| group.map(|group| group as u32));
        PlaceKind::Ring(RingKind::Zone { begins, ends })
    };
    let mut rings: Vec<RingPlace> = Vec::with_capacity(2 * spans.len());
    for (g, &[low, high]) in spans.iter().enumerate() {
        let near = FREE_WAY * path.radius(low);
        match rings.last_mut() {
            Some(before) if low - before.arc < near => {
                before.arc = 0.5 * (before.arc + low);
                if let PlaceKind::Ring(RingKind::Zone { begins, .. }) = &mut before.kind {
                    *begins = Some(g as u32);
                }
            }
            _ => rings.push(RingPlace {
                arc: low,
                kind: zone(Some(g), None),
            }),
        }
        rings.push(RingPlace {
            arc: high,
            kind: zone(None, Some(g)),
        });
    }
    rings
}

/// Drops a path's own points that lie too near before a ring that must stay.
fn give_way(rings: &mut Vec<RingPlace>, path: &Polyline, arc: f64, share: f64) {
    let near = share * path.radius(arc);
    while let Some(RingPlace {
        arc: before,
        kind: PlaceKind::Point(_),
    }) = rings.last()
        && arc - before < near
    {
        rings.pop();
    }
}
