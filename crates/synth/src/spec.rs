//! What makes a kind of neuron: numbers for the soma and for each of its trees.

use glam::DVec3;
use neurotess_morphology::NeuriteKind;

/// A kind of neuron at its usual number of points. Lengths and radii are µm.
pub(crate) struct Spec {
    /// Usual number of points.
    pub(crate) points: usize,
    /// Mean distance of points; smaller in larger cells.
    pub(crate) spacing: f64,
    /// Range of the soma's radius.
    pub(crate) soma_radius: (f64, f64),
    /// Three samples for the soma, or one.
    pub(crate) three_point: bool,
    pub(crate) trees: Vec<Tree>,
}

/// One sort of neurite of a kind of neuron.
#[derive(Clone)]
pub(crate) struct Tree {
    pub(crate) kind: NeuriteKind,
    /// Part of the cell's points.
    pub(crate) share: f64,
    /// How many, at least and at most.
    pub(crate) stems: (u32, u32),
    /// Middle of the directions they start in, and the cosine of the greatest angle with it.
    pub(crate) aim: (DVec3, f64),
    /// Radius at the soma.
    pub(crate) radius: f64,
    /// Radius that tapering and forks end at.
    pub(crate) thinnest: f64,
    /// Length in which the radius above the thinnest falls by e.
    pub(crate) taper: f64,
    /// Mean length between forks.
    pub(crate) section: f64,
    /// Mean length of terminals.
    pub(crate) terminal: f64,
    /// Part of the points that the lesser daughter gets.
    pub(crate) split: (f64, f64),
    /// Angle between daughters (radians).
    pub(crate) angle: (f64, f64),
    pub(crate) tropism: Tropism,
    /// Sideways part of a step; 0.42 contracts to about 0.92.
    pub(crate) wobble: f64,
    /// Side branches before the tree splits up.
    pub(crate) trunk: Option<Trunk>,
    /// Stays near the plane z = 0.
    pub(crate) flat: bool,
}

/// What bends a branch: a direction and its strength per µm.
#[derive(Clone, Copy)]
pub(crate) enum Tropism {
    /// Away from the soma.
    Away(f64),
    /// One way.
    To(DVec3, f64),
}

/// A main branch and what comes of it.
#[derive(Clone, Copy)]
pub(crate) struct Trunk {
    /// Number of side branches in a cell of the usual size.
    pub(crate) sides: f64,
    /// Part of the tree's points for all of them together.
    pub(crate) share: f64,
    /// Mean length between them.
    pub(crate) section: f64,
    /// The trunk ends in two branches along ±x instead of an ordinary fork.
    pub(crate) tee: bool,
}
