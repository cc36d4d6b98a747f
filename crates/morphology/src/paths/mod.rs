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

use glam::DVec3;

use crate::{Attachment, Morphology, SectionId, shape};

/// A location on a tracing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Location {
    /// The center of a soma, by its index in [`Morphology::somata`].
    Soma(u32),
    /// A location on the link that leads to a point.
    Neurite {
        /// Index of the point in [`Morphology::points`].
        point: u32,
        /// Share of the link, in [0, 1], from the point before: 1 is the point itself. It does not
        /// matter for the first point of a neurite, which no link leads to.
        fraction: f64,
    },
}

impl Location {
    /// The location of a point.
    pub fn of_point(point: u32) -> Self {
        Self::Neurite {
            point,
            fraction: 1.0,
        }
    }

    /// The location of a sample of the file: a point, or for a sample of a soma its center. The
    /// first one, if several samples have this number.
    pub fn of_sample(morphology: &Morphology, id: i64) -> Option<Self> {
        let point = morphology.sample_ids.iter().position(|&known| known == id);
        if let Some(point) = point {
            return Some(Self::of_point(point as u32));
        }
        let has = |soma: &crate::Soma| soma.samples.iter().any(|sample| sample.id == id);
        let soma = morphology.somata.iter().position(has)?;
        Some(Self::Soma(soma as u32))
    }

    /// Whether it is on this tracing. The other functions take such locations only.
    pub fn is_on(self, morphology: &Morphology) -> bool {
        match self {
            Self::Soma(soma) => (soma as usize) < morphology.somata.len(),
            Self::Neurite { point, fraction } => {
                (point as usize) < morphology.points.len() && (0.0..=1.0).contains(&fraction)
            }
        }
    }

    /// Its position (µm) in the file's coordinates.
    ///
    /// # Panics
    /// If it is not on the tracing.
    pub fn position(self, morphology: &Morphology) -> DVec3 {
        morphology.origin + self.center(morphology)
    }

    /// The radius (µm) there, interpolated along the link; a negative one counts as 0. Of a soma,
    /// that of the sphere that stands for it.
    ///
    /// # Panics
    /// If it is not on the tracing.
    pub fn radius(self, morphology: &Morphology) -> f64 {
        let of = |point: u32| f64::from(morphology.points[point as usize].radius).max(0.0);
        match self {
            Self::Soma(soma) => f64::from(morphology.somata[soma as usize].radius),
            Self::Neurite { point, fraction } => match point_before(morphology, point) {
                Some(before) => of(before) + fraction * (of(point) - of(before)),
                None => of(point),
            },
        }
    }

    /// The section that it is on: that of the point which its link leads to.
    ///
    /// # Panics
    /// If it is not on the tracing.
    pub fn section(self, morphology: &Morphology) -> Option<SectionId> {
        match self {
            Self::Soma(_) => None,
            Self::Neurite { point, .. } => Some(section_of(morphology, point)),
        }
    }

    /// Position relative to the morphology's origin.
    fn center(self, morphology: &Morphology) -> DVec3 {
        let of = |point: u32| morphology.points[point as usize].position.as_dvec3();
        match self {
            Self::Soma(soma) => morphology.somata[soma as usize].center.as_dvec3(),
            Self::Neurite { point, fraction } => match point_before(morphology, point) {
                Some(before) => of(before).lerp(of(point), fraction),
                None => of(point),
            },
        }
    }

    /// The same location, at a point wherever it can be.
    fn at_point(self, morphology: &Morphology) -> Self {
        match self {
            Self::Soma(_) => self,
            Self::Neurite { point, fraction } => match point_before(morphology, point) {
                None => Self::of_point(point),
                Some(before) if fraction <= 0.0 => Self::of_point(before),
                Some(_) => self,
            },
        }
    }
}

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

