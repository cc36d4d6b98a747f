//! Edits of a tracing: units, places, types, spacing, noise, roots, pieces, cuts, radii, spines.
//!
//! An [`Edit`] says what to do, [`apply`] does several in the order given, each to what the one before made
//! of the tracing, and an [`EditReport`] says what each has changed. The tracing itself stays as it is, so
//! a report without the result is a dry run.
//!
//! **Theory.** A tracing is taken apart into the nodes that a file would have, the nodes are edited, and
//! [`Morphology::from_nodes`] puts them together again. So every edit gives a tracing that a file could
//! have given, with its sections, somata and origin as reading that file would find them. Somata that
//! were traced as outlines stay outlines.
//!
//! **Practice.** Each edit is a file of its own and takes time that is linear in the samples, or n log n
//! where it sorts. Lengths are µm in the tracing's own frame; angles are radians.
//!
//! ```
//! use glam::DVec3;
//! use neurotess_morphology::edit::{self, Edit};
//! use neurotess_morphology::{Measures, Morphology, NeuriteKind, Node};
//!
//! let nodes: Vec<Node> = (0..11_u32)
//!     .map(|i| Node {
//!         id: i64::from(i) + 1,
//!         kind: NeuriteKind::AXON,
//!         position: DVec3::new(1000.0 * f64::from(i), 0.0, 0.0), // nanometers
//!         radius: 500.0,
//!         parent: i.checked_sub(1),
//!         section: None,
//!     })
//!     .collect();
//! let traced = Morphology::from_nodes("axon", Vec::new(), &nodes)?.morphology;
//! let edits = [Edit::Scale(DVec3::splat(0.001)), Edit::Resample { spacing: 5.0 }];
//! let edited = edit::apply(&traced, &edits)?;
//! assert_eq!(Measures::of(&edited.morphology).length, 10.0);
//! assert_eq!(edited.morphology.points.len(), 3);
//! assert_eq!(edited.reports[0].length.before, 10_000.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod cut;
mod join;
mod mend;
mod nodes;
mod place;
mod report;
mod resample;
mod root;
mod simplify;
mod smooth;
mod spines;
mod within;

use glam::{DAffine3, DVec3};
use thiserror::Error;

pub use report::{BeforeAfter, EditReport};
pub use spines::{SPINE, SPINE_REACH};

use crate::smoothing::SmoothingLength;
use crate::{BuildError, Morphology, NeuriteKind, SectionId};
use nodes::{Edits, Nodes};

/// One edit of a tracing.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Edit {
    /// Gives samples other types, all at once: `[(2, 3), (3, 2)]` swaps them. Types that are not named stay.
    /// Type 1 makes samples a part of the soma, and takes them out of it where it is renamed.
    Types(Vec<(NeuriteKind, NeuriteKind)>),
    /// Multiplies the coordinates of each axis by a factor above 0, as for units and voxels. Radii, which are
    /// measured in the plane of the image, are multiplied by √(x·y).
    Scale(DVec3),
    /// Gives neurites' samples without a radius above 0 the one between their nearest neighbors along the
    /// tree that have one, in proportion to the distance. `outliers`: also those whose radius is more than so
    /// many times that of their neighborhood, or less than its so-manieth part; `None` for none.
    MendRadii {
        /// Factor from which on a radius is an outlier.
        outliers: Option<f64>,
    },
    /// Makes the sample of this number the root of its tree, which must have no soma.
    Reroot {
        /// The file's number of the sample.
        sample: i64,
    },
    /// Connects pieces without a soma to the nearest sample of another piece, where that is no farther than
    /// this distance (µm). A soma is as near as its surface. Pieces that have a soma each stay apart.
    Join {
        /// Greatest distance (µm); infinite for any.
        distance: f64,
    },
    /// Keeps the sample of this number and what hangs on it, and nothing else.
    Subtree {
        /// The file's number of the sample.
        sample: i64,
    },
    /// Takes away the samples of these numbers and all that hangs on them. A soma goes only as a whole, by its
    /// first sample, and its neurites with it.
    Cut {
        /// The file's numbers of the samples. One may hang on another.
        samples: Vec<i64>,
    },
    /// Takes away the samples of these types. What hung on them and is of another type stays where it is, as a
    /// piece of its own.
    DropTypes(Vec<NeuriteKind>),
    /// Takes away what is farther along the tree (µm) than this distance: from the soma's center, the way to
    /// a neurite's first sample being straight (as in [`paths`](crate::paths)), or without a soma from the root.
    /// A neurite is cut at the distance, where it gets a sample with a number beyond those that there are.
    Within {
        /// Greatest distance along the tree (µm).
        distance: f64,
    },
    /// Takes away twigs that are shorter than a length (µm): what lies between an end and the fork, or the soma,
    /// before it. Once: a twig that comes to be by it stays, as by navis' `prune_twigs`. A piece without a
    /// soma and without a fork is no twig.
    Prune {
        /// Length from which on twigs stay (µm); the way from a soma to its neurite does not count.
        length: f64,
    },
    /// Smooths the noise away, as [`smoothing`](crate::smoothing) explains. Roots, forks, ends and changes of
    /// type stay.
    Smooth(SmoothingLength),
    /// Replaces the samples of each section by ones at equal distances along it: the length of the section
    /// over a whole number, as near to the spacing (µm) as possible. Roots, forks, ends and changes of type
    /// stay; all samples are numbered anew.
    Resample {
        /// Distance of samples along the section (µm).
        spacing: f64,
    },
    /// Leaves out samples as long as the membrane of the rest, a tube of frusta, moves by no more than the
    /// tolerance (µm). Roots, forks, ends and changes of type stay.
    Simplify {
        /// Greatest move of the membrane (µm).
        tolerance: f64,
    },
    /// Grows spines, samples of type [`SPINE`]. How many had no room, or no dendrite near them, is
    /// [`EditReport::left`].
    Spines {
        /// Where they grow.
        places: SpinePlaces,
        /// Another seed gives other directions and sizes, and where a density is given other places.
        seed: u64,
    },
    /// Places the cell elsewhere, as a circuit does with its cells. Radii are multiplied by the cube root of the
    /// determinant.
    Place(DAffine3),
    /// Moves the soma's center, or without a soma the first root, to the origin.
    Recenter,
    /// Turns around an axis through the origin by an angle (radians), counterclockwise as seen from
    /// the axis' tip.
    Rotate {
        /// The axis; its length does not matter.
        axis: DVec3,
        /// Angle (radians).
        angle: f64,
    },
    /// Mirrors: the coordinates of this axis (0 for x, 1 for y, 2 for z) change their sign.
    Mirror {
        /// Number of the axis.
        axis: usize,
    },
}

