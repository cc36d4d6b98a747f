//! Which segments run into one another, though they do not belong together, and which into a soma.
//!
//! Candidates come from a tree of boxes; n log n steps and one for each candidate. Where hundreds of
//! segments lie in one place each looks at some of the others only, and the search says so.

use std::ops::ControlFlow;

use glam::DVec3;

use super::boxes::{Bounds, Boxes};
use super::geometry::{closest, nearest_to};
use super::paths::OnSegment;
use super::rods::Rods;
use crate::tracing::SomaSphere;

/// Two segments may touch if the way between them is at most this many times the sum of their radii: a
/// branch leaves its parent's surface only after such a way.
const MAX_WAY: f64 = 2.0;
/// A neurite may touch its own soma up to this way from it: so many of its radii, and of the soma's.
const OWN_WAY: (f64, f64) = (3.0, 0.25);
/// The soma bulges towards its neurites: it reaches this many of its radii. With 1 it crosses two branches of IF4_140201.
pub(super) const SOMA_REACH: f64 = 1.1;
/// Boxes that one segment looks at, at most, and contacts that it may have with segments after it. A guard.
pub(super) const MAX_LOOKS: usize = 256;
const MAX_CONTACTS: usize = 32;
/// Boxes that all somata look at, for each segment of the cell. A guard.
const SOMA_LOOKS: usize = 64;

/// Two segments that may not touch, by their lower ends, `a` before `b`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Contact {
    pub(super) a: u32,
    pub(super) b: u32,
    /// Shares of the way from the upper ends where the two are nearest.
    pub(super) s: f64,
    pub(super) t: f64,
    /// How far one is within the other (µm); negative: how far apart they are.
    pub(super) depth: f64,
}

/// A segment near a soma that it does not belong to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SomaContact {
    pub(super) segment: u32,
    pub(super) soma: u32,
    /// Share of the way from the upper end where it is nearest.
    pub(super) s: f64,
    /// How far it is within the soma, as it was traced (µm).
    pub(super) depth: f64,
}

/// Places along a segment at which it is compared with a soma that is no sphere.
const SOMA_PLACES: u32 = 8;

/// Share of the way along a segment at which it is deepest within a soma: of a sphere that is where it is nearest to the
/// center.
pub(super) fn deepest(soma: &SomaSphere, ends: [DVec3; 2]) -> f64 {
    let nearest = nearest_to(soma.center, ends);
    if soma.is_sphere() {
        return nearest;
    }
    let beyond = |s: f64| {
        let place = ends[0].lerp(ends[1], s);
        place.distance(soma.center) - soma.towards(place)
    };
    let places = (0..=SOMA_PLACES).map(|i| f64::from(i) / f64::from(SOMA_PLACES));
    let places = places.chain([nearest]).map(|s| (beyond(s), s));
    let deepest = places.min_by(|a, b| a.0.total_cmp(&b.0));
    deepest.map_or(nearest, |(_, s)| s)
}

/// How far apart segments may be to be found: so many radii of the thinner and of the thicker one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Margin {
    pub(super) thin: f64,
    pub(super) thick: f64,
}

impl Margin {
    /// Only what touches.
    pub(super) const NONE: Self = Self {
        thin: 0.0,
        thick: 0.0,
    };

    /// By how many of its radii each box has to grow.
    fn share(self) -> f64 {
        (0.5 * (self.thin + self.thick)).max(self.thick)
    }
}

/// What was found.
#[derive(Debug, Default)]
pub(super) struct Found {
    pub(super) contacts: Vec<Contact>,
    pub(super) somata: Vec<SomaContact>,
    /// Whether these are all.
    pub(super) complete: bool,
}

impl Found {
    /// Whether anything runs into anything else.
    pub(super) fn touches(&self) -> bool {
        self.contacts.iter().any(|c| c.depth > 0.0) || self.somata.iter().any(|c| c.depth > 0.0)
    }
}

/// Searches among the segments between `centers`; with `moving`, only what touches a segment of which
/// an end moves. Sorted by the numbers of segments.
pub(super) fn search(
    rods: &Rods,
    centers: &[DVec3],
    margin: Margin,
    moving: Option<&[bool]>,
) -> Found {
    let grown = 1.0 + margin.share();
    let bounds = (0..rods.count() as u32).map(|i| {
        let above = rods.parent(i).min(i);
        let radius = rods.radius(i).max(rods.radius(above));
        Bounds::around([above, i].map(|n| centers[n as usize]), grown * radius)
    });
    let view = View {
        rods,
        centers,
        margin,
        boxes: Boxes::new(bounds.collect(), rods.segments().collect()),
    };
    let moves =
        |i: u32| moving.is_none_or(|moving| moving[i as usize] || moving[rods.parent(i) as usize]);
    let mut found = Found {
        complete: true,
        ..Found::default()
    };
    for segment in rods.segments().filter(|&i| moves(i)) {
        view.look_around(segment, moves, &mut found);
    }
    view.look_around_somata(moves, &mut found);
    found.contacts.sort_unstable_by_key(|c| (c.a, c.b));
    found
}