/// Length (µm) of the path from a location to each point; none where there is no path. Linear in
/// the points.
///
/// # Panics
/// If the location is not on the tracing.
pub fn path_distances(morphology: &Morphology, from: Location) -> Vec<Option<f64>> {
    let mut distances = vec![None; morphology.points.len()];
    let from = from.at_point(morphology);
    let at = |point: u32| morphology.points[point as usize].position.as_dvec3();
    // Upwards: the points between the location and the soma.
    let mut soma = match from {
        Location::Soma(soma) => Some((soma, 0.0)),
        Location::Neurite { .. } => None,
    };
    if let Location::Neurite { point, .. } = from {
        let mut here = from.center(morphology);
        distances[point as usize] = Some(here.distance(at(point)));
        let mut length = 0.0;
        let mut next = match from == Location::of_point(point) {
            true => Some(point),
            false => point_before(morphology, point),
        };
        let mut first = point;
        while let Some(above) = next {
            length += here.distance(at(above));
            distances[above as usize] = Some(length);
            (here, first) = (at(above), above);
            next = point_before(morphology, above);
        }
        if let Some(of) = soma_of(morphology, first) {
            let center = Location::Soma(of).center(morphology);
            soma = Some((of, length + here.distance(center)));
        }
    }
    // Downwards: parents come before their children.
    for section in &morphology.sections {
        for point in section.first..section.end {
            if distances[point as usize].is_some() {
                continue;
            }
            distances[point as usize] = match point_before(morphology, point) {
                Some(before) => {
                    distances[before as usize].map(|d| d + at(before).distance(at(point)))
                }
                None => soma.and_then(|(of, length)| {
                    let center = Location::Soma(of).center(morphology);
                    (soma_of(morphology, point) == Some(of))
                        .then(|| length + center.distance(at(point)))
                }),
            };
        }
    }
    distances
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

fn section_of(morphology: &Morphology, point: u32) -> SectionId {
    let sections = &morphology.sections;
    SectionId(sections.partition_point(|section| section.end <= point) as u32)
}

/// The point that a point hangs on; none for the first one of a neurite.
fn point_before(morphology: &Morphology, point: u32) -> Option<u32> {
    let section = &morphology.sections[section_of(morphology, point).index()];
    if point > section.first {
        return Some(point - 1);
    }
    let parent = section.parent()?;
    Some(morphology.sections[parent.index()].end - 1)
}

/// The soma that the first point of a neurite is attached to.
fn soma_of(morphology: &Morphology, first: u32) -> Option<u32> {
    let section = section_of(morphology, first);
    match morphology.sections[section.index()].attachment {
        Attachment::Soma { soma, .. } => Some(soma),
        Attachment::Section(_) | Attachment::Free => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{NeuriteKind, Node};

    /// A soma at (0, 0); to the right a dendrite that forks at (10, 0), and whose upper branch
    /// forks at (10, 10); to the left an axon; and a free tree.
    ///
    /// ```text
    ///                    6 ○──○ 7 (20, 10)
    ///   3 ○─○ 2   ● 1  4 ○─○ 5─○ 8 (22, 0)
    /// ```
    fn cell() -> Morphology {
        let row = |id: i64, kind: i32, x: f64, y: f64, radius: f64, parent: Option<u32>| Node {
            id,
            kind: NeuriteKind(kind),
            position: DVec3::new(x, y, 0.0),
            radius,
            parent,
        };
        let nodes = [
            row(1, 1, 0.0, 0.0, 3.0, None),
            row(2, 2, -4.0, 0.0, 1.0, Some(0)),
            row(3, 2, -4.0, -6.0, 0.5, Some(1)),
            row(4, 3, 5.0, 0.0, 2.0, Some(0)),
            row(5, 3, 10.0, 0.0, 1.0, Some(3)),
            row(6, 3, 10.0, 10.0, 0.5, Some(4)),
            row(7, 3, 20.0, 10.0, 0.5, Some(5)),
            row(8, 3, 22.0, 0.0, 0.25, Some(4)),
            row(9, 3, 10.0, 15.0, 0.5, Some(5)),
            row(10, 3, 50.0, 0.0, 0.5, None),
            row(11, 3, 53.0, 4.0, 0.5, Some(9)),
        ];
        let built = Morphology::from_nodes("cell", Vec::new(), &nodes);
        built.expect("built").morphology
    }

    fn sample(cell: &Morphology, id: i64) -> Location {
        Location::of_sample(cell, id).expect("there")
    }

    fn path(cell: &Morphology, a: i64, b: i64) -> Option<Path> {
        Path::between(cell, sample(cell, a), sample(cell, b))
    }

    #[test]
    fn paths_go_through_the_common_ancestor() {
        let cell = cell();
        let there = path(&cell, 7, 8).expect("one tree");
        assert_eq!((there.length, there.soma_length), (32.0, 0.0));
        assert_eq!(there.straight, 104_f64.sqrt());
        assert_eq!(there.forks.len(), 2);
        assert_eq!(there.tortuosity(), Some(32.0 / 104_f64.sqrt()));
        let back = path(&cell, 8, 7).expect("one tree");
        let mut reversed = back.locations.clone();
        reversed.reverse();
        assert_eq!((back.length, reversed), (there.length, there.locations));
        // Down one branch; the fork at its end is not passed.
        let down = path(&cell, 4, 6).expect("one tree");
        assert_eq!((down.length, down.forks.len()), (15.0, 1));
        assert_eq!(path(&cell, 5, 6).map(|p| p.forks.len()), Some(0));
    }

    #[test]
    fn between_neurites_the_somas_center_counts() {
        let cell = cell();
        let there = path(&cell, 3, 8).expect("one soma");
        assert_eq!(
            (there.length, there.soma_length),
            (6.0 + 4.0 + 5.0 + 17.0, 9.0)
        );
        assert_eq!((there.straight, there.forks.len()), (26_f64.hypot(6.0), 1));
        let soma = path(&cell, 1, 6).expect("one soma");
        assert_eq!((soma.length, soma.soma_length), (20.0, 5.0));
        assert_eq!(path(&cell, 6, 1).map(|p| p.length), Some(20.0));
        assert_eq!(path(&cell, 3, 10), None, "a free tree");
        assert_eq!(path(&cell, 1, 10), None);
        assert_eq!(path(&cell, 10, 11).map(|p| p.length), Some(5.0));
    }

    #[test]
    fn ends_may_be_on_links() {
        let cell = cell();
        let on = |id: i64, fraction: f64| match sample(&cell, id) {
            Location::Neurite { point, .. } => Location::Neurite { point, fraction },
            soma @ Location::Soma(_) => soma,
        };
        let length = |a, b| Path::between(&cell, a, b).map(|p| p.length);
        assert_eq!(length(on(8, 0.25), on(8, 0.75)), Some(6.0));
        // On the link above an end, below it, and beside it.
        assert_eq!(length(on(5, 0.6), on(8, 0.5)), Some(2.0 + 6.0));
        assert_eq!(length(on(8, 0.5), on(5, 0.6)), Some(2.0 + 6.0));
        assert_eq!(length(on(7, 0.5), on(9, 1.0)), Some(5.0 + 5.0));
        assert_eq!(length(on(2, 0.3), on(1, 0.0)), Some(4.0), "a first point");
        // The start of a link is the fork that it leaves.
        let start = Path::between(&cell, on(8, 0.0), on(6, 0.0)).expect("one tree");
        assert_eq!((start.length, start.locations.len()), (0.0, 1));
        assert_eq!((start.tortuosity(), start.forks.len()), (None, 0));
        assert_eq!(on(5, 0.5).radius(&cell), 1.5);
        assert_eq!(on(8, 0.0).radius(&cell), 1.0, "begins with the fork's");
        assert_eq!(on(1, 0.0).radius(&cell), 3.0);
        assert_eq!(on(5, 0.5).position(&cell), DVec3::new(7.5, 0.0, 0.0));
        assert!(!Location::of_point(99).is_on(&cell) && !on(5, f64::NAN).is_on(&cell));
    }

    #[test]
    fn distances_of_all_points_are_those_of_their_paths() {
        let cell = cell();
        let mut starts: Vec<Location> = [1, 2, 3, 5, 7, 8, 11].map(|id| sample(&cell, id)).into();
        let point = cell.points.len() as u32 - 3;
        starts.push(Location::Neurite {
            point,
            fraction: 0.3,
        });
        for start in starts {
            let all = path_distances(&cell, start);
            for (point, distance) in (0..).zip(all) {
                let path = Path::between(&cell, start, Location::of_point(point));
                let near = |(a, b): (f64, f64)| (a - b).abs() < 1e-9;
                let length = path.map(|p| p.length);
                assert_eq!(length.is_some(), distance.is_some(), "{start:?} {point}");
                assert!(length.zip(distance).is_none_or(near), "{start:?} {point}");
            }
        }
    }
}
