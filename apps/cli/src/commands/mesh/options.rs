//! From the command line's options to the library's.

use std::path::PathBuf;

use neurotess::generate::{SomaKeep, SphereKind};
use neurotess::mesh::{Format, Unit};
use neurotess::recipe::{
    self, Crossings, FileOptions, Levels, NamedOptions, OptionValue, OptionsError, Radii, Spelling,
};
use neurotess::refine::{Caps, LodCriterion, Path};

use super::args::{CapsArg, CrossingsArg, MeshArgs, PathArg, RadiiArg, SomaKeepArg, SphereArg};
use crate::io::inputs::Inputs;
use crate::io::output::is_standard;
use crate::io::targets::{self, Job};
use crate::report::{Usage, usage};

/// All that a cell's mesh and its files depend on.
#[derive(Clone, Debug)]
pub(crate) struct MeshOptions {
    pub(crate) strict: bool,
    pub(crate) recipe: recipe::MeshOptions,
    pub(crate) files: FileOptions,
    /// Where a row for each triangle goes.
    pub(crate) table: Option<PathBuf>,
    /// Where a row for each section goes.
    pub(crate) areas: Option<PathBuf>,
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
            files,
            strict: _,
            table: _,
            areas: _,
            force: _,
            measure: _,
        } = self;
        let FileOptions {
            format,
            unit,
            walls,
            materials,
            parts,
            ..
        } = files;
        let (generate, refine) = (recipe.generate_options(), &recipe.refine);
        let lod = match recipe.levels {
            Levels::Coarse => "Coarse".to_owned(),
            Levels::Criterion(LodCriterion::Homogeneous(level)) => format!("Level({level})"),
            Levels::Criterion(other) => format!("{other:?}"),
            Levels::Edges(rule) => format!("{rule:?}"),
            other => format!("{other:?}"),
        };
        // What earlier versions did not have is left out where it has its default.
        let generate = format!("{generate:?}");
        let generate = generate
            .replace(", soma_keep: Volume", "")
            .replace(", soma_shape: None", "")
            .replace(", polygons: None", "")
            .replace(", unknown_radius: None", "")
            .replace(", least_radius: 0.0", "")
            .replace(", crossings: Keep", "")
            .replace(", smooth: None", "");
        let soma_mesh = recipe.soma_mesh.as_ref();
        let soma_mesh = soma_mesh.map_or(String::new(), |file| format!(" {}", file.display()));
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
            "{lod} {generate} {refine:?} {format:?}{unit}{merged}{simulation}{walls}{materials}{parts}{soma_mesh}"
        )
    }

    /// Tells a job which files it has.
    pub(super) fn complete(&self, job: &mut Job) {
        job.beside = self.files.materials_of(&job.out);
        job.parts = self.files.parts;
    }

    /// Checks the options together and translates them.
    pub(crate) fn new(args: &MeshArgs, inputs: &Inputs, measure: bool) -> anyhow::Result<Self> {
        let wrong = |error: OptionsError| Usage(error.told(Spelling::Flag));
        let mut files = FileOptions::new(format(args, inputs)?);
        files.unit = args.unit.unit();
        (files.walls, files.materials, files.parts) = (args.walls, args.materials, args.parts);
        let recipe = named(args).and_then(|named| named.options());
        let recipe = recipe.map_err(wrong)?;
        files.check(&recipe).map_err(wrong)?;
        check_outputs(args, &files, recipe.levels)?;
        Ok(Self {
            strict: args.strict,
            recipe,
            files,
            table: args.table.clone(),
            areas: args.areas.clone(),
            force: args.out.force,
            measure,
        })
    }
}

/// Whether files can be where they are to be.
fn check_outputs(args: &MeshArgs, files: &FileOptions, levels: Levels) -> anyhow::Result<()> {
    let (out, format) = (&args.out.out, files.format);
    if args.table.is_some() && levels == Levels::Coarse && format.has_quads() {
        return usage(format!(
            "--table counts triangles, and level 0 of {format} is quads: use --level 1, or msh"
        ));
    }
    if args.parts && is_standard(out) {
        return usage("--parts writes several files: give a name for them, as in -o cell.ply");
    }
    match format {
        Format::Glb if args.materials && args.table.is_some() => usage(
            "materials part the triangles of glb by type, in another order than the rows of --table: leave out one",
        ),
        Format::Obj if args.materials && is_standard(out) => usage(
            "standard output has no place for the file of materials: leave out --materials, or give a file",
        ),
        Format::Obj if args.materials && out.extension().is_some_and(|end| end == "mtl") => usage(
            "the file of materials would have the name of the mesh: give one that ends in .obj",
        ),
        _ => Ok(()),
    }
}

