//! Options of the generation.

use std::collections::BTreeMap;

use neurotess_morphology::NeuriteKind;

/// How the soma is rebuilt.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SomaMethod {
    /// A sphere deformed towards the neurites by linear elasticity.
    #[default]
    Fem,
    /// The sphere as it is, neurites growing out of it.
    Sphere,
    /// LiveMesh's radius function: circle near the center, tube far out, cubic between.
    Profile,
    /// No soma: every neurite is closed by itself.
    None,
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

/// Choices for [`generate`](crate::generate).
#[derive(Clone, Debug, PartialEq)]
pub struct GenerateOptions {
    /// How the soma is rebuilt.
    pub soma: SomaMethod,
    /// Poisson ratio ν of the soma's material, 0 to 0.49.
    pub poisson: f64,
    /// Factor on the soma's radius, greater than 0.
    pub soma_scale: f64,
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
}

impl Default for GenerateOptions {
    fn default() -> Self {
        Self {
            soma: SomaMethod::Fem,
            poisson: 0.3,
            soma_scale: 1.0,
            sphere: SphereKind::Cube,
            sphere_level: None,
            rings: BTreeMap::new(),
            kinds: None,
            crossings: Crossings::Keep,
        }
    }
}
