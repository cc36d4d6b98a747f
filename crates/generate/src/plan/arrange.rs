//! Several branches on one trunk: zones that overlap share their rings or are pushed apart.

use super::polyline::Polyline;
use super::zone::Zone;

/// Zones share their rings if their branches leave at least this far apart around the trunk (cosine
/// of 60°).
const MAX_ALIKE: f64 = 0.5;
/// Lengths (µm) below this one are rounding. A guard.
const ROUNDING: f64 = 1e-9;
/// Branches between the same two rings at most: a ring has four sides, and one stays free to turn.
const MAX_SHARED: usize = 3;

/// Branches between the same two rings of a trunk.
#[derive(Clone, Debug)]
pub(crate) struct Group {
    pub(crate) low: f64,
    pub(crate) high: f64,
    pub(crate) zones: Vec<Zone>,
}

/// Groups zones along a trunk. The forks of those that find no room are the error.
pub(crate) fn arrange(mut zones: Vec<Zone>, trunk: &Polyline) -> Result<Vec<Group>, Vec<u32>> {
    zones.sort_by(|a, b| a.low.total_cmp(&b.low).then(a.child.cmp(&b.child)));
    let mut groups: Vec<Group> = Vec::new();
    let mut crowded = Vec::new();
    for zone in zones {
        match groups.pop() {
            Some(group) if zone.low < group.high - ROUNDING => {
                if fits(&zone, &group, trunk) {
                    groups.push(joined(group, zone));
                    continue;
                }
                let before = groups.last().map(|g| g.high);
                match part(group, zone, before, trunk) {
                    Ok(parted) => groups.extend(parted),
                    Err((group, fork)) => {
                        crowded.push(fork);
                        groups.push(group);
                    }
                }
            }
            last => {
                groups.extend(last);
                groups.push(Group {
                    low: zone.low,
                    high: zone.high,
                    zones: vec![zone],
                });
            }
        }
    }
    if crowded.is_empty() {
        Ok(groups)
    } else {
        Err(crowded)
    }
}

/// Whether a zone may share a group's rings.
fn fits(zone: &Zone, group: &Group, trunk: &Polyline) -> bool {
    let side = zone.side(trunk);
    let mut others = group.zones.iter();
    let apart = others.all(|other| other.side(trunk).dot(side) < MAX_ALIKE);
    let both = group.high.max(zone.high) - group.low.min(zone.low);
    let longer = (group.high - group.low).max(zone.high - zone.low);
    group.zones.len() < MAX_SHARED && apart && both < 2.0 * longer
}

fn joined(mut group: Group, zone: Zone) -> Group {
    group.low = group.low.min(zone.low);
    group.high = group.high.max(zone.high);
    group.zones.push(zone);
    group
}

/// Pushes a zone and the group before it apart, as far as either has room.
fn part(
    mut group: Group,
    mut zone: Zone,
    before: Option<f64>,
    trunk: &Polyline,
) -> Result<[Group; 2], (Group, u32)> {
    let overlap = group.high - zone.low;
    let ahead = zone.room[1] - zone.high;
    let rooms = group.zones.iter().map(|z| z.room[0]);
    let start = before.unwrap_or_else(|| rooms.fold(f64::NEG_INFINITY, f64::max));
    let behind = group.low - start;
    let wanted = if behind >= 0.5 * overlap {
        0.5 * overlap
    } else {
        overlap - behind.max(0.0)
    };
    let up = ahead.min(wanted);
    let down = overlap - up;
    if up < -ROUNDING || down > behind + ROUNDING {
        return Err((group, zone.fork));
    }
    zone.shift(up, trunk);
    for other in &mut group.zones {
        other.shift(-down, trunk);
    }
    group.low -= down;
    group.high -= down;
    let own = Group {
        low: zone.low,
        high: zone.high,
        zones: vec![zone],
    };
    Ok([group, own])
}