/// The flags as named options, which the recipe checks.
fn named(args: &MeshArgs) -> Result<NamedOptions, OptionsError> {
    let mut named = NamedOptions::default();
    for (keyword, value) in [
        ("level", args.level),
        ("level_along", args.level_along),
        ("soma_level", args.soma_level),
    ] {
        if let Some(value) = value {
            named.set(keyword, &OptionValue::Whole(value))?;
        }
    }
    named.max_error = args.max_error;
    named.isotropic = args.isotropic;
    named.max_edge = args.max_edge;
    named.min_edge = args.min_edge;
    named.max_aspect = args.max_aspect;
    named.path = Some(match args.path {
        PathArg::Hermite => Path::Hermite,
        PathArg::Linear => Path::Linear,
    });
    named.caps = Some(match args.caps {
        CapsArg::Round => Caps::Round,
        CapsArg::Flat => Caps::Flat,
    });
    named.crossings = args.crossings.map(|crossings| match crossings {
        CrossingsArg::Keep => Crossings::Keep,
        CrossingsArg::Separate => Crossings::Separate,
        CrossingsArg::Merge => Crossings::Merge,
    });
    named.simulation = args.simulation;
    named.soma = Some(args.soma.method());
    named.poisson = Some(args.poisson);
    named.soma_keep = args.soma_keep.map(|keep| match keep {
        SomaKeepArg::Volume => SomaKeep::Volume,
        SomaKeepArg::Area => SomaKeep::Area,
        SomaKeepArg::Scale => SomaKeep::Scale,
    });
    named.soma_mesh = args.soma_mesh.clone();
    named.soma_scale = Some(args.soma_scale);
    named.radii = args.radii.map(|radii| match radii {
        RadiiArg::Traced => Radii::Traced,
        RadiiArg::EqualArea => Radii::EqualArea,
        RadiiArg::EqualPerimeter => Radii::EqualPerimeter,
    });
    named.radius_factor = Some(args.radius_factor);
    named.radius = args.radius.radius;
    named.min_radius = args.radius.min_radius;
    named.soma_sphere = args.soma_sphere.map(|sphere| match sphere {
        SphereArg::Octahedron => SphereKind::Octahedron,
        SphereArg::Cube => SphereKind::Cube,
    });
    let rings = args.rings.positions().into_iter();
    named.ring = rings.map(|(index, at)| (index + 1, at)).collect();
    named.smooth = args.smooth;
    let kinds = args.types.iter().flat_map(|types| types.0.iter().copied());
    named.types = (!args.types.is_empty()).then(|| kinds.collect());
    named.quads = args.quads;
    Ok(named)
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

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use clap::Parser;
    use neurotess::generate::{Equal, Polygons, Sides, Smooth};
    use neurotess::morphology::NeuriteKind;

    use super::*;

    /// Texts that earlier versions hashed into records, so that their outputs are recognized.
    #[test]
    fn fingerprints_stay_for_ever() {
        let mut options = MeshOptions {
            strict: false,
            recipe: recipe::MeshOptions::default(),
            files: FileOptions::new(Format::Ply),
            table: None,
            areas: None,
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
        options.files.format = Format::Glb;
        options.recipe.generate.rings = BTreeMap::from([(1, 0.5)]);
        options.recipe.generate.kinds = Some([NeuriteKind::AXON].into_iter().collect());
        assert_eq!(
            options.fingerprint(),
            "Coarse GenerateOptions { soma: Fem, poisson: 0.3, soma_scale: 1.0, radius_factor: 1.0, sphere: Cube, \
             sphere_level: None, rings: {1: 0.5}, kinds: Some([NeuriteKind(2)]) } \
             RefineOptions { path: Hermite, caps: Round, quads: false } Glb"
        );
        options.recipe.levels = Levels::Criterion(LodCriterion::MaxError(0.05));
        options.files.unit = Unit::Meter;
        let text = options.fingerprint();
        assert!(text.ends_with("quads: false } Glb Meter"), "{text}");
        assert!(text.starts_with("MaxError(0.05) "), "{text}");
        options.recipe.generate.polygons = Some(Polygons {
            sides: Sides::Level(2),
            equal: Equal::Area,
        });
        let text = options.fingerprint();
        assert!(
            text.contains(", polygons: Some(Polygons { sides: Level(2), equal: Area }), "),
            "{text}"
        );
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
    /// The options alone, without the program around them.
    #[derive(Debug, Parser)]
    struct Options {
        #[command(flatten)]
        args: MeshArgs,
    }

    fn of(flags: &[&str]) -> Result<recipe::MeshOptions, String> {
        let words = ["mesh", "-", "--out=-", "--format=ply"].into_iter();
        let Options { args } = Options::try_parse_from(words.chain(flags.iter().copied()))
            .map_err(|e| e.to_string())?;
        let options = MeshOptions::new(&args, &Inputs::default(), false);
        options.map(|o| o.recipe).map_err(|e| format!("{e:#}"))
    }

    #[test]
    fn the_library_has_the_same_defaults() {
        let of = |flags: &[&str]| of(flags).expect("options");
        let default = recipe::MeshOptions::default;
        assert_eq!(of(&[]), default());
        assert_eq!(of(&["--level=0"]), default().with_level(0));
        assert_eq!(of(&["--quads"]), default().with_quads(true));
        assert_eq!(of(&["--simulation"]), recipe::MeshOptions::simulation());
    }

    #[test]
    fn wrong_options_are_told_with_their_flags() {
        let told = |flags: &[&str]| of(flags).expect_err("wrong");
        assert_eq!(
            told(&["--level=99"]),
            "invalid value '99' for '--level': 99 is not in 0..=64"
        );
        let both = told(&["--level=4", "--max-error=1"]);
        assert_eq!(both, "'--level' cannot be used with '--max-error'");
        let needs = told(&["--max-edge=2"]);
        assert!(needs.starts_with("--max-edge, --min-edge"), "{needs}");
        let radii = told(&["--max-error=1", "--radii=equal-area"]);
        assert!(radii.starts_with("--radii equal-area must know"), "{radii}");
    }
}
