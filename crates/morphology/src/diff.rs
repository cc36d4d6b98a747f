//! What differs between two tracings.
//!
//! Samples of one are matched with those of the other in one of three ways, the first that fits: where both have
//! the same tree, in its **order**; else by their **number** or by their **place**, whichever finds more samples
//! that are the same. So renumbered, moved, retyped, cut and extended tracings are all compared sample by
//! sample. Only neurites' samples are matched; somata are compared as a whole.

use std::collections::{BTreeMap, HashMap};

use glam::DVec3;
use serde::Serialize;

use crate::edit::BeforeAfter;
use crate::{LengthByType, Measures, Morphology, NeuriteKind, Soma};

/// Number of samples that are named of each kind of difference, if nothing is said.
const NAMED: usize = 10;

/// How samples were matched.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum MatchedBy {
    /// The trees are the same.
    Order,
    /// The numbers of the samples.
    Number,
    /// The places of the samples.
    Place,
}

/// Samples that differ in one way.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Differing {
    /// How many.
    pub count: usize,
    /// By how much at most (µm), where it is a length.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub largest: Option<f64>,
    /// The first ten, or as many as were asked for, by their numbers in the first tracing, or in the second one if only
    /// that has them.
    pub samples: Vec<i64>,
}

/// Samples whose type is another one.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Retyped {
    /// The type in the first tracing.
    pub from: NeuriteKind,
    /// The type in the second one.
    pub to: NeuriteKind,
    /// How many samples.
    pub count: usize,
}

/// What differs between the somata.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SomaDifference {
    /// Number of somata.
    pub count: BeforeAfter<usize>,
    /// Kind of the main one.
    pub kind: BeforeAfter<&'static str>,
    /// Radius (µm) of the main one.
    pub radius: BeforeAfter<f64>,
    /// How far (µm) the main one has moved.
    pub moved: f64,
}

/// What differs between two tracings, the first `before`, the second `after`.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Difference {
    /// Whether nothing differs by more than the tolerance.
    pub same: bool,
    /// How samples were matched.
    pub matched_by: MatchedBy,
    /// Greatest distance and difference of radii (µm) that count as none.
    pub tolerance: f64,
    /// Samples outside somata.
    pub samples: BeforeAfter<usize>,
    /// Sections.
    pub sections: BeforeAfter<usize>,
    /// Neurites.
    pub neurites: BeforeAfter<usize>,
    /// Points with two children or more.
    pub forks: BeforeAfter<usize>,
    /// Ends.
    pub ends: BeforeAfter<usize>,
    /// Length of all neurites (µm).
    pub length: BeforeAfter<f64>,
    /// The length by type (µm).
    pub length_by_type: BeforeAfter<LengthByType>,
    /// Samples that only the first tracing has.
    pub only_in_first: Differing,
    /// Samples that only the second one has.
    pub only_in_second: Differing,
    /// Samples at other places.
    pub moved: Differing,
    /// Samples with other radii.
    pub radii: Differing,
    /// Samples of other types.
    pub types: Differing,
    /// From which types to which.
    pub retyped: Vec<Retyped>,
    /// Samples that hang on another one.
    pub parents: Differing,
    /// The somata, where they differ.
    pub soma: Option<SomaDifference>,
}

impl Difference {
    /// Compares two tracings. `tolerance` (µm, 0 or more): distances and differences of radii up to it are
    /// none; coordinates are taken in the files' frames.
    pub fn of(first: &Morphology, second: &Morphology, tolerance: f64) -> Self {
        Self::naming(first, second, tolerance, NAMED)
    }