/// Where spines grow.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum SpinePlaces {
    /// So many for each µm of basal and apical dendrites, at most: bases are at least two radii of the dendrite
    /// apart.
    Density(f64),
    /// Where the file tells of spines: [`Morphology::spines`], which are in the tree then.
    File,
    /// At these places (µm, the file's coordinates), as those of synapses: on the nearest neurite within
    /// [`SPINE_REACH`] µm, unless that is an axon or the soma. Half a µm and more beyond the membrane, a place is where the spine ends; on
    /// it, where it leaves the dendrite; near the axis, it says nothing of the direction.
    At(Vec<DVec3>),
    /// At these shares of sections' lengths, from 0 at the start to 1 at the end, in random directions. Axons carry
    /// none.
    Along(Vec<(SectionId, f64)>),
}

impl Edit {
    /// Name for machines, like that of the command line's option.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Types(_) => "types",
            Self::Scale(_) => "scale",
            Self::MendRadii { .. } => "mend_radii",
            Self::Reroot { .. } => "reroot",
            Self::Join { .. } => "join",
            Self::Subtree { .. } => "subtree",
            Self::Cut { .. } => "cut",
            Self::DropTypes(_) => "drop_types",
            Self::Within { .. } => "within",
            Self::Prune { .. } => "prune",
            Self::Smooth(_) => "smooth",
            Self::Resample { .. } => "resample",
            Self::Simplify { .. } => "simplify",
            Self::Spines { .. } => "spines",
            Self::Place(_) => "place",
            Self::Recenter => "recenter",
            Self::Rotate { .. } => "rotate",
            Self::Mirror { .. } => "mirror",
        }
    }
}

