//! Rings along a path: its own points, and two for each zone.

use super::arrange::Group;
use super::polyline::Polyline;

/// Free way beside a zone's rings, in radii of the trunk.
const BESIDE_ZONE: f64 = 0.35;

/// A ring on a path.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ring {
    pub(super) arc: f64,
    pub(super) what: RingKind,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum RingKind {
    /// A point of the path, by its index.
    Point(usize),
    /// A ring between points, for a zone: the group that begins with it, and the one that ends. With neither it is that
    /// of a branch where it is clear of its trunk.
    Zone(Option<usize>, Option<usize>),
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
) -> Vec<Ring> {
    let last = path.arcs.len() - 1;
    let mut zones = zone_rings(path, groups).into_iter().peekable();
    let mut rings: Vec<Ring> = Vec::with_capacity(last + 2 * groups.len());
    for index in 1..=last {
        let arc = path.arcs[index];
        while let Some(zone) = zones.next_if(|zone| zone.arc <= arc || index == last) {
            give_way(&mut rings, path, zone.arc, BESIDE_ZONE);
            rings.push(zone);
        }
        let end = index == last;
        if !end {
            let in_room = arc >= room[0] && arc <= room[1];
            let beside = BESIDE_ZONE * path.radius(arc);
            let next = groups.partition_point(|g| g.high + beside <= arc);
            let within = groups.get(next).is_some_and(|g| arc > g.low - beside);
            // Points of a path without zones stay as they are: later steps see to them.
            if !groups.is_empty() && (!in_room || within) {
                continue;
            }
        } else if !groups.is_empty() && !is_fixed {
            give_way(&mut rings, path, arc, 0.5);
        }
        rings.push(Ring {
            arc,
            what: RingKind::Point(index),
        });
    }
    rings
}

/// Two rings for each group, or one where the next begins right behind it.
fn zone_rings(path: &Polyline, groups: &[Group]) -> Vec<Ring> {
    let mut rings: Vec<Ring> = Vec::with_capacity(2 * groups.len());
    for (g, group) in groups.iter().enumerate() {
        let near = 0.3 * path.radius(group.low);
        match rings.last_mut() {
            Some(before) if group.low - before.arc < near => {
                before.arc = 0.5 * (before.arc + group.low);
                if let RingKind::Zone(begins, _) = &mut before.what {
                    *begins = Some(g);
                }
            }
            _ => rings.push(Ring {
                arc: group.low,
                what: RingKind::Zone(Some(g), None),
            }),
        }
        rings.push(Ring {
            arc: group.high,
            what: RingKind::Zone(None, Some(g)),
        });
    }
    rings
}

/// Drops a path's own points that lie too near before a ring that must stay.
fn give_way(rings: &mut Vec<Ring>, path: &Polyline, arc: f64, share: f64) {
    let near = share * path.radius(arc);
    while let Some(Ring {
        arc: before,
        what: RingKind::Point(_),
    }) = rings.last()
        && arc - before < near
    {
        rings.pop();
    }
}
