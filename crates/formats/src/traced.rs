//! Records of formats that trace somata as outlines and repeat the fork in each child: Neurolucida
//! ASC and BBP's H5.
//!
//! **Theory.** Such formats say nothing of how neurites hang on the soma, and may begin a child with
//! a copy of the point that it branches from. **Practice.** A copy with the same radius is left out;
//! one with another radius is kept, as is a segment of length zero, for its radius is the child's
//! own; a child that is nothing but a copy is left out. A root hangs on the nearest sample of an
//! outline. Outlines that are within each other's reach are slices of one soma.

use glam::DVec3;
use neurotess_morphology::{BuildError, FileSection, FileSectionId, Morphology, NeuriteKind, Node};
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

use crate::Fault;
use crate::sample::Sample;
use crate::text::Located;
use crate::warning::Warnings;

/// A point of a neurite.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Traced {
    pub(crate) sample: Sample,
    pub(crate) kind: NeuriteKind,
    /// Index of the parent among the traced points; `None` for a root.
    pub(crate) parent: Option<u32>,
    /// Whether it is the first of its section.
    pub(crate) starts: bool,
    /// Index of its section in [`Tracing::sections`].
    pub(crate) section: u32,
}

/// What a file traced.
#[derive(Default)]
pub(crate) struct Tracing {
    /// Outlines of somata, none of them empty.
    pub(crate) outlines: Vec<Vec<Sample>>,
    pub(crate) points: Vec<Traced>,
    /// Sections in the order of the file, somata left out.
    pub(crate) sections: Vec<FileSection>,
    /// Whether a section that is nothing but a copy of its fork has a number: it has one in H5, where it has a row. Readers
    /// of ASC leave it out (NEURON 9.0.2, MorphIO 3.5.0).
    pub(crate) empty_sections_count: bool,
    /// Where spines are that are not traced (µm).
    pub(crate) spines: Vec<DVec3>,
    /// Comments to keep.
    pub(crate) header: Vec<String>,
}

/// What is told of spines that are not traced: code and message.
pub(crate) const SPINES_LEFT_OUT: (&str, &str) = (
    "spines_left_out",
    "spines: left out of the tree, their places are kept",
);

impl Tracing {
    /// Appends a point and gives its index. One that starts begins a section of the file.
    pub(crate) fn push(
        &mut self,
        sample: Sample,
        kind: NeuriteKind,
        parent: Option<u32>,
        starts: bool,
    ) -> u32 {
        if starts {
            self.sections.push(FileSection {
                kind,
                parent: parent.map(|parent| self.points[parent as usize].section),
                empty: false,
            });
        }
        self.points.push(Traced {
            sample,
            kind,
            parent,
            starts,
            section: self.sections.len().saturating_sub(1) as u32,
        });
        // More than 32 bits can count are refused before they are used.
        (self.points.len() - 1) as u32
    }

    /// The morphology, its oddities told to `warnings`.
    pub(crate) fn build(mut self, name: &str, warnings: &mut Warnings) -> Located<Morphology> {
        if self.outlines.is_empty() && self.points.is_empty() {
            return Err((1, Fault::NoSample));
        }
        if u32::try_from(self.points.len()).is_err() {
            return Err((1, Fault::TooMany));
        }
        let (mut nodes, mut lines) = (Vec::new(), Vec::new());
        let mut starts: Vec<u32> = Vec::with_capacity(self.outlines.len());
        for (outline, hung_on) in self.outlines.iter().zip(slices(&self.outlines)) {
            let first = nodes.len() as u32;
            starts.push(first);
            for (i, sample) in (0..).zip(outline) {
                let parent = match i {
                    0 => hung_on.map(|earlier| starts[earlier]),
                    _ => Some(first + i - 1),
                };
                nodes.push(node(sample, NeuriteKind::SOMA, parent, nodes.len()));
                lines.push(sample.line);
            }
        }
        let sections = self.neurites(&mut nodes, &mut lines)?;
        let header = std::mem::take(&mut self.header);
        let built = Morphology::from_outlined_nodes(name, header, &nodes, &sections).map_err(
            |e| match e {
                BuildError::Cycle { node } => (lines[node as usize], Fault::OwnAncestor),
                BuildError::OutOfRange { node } => (
                    lines[node as usize],
                    Fault::OutOfRange {
                        column: "a number",
                        text: "too large".into(),
                    },
                ),
                BuildError::UnknownParent { .. } | BuildError::TooMany { .. } => {
                    (1, Fault::TooMany)
                }
            },
        )?;
        warnings.add_notes(built.notes, |node| lines[node as usize]);
        let mut morphology = built.morphology;
        let origin = morphology.origin;
        let spines = self.spines.iter().map(|&spine| (spine - origin).as_vec3());
        morphology.spines = spines.filter(|spine| spine.is_finite()).collect();
        Ok(morphology)
    }

