//! Options of a cell's mesh.

use std::path::PathBuf;

use neurotess_generate::{Equal, GenerateOptions, Polygons, Sides, Smooth, SomaMethod};
use neurotess_morphology::NeuriteKind;
use neurotess_refine::{EdgeRule, LodCriterion, LodView, RefineOptions};

/// How many times the local radius edges along neurites of a mesh for simulators may be long: half as many triangles as
/// with 1, and still none narrower than 15° but for a few. With 3 these are 14°, of 12 % fewer triangles.
pub const SIMULATION_ASPECT: f32 = 2.6;
/// Level of a surface to look at.
pub(crate) const LEVEL: u32 = 4;
/// What errors say of levels.
pub(crate) const LEVELS: &str = "0..=64";
pub(crate) const LEVELS_ALONG: &str = "1..=64";
pub(crate) const SOMA_LEVELS: &str = "1..=32";

/// How finely a surface is made.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Levels {
    /// The coarse quads themselves.
    Coarse,
    /// By a criterion.
    Criterion(LodCriterion),
    /// By kinds of edges.
    Edges(EdgeRule),
    /// By a criterion that depends on a view.
    Seen {
        /// The criterion.
        criterion: LodCriterion,
        /// The view, in the coordinates of the coarse mesh.
        view: LodView,
    },
}

impl Levels {
    /// Whether edges have lengths instead of subdivisions.
    pub fn is_by_length(&self) -> bool {
        matches!(self, Self::Edges(EdgeRule::Lengths { .. }))
    }
}

/// What becomes of places where the surface crosses itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Crossings {
    /// It crosses there.
    #[default]
    Keep,
    /// Branches that were traced through one another are moved apart, and what still crosses is merged.
    Separate,
    /// The surface becomes the exact union with itself.
    Merge,
}

/// What a mesh is for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Purpose {
    /// Pictures, measures, printing.
    #[default]
    Surface,
    /// Solvers: closed, without crossings, short circuits and narrow triangles, or an error.
    Simulation,
}

/// Which radius rings of neurites have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Radii {
    /// The traced one: vertices lie on the circle, and the polygon within it.
    #[default]
    Traced,
    /// As much larger as gives the polygon the area of the circle, so that neurites keep their volume.
    EqualArea,
    /// As much larger as gives the polygon the perimeter of the circle, so that neurites keep the area of their membrane.
    EqualPerimeter,
}

/// All that a cell's mesh depends on. The command line, Python and the window have the same.
///
/// In files it has the names of [`NamedOptions`](crate::NamedOptions): `{"simulation": true, "max_edge": 2.0}`.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct MeshOptions {
    /// Of the coarse mesh. Its `crossings` are not looked at: [`MeshOptions::crossings`] are.
    pub generate: GenerateOptions,
    /// Of the surface.
    pub refine: RefineOptions,
    /// How finely it is made.
    pub levels: Levels,
    /// What becomes of places where it crosses itself.
    pub crossings: Crossings,
    /// What it is for.
    pub purpose: Purpose,
    /// A file with the surface of the soma, in the coordinates of the tracing (µm): [`mesh`](crate::mesh) makes
    /// [`GenerateOptions::soma_shape`] of it.
    pub soma_mesh: Option<PathBuf>,
}

impl Default for MeshOptions {
    /// A surface of level 4, as traced.
    fn default() -> Self {
        Self {
            generate: GenerateOptions::default(),
            refine: RefineOptions::default(),
            levels: Levels::Criterion(LodCriterion::Homogeneous(LEVEL)),
            crossings: Crossings::Keep,
            purpose: Purpose::Surface,
            soma_mesh: None,
        }
    }
}

impl MeshOptions {
    /// A mesh that solvers take: nothing crosses, triangles are of even size, and neurites hold what was traced.
    pub fn simulation() -> Self {
        let rule = EdgeRule::Lengths {
            radii: 1.0,
            least: 0.0,
            most: f32::INFINITY,
            aspect: SIMULATION_ASPECT,
        };
        Self {
            generate: GenerateOptions {
                polygons: Self::polygons(Equal::Area, Levels::Edges(rule)),
                ..GenerateOptions::default()
            },
            levels: Levels::Edges(rule),
            crossings: Crossings::Separate,
            purpose: Purpose::Simulation,
            ..Self::default()
        }
    }

    /// The same with a level, 1 to 64: subdivisions of each edge of the coarse mesh; 0: the coarse mesh itself.
    #[must_use]
    pub fn with_level(self, level: u32) -> Self {
        self.with_levels(match level {
            0 => Levels::Coarse,
            level => Levels::Criterion(LodCriterion::Homogeneous(level)),
        })
    }

