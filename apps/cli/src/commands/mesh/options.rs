//! From the command line's options to the library's.

use std::path::PathBuf;

use neurotess::Batch;
use neurotess::batch::{Inputs, Tables, targets};
use neurotess::formats::ReadOptions;
use neurotess::generate::{SomaKeep, SphereKind};
use neurotess::mesh::Format;
use neurotess::recipe::{
    self, Crossings, FileOptions, Levels, NamedOptions, OptionValue, OptionsError, Radii, Spelling,
};
use neurotess::refine::{Caps, Path};

use super::args::{CapsArg, CrossingsArg, MeshArgs, PathArg, RadiiArg, SomaKeepArg, SphereArg};
use crate::io::output::{existing, is_standard};
use crate::report::{Reporter, Usage, usage};

/// All that a cell's mesh and its files depend on.
#[derive(Clone, Debug)]
pub(crate) struct MeshOptions {
    pub(crate) read: ReadOptions,
    pub(crate) recipe: recipe::MeshOptions,
    pub(crate) files: FileOptions,
    pub(crate) force: bool,
}

impl MeshOptions {
    /// A batch with these options.
    pub(super) fn of(self, batch: Batch, args: &MeshArgs, reporter: &Reporter) -> Batch {
        let batch = batch
            .options(self.recipe)
            .read(self.read)
            .files(self.files)
            .tables(Tables {
                triangles: args.table.clone(),
                sections: args.areas.clone(),
            })
            .existing(existing(self.force))
            .resume(args.resume)
            .workers(reporter.threads())
            .measures(reporter.json() || args.log.is_some());
        match args.shard {
            Some(shard) => batch.shard(shard),
            None => batch,
        }
    }

    /// Checks the options together and translates them.
    pub(crate) fn new(args: &MeshArgs, inputs: &Inputs) -> anyhow::Result<Self> {
        let wrong = |error: OptionsError| Usage(error.told(Spelling::Flag));
        let mut files = FileOptions::new(format(args, inputs)?);
        files.unit = args.unit.unit();
        (files.walls, files.materials, files.parts) = (args.walls, args.materials, args.parts);
        (files.color_by, files.compress) = (args.color_by, args.compress);
        let recipe = named(args).and_then(|mut named| {
            // The mesh that the tracing's own file has, unless there is a file of this name.
            let of_input = named.soma_mesh.as_deref() == Some("file".as_ref());
            if let (true, [input]) = (
                of_input && !PathBuf::from("file").exists(),
                &inputs.files[..],
            ) {
                named.soma_mesh = Some(input.path.clone());
            }
            named.options()
        });
        let recipe = recipe.map_err(wrong)?;
        files.check(&recipe).map_err(wrong)?;
        check_outputs(args, &files, recipe.levels)?;
        Ok(Self {
            read: ReadOptions {
                strict: args.strict,
                ..ReadOptions::default()
            },
            recipe,
            files,
            force: args.out.force,
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
    named.soma = Some(args.soma.into());
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
    named.radius = args.radius.radius.map(|radius| radius.0);
    named.min_radius = args.radius.min_radius.map(|radius| radius.0);
    named.soma_sphere = args.soma_sphere.map(|sphere| match sphere {
        SphereArg::Octahedron => SphereKind::Octahedron,
        SphereArg::Cube => SphereKind::Cube,
    });
    let rings = args.rings.positions().into_iter();
    named.ring = rings.map(|(index, at)| (index + 1, at)).collect();
    named.smooth = args.smooth;
    let kinds = args.types.iter().flat_map(|types| types.kinds().to_vec());
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
    use clap::Parser;

    use super::*;

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
        let options = MeshOptions::new(&args, &Inputs::default());
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