    /// Appends the neurites' nodes without copies, and gives the sections that have numbers.
    fn neurites(&self, nodes: &mut Vec<Node>, lines: &mut Vec<u64>) -> Located<Vec<FileSection>> {
        let roots = self.points.iter().filter(|point| point.parent.is_none());
        let soma = SomaPoints::new(nodes.iter().map(|n| n.position), roots.count());
        let copies = self.copies();
        let (sections, numbers) = self.numbered_sections(&copies);
        let kept_before: Vec<u32> = copies
            .iter()
            .scan(nodes.len() as u32, |next, &copy| {
                let own = *next;
                *next += u32::from(!copy);
                Some(own)
            })
            .collect();
        // Where a chain of copies ends, so that no chain is walked twice.
        let mut ends: Vec<Option<Option<u32>>> = vec![None; self.points.len()];
        for (point, _) in self.points.iter().zip(&copies).filter(|(_, copy)| !**copy) {
            // Copies may hang on copies; more steps than points is a ring of them.
            let mut parent = point.parent;
            let mut walked = Vec::new();
            while let Some(p) = parent.filter(|&p| copies[p as usize]) {
                if let Some(end) = ends[p as usize] {
                    parent = end;
                    break;
                }
                walked.push(p as usize);
                parent = self.points[p as usize].parent;
                if walked.len() > self.points.len() {
                    return Err((point.sample.line, Fault::OwnAncestor));
                }
            }
            for copy in walked {
                ends[copy] = Some(parent);
            }
            let parent = match parent {
                Some(p) => Some(kept_before[p as usize]),
                None => soma.nearest(point.sample.position),
            };
            let mut node = node(&point.sample, point.kind, parent, nodes.len());
            node.section = numbers[point.section as usize].and_then(FileSectionId::new);
            nodes.push(node);
            lines.push(point.sample.line);
        }
        Ok(sections)
    }

    /// The sections that have numbers, and by section its index among them.
    fn numbered_sections(&self, copies: &[bool]) -> (Vec<FileSection>, Vec<Option<u32>>) {
        let mut empty = vec![true; self.sections.len()];
        for (point, _) in self.points.iter().zip(copies).filter(|(_, copy)| !**copy) {
            empty[point.section as usize] = false;
        }
        let mut count = 0;
        let number = |&empty: &bool| {
            let numbered = self.empty_sections_count || !empty;
            count += u32::from(numbered);
            numbered.then(|| count - 1)
        };
        let numbers: Vec<Option<u32>> = empty.iter().map(number).collect();
        // A section that hangs on one without a number hangs on what that one hangs on; where sections have none, parents
        // stand before their children.
        let mut above: Vec<Option<u32>> = Vec::with_capacity(numbers.len());
        for (section, &number) in self.sections.iter().zip(&numbers) {
            let parent = section.parent.map(|parent| parent as usize);
            let inherited = parent.and_then(|parent| above.get(parent).copied().flatten());
            above.push(number.or(inherited));
        }
        let above = |parent: u32| match numbers[parent as usize] {
            None => above[parent as usize],
            number => number,
        };
        let all = self.sections.iter().zip(&empty).zip(&numbers);
        let sections = all.filter(|(_, number)| number.is_some());
        let sections = sections.map(|((section, &empty), _)| FileSection {
            parent: section.parent.and_then(above),
            empty,
            ..*section
        });
        (sections.collect(), numbers)
    }

