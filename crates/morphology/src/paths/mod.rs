//! Paths along a tracing from one location to another: their length, their forks, their points.
//!
//! A path goes along the tracing through the common ancestor of its ends. Between two neurites of
//! one soma it goes through the soma: straight from a neurite's first point to the soma's center
//! and from there straight to the first point of the other. Those two links count as a part of the
//! path, and [`Path::soma_length`] tells how long they are, since they belong to no neurite: all
//! other lengths of this crate leave them out. There is no path between trees that are not attached
//! to the same soma.
//!
//! ```
//! use glam::DVec3;
//! use neurotess_morphology::paths::{Location, Path};
//! use neurotess_morphology::{Morphology, NeuriteKind, Node};
//!
//! let node = |id, kind, x, y, parent| Node {
//!     id,
//!     kind,
//!     position: DVec3::new(x, y, 0.0),
//!     radius: 1.0,
//!     parent,
//!     section: None,
//! };
//! let nodes = [
//!     node(1, NeuriteKind::SOMA, 0.0, 0.0, None),
//!     node(2, NeuriteKind::AXON, 5.0, 0.0, Some(0)),
//!     node(3, NeuriteKind::AXON, 5.0, 8.0, Some(1)),
//! ];
//! let cell = Morphology::from_nodes("cell", Vec::new(), &nodes)?.morphology;
//! let middle = Location::Neurite { point: 1, fraction: 0.5 };
//! let path = Path::between(&cell, Location::Soma(0), middle).expect("one tree");
//! assert_eq!((path.length, path.soma_length), (9.0, 5.0));
//! # Ok::<(), neurotess_morphology::BuildError>(())
//! ```

mod distances;
mod links;
mod location;
#[cfg(test)]
mod tests;

use glam::DVec3;

use crate::{Morphology, SectionId, shape};

use links::{point_before, section_of, soma_of};

pub use distances::path_distances;
pub use location::Location;

/// The way along a tracing from one location to another.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    /// Its length (µm).
    pub length: f64,
    /// Of that, what is between the soma's center and the first points of neurites (µm).
    pub soma_length: f64,
    /// Distance (µm) of its ends.
    pub straight: f64,
    /// Where it changes direction, both ends included; a single location if they are the same.
    pub locations: Vec<Location>,
    /// The sections whose forks it passes, in its order. A fork at one of its ends is not passed.
    pub forks: Vec<SectionId>,
}

impl Path {
    /// The path between two locations; none if they are on trees that are not attached to the same
    /// soma. Linear in the number of its points and of sections.
    ///
    /// # Panics
    /// If a location is not on the tracing.
    pub fn between(morphology: &Morphology, from: Location, to: Location) -> Option<Self> {
        let [from, to] = [from, to].map(|end| end.at_point(morphology));
        let locations = locations(morphology, from, to)?;
        let centers: Vec<DVec3> = locations.iter().map(|l| l.center(morphology)).collect();
        let (mut length, mut soma_length) = (0.0, 0.0);
        for (centers, ends) in centers.windows(2).zip(locations.windows(2)) {
            let link = centers[0].distance(centers[1]);
            length += link;
            if ends.iter().any(|end| matches!(end, Location::Soma(_))) {
                soma_length += link;
            }
        }
        let straight = match (centers.first(), centers.last()) {
            (Some(from), Some(to)) => from.distance(*to),
            _ => 0.0,
        };
        Some(Self {
            length,
            soma_length,
            straight,
            forks: forks(morphology, &locations),
            locations,
        })
    }

    /// The length by the distance of its ends, at least 1; none if they are at the same position.
    pub fn tortuosity(&self) -> Option<f64> {
        (self.straight > 0.0).then(|| (self.length / self.straight).max(1.0))
    }

    /// Its corners (µm) in the file's coordinates.
    pub fn positions(&self, morphology: &Morphology) -> Vec<DVec3> {
        let locations = self.locations.iter();
        locations.map(|l| l.position(morphology)).collect()
    }
}

/// Corners of the path between two locations.
fn locations(morphology: &Morphology, from: Location, to: Location) -> Option<Vec<Location>> {
    let (a, b) = match (from, to) {
        _ if from == to => return Some(vec![from]),
        (Location::Neurite { point: a, .. }, Location::Neurite { point: b, .. }) => (a, b),
        // One of them is a soma.
        (from, to) => return through_soma(morphology, from, to),
    };
    // Between two locations of one link it is straight.
    if a == b {
        return Some(vec![from, to]);
    }
    let Some(ancestor) = common_ancestor(morphology, a, b) else {
        return through_soma(morphology, from, to);
    };
    let mut path = up(morphology, from, |point| point == ancestor);
    let back = up(morphology, to, |point| point == ancestor);
    path.extend(back.into_iter().rev().skip(1));
    Some(path)
}

/// From a location up to the soma and down to another location.
fn through_soma(morphology: &Morphology, from: Location, to: Location) -> Option<Vec<Location>> {
    let to_soma = |end: Location| match end {
        Location::Soma(soma) => Some((soma, vec![end])),
        Location::Neurite { .. } => {
            let mut path = up(morphology, end, |_| false);
            let Some(Location::Neurite { point, .. }) = path.last().copied() else {
                return None;
            };
            let soma = soma_of(morphology, point)?;
            path.push(Location::Soma(soma));
            Some((soma, path))
        }
    };
    let ((soma, mut path), (other, back)) = (to_soma(from)?, to_soma(to)?);
    if soma != other {
        return None;
    }
    path.extend(back.into_iter().rev().skip(1));
    Some(path)
}

/// A location and the points above it, up to the one where `ends` is true or the neurite's first.
/// If it is on the link that leads to that one, it goes down to it.
fn up(morphology: &Morphology, from: Location, ends: impl Fn(u32) -> bool) -> Vec<Location> {
    let mut path = vec![from];
    let Location::Neurite { point, .. } = from else {
        return path;
    };
    let at_point = from == Location::of_point(point);
    if ends(point) {
        if !at_point {
            path.push(Location::of_point(point));
        }
        return path;
    }
    let mut here = point;
    while let Some(above) = point_before(morphology, here) {
        path.push(Location::of_point(above));
        if ends(above) {
            break;
        }
        here = above;
    }
    path
}

/// The last point that is above both, or one of them.
fn common_ancestor(morphology: &Morphology, mut a: u32, mut b: u32) -> Option<u32> {
    while a != b {
        // A point has a greater index than all above it.
        let lower = if a > b { &mut a } else { &mut b };
        *lower = point_before(morphology, *lower)?;
    }
    Some(a)
}

/// The sections at whose ends inner corners of a path are forks.
fn forks(morphology: &Morphology, locations: &[Location]) -> Vec<SectionId> {
    let children = shape::child_counts(morphology);
    let inner = locations.get(1..locations.len().saturating_sub(1));
    let fork = |location: &Location| {
        let Location::Neurite { point, .. } = *location else {
            return None;
        };
        let section = section_of(morphology, point);
        let ends = morphology.sections[section.index()].end == point + 1;
        (ends && children[section.index()] > 1).then_some(section)
    };
    inner.unwrap_or_default().iter().filter_map(fork).collect()
}
