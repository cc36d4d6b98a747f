//! Model 1: the arrays and their invariants.

use std::num::NonZeroU32;
use std::ops::Range;

use glam::{DVec3, Vec3};

use crate::NeuriteKind;

/// A traced cell. Positions are `f32`, in µm relative to [`origin`](Self::origin).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Morphology {
    /// Name for people: the file's stem, or what made the cell.
    pub name: String,
    /// What to add to every position to get the file's coordinates (µm). Zero unless the
    /// coordinates are so large that `f32` would lose hundredths of a micrometer.
    pub origin: DVec3,
    /// Somata, the main one first; nearly always one or none.
    pub somata: Vec<Soma>,
    /// Points of all neurites in depth-first order.
    pub points: Vec<Point>,
    /// The file's own number of each point; as many as `points`.
    pub sample_ids: Vec<i64>,
    /// Sections in depth-first order: a parent stands before its children, and the ranges of
    /// points follow one another without a gap.
    pub sections: Vec<Section>,
    /// Sections as the file has them, which other programs number.
    pub file_sections: FileSections,
    /// Comment lines of the file's header, without the comment sign.
    pub header: Vec<String>,
    /// Spines that the file tells of without tracing them (µm, relative to the origin): where each ends, or where it
    /// is on its dendrite. They are no part of the tree until [`Edit::Spines`](crate::edit::Edit::Spines) grows them.
    pub spines: Vec<Vec3>,
}

/// Center (µm, relative to the morphology's origin) and radius (µm) of a traced point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Point {
    /// Center.
    pub position: Vec3,
    /// Radius; as the file gave it, so possibly zero or negative.
    pub radius: f32,
}

/// Index of a section in [`Morphology::sections`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SectionId(pub u32);

impl SectionId {
    /// The index as a `usize`.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A maximal unbranched run of points of one kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Section {
    /// What it is.
    pub kind: NeuriteKind,
    /// What its first point hangs on.
    pub attachment: Attachment,
    /// First own point.
    pub first: u32,
    /// One past the last own point; always greater than `first`.
    pub end: u32,
}

impl Section {
    /// Range of the section's own points in [`Morphology::points`].
    pub fn range(&self) -> Range<usize> {
        self.first as usize..self.end as usize
    }

    /// The parent section, if it has one.
    pub fn parent(&self) -> Option<SectionId> {
        match self.attachment {
            Attachment::Section(id) => Some(id),
            Attachment::Soma { .. } | Attachment::Free => None,
        }
    }
}

/// The sections of a file, and which points are from which.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FileSections {
    /// In the order of the file. Those whose points were taken away by an edit stay, so that the others keep their numbers.
    pub sections: Vec<FileSection>,
    /// By point: index in `sections`. Empty where a morphology was not made from nodes: then sections of the file are
    /// ours.
    pub of_points: Vec<u32>,
    /// Whether the format has sections; otherwise they are ours, in the order of their first samples in the file.
    pub told: bool,
}

/// Index of a section in the file that a node is from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FileSectionId(NonZeroU32);

impl FileSectionId {
    /// The section of this index; none of the last number that 32 bits hold.
    pub fn new(index: u32) -> Option<Self> {
        NonZeroU32::new(index.wrapping_add(1)).map(Self)
    }

    /// Index in [`FileSections::sections`].
    pub fn index(self) -> usize {
        self.0.get() as usize - 1
    }
}

/// A section as the file has it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FileSection {
    /// Its type.
    pub kind: NeuriteKind,
    /// Index of the file's section that it hangs on; none on a soma, or on nothing.
    pub parent: Option<u32>,
    /// Whether it has no point but a copy of the one that it branches from.
    pub empty: bool,
}

/// What a section's first point hangs on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Attachment {
    /// The last point of another section.
    Section(SectionId),
    /// A sample of a soma.
    Soma {
        /// Index in [`Morphology::somata`].
        soma: u32,
        /// Index in [`Soma::samples`].
        sample: u32,
    },
    /// Nothing: the root of a tree without a soma.
    Free,
}

/// How a file described its soma.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SomaKind {
    /// One sample: a sphere.
    Point,
    /// NeuroMorpho's three samples: a center and two at ± radius, standing for a sphere.
    ThreePoint,
    /// An outline.
    Contour,
    /// Two or more samples: stacked frusta.
    Cylinders,
    /// Samples on its surface, all around one in its middle: a sphere.
    Surface,
}

impl SomaKind {
    /// Name as the command line and the Python package give it.
    ///
    /// ```
    /// assert_eq!(neurotess_morphology::SomaKind::ThreePoint.name(), "three_point");
    /// ```
    pub fn name(self) -> &'static str {
        match self {
            Self::Point => "point",
            Self::ThreePoint => "three_point",
            Self::Contour => "contour",
            Self::Cylinders => "cylinders",
            Self::Surface => "surface",
        }
    }
}

/// A soma: what was traced of it and the sphere that stands for it.
#[derive(Clone, Debug, PartialEq)]
pub struct Soma {
    /// How it was traced.
    pub kind: SomaKind,
    /// The traced samples, in the file's order.
    pub samples: Vec<SomaSample>,
    /// Center (µm, relative to the morphology's origin): the mean of the samples; of a contour the
    /// centroid of its area.
    pub center: Vec3,
    /// Radius (µm) of the sphere that stands for it: the sample's own, or that of equal area.
    pub radius: f32,
}

/// One traced sample of a soma.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SomaSample {
    /// The file's own number of it.
    pub id: i64,
    /// Position (µm, relative to the morphology's origin).
    pub position: Vec3,
    /// Radius (µm) as the file gave it.
    pub radius: f32,
    /// Index of its parent among the soma's samples.
    pub parent: Option<u32>,
}

impl AsRef<Self> for Morphology {
    fn as_ref(&self) -> &Self {
        self
    }
}

impl Morphology {
    /// The main soma, if there is one.
    pub fn soma(&self) -> Option<&Soma> {
        self.somata.first()
    }

    /// Points of a section, without the one that it branches from.
    ///
    /// # Panics
    /// If the id is not of this morphology.
    pub fn section_points(&self, id: SectionId) -> &[Point] {
        &self.points[self.sections[id.index()].range()]
    }
}