    /// Which points only repeat the one that they branch from.
    fn copies(&self) -> Vec<bool> {
        let mut has_child = vec![false; self.points.len()];
        for p in self.points.iter().filter_map(|p| p.parent) {
            has_child[p as usize] = true;
        }
        let copy = |(point, has_child): (&Traced, bool)| {
            let Some(parent) = point.parent.filter(|_| point.starts) else {
                return false;
            };
            let parent = &self.points[parent as usize];
            parent.sample.position == point.sample.position
                && (parent.sample.radius == point.sample.radius || !has_child)
        };
        self.points.iter().zip(has_child).map(copy).collect()
    }
}

fn node(sample: &Sample, kind: NeuriteKind, parent: Option<u32>, before: usize) -> Node {
    Node {
        id: before as i64 + 1,
        kind,
        position: sample.position,
        radius: sample.radius,
        parent,
        section: None,
    }
}

/// The box of an outline, with its number, its middle and its reach.
type Outline = GeomWithData<Rectangle<[f64; 3]>, (usize, DVec3, f64)>;

/// For each outline an earlier one that it is a slice beside, if any: the latest that is found by way of
/// its box, so that many outlines take no longer than they must.
fn slices(outlines: &[Vec<Sample>]) -> Vec<Option<usize>> {
    let sphere = |outline: &Vec<Sample>| {
        let center = outline.iter().map(|s| s.position).sum::<DVec3>() / outline.len() as f64;
        let reach = outline
            .iter()
            .map(|s| s.position.distance(center).max(s.radius));
        (center, reach.fold(0.0, f64::max))
    };
    let mut earlier: RTree<Outline> = RTree::new();
    let one = |(i, outline): (usize, &Vec<Sample>)| {
        let (center, reach) = sphere(outline);
        // What is out of range is refused when the nodes are built.
        if !is_place(center) || reach.is_nan() || reach > Morphology::MAX_COORDINATE {
            return None;
        }
        let (low, high) = ((center - reach).to_array(), (center + reach).to_array());
        let beside = earlier
            .locate_in_envelope_intersecting(AABB::from_corners(low, high))
            .map(|found| found.data)
            .find(|&(_, other, far)| other.distance(center) <= far + reach);
        // Of slices of one soma its first stands for all that are within its reach.
        let inside = |&(_, other, far): &(usize, DVec3, f64)| other.distance(center) + reach <= far;
        if beside.as_ref().is_none_or(|found| !inside(found)) {
            let bounds = Rectangle::from_corners(low, high);
            earlier.insert(GeomWithData::new(bounds, (i, center, reach)));
        }
        beside.map(|(k, ..)| k)
    };
    outlines.iter().enumerate().map(one).collect()
}

/// Whether a tree of places takes it.
fn is_place(position: DVec3) -> bool {
    position.is_finite() && position.abs().max_element() <= Morphology::MAX_COORDINATE
}

/// The points of somata, to find the nearest to a place: in a list, or in a tree where that is asked often.
enum SomaPoints {
    Few(Vec<(DVec3, u32)>),
    Tree(RTree<GeomWithData<[f64; 3], u32>>),
}

/// Questions up to which a list is surely quicker: of 22,026 points a tree takes 3.4 ms to make, a question of a list 0.04 ms.
const WORTH_A_TREE: usize = 40;

impl SomaPoints {
    /// `asked`: how often.
    fn new(positions: impl Iterator<Item = DVec3>, asked: usize) -> Self {
        let points = positions.zip(0..).filter(|(p, _)| is_place(*p));
        if asked <= WORTH_A_TREE {
            return Self::Few(points.collect());
        }
        let points = points.map(|(p, i)| GeomWithData::new(p.to_array(), i));
        Self::Tree(RTree::bulk_load(points.collect()))
    }

    /// The first of those that are nearest.
    fn nearest(&self, position: DVec3) -> Option<u32> {
        if !is_place(position) {
            return None;
        }
        match self {
            Self::Few(points) => {
                let (mut least, mut nearest) = (f64::INFINITY, None);
                for &(point, number) in points {
                    let far = point.distance_squared(position);
                    if far < least {
                        (least, nearest) = (far, Some(number));
                    }
                }
                nearest
            }
            Self::Tree(tree) => {
                let nearest = tree.nearest_neighbors(&position.to_array());
                nearest.into_iter().map(|point| point.data).min()
            }
        }
    }
}
