//! What was odd about the nodes, told once per kind of oddity.

use std::collections::BTreeMap;
use std::fmt;

use super::Node;
use crate::{Soma, SomaKind};

/// Something that a reader should warn of; the morphology is usable all the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Oddity {
    /// No sample is of type 1.
    NoSoma,
    /// All samples are of type 1, and run on as neurites do: taken as neurites.
    AllSoma,
    /// A tree's root was a neurite's point and its soma elsewhere: the soma is the root now.
    SomaNotRoot,
    /// Somata lie in the same place: taken as one.
    CoincidentSomata,
    /// Samples of type 1 form several somata.
    SeveralSomata,
    /// The samples of a soma fork, other than those of a three-point soma.
    SomaBranches,
    /// Samples of a soma have no radius of their own.
    SomaMarks,
    /// A soma has no positive radius.
    SomaZeroRadius,
    /// Samples of type 1 inside a neurite, apart from the tree's soma: kept as points.
    SomaInsideNeurite,
    /// Neurites that hang on nothing and begin within a soma: taken as the soma's.
    RootInSoma,
    /// Neurites that hang on nothing: beside a soma, or several of them.
    Disconnected,
    /// Points with radius zero.
    ZeroRadius,
    /// Samples with a negative radius.
    NegativeRadius,
    /// The cell is far larger than neurons are, as if its unit were not the micrometer.
    TooLarge,
    /// The cell is so small that its unit is likely the millimeter or the meter.
    TooSmall,
    /// A skeleton whose radii are all one round number, as exporters write that know none.
    EqualRadii,
    /// A skeleton without types, one sample of which is far thicker than all others, as a soma is.
    ThickSample,
}

impl Oddity {
    /// Name for machines.
    pub fn code(self) -> &'static str {
        match self {
            Self::NoSoma => "no_soma",
            Self::AllSoma => "all_soma",
            Self::SomaNotRoot => "soma_not_root",
            Self::CoincidentSomata => "coincident_somata",
            Self::SeveralSomata => "several_somata",
            Self::SomaBranches => "soma_branches",
            Self::SomaMarks => "soma_marks",
            Self::SomaZeroRadius => "soma_zero_radius",
            Self::SomaInsideNeurite => "soma_inside_neurite",
            Self::RootInSoma => "root_in_soma",
            Self::Disconnected => "disconnected",
            Self::ZeroRadius => "zero_radius",
            Self::NegativeRadius => "negative_radius",
            Self::TooLarge => "too_large",
            Self::TooSmall => "too_small",
            Self::EqualRadii => "equal_radii",
            Self::ThickSample => "thick_sample",
        }
    }
}

impl fmt::Display for Oddity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NoSoma => "no sample is of type 1: the cell has no soma",
            Self::AllSoma => "all samples are of type 1, the soma's: taken as neurites without a soma",
            Self::SomaNotRoot => "the soma is not the root of its tree: re-rooted there",
            Self::CoincidentSomata => "somata in the same place: taken as one",
            Self::SeveralSomata => "several separate somata: the thickest is taken as the main one",
            Self::SomaBranches => "the samples of the soma fork: taken as frusta along the links, or as an outline if they have no thickness",
            Self::SomaMarks => "samples of the soma have no radius of their own: taken as places on its outline or surface, or left out",
            Self::SomaZeroRadius => "the soma has no radius",
            Self::SomaInsideNeurite => "soma samples inside a neurite: kept as points of type 1",
            Self::RootInSoma => "neurites that begin within the soma and hang on nothing: taken as the soma's",
            Self::Disconnected => "neurites that are connected to nothing: kept where they are",
            Self::ZeroRadius => "points with radius zero",
            Self::NegativeRadius => "negative radius: kept, measured as zero",
            Self::TooLarge => "the cell is far larger than neurons are: its unit may be the nanometer or the voxel",
            Self::TooSmall => "the cell is far smaller than neurons are: its unit may be the millimeter or the meter",
            Self::EqualRadii => "all radii are one round number, as if none were known: export them, too (meshparty: radius=), or give those of the neurites by --radius-factor",
            Self::ThickSample => "a sample without type is far thicker than all others, as a soma: if it is one, give it type 1",
        })
    }
}

/// An oddity and where it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BuildNote {
    /// What is odd.
    pub oddity: Oddity,
    /// Index of the first node that is so.
    pub node: u32,
    /// How many are.
    pub count: u64,
}

/// The oddities so far: first node and count of each.
#[derive(Default)]
pub(super) struct Notes(BTreeMap<Oddity, (u32, u64)>);

impl Notes {
    pub(super) fn add(&mut self, oddity: Oddity, node: u32) {
        self.add_many(oddity, node, 1);
    }

    pub(super) fn add_many(&mut self, oddity: Oddity, node: u32, count: u64) {
        let entry = self.0.entry(oddity).or_insert((node, 0));
        *entry = (entry.0.min(node), entry.1 + count);
    }

    pub(super) fn soma(&mut self, soma: &Soma, members: &[u32]) {
        if soma.radius <= 0.0 {
            self.add(Oddity::SomaZeroRadius, members[0]);
        }
    }

    /// Of a soma whose samples are no outlines.
    pub(super) fn fork(&mut self, soma: &Soma, members: &[u32]) {
        if soma.is_marked() {
            self.add(Oddity::SomaMarks, members[0]);
            return;
        }
        let of_no_kind = matches!(soma.kind, SomaKind::Cylinders | SomaKind::Contour);
        if let Some(fork) = soma.fork().filter(|_| of_no_kind) {
            self.add(Oddity::SomaBranches, members[fork as usize]);
        }
    }

    /// Radii of points; those of somata are zero by right in contours.
    pub(super) fn radii(&mut self, nodes: &[Node], is_of_soma: impl Fn(u32) -> bool) {
        for (i, node) in (0_u32..).zip(nodes) {
            if node.radius < 0.0 {
                self.add(Oddity::NegativeRadius, i);
            } else if node.radius == 0.0 && !is_of_soma(i) {
                self.add(Oddity::ZeroRadius, i);
            }
        }
    }

    pub(super) fn into_vec(self) -> Vec<BuildNote> {
        let note = |(oddity, (node, count))| BuildNote {
            oddity,
            node,
            count,
        };
        self.0.into_iter().map(note).collect()
    }
}
