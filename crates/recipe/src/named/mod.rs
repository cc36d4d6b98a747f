//! Options by name, as flags, keywords and files give them.

mod entries;
mod from_options;
mod to_options;

use std::collections::BTreeMap;
use std::path::PathBuf;

use neurotess_generate::{Smooth, SomaKeep, SomaMethod, SphereKind};
use neurotess_morphology::NeuriteKind;
use neurotess_refine::{Caps, Path};

use crate::options::{LEVELS, LEVELS_ALONG, SOMA_LEVELS};
use crate::value::Given;
use crate::{Crossings, MeshOption, OptionValue, OptionsError, Radii};

/// Options by the names that flags of `neurotess mesh`, keywords of Python's `mesh` and files have. What is none has its
/// default, which depends on `simulation`.
///
/// ```
/// use neurotess_recipe::{MeshOptions, NamedOptions};
///
/// let mut named = NamedOptions::default();
/// named.simulation = true;
/// named.max_edge = Some(2.0);
/// let options = named.options()?;
/// assert!(options.is_simulation() && options.merges());
/// assert_eq!(NamedOptions::of(&options)?.options()?, options);
/// # Ok::<(), neurotess_recipe::OptionsError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct NamedOptions {
    /// Subdivisions of each coarse edge, 0 to 64; 0 gives the coarse quads.
    pub level: Option<u32>,
    /// As fine as keeps the surface within this distance (µm) of that of level 64, instead of `level`.
    pub max_error: Option<f64>,
    /// Subdivisions along neurites, 1 to 64; `level` is then for the edges around them.
    pub level_along: Option<u32>,
    /// Edges about so many local radii long, instead of `level`.
    pub isotropic: Option<f64>,
    /// With `isotropic`: longest edge (µm).
    pub max_edge: Option<f64>,
    /// With `isotropic`: shortest edge (µm) that is asked for.
    pub min_edge: Option<f64>,
    /// With `isotropic`: how many times as long edges along neurites may be.
    pub max_aspect: Option<f64>,
    /// Course between traced points.
    pub path: Option<Path>,
    /// Shape of the ends of neurites.
    pub caps: Option<Caps>,
    /// What becomes of places where the surface crosses itself.
    pub crossings: Option<Crossings>,
    /// Whether it is for solvers.
    pub simulation: bool,
    /// How the soma is made.
    pub soma: Option<SomaMethod>,
    /// Poisson's ratio of the soma's material, from 0 to below 0.5.
    pub poisson: Option<f64>,
    /// What of the soma stays as it was traced.
    pub soma_keep: Option<SomaKeep>,
    /// A file with the soma's surface.
    pub soma_mesh: Option<PathBuf>,
    /// Factor on the soma's radius.
    pub soma_scale: Option<f64>,
    /// Which radius rings of neurites have.
    pub radii: Option<Radii>,
    /// Factor on the radii of neurites, 0.01 to 1000.
    pub radius_factor: Option<f64>,
    /// Radius (µm) of points without one.
    pub radius: Option<f64>,
    /// Least radius (µm) of neurites.
    pub min_radius: Option<f64>,
    /// Type of the reference sphere.
    pub soma_sphere: Option<SphereKind>,
    /// Resolution of the reference sphere.
    pub soma_level: Option<u32>,
    /// Positions of first rings, 0 to 2, by the number of the neurite, from 1.
    pub ring: BTreeMap<u32, f64>,
    /// How much the noise of the tracing is smoothed away.
    pub smooth: Option<Smooth>,
    /// Types of neurites that are kept.
    pub types: Option<Vec<NeuriteKind>>,
    /// Quads where possible, instead of triangles.
    pub quads: bool,
}

impl NamedOptions {
    /// Sets an option by its keyword.
    ///
    /// # Errors
    /// There is no such option, or its value is of another kind.
    pub fn set(&mut self, keyword: &str, value: &OptionValue) -> Result<(), OptionsError> {
        let unknown = || OptionsError::Unknown {
            name: keyword.to_owned(),
        };
        let option = MeshOption::of_keyword(keyword).ok_or_else(unknown)?;
        let given = Given { option, value };
        match option {
            MeshOption::Level => self.level = Some(given.whole(LEVELS)?),
            MeshOption::MaxError => self.max_error = Some(given.number()?),
            MeshOption::LevelAlong => self.level_along = Some(given.whole(LEVELS_ALONG)?),
            MeshOption::Isotropic => self.isotropic = given.factor()?,
            MeshOption::MaxEdge => self.max_edge = Some(given.number()?),
            MeshOption::MinEdge => self.min_edge = Some(given.number()?),
            MeshOption::MaxAspect => self.max_aspect = Some(given.number()?),
            MeshOption::Path => self.path = Some(given.word()?),
            MeshOption::Caps => self.caps = Some(given.word()?),
            MeshOption::Crossings => self.crossings = Some(given.word()?),
            MeshOption::Simulation => self.simulation = given.switch()?,
            MeshOption::Soma => self.soma = Some(given.word()?),
            MeshOption::Poisson => self.poisson = Some(given.number()?),
            MeshOption::SomaKeep => self.soma_keep = Some(given.word()?),
            MeshOption::SomaMesh => self.soma_mesh = Some(given.path()?),
            MeshOption::SomaScale => self.soma_scale = Some(given.number()?),
            MeshOption::Radii => self.radii = Some(given.word()?),
            MeshOption::RadiusFactor => self.radius_factor = Some(given.number()?),
            MeshOption::Radius => self.radius = Some(given.number()?),
            MeshOption::MinRadius => self.min_radius = Some(given.number()?),
            MeshOption::SomaSphere => self.soma_sphere = Some(given.word()?),
            MeshOption::SomaLevel => self.soma_level = Some(given.whole(SOMA_LEVELS)?),
            MeshOption::Ring => self.ring = given.rings()?,
            MeshOption::Smooth => self.smooth = Some(given.smooth()?),
            MeshOption::Types => self.types = Some(given.kinds()?),
            MeshOption::Quads => self.quads = given.switch()?,
            MeshOption::Format
            | MeshOption::Unit
            | MeshOption::Walls
            | MeshOption::Materials
            | MeshOption::ColorBy
            | MeshOption::Compress
            | MeshOption::Parts => return Err(unknown()),
        }
        Ok(())
    }
}
