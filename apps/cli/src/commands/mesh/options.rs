//! From the command line's options to the library's.

use std::path::{self, PathBuf};

use neurotess::generate::{GenerateOptions, Sides, SphereKind};
use neurotess::mesh::{Format, Unit};
use neurotess::recipe::{self, Crossings, Levels, Purpose};
use neurotess::refine::{Caps, EdgeRule, LodCriterion, Path, RefineOptions};

use super::args::{CapsArg, CrossingsArg, MeshArgs, PathArg, RadiiArg, SphereArg};
use crate::io::inputs::Inputs;
use crate::io::output::is_standard;
use crate::io::targets::{self, Job};
use crate::report::usage;

/// All that a cell's mesh and its files depend on.
#[derive(Clone, Debug)]
pub(crate) struct MeshOptions {
    pub(crate) strict: bool,
    pub(crate) recipe: recipe::MeshOptions,
    pub(crate) format: Format,
    pub(crate) unit: Unit,
    /// Whether walls part the soma from neurites.
    pub(crate) walls: bool,
    /// Whether faces have the material of their type, in formats that know materials.
    pub(crate) materials: bool,
    /// Whether each type gets a file of its own.
    pub(crate) parts: bool,
    /// Where a row for each triangle goes.
    pub(crate) table: Option<PathBuf>,
    pub(crate) force: bool,
    /// Whether volume and area are measured, which takes a pass over the surface.
    pub(crate) measure: bool,
}

impl MeshOptions {
    /// All options that a file depends on, as text. Records of earlier versions contain its hash,
    /// so the same options must always give the same text.
    pub(crate) fn fingerprint(&self) -> String {
        let Self {
            recipe,
            format,
            unit,
            walls,
            materials,
            parts,
            strict: _,
            table: _,
            force: _,
            measure: _,
        } = self;
        let (generate, refine) = (recipe.generate_options(), &recipe.refine);
        let lod = match recipe.levels {
            Levels::Coarse => "Coarse".to_owned(),
            Levels::Criterion(LodCriterion::Homogeneous(level)) => format!("Level({level})"),
            Levels::Criterion(other) => format!("{other:?}"),
            Levels::Edges(rule) => format!("{rule:?}"),
        };
        // What earlier versions did not have is left out where it has its default.
        let generate = format!("{generate:?}");
        let generate = generate
            .replace(", equal_area: None", "")
            .replace(", unknown_radius: None", "")
            .replace(", least_radius: 0.0", "")
            .replace(", crossings: Keep", "")
            .replace(", smooth: None", "");
        let unit = match unit {
            Unit::Micrometer => "",
            Unit::Meter => " Meter",
        };
        let merged = if recipe.merges() { " merged" } else { "" };
        let simulation = if recipe.is_simulation() {
            " simulation"
        } else {
            ""
        };
        let walls = if *walls { " walls" } else { "" };
        let materials = match (format, materials) {
            (Format::Obj, true) => " materials",
            (Format::Glb, true) => " materials",
            _ => "",
        };
        let parts = if *parts { " parts" } else { "" };
        format!(
            "{lod} {generate} {refine:?} {format:?}{unit}{merged}{simulation}{walls}{materials}{parts}"
        )
    }

    /// Where the file of materials of a mesh is, if it has one.
    pub(super) fn materials_of(&self, out: &path::Path) -> Option<PathBuf> {
        let has_one = self.format == Format::Obj && self.materials;
        has_one.then(|| out.with_extension("mtl"))
    }

    /// Tells a job which files it has.
    pub(super) fn complete(&self, job: &mut Job) {
        job.beside = self.materials_of(&job.out);
        job.parts = self.parts;
    }

