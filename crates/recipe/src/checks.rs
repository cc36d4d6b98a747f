//! Whether options fit together, and have values that make sense.

use neurotess_generate::{GenerateOptions, Smooth, SomaMethod, SphereKind};
use neurotess_refine::{EdgeRule, LodCriterion};

use crate::options::{LEVELS, LEVELS_ALONG};
use crate::words::SMOOTH;
use crate::{Levels, MeshOption, MeshOptions, OptionsError};

/// Subdivisions of an edge.
const EDGE_LEVELS: std::ops::RangeInclusive<u32> = 1..=64;
/// Factors on radii. Far beyond these bounds there is nothing to recognize.
const RADIUS_FACTORS: std::ops::RangeInclusive<f64> = 0.01..=1000.0;

impl MeshOptions {
    /// Whether they fit together and have values that make sense. The only place that says so: the command line, Python
    /// and files come here.
    ///
    /// # Errors
    /// Which do not.
    pub fn check(&self) -> Result<(), OptionsError> {
        if self.merges() && self.refine.quads {
            return Err(OptionsError::MergedQuads);
        }
        if self.is_simulation() && !self.merges() {
            return Err(OptionsError::CrossingSimulation);
        }
        if self.soma_mesh.is_some() && self.generate.soma != SomaMethod::Fem {
            return Err(OptionsError::Conflict {
                option: MeshOption::SomaMesh,
                with: MeshOption::Soma,
            });
        }
        check_levels(self.levels)?;
        check_generate(&self.generate)
    }
}

fn check_levels(levels: Levels) -> Result<(), OptionsError> {
    match levels {
        Levels::Coarse => Ok(()),
        Levels::Criterion(criterion) | Levels::Seen { criterion, .. } => match criterion {
            LodCriterion::Homogeneous(level) => in_levels(MeshOption::Level, level, LEVELS),
            LodCriterion::MaxError(error) => positive(MeshOption::MaxError, error.into()),
            _ => Ok(()),
        },
        Levels::Edges(EdgeRule::Levels { around, along }) => {
            in_levels(MeshOption::Level, around, LEVELS)?;
            in_levels(MeshOption::LevelAlong, along, LEVELS_ALONG)
        }
        Levels::Edges(EdgeRule::Lengths {
            radii,
            aspect,
            least,
            most,
        }) => {
            positive(MeshOption::Isotropic, radii.into())?;
            positive(MeshOption::MaxAspect, aspect.into())?;
            not_negative(MeshOption::MinEdge, least.into())?;
            if most != f32::INFINITY {
                positive(MeshOption::MaxEdge, most.into())?;
            }
            match least > most {
                true => Err(OptionsError::EdgeLimits),
                false => Ok(()),
            }
        }
    }
}

fn check_generate(options: &GenerateOptions) -> Result<(), OptionsError> {
    let GenerateOptions {
        poisson,
        soma_scale,
        radius_factor,
        sphere,
        sphere_level,
        rings,
        smooth,
        unknown_radius,
        least_radius,
        ..
    } = options;
    holds(
        MeshOption::Poisson,
        *poisson,
        (0.0..0.5).contains(poisson),
        "a number from 0 to below 0.5 is needed",
    )?;
    positive(MeshOption::SomaScale, *soma_scale)?;
    holds(
        MeshOption::RadiusFactor,
        *radius_factor,
        RADIUS_FACTORS.contains(radius_factor),
        "a number from 0.01 to 1000 is needed",
    )?;
    let levels = match sphere {
        SphereKind::Octahedron => 1..=5,
        SphereKind::Cube => 2..=32,
    };
    if let Some(level) = sphere_level.filter(|level| !levels.contains(level)) {
        let needed = format!(
            "this sphere has levels {} to {}",
            levels.start(),
            levels.end()
        );
        return refused(MeshOption::SomaLevel, level, needed);
    }
    let mut rings = rings.iter();
    if let Some((&neurite, &at)) = rings.find(|(_, at)| !(0.0..=2.0).contains(*at)) {
        return Err(OptionsError::ring(neurite.saturating_add(1), at));
    }
    if let Smooth::Length(length) = *smooth {
        let fits = length >= 0.0 && length.is_finite();
        holds(MeshOption::Smooth, length, fits, SMOOTH)?;
    }
    unknown_radius.map_or(Ok(()), |radius| positive(MeshOption::Radius, radius))?;
    not_negative(MeshOption::MinRadius, *least_radius)
}

fn in_levels(option: MeshOption, level: u32, range: &str) -> Result<(), OptionsError> {
    match EDGE_LEVELS.contains(&level) {
        true => Ok(()),
        false => refused(option, level, format!("{level} is not in {range}")),
    }
}

fn positive(option: MeshOption, number: f64) -> Result<(), OptionsError> {
    let fits = number > 0.0 && number.is_finite();
    holds(option, number, fits, "a number above 0 is needed")
}

fn not_negative(option: MeshOption, number: f64) -> Result<(), OptionsError> {
    let fits = number >= 0.0 && number.is_finite();
    holds(option, number, fits, "a number of 0 or more is needed")
}

