//! The link of a tracing that is nearest to a place, by a grid.

use std::collections::HashMap;

use glam::{DVec3, IVec3};

/// A place is at most so far (µm) from a membrane that it belongs to.
pub(crate) const REACH: f64 = 5.0;

/// Least side of a cell of the grid (µm).
const MIN_CELL: f64 = 4.0;
/// Cells that a link of mean length goes through at most: tracings in another unit than they should be would fill
/// all memory.
const MAX_CELLS: f64 = 8.0;
/// Cells along a side of what is searched at most.
const MAX_SHELLS: i32 = 16;

/// Links in a grid, each in all cells that its axis goes through.
#[derive(Debug)]
pub(crate) struct Links {
    /// Side of a cell (µm).
    side: f64,
    cells: HashMap<IVec3, Vec<u32>>,
    links: Vec<Link>,
    /// The largest radius (µm).
    widest: f64,
}

/// A piece of a section between two points.
#[derive(Debug)]
pub(crate) struct Link {
    pub(crate) section: usize,
    /// Distance (µm) of its first end from the start of the section.
    pub(crate) along: f64,
    pub(crate) ends: [(DVec3, f64); 2],
}

/// The place on a neurite that is nearest to another place.
#[derive(Clone, Copy)]
pub(crate) struct Found {
    pub(crate) section: usize,
    /// Distance (µm) from the start of the section.
    pub(crate) along: f64,
    /// Distance (µm) from the surface; below 0 inside.
    pub(crate) far: f64,
}

impl Links {
    pub(crate) fn new(all: impl IntoIterator<Item = Link>) -> Self {
        let all: Vec<Link> = all.into_iter().collect();
        let length: f64 = all.iter().map(Link::length).filter(|n| n.is_finite()).sum();
        let mut links = Self {
            side: MIN_CELL.max(length / (MAX_CELLS * all.len().max(1) as f64)),
            cells: HashMap::new(),
            links: Vec::with_capacity(all.len()),
            widest: 0.0,
        };
        for link in all {
            links.add(link);
        }
        links
    }

    fn add(&mut self, link: Link) {
        let number = self.links.len() as u32;
        let [(from, thick), (to, thin)] = link.ends;
        self.widest = self.widest.max(thick).max(thin);
        let steps = (2.0 * link.length() / self.side).ceil().clamp(1.0, 1e6) as u32;
        for step in 0..=steps {
            let at = from.lerp(to, f64::from(step) / f64::from(steps));
            let there = self.cells.entry(cell(at, self.side)).or_default();
            if there.last() != Some(&number) {
                there.push(number);
            }
        }
        self.links.push(link);
    }

    /// What is nearest to a place, if it is near at all. Cells are searched outwards.
    pub(crate) fn nearest(&self, place: DVec3) -> Option<Found> {
        if !place.is_finite() {
            return None;
        }
        let mut best: Option<Found> = None;
        for shell in 0..=MAX_SHELLS {
            // No link that is not found yet is nearer to the axis: half a cell for its samples.
            let rest = (f64::from(shell) - 1.5) * self.side - self.widest;
            if rest > best.map_or(REACH, |found| found.far) {
                break;
            }
            for at in around(cell(place, self.side), shell) {
                let links = self.cells.get(&at).into_iter().flatten();
                for found in links.map(|&number| self.links[number as usize].found(place)) {
                    if best.is_none_or(|best| found.far < best.far) {
                        best = Some(found);
                    }
                }
            }
        }
        best
    }
}

impl Link {
    /// µm.
    fn length(&self) -> f64 {
        self.ends[0].0.distance(self.ends[1].0)
    }

    fn found(&self, place: DVec3) -> Found {
        let [(from, radius), (to, other)] = self.ends;
        let way = to - from;
        let length = way.length();
        let share = match length > 0.0 {
            true => ((place - from).dot(way) / (length * length)).clamp(0.0, 1.0),
            false => 0.0,
        };
        let axis = from.lerp(to, share);
        Found {
            section: self.section,
            along: self.along + share * length,
            far: axis.distance(place) - (radius + share * (other - radius)),
        }
    }
}

fn cell(place: DVec3, side: f64) -> IVec3 {
    (place / side).floor().as_ivec3()
}

/// The cells that are so many cells from one.
fn around(center: IVec3, shell: i32) -> impl Iterator<Item = IVec3> {
    let range = move || -shell..=shell;
    let all = range().flat_map(move |x| range().map(move |y| (x, y)));
    all.flat_map(move |(x, y)| {
        let is_side = x.abs() == shell || y.abs() == shell;
        // Within the sides only the two that close them.
        let step = match is_side {
            true => 1,
            false => 2 * shell.max(1),
        };
        range()
            .step_by(step as usize)
            .map(move |z| center.wrapping_add(IVec3::new(x, y, z)))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A path of links that turns about, and places beside it.
    fn path(scale: f64) -> (Links, Vec<DVec3>) {
        let at = |n: u32| {
            let turn = f64::from(n) * 0.37;
            scale * DVec3::new(f64::from(n), 9.0 * turn.sin(), 7.0 * turn.cos())
        };
        let link = |n: u32| Link {
            section: n as usize,
            along: 0.0,
            ends: [(at(n), 0.4), (at(n + 1), 0.6)],
        };
        let places = (0..200).map(|n| at(n) + DVec3::new(0.3, -1.1, 0.8));
        (Links::new((0..200).map(link)), places.collect())
    }

    #[test]
    fn the_nearest_is_that_of_all() {
        for scale in [0.1, 1.0, 30.0] {
            let (links, places) = path(scale);
            for place in places {
                let found = links.nearest(place).expect("one is near");
                let all = links.links.iter().map(|link| link.found(place).far);
                assert_eq!(found.far, all.fold(f64::INFINITY, f64::min), "{scale}");
            }
        }
    }

    #[test]
    fn links_in_nanometers_do_not_fill_memory() {
        let (links, _) = path(1000.0);
        let named: usize = links.cells.values().map(Vec::len).sum();
        assert!(named < 20 * links.links.len(), "{named}");
    }
}
