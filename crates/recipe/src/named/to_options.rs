//! From names to options: defaults, and what excludes what.

use neurotess_generate::{Equal, GenerateOptions, Polygons};
use neurotess_refine::{EdgeRule, LodCriterion, RefineOptions};

use super::NamedOptions;
use crate::options::{LEVEL, SIMULATION_ASPECT};
use crate::{Crossings, Levels, MeshOption, MeshOptions, OptionsError, Purpose, Radii};

impl NamedOptions {
    /// The options of these names, checked.
    ///
    /// # Errors
    /// Which exclude one another, are of no use without another, or have a value out of bounds.
    pub fn options(&self) -> Result<MeshOptions, OptionsError> {
        self.check_together()?;
        let levels = self.levels();
        let usual = MeshOptions::default();
        let generate = GenerateOptions {
            polygons: self.polygons(levels)?,
            ..self.generate()?
        };
        let options = MeshOptions {
            generate,
            refine: RefineOptions {
                path: self.path.unwrap_or(usual.refine.path),
                caps: self.caps.unwrap_or(usual.refine.caps),
                quads: self.quads,
                ..usual.refine
            },
            levels,
            crossings: self.crossings.unwrap_or(match self.simulation {
                true => Crossings::Separate,
                false => Crossings::Keep,
            }),
            soma_mesh: self.soma_mesh.clone(),
            purpose: match self.simulation {
                true => Purpose::Simulation,
                false => Purpose::Surface,
            },
        };
        options.check()?;
        Ok(options)
    }

    /// What only names can get wrong: two say the same, or one is of no use without another.
    fn check_together(&self) -> Result<(), OptionsError> {
        use MeshOption::{Isotropic, Level, LevelAlong, MaxError, Quads, Simulation};
        let is_set = |option| match option {
            Level => self.level.is_some(),
            MaxError => self.max_error.is_some(),
            LevelAlong => self.level_along.is_some(),
            Isotropic => self.isotropic.is_some(),
            Simulation => self.simulation,
            Quads => self.quads,
            _ => false,
        };
        const EXCLUDED: [(MeshOption, MeshOption); 9] = [
            (Level, MaxError),
            (LevelAlong, MaxError),
            (Isotropic, Level),
            (Isotropic, LevelAlong),
            (Isotropic, MaxError),
            (Simulation, Level),
            (Simulation, LevelAlong),
            (Simulation, MaxError),
            (Simulation, Quads),
        ];
        let mut excluded = EXCLUDED.into_iter();
        if let Some((option, with)) = excluded.find(|&(a, b)| is_set(a) && is_set(b)) {
            return Err(OptionsError::Conflict { option, with });
        }
        let of_edges = self.max_edge.or(self.min_edge).or(self.max_aspect);
        if of_edges.is_some() && !self.has_edge_lengths() {
            return Err(OptionsError::NeedsIsotropic);
        }
        if self.level == Some(0) && self.level_along.is_some() {
            return Err(OptionsError::NeedsLevel);
        }
        Ok(())
    }

    fn has_edge_lengths(&self) -> bool {
        self.isotropic.is_some() || self.simulation
    }

    fn levels(&self) -> Levels {
        if self.has_edge_lengths() {
            return Levels::Edges(EdgeRule::Lengths {
                radii: self.isotropic.unwrap_or(1.0) as f32,
                aspect: match self.max_aspect {
                    Some(aspect) => aspect as f32,
                    None if self.simulation => SIMULATION_ASPECT,
                    None => 1.0,
                },
                least: self.min_edge.unwrap_or(0.0) as f32,
                most: self.max_edge.unwrap_or(f64::INFINITY) as f32,
            });
        }
        match (self.max_error, self.level.unwrap_or(LEVEL)) {
            (Some(error), _) => Levels::Criterion(LodCriterion::MaxError(error as f32)),
            (None, 0) => Levels::Coarse,
            (None, around) => match self.level_along {
                Some(along) => Levels::Edges(EdgeRule::Levels { around, along }),
                None => Levels::Criterion(LodCriterion::Homogeneous(around)),
            },
        }
    }

    /// Radii that make up for the sides of the polygons around neurites.
    fn polygons(&self, levels: Levels) -> Result<Option<Polygons>, OptionsError> {
        let usual = match self.simulation {
            true => Radii::EqualArea,
            false => Radii::Traced,
        };
        let equal = match self.radii.unwrap_or(usual) {
            Radii::Traced => return Ok(None),
            Radii::EqualArea => Equal::Area,
            Radii::EqualPerimeter => Equal::Perimeter,
        };
        let polygons = MeshOptions::polygons(equal, levels);
        polygons.map(Some).ok_or(OptionsError::UnknownSides)
    }

    fn generate(&self) -> Result<GenerateOptions, OptionsError> {
        let usual = GenerateOptions::default();
        let ring = |(&neurite, &position): (&u32, &f64)| match neurite.checked_sub(1) {
            Some(index) => Ok((index, position)),
            None => Err(OptionsError::ring(neurite, position)),
        };
        Ok(GenerateOptions {
            soma: self.soma.unwrap_or(usual.soma),
            poisson: self.poisson.unwrap_or(usual.poisson),
            soma_keep: self.soma_keep.unwrap_or(usual.soma_keep),
            soma_scale: self.soma_scale.unwrap_or(usual.soma_scale),
            radius_factor: self.radius_factor.unwrap_or(usual.radius_factor),
            sphere: self.soma_sphere.unwrap_or(usual.sphere),
            sphere_level: self.soma_level,
            rings: self.ring.iter().map(ring).collect::<Result<_, _>>()?,
            kinds: self.types.clone(),
            smooth: self.smooth.unwrap_or(usual.smooth),
            unknown_radius: self.radius,
            least_radius: self.min_radius.unwrap_or(usual.least_radius),
            ..usual
        })
    }
}