    /// [`of`](Self::of) with so many samples of each kind of difference.
    pub fn naming(first: &Morphology, second: &Morphology, tolerance: f64, named: usize) -> Self {
        let (a, b) = (Samples::of(first), Samples::of(second));
        let (matched_by, partner) = a.matched(&b, tolerance);
        let counts = [first, second].map(Measures::of);
        let pair = |of: fn(&Measures) -> usize| BeforeAfter {
            before: of(&counts[0]),
            after: of(&counts[1]),
        };
        let mut difference = Self {
            same: false,
            matched_by,
            tolerance,
            samples: pair(|m| m.n_points),
            sections: pair(|m| m.n_sections),
            neurites: pair(|m| m.n_neurites),
            forks: pair(|m| m.n_bifurcations + m.n_multifurcations),
            ends: pair(|m| m.n_ends),
            length: BeforeAfter {
                before: counts[0].length,
                after: counts[1].length,
            },
            length_by_type: BeforeAfter {
                before: counts[0].length_by_type,
                after: counts[1].length_by_type,
            },
            only_in_first: Differing::default(),
            only_in_second: Differing::default(),
            moved: Differing::default(),
            radii: Differing::default(),
            types: Differing::default(),
            retyped: Vec::new(),
            parents: Differing::default(),
            soma: soma_difference(first, second, tolerance),
        };
        difference.compare(&a, &b, &partner);
        let found = [
            &mut difference.only_in_first,
            &mut difference.only_in_second,
            &mut difference.moved,
            &mut difference.radii,
            &mut difference.types,
            &mut difference.parents,
        ];
        difference.same = found.iter().all(|d| d.count == 0) && difference.soma.is_none();
        for differing in found {
            differing.samples.truncate(named);
        }
        difference
    }

    /// `partner`: of each sample of `a` the one of `b`.
    fn compare(&mut self, a: &Samples<'_>, b: &Samples<'_>, partner: &[Option<usize>]) {
        let mut has_partner = vec![false; b.len()];
        let mut retyped: BTreeMap<(NeuriteKind, NeuriteKind), usize> = BTreeMap::new();
        for (i, &j) in partner.iter().enumerate() {
            let id = a.ids[i];
            let Some(j) = j else {
                self.only_in_first.add(id);
                continue;
            };
            has_partner[j] = true;
            let way = a.places[i].distance(b.places[j]);
            if way > self.tolerance {
                self.moved.add_length(id, way);
            }
            let radius = (a.radii[i] - b.radii[j]).abs();
            if radius > self.tolerance {
                self.radii.add_length(id, radius);
            }
            if a.kinds[i] != b.kinds[j] {
                self.types.add(id);
                *retyped.entry((a.kinds[i], b.kinds[j])).or_default() += 1;
            }
            let above = match a.parents[i] {
                Parent::Sample(p) => partner[p].map_or(Parent::Nothing, Parent::Sample),
                other => other,
            };
            if above != b.parents[j] {
                self.parents.add(id);
            }
        }
        for j in (0..b.len()).filter(|&j| !has_partner[j]) {
            self.only_in_second.add(b.ids[j]);
        }
        let retyped = retyped.into_iter();
        self.retyped = retyped
            .map(|((from, to), count)| Retyped { from, to, count })
            .collect();
    }
}

impl Differing {
    fn add(&mut self, sample: i64) {
        self.count += 1;
        self.samples.push(sample);
    }

    fn add_length(&mut self, sample: i64, length: f64) {
        self.add(sample);
        self.largest = Some(self.largest.unwrap_or(0.0).max(length));
    }
}

/// What a sample hangs on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Parent {
    Sample(usize),
    Soma,
    Nothing,
}

/// The neurites' samples of a tracing, in its order.
struct Samples<'a> {
    ids: &'a [i64],
    places: Vec<DVec3>,
    radii: Vec<f64>,
    kinds: Vec<NeuriteKind>,
    parents: Vec<Parent>,
}

impl<'a> Samples<'a> {
    fn of(morphology: &'a Morphology) -> Self {
        let points = || morphology.points.iter();
        let mut samples = Self {
            ids: &morphology.sample_ids,
            places: points()
                .map(|p| morphology.origin + p.position.as_dvec3())
                .collect(),
            radii: points().map(|p| f64::from(p.radius)).collect(),
            kinds: Vec::with_capacity(morphology.points.len()),
            parents: Vec::with_capacity(morphology.points.len()),
        };
        for section in &morphology.sections {
            let mut parent = match section.attachment {
                crate::Attachment::Section(id) => {
                    Parent::Sample(morphology.sections[id.index()].end as usize - 1)
                }
                crate::Attachment::Soma { .. } => Parent::Soma,
                crate::Attachment::Free => Parent::Nothing,
            };
            for point in section.range() {
                samples.kinds.push(section.kind);
                samples.parents.push(parent);
                parent = Parent::Sample(point);
            }
        }
        samples
    }

    fn len(&self) -> usize {
        self.ids.len()
    }