/// Whether the way between two places is so short that surfaces of these `radii` (their sum, µm) meet there.
pub(super) fn may_touch(rods: &Rods, a: OnSegment, b: OnSegment, radii: f64) -> bool {
    rods.paths.way(a, b).is_some_and(|way| {
        let fork = way.fork.map_or(0.0, |fork| rods.radius(fork));
        way.length <= MAX_WAY * radii.max(fork)
    })
}

struct View<'a> {
    rods: &'a Rods,
    centers: &'a [DVec3],
    margin: Margin,
    boxes: Boxes,
}

impl View<'_> {
    fn look_around(&self, i: u32, moves: impl Fn(u32) -> bool, found: &mut Found) {
        let mut looks = 0;
        let Found {
            contacts, complete, ..
        } = found;
        let before = contacts.len();
        self.boxes.overlapping(self.boxes.bounds(i), |j| {
            // A pair of two that move is found from its first.
            if j == i || (j < i && moves(j)) {
                return ControlFlow::Continue(());
            }
            looks += 1;
            if looks > MAX_LOOKS || contacts.len() - before >= MAX_CONTACTS {
                *complete = false;
                return ControlFlow::Break(());
            }
            contacts.extend(self.contact(i.min(j), i.max(j)));
            ControlFlow::Continue(())
        });
    }

    fn ends(&self, segment: u32) -> [DVec3; 2] {
        [self.rods.parent(segment), segment].map(|n| self.centers[n as usize])
    }

    fn radius_at(&self, segment: u32, share: f64) -> f64 {
        let above = self.rods.radius(self.rods.parent(segment));
        above + share * (self.rods.radius(segment) - above)
    }

    fn on_segment(&self, segment: u32, share: f64) -> OnSegment {
        let rest = (1.0 - share) * self.rods.length[segment as usize];
        OnSegment {
            segment,
            arc: self.rods.paths.arc(segment) - rest,
        }
    }

    /// A pair, if it is near enough and does not belong together.
    fn contact(&self, a: u32, b: u32) -> Option<Contact> {
        let (above_a, above_b) = (self.rods.parent(a), self.rods.parent(b));
        if above_a == b || above_b == a || above_a == above_b {
            return None;
        }
        let (p, q) = (self.ends(a), self.ends(b));
        let (s, t) = closest(p, q);
        let (ra, rb) = (self.radius_at(a, s), self.radius_at(b, t));
        let depth = ra + rb - p[0].lerp(p[1], s).distance(q[0].lerp(q[1], t));
        let near = -self.margin.thin * ra.min(rb) - self.margin.thick * ra.max(rb);
        let contact = Contact { a, b, s, t, depth };
        // Not with `<`: a distance that is no number is no contact.
        let (on_a, on_b) = (self.on_segment(a, s), self.on_segment(b, t));
        (depth > near && !may_touch(self.rods, on_a, on_b, ra + rb)).then_some(contact)
    }

    fn look_around_somata(&self, moves: impl Fn(u32) -> bool, found: &mut Found) {
        let mut looks = SOMA_LOOKS * self.rods.count();
        let Found {
            somata, complete, ..
        } = found;
        for (soma, sphere) in self.rods.somata.iter().enumerate() {
            let Some(sphere) = sphere else { continue };
            let bounds = Bounds::around([sphere.center; 2], SOMA_REACH * sphere.farthest());
            self.boxes.overlapping(&bounds, |segment| {
                if looks == 0 {
                    *complete = false;
                    return ControlFlow::Break(());
                }
                looks -= 1;
                if moves(segment) {
                    somata.extend(self.soma_contact(segment, soma as u32));
                }
                ControlFlow::Continue(())
            });
        }
        somata.sort_unstable_by_key(|c| (c.soma, c.segment));
    }

    fn soma_contact(&self, segment: u32, soma: u32) -> Option<SomaContact> {
        let sphere = self.rods.somata[soma as usize].as_ref()?;
        let ends = self.ends(segment);
        let s = deepest(sphere, ends);
        let radius = self.radius_at(segment, s);
        let place = ends[0].lerp(ends[1], s);
        let (distance, surface) = (place.distance(sphere.center), sphere.towards(place));
        let near = SOMA_REACH * surface + (1.0 + self.margin.share()) * radius;
        let origin = self.rods.paths.origin(segment);
        let own = origin.filter(|o| o.soma == soma).is_some_and(|origin| {
            let way = self.on_segment(segment, s).arc + origin.way;
            way <= OWN_WAY.0 * radius + OWN_WAY.1 * surface
        });
        (distance < near && !own).then_some(SomaContact {
            segment,
            soma,
            s,
            depth: surface + radius - distance,
        })
    }
}
