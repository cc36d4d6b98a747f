//! From the command line's options to the library's.

use std::path::PathBuf;

use neurotess::generate::{GenerateOptions, SphereKind};
use neurotess::mesh::{Format, Unit};
use neurotess::refine::{Caps, LodCriterion, Path, RefineOptions};

use super::args::{CapsArg, MeshArgs, PathArg, SphereArg};
use crate::io::inputs::Inputs;
use crate::io::output::is_standard;
use crate::io::targets;
use crate::report::usage;

/// All that a cell's mesh depends on.
#[derive(Clone, Debug)]
pub(crate) struct MeshOptions {
    pub(crate) strict: bool,
    pub(crate) generate: GenerateOptions,
    /// Levels; none: the coarse quads themselves.
    pub(crate) lod: Option<LodCriterion>,
    pub(crate) refine: RefineOptions,
    pub(crate) format: Format,
    pub(crate) unit: Unit,
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
            generate,
            lod,
            refine,
            format,
            unit,
            strict: _,
            table: _,
            force: _,
            measure: _,
        } = self;
        let lod = match lod {
            None => "Coarse".to_owned(),
            Some(LodCriterion::Homogeneous(level)) => format!("Level({level})"),
            Some(other) => format!("{other:?}"),
        };
        let unit = match unit {
            Unit::Micrometer => "",
            Unit::Meter => " Meter",
        };
        format!("{lod} {generate:?} {refine:?} {format:?}{unit}")
    }

    /// Checks the options together and translates them.
    pub(crate) fn new(args: &MeshArgs, inputs: &Inputs, measure: bool) -> anyhow::Result<Self> {
        let format = format(args, inputs)?;
        if args.quads && !format.has_quads() {
            return usage(format!(
                "{format} holds triangles only: leave out --quads, or write ply, obj, off or vtu"
            ));
        }
        let lod = match (args.max_error, args.level) {
            (Some(error), _) => Some(LodCriterion::MaxError(error as f32)),
            (None, 0) => None,
            (None, level) => Some(LodCriterion::Homogeneous(level)),
        };
        if args.table.is_some() && lod.is_none() && format.has_quads() {
            return usage(format!(
                "--table counts triangles, and level 0 of {format} is quads: use --level 1, or msh"
            ));
        }
        Ok(Self {
            strict: args.strict,
            generate: generate(args)?,
            lod,
            refine: RefineOptions {
                path: match args.path {
                    PathArg::Hermite => Path::Hermite,
                    PathArg::Linear => Path::Linear,
                },
                caps: match args.caps {
                    CapsArg::Round => Caps::Round,
                    CapsArg::Flat => Caps::Flat,
                },
                quads: args.quads,
            },
            format,
            unit: args.unit.unit(),
            table: args.table.clone(),
            force: args.out.force,
            measure,
        })
    }
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
             poly or smesh",
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

fn generate(args: &MeshArgs) -> anyhow::Result<GenerateOptions> {
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
        sphere,
        sphere_level: args.soma_level,
        rings: args.rings.positions(),
        kinds: (!args.types.is_empty()).then(|| kinds.collect()),
    })
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use neurotess::morphology::NeuriteKind;

    use super::*;

    /// Texts that earlier versions hashed into records, so that their outputs are recognized.
    #[test]
    fn fingerprints_stay_for_ever() {
        let mut options = MeshOptions {
            strict: false,
            generate: GenerateOptions::default(),
            lod: Some(LodCriterion::Homogeneous(4)),
            refine: RefineOptions::default(),
            format: Format::Ply,
            unit: Unit::Micrometer,
            table: None,
            force: false,
            measure: false,
        };
        assert_eq!(
            options.fingerprint(),
            "Level(4) GenerateOptions { soma: Fem, poisson: 0.3, soma_scale: 1.0, sphere: Cube, \
             sphere_level: None, rings: {}, kinds: None } \
             RefineOptions { path: Hermite, caps: Round, quads: false } Ply"
        );
        options.lod = None;
        options.format = Format::Glb;
        options.generate.rings = BTreeMap::from([(1, 0.5)]);
        options.generate.kinds = Some([NeuriteKind::AXON].into_iter().collect());
        assert_eq!(
            options.fingerprint(),
            "Coarse GenerateOptions { soma: Fem, poisson: 0.3, soma_scale: 1.0, sphere: Cube, \
             sphere_level: None, rings: {1: 0.5}, kinds: Some([NeuriteKind(2)]) } \
             RefineOptions { path: Hermite, caps: Round, quads: false } Glb"
        );
        options.lod = Some(LodCriterion::MaxError(0.05));
        options.unit = Unit::Meter;
        let text = options.fingerprint();
        assert!(text.ends_with("quads: false } Glb Meter"), "{text}");
        assert!(text.starts_with("MaxError(0.05) "), "{text}");
    }
}
