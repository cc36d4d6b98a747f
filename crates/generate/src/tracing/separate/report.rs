//! What was found and what it took.

use std::collections::{BTreeMap, BTreeSet};

use super::rods::Rods;
use super::search::{Contact, Found, SomaContact};
use crate::tracing::{NONE, Skeleton};

/// Where branches were traced through one another, and what moving them apart took.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Separation {
    /// The places, in the order of the tracing.
    pub places: Vec<SeparatedPlace>,
    /// Points that moved by more than a hundredth of their radius, with those that were added.
    pub moved: usize,
    /// Half of these moved by less (µm).
    pub median_move: f64,
    /// None moved by more (µm).
    pub largest_move: f64,
    /// Half of these moved by less (radii).
    pub median_move_radii: f64,
    /// None moved by more (radii).
    pub largest_move_radii: f64,
    /// By what share all neurites together became longer.
    pub length_change: f64,
    /// Whether all contacts were seen: where hundreds of branches lie in one spot, each looks at some of
    /// the others only.
    pub complete: bool,
}

/// A place where two branches were traced through one another, or a branch through a soma.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SeparatedPlace {
    /// The file's own numbers of the samples nearest to where the two were deepest in one another; that of a
    /// soma is its first.
    pub samples: [i64; 2],
    /// How deep (µm) one was within the other, as traced.
    pub before: f64,
    /// How deep it still is (µm); 0 where they are apart.
    pub after: f64,
}

/// What a traced segment meets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Other {
    Segment(u32),
    Soma(u32),
}

/// Two that meet, by numbers of traced segments.
type Meeting = (u32, Other);

/// Depths of all meetings, as traced and at the end.
#[derive(Debug)]
pub(super) struct Depths<'a> {
    traced: &'a Skeleton,
    /// First samples.
    somata: &'a [i64],
    meetings: BTreeMap<Meeting, SeparatedPlace>,
}

impl<'a> Depths<'a> {
    pub(super) fn new(traced: &'a Skeleton, somata: &'a [i64]) -> Self {
        Self {
            traced,
            somata,
            meetings: BTreeMap::new(),
        }
    }

    /// Depths as traced.
    pub(super) fn before(&mut self, rods: &Rods, found: &Found) {
        self.each(rods, found, |place, samples, depth| {
            if depth > place.before {
                (place.samples, place.before) = (samples, depth);
            }
        });
    }

    /// Depths at the end.
    pub(super) fn after(&mut self, rods: &Rods, found: &Found) {
        self.each(rods, found, |place, samples, depth| {
            place.after = place.after.max(depth);
            if place.before == 0.0 {
                place.samples = samples;
            }
        });
    }

    fn each(
        &mut self,
        rods: &Rods,
        found: &Found,
        mut record: impl FnMut(&mut SeparatedPlace, [i64; 2], f64),
    ) {
        let pairs = found.contacts.iter().map(|c| {
            let meeting = (traced(rods, c.a), Other::Segment(traced(rods, c.b)));
            (meeting, samples(rods, c), c.depth)
        });
        let somata = found.somata.iter().map(|c| {
            let meeting = (traced(rods, c.segment), Other::Soma(c.soma));
            (meeting, self.samples_at_soma(rods, c), c.depth)
        });
        let all: Vec<_> = pairs.chain(somata).filter(|m| m.2 > 0.0).collect();
        for (meeting, samples, depth) in all {
            let none = SeparatedPlace {
                samples,
                before: 0.0,
                after: 0.0,
            };
            record(self.meetings.entry(meeting).or_insert(none), samples, depth);
        }
    }

    fn samples_at_soma(&self, rods: &Rods, contact: &SomaContact) -> [i64; 2] {
        let soma = self.somata.get(contact.soma as usize).copied();
        [
            nearest_sample(rods, contact.segment, contact.s),
            soma.unwrap_or(-1),
        ]
    }

    /// Meetings that hang together along both branches are one place.
    fn places(&self) -> Vec<SeparatedPlace> {
        let mut left: BTreeSet<Meeting> = self.meetings.keys().copied().collect();
        let mut places = Vec::new();
        while let Some(first) = left.pop_first() {
            let mut place = self.meetings[&first];
            let mut pending = vec![first];
            while let Some(meeting) = pending.pop() {
                let here = self.meetings[&meeting];
                if here.before > place.before {
                    (place.samples, place.before) = (here.samples, here.before);
                }
                place.after = place.after.max(here.after);
                let beside = self.beside(meeting);
                pending.extend(beside.into_iter().filter(|m| left.remove(m)));
            }
            places.push(place);
        }
        places
    }

    /// Meetings one step away on either side, whether they are there or not.
    fn beside(&self, (a, other): Meeting) -> Vec<Meeting> {
        let near_a = self.near(a);
        match other {
            Other::Soma(_) => near_a.into_iter().map(|a| (a, other)).collect(),
            Other::Segment(b) => {
                let near_b = self.near(b);
                let pair = |a: u32, b: u32| (a.min(b), Other::Segment(a.max(b)));
                near_a
                    .iter()
                    .flat_map(|&a| near_b.iter().map(move |&b| pair(a, b)))
                    .collect()
            }
        }
    }

    /// A traced segment, the one above it, some of those below and beside it.
    fn near(&self, segment: u32) -> Vec<u32> {
        let children = self.traced.children();
        let above = self.traced.node(segment).parent;
        let mut near = vec![segment];
        near.extend(children.of(segment).iter().take(MAX_BESIDE));
        if above != NONE {
            near.push(above);
            near.extend(children.of(above).iter().take(MAX_BESIDE));
        }
        near
    }

    /// The whole report.
    pub(super) fn report(&self, rods: &Rods, complete: bool) -> Separation {
        let moves = rods.nodes().map(|i| {
            let p = &rods.points[i as usize];
            let way = p.node.center.distance(p.rest);
            (way, way / p.node.radius)
        });
        let moves: Vec<(f64, f64)> = moves.filter(|m| m.1 > 0.01).collect();
        let (median_move, largest_move) = median_and_largest(moves.iter().map(|m| m.0));
        let (median_move_radii, largest_move_radii) = median_and_largest(moves.iter().map(|m| m.1));
        let traced = length(self.traced);
        let length_change = if traced > 0.0 {
            length(&rods.skeleton()) / traced - 1.0
        } else {
            0.0
        };
        Separation {
            places: self.places(),
            moved: moves.len(),
            median_move,
            largest_move,
            median_move_radii,
            largest_move_radii,
            length_change,
            complete,
        }
    }
}

/// Branches of a fork that are looked at for places that hang together.
const MAX_BESIDE: usize = 8;

fn traced(rods: &Rods, segment: u32) -> u32 {
    rods.points[segment as usize].traced_segment
}

fn nearest_sample(rods: &Rods, segment: u32, share: f64) -> i64 {
    let point = if share < 0.5 {
        rods.parent(segment)
    } else {
        segment
    };
    rods.points[point as usize].node.sample
}

fn samples(rods: &Rods, contact: &Contact) -> [i64; 2] {
    [(contact.a, contact.s), (contact.b, contact.t)]
        .map(|(i, share)| nearest_sample(rods, i, share))
}

fn median_and_largest(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    let median = values.get(values.len() / 2).copied().unwrap_or(0.0);
    (median, values.last().copied().unwrap_or(0.0))
}

/// Length of all segments (µm).
fn length(skeleton: &Skeleton) -> f64 {
    let nodes = skeleton.nodes().iter().filter(|n| n.parent != NONE);
    nodes
        .map(|n| n.center.distance(skeleton.node(n.parent).center))
        .sum()
}