/// Why an edit cannot be done: `what: what to do`.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum EditError {
    /// No sample has the number.
    #[error("no sample has the number {sample}: the numbers are from {least} to {most}")]
    NoSample {
        /// The number.
        sample: i64,
        /// The least number that a sample has; 0 without samples.
        least: i64,
        /// The greatest.
        most: i64,
    },
    /// No samples have the numbers.
    #[error(
        "no samples have the numbers {}: the numbers are from {least} to {most}",
        list(samples)
    )]
    NoSamples {
        /// The numbers, two or more.
        samples: Vec<i64>,
        /// The least number that a sample has; 0 without samples.
        least: i64,
        /// The greatest.
        most: i64,
    },
    /// A part of a soma is to go, but not all of it.
    #[error(
        "sample {sample} is a part of the soma, which is cut only as a whole: give {first}, its first sample, \
         to take the soma away with all that hangs on it"
    )]
    PartOfSoma {
        /// The number of the sample.
        sample: i64,
        /// The number of the soma's first sample.
        first: i64,
    },
    /// Nothing would be left.
    #[error("{} leaves nothing of the tracing: keep at least one sample", edit.replace('_', "-"))]
    NothingLeft {
        /// [`Edit::name`].
        edit: &'static str,
    },
    /// Several samples have the number.
    #[error(
        "several samples have the number {sample}: write the tracing as SWC first, which numbers them anew"
    )]
    RepeatedSample {
        /// The number.
        sample: i64,
    },
    /// The tree has a soma, which is its root.
    #[error(
        "sample {sample} is in a tree with a soma, which stays the root: give the soma another type before, \
         or leave the root where it is"
    )]
    RootIsSoma {
        /// The number of the sample.
        sample: i64,
    },
    /// A number of an edit means nothing.
    #[error("{what} is {value}: it must be {must}")]
    Number {
        /// Which one.
        what: &'static str,
        /// What was given.
        value: f64,
        /// What is possible.
        must: &'static str,
    },
    /// An axis that is none.
    #[error("axis {axis} is not one of 0, 1 and 2")]
    Axis {
        /// What was given.
        axis: usize,
    },
    /// More samples than a tracing should have.
    #[error(
        "a spacing of {spacing} µm makes {samples:.0} samples of the tracing: take a larger one"
    )]
    TooMany {
        /// The spacing (µm).
        spacing: f64,
        /// How many there would be.
        samples: f64,
    },
    /// More spines than a tracing should have.
    #[error("{density} spines for each µm are {spines:.0} of them: take fewer")]
    TooManySpines {
        /// Spines for each µm.
        density: f64,
        /// How many there would be.
        spines: f64,
    },
    /// More places of spines than a tracing should have.
    #[error("{places} places of spines are too many: take fewer")]
    TooManyPlaces {
        /// How many there are.
        places: usize,
    },
    /// The result is no morphology: coordinates grew beyond [`Morphology::MAX_COORDINATE`].
    #[error("the edit makes numbers too large ({0}): check its factor")]
    Build(#[from] BuildError),
}

fn list(numbers: &[i64]) -> String {
    let numbers: Vec<String> = numbers.iter().map(i64::to_string).collect();
    numbers.join(", ")
}

/// What [`apply`] gives.
#[derive(Clone, Debug, PartialEq)]
pub struct Edited {
    /// The edited tracing.
    pub morphology: Morphology,
    /// What each edit did, in their order.
    pub reports: Vec<EditReport>,
}

/// Applies edits one after the other. None gives an equal tracing.
///
/// # Errors
/// See [`EditError`]; nothing is edited then.
pub fn apply(morphology: &Morphology, edits: &[Edit]) -> Result<Edited, EditError> {
    let mut edited = Edited {
        morphology: morphology.clone(),
        reports: Vec::with_capacity(edits.len()),
    };
    for edit in edits {
        let before = &edited.morphology;
        let nodes = Nodes::of(before);
        let edits = apply_one(before, &nodes, edit)?;
        if edits.nodes.is_empty() && !nodes.nodes.is_empty() {
            return Err(EditError::NothingLeft { edit: edit.name() });
        }
        let after = nodes.rebuilt(before, &edits)?;
        let report = EditReport::new(edit.name(), before, &nodes, &after, &edits);
        edited.reports.push(report);
        edited.morphology = after;
    }
    Ok(edited)
}

fn apply_one(morphology: &Morphology, nodes: &Nodes, edit: &Edit) -> Result<Edits, EditError> {
    match *edit {
        Edit::Types(ref types) => Ok(place::retype(nodes, types)),
        Edit::Scale(factors) => place::scale(nodes, factors),
        Edit::MendRadii { outliers } => mend::mend_radii(morphology, nodes, outliers),
        Edit::Reroot { sample } => root::reroot(nodes, sample),
        Edit::Join { distance } => join::join(morphology, nodes, distance),
        Edit::Subtree { sample } => root::subtree(nodes, sample),
        Edit::Cut { ref samples } => cut::cut(morphology, nodes, samples),
        Edit::DropTypes(ref types) => Ok(cut::drop_types(nodes, types)),
        Edit::Within { distance } => within::within(morphology, nodes, distance),
        Edit::Prune { length } => cut::prune(nodes, length),
        Edit::Smooth(length) => smooth::smooth(morphology, nodes, length),
        Edit::Resample { spacing } => resample::resample(morphology, nodes, spacing),
        Edit::Simplify { tolerance } => simplify::simplify(morphology, nodes, tolerance),
        Edit::Spines { ref places, seed } => spines::grow(morphology, nodes, places, seed),
        Edit::Place(ref placement) => place::place(nodes, placement),
        Edit::Recenter => Ok(place::recenter(morphology, nodes)),
        Edit::Rotate { axis, angle } => place::rotate(nodes, axis, angle),
        Edit::Mirror { axis } => place::mirror(nodes, axis),
    }
}

/// An error unless a number is above 0 and finite.
fn positive(what: &'static str, value: f64) -> Result<f64, EditError> {
    if value > 0.0 && value.is_finite() {
        return Ok(value);
    }
    Err(EditError::Number {
        what,
        value,
        must: "above 0 and finite",
    })
}
