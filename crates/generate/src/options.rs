//! Options of the generation.

use std::collections::BTreeMap;
use std::sync::Arc;

use neurotess_morphology::{NeuriteKind, SomaShape};

use crate::Polygons;

/// How the soma is rebuilt.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SomaMethod {
    /// What was traced, drawn out towards the neurites by linear elasticity.
    #[default]
    Fem,
    /// The sphere as it is, neurites growing out of it.
    Sphere,
    /// LiveMesh's radius function: circle near the center, tube far out, cubic between.
    Profile,
    /// No soma: every neurite is closed by itself.
    None,
}

/// What of a soma stays as it was traced, while neurites draw its surface out ([`SomaMethod::Fem`]).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum SomaKeep {
    /// Its volume, closed by the planes of the first rings.
    #[default]
    Volume,
    /// Its area, as for electrical properties of membranes; what neurites take counts.
    Area,
    /// The size of the shape that is drawn out, so that volume and area become what they may.
    Scale,
}

/// The tetrahedral sphere that is deformed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum SphereKind {
    /// The paper's: an octahedron split by edges; level 3 has 258 surface vertices.
    Octahedron,
    /// A cube's six faces on the sphere, level × level quads each.
    #[default]
    Cube,
}

/// What becomes of branches that were traced through one another.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Crossings {
    /// They stay where they were traced, and their surfaces cross.
    #[default]
    Keep,
    /// They are moved apart, thin ones more than thick ones.
    Separate,
}

/// How much the noise of a tracing is smoothed away.
///
/// Each section, from root or fork to fork or end, becomes a cubic smoothing spline in the arc length, its
/// radii too. Roots, forks and ends stay exactly as they were traced.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Smooth {
    /// Everything stays as it was traced.
    #[default]
    None,
    /// By a length of 1.5 radii, for each section of its median radius.
    Auto,
    /// By this length λ (µm): the half-width of the spline's kernel, so that a point is about the mean of
    /// what lies within λ of it on both sides. A wave in the path keeps 1 / (1 + (2πλ/Λ)⁴ / 4) of its height: 96 %
    /// if it is Λ = 10 λ long, half at 4.4 λ, 6 % at 2 λ. Of a section shorter than λ, a straight line
    /// remains. 0 or less is [`Smooth::None`].
    Length(f64),
}

/// Choices for [`generate`](crate::generate).
#[derive(Clone, Debug, PartialEq)]
pub struct GenerateOptions {
    /// How the soma is rebuilt.
    pub soma: SomaMethod,
    /// Poisson ratio ν of the soma's material, 0 to 0.49.
    pub poisson: f64,
    /// What of a soma stays as it was traced.
    pub soma_keep: SomaKeep,
    /// The surface of the soma (µm, relative to the morphology's origin), where it is known better than from the tracing: it
    /// stands for the soma whose center is nearest to its own. For [`SomaMethod::Fem`].
    pub soma_shape: Option<Arc<SomaShape>>,
    /// Factor on the soma's radius, greater than 0.
    pub soma_scale: f64,
    /// Factor on the radii of neurites, greater than 0, as for figures in which thin ones must be seen, or
    /// for printing in three dimensions. Paths and somata stay; [`TracingPoint::radius`] is that of the
    /// surface.
    ///
    /// [`TracingPoint::radius`]: neurotess_mesh::TracingPoint::radius
    pub radius_factor: f64,
    /// Radii of neurites that make up for the sides of polygons: refined, neurites hold as much as was traced, or have
    /// as much membrane. `None`: the vertices lie on the traced radius, and polygons within it.
    pub polygons: Option<Polygons>,
    /// Type of the sphere.
    pub sphere: SphereKind,
    /// Resolution of the sphere: octahedron 3 to 5, cube 4 to 32; `None`: what fits the neurites.
    pub sphere_level: Option<u32>,
    /// Positions of first rings by the number of the neurite (from 0, in the order of the tracing):
    /// 0 on the soma's sphere, 1 at the first traced point outside it, up to 2 along the path beyond it
    /// (by as much again, at least half a radius of the soma). Of neurites that are not named: the first
    /// point, but no farther than 1.35 radii ([`SomaMethod::Fem`]) or 1.5 ([`SomaMethod::Profile`]).
    /// The other methods have no choice.
    pub rings: BTreeMap<u32, f64>,
    /// Kinds of neurites to keep; `None`: all.
    pub kinds: Option<Vec<NeuriteKind>>,
    /// What becomes of branches that were traced through one another.
    pub crossings: Crossings,
    /// How much the noise of the tracing is smoothed away.
    pub smooth: Smooth,
    /// Radius (µm) of points without one (zero, negative or no number). `None`: that of their neighbors along the
    /// path, the median of the cell where there are none, or half a micrometer where no point has a radius.
    pub unknown_radius: Option<f64>,
    /// Least radius (µm) of neurites: thinner points become as thick.
    pub least_radius: f64,
}

impl GenerateOptions {
    /// Radius (µm) of the rings where one was traced.
    pub(crate) fn radius(&self, traced: f64) -> f64 {
        let wanted = self.radius_factor * traced;
        self.polygons
            .map_or(wanted, |polygons| polygons.radius(wanted))
    }
}

impl Default for GenerateOptions {
    fn default() -> Self {
        Self {
            soma: SomaMethod::Fem,
            poisson: 0.3,
            soma_keep: SomaKeep::Volume,
            soma_shape: None,
            soma_scale: 1.0,
            radius_factor: 1.0,
            polygons: None,
            sphere: SphereKind::Cube,
            sphere_level: None,
            rings: BTreeMap::new(),
            kinds: None,
            crossings: Crossings::Keep,
            smooth: Smooth::None,
            unknown_radius: None,
            least_radius: 0.0,
        }
    }
}