    /// The same within this error (µm) of the smooth surface.
    #[must_use]
    pub fn with_max_error(self, error: f32) -> Self {
        self.with_levels(Levels::Criterion(LodCriterion::MaxError(error)))
    }

    /// The same as fine as this. Neurites that keep their volume do so at these levels, if their sides are known.
    #[must_use]
    pub fn with_levels(mut self, levels: Levels) -> Self {
        self.levels = levels;
        if let Some(polygons) = self.generate.polygons {
            self.generate.polygons = Self::polygons(polygons.equal, levels);
        }
        self
    }

    /// The same with another way with crossings.
    #[must_use]
    pub fn with_crossings(mut self, crossings: Crossings) -> Self {
        self.crossings = crossings;
        self
    }

    /// The same with another soma.
    #[must_use]
    pub fn with_soma(mut self, soma: SomaMethod) -> Self {
        self.generate.soma = soma;
        self
    }

    /// The same with the soma's surface from a file.
    #[must_use]
    pub fn with_soma_mesh(mut self, file: impl Into<PathBuf>) -> Self {
        self.soma_mesh = Some(file.into());
        self
    }

    /// The same with the noise of the tracing smoothed away.
    #[must_use]
    pub fn with_smooth(mut self, smooth: Smooth) -> Self {
        self.generate.smooth = smooth;
        self
    }

    /// The same with these types of neurites only.
    #[must_use]
    pub fn with_types(mut self, types: impl IntoIterator<Item = NeuriteKind>) -> Self {
        self.generate.kinds = Some(types.into_iter().collect());
        self
    }

    /// The same with quads where possible, or with triangles only.
    #[must_use]
    pub fn with_quads(mut self, quads: bool) -> Self {
        self.refine.quads = quads;
        self
    }

    /// Radii that make up for the sides of the polygons around neurites at these levels; none where these sides differ from
    /// place to place.
    pub fn polygons(equal: Equal, levels: Levels) -> Option<Polygons> {
        Self::sides(levels).map(|sides| Polygons { sides, equal })
    }

    /// Sides of the polygons around neurites, for radii that make up for them; none where they differ from place to
    /// place in a way that is not known beforehand.
    fn sides(levels: Levels) -> Option<Sides> {
        match levels {
            Levels::Coarse => Some(Sides::Level(1)),
            Levels::Criterion(LodCriterion::Homogeneous(level)) => Some(Sides::Level(level)),
            Levels::Criterion(_) | Levels::Seen { .. } => None,
            Levels::Edges(EdgeRule::Levels { around, .. }) => Some(Sides::Level(around)),
            Levels::Edges(EdgeRule::Lengths {
                radii, least, most, ..
            }) => Some(Sides::ByLength {
                radii: f64::from(radii),
                least: f64::from(least),
                most: f64::from(most),
            }),
        }
    }

    /// Whether the surface is merged with itself where it crosses.
    pub fn merges(&self) -> bool {
        self.crossings != Crossings::Keep
    }

    /// Whether it is for solvers.
    pub fn is_simulation(&self) -> bool {
        self.purpose == Purpose::Simulation
    }

    /// Those of the coarse mesh, with what follows from the crossings.
    pub fn generate_options(&self) -> GenerateOptions {
        GenerateOptions {
            crossings: match self.crossings {
                Crossings::Separate => neurotess_generate::Crossings::Separate,
                Crossings::Keep | Crossings::Merge => neurotess_generate::Crossings::Keep,
            },
            ..self.generate.clone()
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::OptionsError;

    use super::*;

    #[test]
    fn what_does_not_fit_together_is_an_error() {
        assert_eq!(MeshOptions::default().check(), Ok(()));
        assert_eq!(MeshOptions::simulation().check(), Ok(()));
        let quads = MeshOptions::default().with_crossings(Crossings::Merge);
        let quads = quads.with_quads(true);
        assert_eq!(quads.check(), Err(OptionsError::MergedQuads));
        let crossing = MeshOptions::simulation().with_crossings(Crossings::Keep);
        assert_eq!(crossing.check(), Err(OptionsError::CrossingSimulation));
    }

    #[test]
    fn separating_is_told_to_the_generator() {
        let crossings = |options: MeshOptions| options.generate_options().crossings;
        let separate = neurotess_generate::Crossings::Separate;
        assert_eq!(crossings(MeshOptions::simulation()), separate);
        let merge = MeshOptions::default().with_crossings(Crossings::Merge);
        assert_ne!(crossings(merge), separate);
    }
}