fn holds(option: MeshOption, number: f64, fits: bool, needed: &str) -> Result<(), OptionsError> {
    match fits {
        true => Ok(()),
        false => refused(option, number, needed.to_owned()),
    }
}

fn refused(
    option: MeshOption,
    value: impl std::fmt::Display,
    needed: String,
) -> Result<(), OptionsError> {
    Err(OptionsError::Value {
        option,
        value: value.to_string(),
        needed,
    })
}

#[cfg(test)]
mod tests {
    use crate::{NamedOptions, OptionValue, Spelling};

    use super::*;

    /// What is said of options by keyword, in this spelling.
    fn told(options: &[(&str, OptionValue)], spelling: Spelling) -> String {
        let mut named = NamedOptions::default();
        let set = options
            .iter()
            .try_for_each(|(keyword, value)| named.set(keyword, value));
        let checked = set.and_then(|()| named.options());
        checked.expect_err("wrong").told(spelling)
    }

    #[test]
    fn an_error_names_the_option_as_it_was_written() {
        let level = [("level", OptionValue::Whole(99))];
        for (spelling, name) in [
            (Spelling::Flag, "--level"),
            (Spelling::Keyword, "level"),
            (Spelling::Field, "levels"),
        ] {
            let expected = format!("invalid value '99' for '{name}': 99 is not in 0..=64");
            assert_eq!(told(&level, spelling), expected);
        }
        let both = [
            ("level", OptionValue::Whole(4)),
            ("max_error", OptionValue::Number(0.1)),
        ];
        assert_eq!(
            told(&both, Spelling::Flag),
            "'--level' cannot be used with '--max-error'"
        );
        let radius = [("min_radius", OptionValue::Number(-1.0))];
        assert_eq!(
            told(&radius, Spelling::Field),
            "invalid value '-1' for 'generate.least_radius': a number of 0 or more is needed"
        );
        assert_eq!(
            told(&[("levle", OptionValue::Whole(1))], Spelling::Keyword),
            "there is no option 'levle'"
        );
    }

    #[test]
    fn values_are_within_bounds() {
        let number = OptionValue::Number;
        let text = |text: &str| OptionValue::Text(text.into());
        let ring = OptionValue::Map([("1".into(), number(2.5))].into());
        for (keyword, value, part) in [
            ("level", OptionValue::Whole(-1), "-1 is not in 0..=64"),
            ("level", text("many"), "'many' for 'level': a whole number"),
            ("level_along", OptionValue::Whole(0), "0 is not in 1..=64"),
            ("max_error", number(0.0), "above 0"),
            ("max_error", number(f64::NAN), "above 0"),
            ("isotropic", number(-1.0), "above 0"),
            (
                "max_edge",
                number(2.0),
                "max_edge, min_edge and max_aspect are for isotropic",
            ),
            ("poisson", number(0.5), "from 0 to below 0.5"),
            ("soma_scale", number(0.0), "above 0"),
            ("radius_factor", number(2000.0), "from 0.01 to 1000"),
            ("soma_level", OptionValue::Whole(33), "levels 2 to 32"),
            ("smooth", number(-1.0), "a length of 0 or more"),
            ("radius", number(0.0), "above 0"),
            ("ring", ring, "'1=2.5' for 'ring': a neurite from 1 on"),
            ("types", text("branch"), "use axon, basal"),
            (
                "soma",
                text("cube"),
                "'soma' [possible values: fem, sphere, profile, none]",
            ),
            (
                "soma_keep",
                text("radius"),
                "'soma_keep' [possible values: volume, area, scale]",
            ),
            ("quads", text("yes"), "true or false"),
        ] {
            let told = told(&[(keyword, value)], Spelling::Keyword);
            assert!(told.contains(part), "{keyword}: {told}");
        }
    }

    #[test]
    fn options_are_the_same_in_a_file() {
        for text in [
            "{}",
            r#"{"level":0}"#,
            r#"{"max_error":0.05,"types":[2,9],"ring":{"1":0.5}}"#,
            r#"{"isotropic":0.5,"max_edge":2.0,"max_aspect":1.0}"#,
            r#"{"simulation":true,"radii":"traced","smooth":"auto","soma_keep":"area"}"#,
            r#"{"level":2,"level_along":8,"caps":"flat","soma":"none","quads":true}"#,
        ] {
            let read: MeshOptions = serde_json::from_str(text).expect(text);
            let written = serde_json::to_string(&read).expect("named");
            let again: MeshOptions = serde_json::from_str(&written).expect(&written);
            assert_eq!(read, again, "{text}: {written}");
        }
        let simulation = serde_json::to_string(&MeshOptions::simulation());
        assert_eq!(simulation.expect("named"), r#"{"simulation":true}"#);
        let wrong: Result<MeshOptions, _> = serde_json::from_str(r#"{"level":99}"#);
        let wrong = wrong.expect_err("out of bounds").to_string();
        assert!(wrong.contains("99 is not in 0..=64"), "{wrong}");
    }
}