    /// The partner of each sample among the others.
    fn matched(&self, other: &Self, tolerance: f64) -> (MatchedBy, Vec<Option<usize>>) {
        if self.parents == other.parents {
            return (MatchedBy::Order, (0..self.len()).map(Some).collect());
        }
        let by_place = self.by_place(other, tolerance);
        let Some(by_number) = self.by_number(other) else {
            return (MatchedBy::Place, by_place);
        };
        let same_place =
            |(i, j): &(usize, usize)| self.places[*i].distance(other.places[*j]) <= tolerance;
        let pairs = by_number.iter().enumerate();
        let agree = pairs
            .filter_map(|(i, j)| Some((i, (*j)?)))
            .filter(same_place);
        match agree.count() >= by_place.iter().flatten().count() {
            true => (MatchedBy::Number, by_number),
            false => (MatchedBy::Place, by_place),
        }
    }

    /// None if a number repeats.
    fn by_number(&self, other: &Self) -> Option<Vec<Option<usize>>> {
        let index = |ids: &[i64]| -> Option<HashMap<i64, usize>> {
            let index: HashMap<i64, usize> = ids.iter().copied().zip(0..).collect();
            (index.len() == ids.len()).then_some(index)
        };
        index(self.ids)?;
        let theirs = index(other.ids)?;
        Some(self.ids.iter().map(|id| theirs.get(id).copied()).collect())
    }

    /// Samples within the tolerance of one another; of several, the first that is free.
    fn by_place(&self, other: &Self, tolerance: f64) -> Vec<Option<usize>> {
        let mut grid = Grid::new(tolerance);
        for (j, &place) in other.places.iter().enumerate().rev() {
            grid.add(place, j);
        }
        let places = self.places.iter();
        places
            .map(|&place| grid.take(place, &other.places))
            .collect()
    }
}

/// Samples by the cell of space that they are in.
struct Grid {
    side: f64,
    tolerance: f64,
    cells: HashMap<[i64; 3], Vec<usize>>,
}

impl Grid {
    fn new(tolerance: f64) -> Self {
        Self {
            // Cells no smaller than what files resolve.
            side: (2.0 * tolerance).max(1e-3),
            tolerance,
            cells: HashMap::new(),
        }
    }

    fn cell(&self, place: DVec3) -> [i64; 3] {
        place.to_array().map(|x| (x / self.side).floor() as i64)
    }

    fn add(&mut self, place: DVec3, sample: usize) {
        self.cells.entry(self.cell(place)).or_default().push(sample);
    }

    /// A sample within the tolerance, which is then taken.
    fn take(&mut self, place: DVec3, places: &[DVec3]) -> Option<usize> {
        let reach = DVec3::splat(self.tolerance);
        let (low, high) = (self.cell(place - reach), self.cell(place + reach));
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                for z in low[2]..=high[2] {
                    let Some(samples) = self.cells.get_mut(&[x, y, z]) else {
                        continue;
                    };
                    let near = |&j: &usize| places[j].distance(place) <= self.tolerance;
                    // The last is the first in the file.
                    if let Some(found) = samples.iter().rposition(near) {
                        return Some(samples.remove(found));
                    }
                }
            }
        }
        None
    }
}

fn soma_difference(a: &Morphology, b: &Morphology, tolerance: f64) -> Option<SomaDifference> {
    let main = [a, b].map(|m| (m.origin, m.soma()));
    let center = |(origin, soma): (DVec3, Option<&Soma>)| Some(origin + soma?.center.as_dvec3());
    let radius = |soma: Option<&Soma>| soma.map_or(0.0, |s| f64::from(s.radius));
    let kind = |soma: Option<&Soma>| soma.map_or("none", |s| s.kind.name());
    let difference = SomaDifference {
        count: BeforeAfter {
            before: a.somata.len(),
            after: b.somata.len(),
        },
        kind: BeforeAfter {
            before: kind(main[0].1),
            after: kind(main[1].1),
        },
        radius: BeforeAfter {
            before: radius(main[0].1),
            after: radius(main[1].1),
        },
        moved: match (center(main[0]), center(main[1])) {
            (Some(a), Some(b)) => a.distance(b),
            _ => 0.0,
        },
    };
    let same = difference.count.before == difference.count.after
        && difference.kind.before == difference.kind.after
        && (difference.radius.before - difference.radius.after).abs() <= tolerance
        && difference.moved <= tolerance;
    (!same).then_some(difference)
}
