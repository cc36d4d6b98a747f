//! Synthetic neurons: plausible trees of six **kinds**, the same for the same **seed** on every
//! machine.
//!
//! ```
//! use neurotess_synth::{Kind, Options, grow};
//!
//! let cell = grow(&Options { points: Some(800), ..Options::new(Kind::Pyramidal, 7) });
//! assert_eq!(cell.points.len(), 800);
//! assert_eq!(cell.name, "pyramidal_7");
//! ```
//!
//! **Theory.** A neurite starts with a budget of points. A branch spends some of it on a section and
//! shares the rest between two daughters, until what is left is a terminal; so the number of points
//! is met exactly, and larger cells have more and longer branches instead of denser samples. A
//! section is a walk with a heading (bent by tropism) and a wobble (an Ornstein-Uhlenbeck process,
//! which sets the contraction). Radii taper, and obey Rall's r^1.5 = r₁^1.5 + r₂^1.5 at forks as
//! long as no daughter is as thin as its kind of neurite gets. W. Rall, Branching dendritic trees
//! and motoneuron membrane resistivity, 1959. The numbers for each kind are in `kinds.rs`, and
//! `benchmarks/synthetic.md` compares the results with real cells.
//!
//! No branch grows through another or through the soma: see `room.rs`. Each step looks at what is near, and
//! turns away from it by as little as it must; what finds no way ends, and its points are spent elsewhere in the
//! neurite. With [`Options::may_cross`] branches take no notice of one another.
//!
//! **Practice.** Some milliseconds for 5,000 points. Only additions, multiplications, divisions and square
//! roots are the processor's; all else is `libm`'s, so that results do not depend on the platform.
//!
//! Why not a published growth model (TMD, TREES' minimum spanning trees, NETMORPH)? They need
//! measured distributions or targets per cell type; these cells are for tests and benchmarks.
#![forbid(unsafe_code)]

mod branch;
#[cfg(feature = "circuit")]
pub mod circuit;
mod grown;
mod kind;
mod kinds;
mod room;
mod soma;
mod spec;
mod stems;

use std::ops::RangeInclusive;

use neurotess_morphology::Morphology;
use neurotess_morphology::random::Random;

use grown::Grown;
pub use kind::{Kind, UnknownKind};
use room::Room;

/// How many points a cell may have outside its soma.
pub const POINTS: RangeInclusive<usize> = 50..=500_000;

/// Which cell to grow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// What kind of neuron.
    pub kind: Kind,
    /// Cells of one kind differ by it.
    pub seed: u64,
    /// Points outside the soma, within [`POINTS`] (taken as the nearest end otherwise); `None` for
    /// what is usual for the kind.
    pub points: Option<usize>,
    /// Branches take no notice of one another and cross, as in tracings.
    pub may_cross: bool,
}

impl Options {
    /// A cell with its kind's usual number of points.
    pub fn new(kind: Kind, seed: u64) -> Self {
        Self {
            kind,
            seed,
            points: None,
            may_cross: false,
        }
    }

    /// The cell of a kind that lies in the repository's `samples`: enough to look at, small enough
    /// to keep.
    pub fn sample(kind: Kind) -> Self {
        let points = match kind {
            Kind::Pyramidal => 2000,
            Kind::Purkinje | Kind::Motor => 3000,
            Kind::Granule => 800,
            Kind::Basket | Kind::Star => 1500,
        };
        Self {
            points: Some(points),
            ..Self::new(kind, 1)
        }
    }
}

/// Grows a cell; it is named after its kind and seed. The soma's center is the origin, and up is y.
///
/// # Panics
/// Never: whatever is grown here is a forest with finite coordinates.
pub fn grow(options: &Options) -> Morphology {
    let spec = kinds::spec(options.kind);
    let points = options.points.unwrap_or(spec.points);
    let points = points.clamp(*POINTS.start(), *POINTS.end());
    let mut random = Random::new(options.seed, options.kind as u64);
    let soma = soma::samples(&spec, &mut random);
    let spacing = branch::spacing(&spec, points);
    let room = (!options.may_cross).then(|| Room::new(soma[0].radius, points, spacing));
    let mut grown = Grown::new(soma, room);
    branch::grow_all(&spec, points, &mut random, &mut grown);

    let name = format!("{}_{}", options.kind, options.seed);
    let seed = options.seed;
    let header = vec![format!(
        "synthetic {} neuron, seed {seed}, {points} points",
        options.kind
    )];
    let built = Morphology::from_nodes(name, header, &grown.nodes);
    let mut grown = built
        .expect("grown nodes have parents before them and finite coordinates")
        .morphology;
    // Sections and samples have the order of files, whatever grew first: NEURON refuses numbers that do not ascend.
    grown.number_sections_depth_first();
    let of_somata = grown.somata.iter_mut().flat_map(|soma| &mut soma.samples);
    let ids = of_somata.map(|sample| &mut sample.id);
    for (id, number) in ids.chain(&mut grown.sample_ids).zip(1..) {
        *id = number;
    }
    grown
}