    /// Checks the options together and translates them.
    pub(crate) fn new(args: &MeshArgs, inputs: &Inputs, measure: bool) -> anyhow::Result<Self> {
        let format = format(args, inputs)?;
        if args.quads && !format.has_quads() {
            return usage(format!(
                "{format} holds triangles only: leave out --quads, or write ply, obj, off or vtu"
            ));
        }
        let crossings = crossings(args);
        if crossings != CrossingsArg::Keep && args.quads {
            return usage("merging leaves triangles only: leave out --quads or --crossings");
        }
        if args.walls && !format.has_regions() && !args.parts {
            return usage(format!(
                "{format} cannot tell walls from the membrane: leave out --walls, or write msh, msh2, poly or smesh"
            ));
        }
        if args.table.is_some() && levels(args)? == Levels::Coarse && format.has_quads() {
            return usage(format!(
                "--table counts triangles, and level 0 of {format} is quads: use --level 1, or msh"
            ));
        }
        let levels = levels(args)?;
        if args.parts && is_standard(&args.out.out) {
            return usage("--parts writes several files: give a name for them, as in -o cell.ply");
        }
        let has_quads = args.quads || levels == Levels::Coarse && format.has_quads();
        if args.walls && has_quads {
            return usage(
                "walls are made of triangles: leave out --walls, or --quads and --level 0",
            );
        }
        let mut recipe = recipe::MeshOptions::default();
        recipe.generate = GenerateOptions {
            equal_area: equal_area(args, levels)?,
            ..generate_options(args)?
        };
        recipe.levels = levels;
        recipe.coarse_quads = format.has_quads();
        recipe.crossings = match crossings {
            CrossingsArg::Keep => Crossings::Keep,
            CrossingsArg::Separate => Crossings::Separate,
            CrossingsArg::Merge => Crossings::Merge,
        };
        if args.simulation {
            recipe.purpose = Purpose::Simulation;
        }
        recipe.refine = RefineOptions {
            path: match args.path {
                PathArg::Hermite => Path::Hermite,
                PathArg::Linear => Path::Linear,
            },
            caps: match args.caps {
                CapsArg::Round => Caps::Round,
                CapsArg::Flat => Caps::Flat,
            },
            quads: args.quads,
        };
        Ok(Self {
            strict: args.strict,
            recipe,
            format,
            unit: args.unit.unit(),
            walls: args.walls,
            materials: materials(args, format)?,
            parts: args.parts,
            table: args.table.clone(),
            force: args.out.force,
            measure,
        })
    }
}

/// Whether there are materials.
fn materials(args: &MeshArgs, format: Format) -> anyhow::Result<bool> {
    let asked = args.materials;
    let out = &args.out.out;
    match format {
        Format::Glb if asked && args.table.is_some() => usage(
            "materials part the triangles of glb by type, in another order than the rows of --table: leave out one",
        ),
        Format::Obj if asked && is_standard(out) => usage(
            "standard output has no place for the file of materials: leave out --materials, or give a file",
        ),
        Format::Obj if asked && out.extension().is_some_and(|end| end == "mtl") => usage(
            "the file of materials would have the name of the mesh: give one that ends in .obj",
        ),
        Format::Obj | Format::Glb => Ok(asked),
        other if asked => usage(format!(
            "{other} knows no materials: leave out --materials, or write obj or glb"
        )),
        _ => Ok(false),
    }
}

fn crossings(args: &MeshArgs) -> CrossingsArg {
    args.crossings.unwrap_or(if args.simulation {
        CrossingsArg::Separate
    } else {
        CrossingsArg::Keep
    })
}

/// Sides of the polygons around neurites, whose area is to be that of the traced circles.
fn equal_area(args: &MeshArgs, levels: Levels) -> anyhow::Result<Option<Sides>> {
    let usual = if args.simulation {
        RadiiArg::EqualArea
    } else {
        RadiiArg::Traced
    };
    if args.radii.unwrap_or(usual) == RadiiArg::Traced {
        return Ok(None);
    }
    match recipe::MeshOptions::sides(levels) {
        Some(sides) => Ok(Some(sides)),
        None => usage(
            "--radii equal-area must know how many sides neurites get: use --level or --isotropic instead of \
             --max-error",
        ),
    }
}

fn levels(args: &MeshArgs) -> anyhow::Result<Levels> {
    let isotropic = args.isotropic.or(args.simulation.then_some(1.0));
    let Some(radii) = isotropic else {
        if args
            .max_edge
            .or(args.min_edge)
            .or(args.max_aspect)
            .is_some()
        {
            return usage("--max-edge, --min-edge and --max-aspect are for --isotropic: add it");
        }
        return Ok(match (args.max_error, args.level, args.level_along) {
            (Some(error), ..) => Levels::Criterion(LodCriterion::MaxError(error as f32)),
            (None, 0, Some(_)) => return usage("--level-along needs a --level of 1 or more"),
            (None, 0, None) => Levels::Coarse,
            (None, around, Some(along)) => Levels::Edges(EdgeRule::Levels { around, along }),
            (None, level, None) => Levels::Criterion(LodCriterion::Homogeneous(level)),
        });
    };
    let (least, most) = (
        args.min_edge.unwrap_or(0.0),
        args.max_edge.unwrap_or(f64::MAX),
    );
    if least > most {
        return usage("--min-edge is longer than --max-edge");
    }
    Ok(Levels::Edges(EdgeRule::Lengths {
        radii: radii as f32,
        aspect: match args.max_aspect {
            Some(aspect) => aspect as f32,
            None if args.simulation => recipe::SIMULATION_ASPECT,
            None => 1.0,
        },
        least: least as f32,
        most: most as f32,
    }))
}

