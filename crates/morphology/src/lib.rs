//! The morphology of a neuron as flat arrays: **somata**, **sections** and **points**.
//!
//! A **point** is a traced centre with a *radius*; a **section** is a maximal unbranched run of
//! points of one kind; a **neurite** is a tree of sections. Lengths are micrometres (µm).
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
#![forbid(unsafe_code)]

mod kind;
mod model;

pub use kind::NeuriteKind;
pub use model::{Attachment, Morphology, Point, Section, SectionId, Soma, SomaKind, SomaSample};
