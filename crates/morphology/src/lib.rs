//! The morphology of a neuron as flat arrays: **somata**, **sections** and **points**.
//!
//! A **point** is a traced center with a *radius*; a **section** is a maximal unbranched run of
//! points of one kind; a **neurite** is a tree of sections. Lengths are micrometers (µm).
//!
//! Points stand in depth-first order, so that a section is a range of them and a parent always
//! comes before its children. A section holds its own points only: the point that it branches
//! from is the last one of its parent section and is not repeated.
//!
//! ```text
//!  soma ●──○──○──○        section 0: points 0..3, attached to the soma
//!                 ├─○─○   section 1: points 3..5, parent section 0
//!                 └─○     section 2: points 5..6, parent section 0
//! ```
//!
//! Readers and generators hand over flat **nodes** and get the arrays from
//! [`Morphology::from_nodes`]. [`Measures::of`] measures a cell, the functions of [`shape`] its sections, [`exposed_areas`]
//! what shows of them, [`sholl`] its reach and [`barcode`](mod@barcode) its branching, [`paths`] what lies between two of its locations,
//! and a [`Membrane`] gives places on it; [`edit`] mends tracings and [`Difference`] compares two.
//!
//! ```
//! use glam::DVec3;
//! use neurotess_morphology::{Measures, Morphology, NeuriteKind, Node};
//!
//! let node = |id, kind, y, parent| Node {
//!     id,
//!     kind,
//!     position: DVec3::new(0.0, y, 0.0),
//!     radius: 1.0,
//!     parent,
//!     section: None,
//! };
//! let nodes = [
//!     node(1, NeuriteKind::SOMA, 0.0, None),
//!     node(2, NeuriteKind::AXON, 5.0, Some(0)),
//!     node(3, NeuriteKind::AXON, 9.0, Some(1)),
//! ];
//! let built = Morphology::from_nodes("axon", Vec::new(), &nodes)?;
//! assert_eq!(Measures::of(&built.morphology).length, 4.0); // the link to the soma is not counted
//! # Ok::<(), neurotess_morphology::BuildError>(())
//! ```
#![forbid(unsafe_code)]

pub mod barcode;
mod build;
mod diff;
pub mod edit;
mod exposed;
mod file_sections;
mod frustum;
mod kind;
mod measures;
mod membrane;
mod model;
mod nearest;
pub mod paths;
pub mod random;
mod sample_labels;
mod section_ends;
mod section_numbers;
pub mod shape;
pub mod sholl;
pub mod smoothing;
mod soma;

pub use build::{BuildError, BuildNote, Built, Node, Oddity};
pub use diff::{Difference, Differing, MatchedBy, Retyped, SomaDifference};
pub use exposed::exposed_areas;
pub use file_sections::Piece;
pub use kind::NeuriteKind;
pub use measures::{Bounds, LengthByType, Measures, SomaMeasures};
pub use membrane::{Membrane, MembranePlace};
pub use model::{
    Attachment, FileSection, FileSectionId, FileSections, Morphology, Point, Section, SectionId,
    Soma, SomaKind, SomaSample,
};
pub use sample_labels::SampleLabels;
pub use section_ends::{SectionEnds, SectionPart};
pub use section_numbers::{Program, SectionNumbers, SectionPlace};
pub use soma::{Hidden, SomaMeshError, SomaShape, soma_area_volume};
