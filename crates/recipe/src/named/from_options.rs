//! From options to names.

use neurotess_generate::Equal;
use neurotess_refine::{EdgeRule, LodCriterion};

use super::NamedOptions;
use crate::{Levels, MeshOption, MeshOptions, OptionsError, Purpose, Radii};

impl NamedOptions {
    /// The names of options, without those that have their defaults.
    ///
    /// # Errors
    /// A value that has no name: a soma's shape that is of no file, levels that depend on a view, radii for other sides than the levels give.
    pub fn of(options: &MeshOptions) -> Result<Self, OptionsError> {
        let MeshOptions {
            generate,
            refine,
            levels,
            crossings,
            purpose,
            soma_mesh,
        } = options;
        if generate.soma_shape.is_some() {
            return Err(OptionsError::Unnamed(MeshOption::SomaMesh));
        }
        let simulation = *purpose == Purpose::Simulation;
        let default = match simulation {
            true => MeshOptions::simulation(),
            false => MeshOptions::default(),
        };
        let usual = &default.generate;
        let other = |value: f64, usual: f64| (value != usual).then_some(value);
        let radii = match generate.polygons {
            None => Radii::Traced,
            Some(polygons) if MeshOptions::polygons(polygons.equal, *levels) == Some(polygons) => {
                match polygons.equal {
                    Equal::Area => Radii::EqualArea,
                    Equal::Perimeter => Radii::EqualPerimeter,
                }
            }
            Some(_) => return Err(OptionsError::Unnamed(MeshOption::Radii)),
        };
        let usual_radii = match simulation {
            true => Radii::EqualArea,
            false => Radii::Traced,
        };
        let named = Self {
            path: (refine.path != default.refine.path).then_some(refine.path),
            caps: (refine.caps != default.refine.caps).then_some(refine.caps),
            crossings: (*crossings != default.crossings).then_some(*crossings),
            simulation,
            soma: (generate.soma != usual.soma).then_some(generate.soma),
            poisson: other(generate.poisson, usual.poisson),
            soma_keep: (generate.soma_keep != usual.soma_keep).then_some(generate.soma_keep),
            soma_mesh: soma_mesh.clone(),
            soma_scale: other(generate.soma_scale, usual.soma_scale),
            radii: (radii != usual_radii).then_some(radii),
            radius_factor: other(generate.radius_factor, usual.radius_factor),
            radius: generate.unknown_radius,
            min_radius: other(generate.least_radius, usual.least_radius),
            soma_sphere: (generate.sphere != usual.sphere).then_some(generate.sphere),
            soma_level: generate.sphere_level,
            ring: generate.rings.iter().map(|(&n, &at)| (n + 1, at)).collect(),
            smooth: (generate.smooth != usual.smooth).then_some(generate.smooth),
            types: generate.kinds.clone(),
            quads: refine.quads,
            ..Self::default()
        };
        match *levels == default.levels {
            true => Ok(named),
            false => named.with_levels(*levels),
        }
    }

    fn with_levels(mut self, levels: Levels) -> Result<Self, OptionsError> {
        match levels {
            // Names of such levels are for surfaces.
            levels if self.simulation && !levels.is_by_length() => {
                return Err(OptionsError::Unnamed(MeshOption::Level));
            }
            Levels::Coarse => self.level = Some(0),
            Levels::Criterion(LodCriterion::Homogeneous(level)) => self.level = Some(level),
            Levels::Criterion(LodCriterion::MaxError(error)) => self.max_error = Some(wide(error)),
            Levels::Edges(EdgeRule::Levels { around, along }) => {
                (self.level, self.level_along) = (Some(around), Some(along));
            }
            Levels::Edges(EdgeRule::Lengths {
                radii,
                aspect,
                least,
                most,
            }) => {
                self.isotropic = Some(wide(radii));
                self.max_aspect = Some(wide(aspect));
                self.min_edge = (least > 0.0).then(|| wide(least));
                self.max_edge = most.is_finite().then(|| wide(most));
            }
            Levels::Criterion(_) | Levels::Seen { .. } => {
                return Err(OptionsError::Unnamed(MeshOption::Level));
            }
        }
        Ok(self)
    }
}

/// The number that has the same digits: 0.05 of 0.05.
fn wide(number: f32) -> f64 {
    number
        .to_string()
        .parse()
        .unwrap_or_else(|_| f64::from(number))
}