fn format(args: &MeshArgs, inputs: &Inputs) -> anyhow::Result<Format> {
    let out = &args.out.out;
    let from_name = Format::from_extension(out);
    if targets::is_folder(out, inputs) {
        if from_name.is_ok() && !out.is_dir() && args.format.is_none() {
            return usage(format!(
                "{} is a file's name, but folders, globs and several inputs need a folder: \
                 use -o FOLDER --format {}",
                out.display(),
                out.extension().unwrap_or_default().to_string_lossy()
            ));
        }
        return Ok(args.format.unwrap_or(Format::Ply));
    }
    if is_standard(out) && args.format.is_none() {
        return usage(
            "standard output has no extension: say --format ply, obj, stl, glb, off, vtu, msh, \
             msh2, poly or smesh",
        );
    }
    match (args.format, from_name) {
        (Some(format), _) | (None, Ok(format)) => Ok(format),
        (None, Err(_)) => usage(format!(
            "{} has no extension of a mesh: use .ply, .obj, .stl, .glb, .off, .vtu, .msh, \
             .poly or .smesh, or --format",
            out.display()
        )),
    }
}

fn generate_options(args: &MeshArgs) -> anyhow::Result<GenerateOptions> {
    let sphere = match args.soma_sphere {
        Some(SphereArg::Octahedron) => SphereKind::Octahedron,
        Some(SphereArg::Cube) => SphereKind::Cube,
        None => GenerateOptions::default().sphere,
    };
    let levels = match sphere {
        SphereKind::Octahedron => 1..=5,
        SphereKind::Cube => 2..=32,
    };
    if let Some(level) = args.soma_level.filter(|level| !levels.contains(level)) {
        return usage(format!(
            "--soma-level {level}: this sphere has levels {} to {}",
            levels.start(),
            levels.end()
        ));
    }
    let kinds = args.types.iter().flat_map(|types| types.0.iter().copied());
    Ok(GenerateOptions {
        soma: args.soma.method(),
        poisson: args.poisson,
        soma_scale: args.soma_scale,
        radius_factor: args.radius_factor,
        sphere,
        sphere_level: args.soma_level,
        rings: args.rings.positions(),
        kinds: (!args.types.is_empty()).then(|| kinds.collect()),
        smooth: args.smooth.unwrap_or_default(),
        unknown_radius: args.radius.radius,
        least_radius: args.radius.min_radius.unwrap_or(0.0),
        ..GenerateOptions::default()
    })
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use neurotess::generate::Smooth;
    use neurotess::morphology::NeuriteKind;

    use super::*;

    /// Texts that earlier versions hashed into records, so that their outputs are recognized.
    #[test]
    fn fingerprints_stay_for_ever() {
        let mut options = MeshOptions {
            strict: false,
            recipe: recipe::MeshOptions::default(),
            format: Format::Ply,
            unit: Unit::Micrometer,
            walls: false,
            materials: false,
            parts: false,
            table: None,
            force: false,
            measure: false,
        };
        assert_eq!(
            options.fingerprint(),
            "Level(4) GenerateOptions { soma: Fem, poisson: 0.3, soma_scale: 1.0, radius_factor: 1.0, sphere: Cube, \
             sphere_level: None, rings: {}, kinds: None } \
             RefineOptions { path: Hermite, caps: Round, quads: false } Ply"
        );
        options.recipe.levels = Levels::Coarse;
        options.format = Format::Glb;
        options.recipe.generate.rings = BTreeMap::from([(1, 0.5)]);
        options.recipe.generate.kinds = Some([NeuriteKind::AXON].into_iter().collect());
        assert_eq!(
            options.fingerprint(),
            "Coarse GenerateOptions { soma: Fem, poisson: 0.3, soma_scale: 1.0, radius_factor: 1.0, sphere: Cube, \
             sphere_level: None, rings: {1: 0.5}, kinds: Some([NeuriteKind(2)]) } \
             RefineOptions { path: Hermite, caps: Round, quads: false } Glb"
        );
        options.recipe.levels = Levels::Criterion(LodCriterion::MaxError(0.05));
        options.unit = Unit::Meter;
        let text = options.fingerprint();
        assert!(text.ends_with("quads: false } Glb Meter"), "{text}");
        assert!(text.starts_with("MaxError(0.05) "), "{text}");
        options.recipe.generate.equal_area = Some(Sides::Level(2));
        let text = options.fingerprint();
        assert!(text.contains(", equal_area: Some(Level(2)), "), "{text}");
        options.recipe.generate.smooth = Smooth::Length(2.0);
        let text = options.fingerprint();
        assert!(text.contains(", smooth: Length(2.0) } "), "{text}");
        options.recipe.generate.unknown_radius = Some(0.4);
        options.recipe.generate.least_radius = 0.1;
        let text = options.fingerprint();
        assert!(
            text.contains(", unknown_radius: Some(0.4), least_radius: 0.1 } "),
            "{text}"
        );
    }
}
