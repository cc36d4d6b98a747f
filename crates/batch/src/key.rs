//! What a file depends on besides what its inputs hold, as a key that tells files of other options apart.
//!
//! The key is JSON of options by their names: those that have their defaults are not named, so that a new option does not
//! change the keys of files that were made without it. Options that do not change the file, like the number of threads, are
//! not in it; the number of [`MESHES`](neurotess_recipe::MESHES) is, which is raised when meshes change.

use std::path::Path;

use neurotess_mesh::{ColorBy, Compression, Unit};
use neurotess_recipe::{FileOptions, MESHES, MeshOptions, NamedOptions, OptionsError};
use serde::Serialize;

use crate::targets::Job;

/// Raised when keys of the same options are others than before.
const FORMAT: u32 = 2;

/// What files of a run depend on.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Key {
    key: u32,
    meshes: u32,
    options: NamedOptions,
    format: &'static str,
    meters: bool,
    walls: bool,
    materials: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    color_by: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    compress: Option<&'static str>,
    parts: bool,
}

/// What one file depends on.
#[derive(Serialize)]
struct FileKey<'k> {
    #[serde(flatten)]
    run: &'k Key,
    placement: &'k str,
    /// A folder may move with its outputs, so that only names are compared.
    inputs: Vec<String>,
}

impl Key {
    /// The key of these options.
    ///
    /// # Errors
    /// An option has a value without a name.
    pub(crate) fn new(options: &MeshOptions, files: &FileOptions) -> Result<Self, OptionsError> {
        let FileOptions {
            format,
            unit,
            walls,
            materials,
            color_by,
            compress,
            parts,
            ..
        } = *files;
        Ok(Self {
            key: FORMAT,
            meshes: MESHES,
            options: NamedOptions::of(options)?,
            format: format.name(),
            meters: unit == Unit::Meter,
            walls,
            materials,
            color_by: color_by.map(ColorBy::name),
            compress: compress.map(Compression::name),
            parts,
        })
    }

    /// Hash of all that a file depends on, apart from what its inputs hold, in hexadecimal.
    pub(crate) fn hash(&self, job: &Job) -> String {
        let inputs = std::iter::once(&job.input).chain(&job.further);
        let name = |path: &Path| path.file_name().map(|name| name.to_string_lossy().into());
        let key = FileKey {
            run: self,
            placement: &job.placement,
            inputs: inputs
                .map(|input| name(input).unwrap_or_default())
                .collect(),
        };
        // All of it is named text and numbers, which JSON takes.
        let text = serde_json::to_string(&key).expect("JSON takes it");
        format!("{:016x}", hash(&text))
    }
}

/// FNV-1a (G. Fowler, L. C. Noll, K.-P. Vo): the same in all versions, unlike the standard
/// library's.
fn hash(text: &str) -> u64 {
    let step = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    text.bytes().fold(0xcbf2_9ce4_8422_2325, step)
}

#[cfg(test)]
mod tests {
    use std::collections::{BTreeMap, BTreeSet};

    use neurotess_generate::{Smooth, SomaKeep};
    use neurotess_mesh::Format;
    use neurotess_morphology::NeuriteKind;
    use neurotess_recipe::{Crossings, Levels};
    use neurotess_refine::{Caps, LodCriterion};

    use super::*;

    #[test]
    fn the_hash_is_the_published_one() {
        assert_eq!(hash(""), 0xcbf2_9ce4_8422_2325);
        assert_eq!(hash("a"), 0xaf63_dc4c_8601_ec8c);
    }

    type Change = dyn Fn(&mut MeshOptions, &mut FileOptions, &mut Job);

    /// What makes other files has another hash.
    #[test]
    fn keys_tell_files_apart() {
        let hash = |change: &Change| {
            let mut options = MeshOptions::default();
            let mut files = FileOptions::new(Format::Ply);
            let mut job = Job::new("in/a.swc".into(), "out/a.ply".into());
            change(&mut options, &mut files, &mut job);
            Key::new(&options, &files).expect("a key").hash(&job)
        };
        let usual = hash(&|_, _, _| {});
        assert_eq!(hash(&|_, _, job| job.input = "moved/a.swc".into()), usual);
        assert_eq!(hash(&|_, _, job| job.out = "b.ply".into()), usual);
        let others: [&Change; 25] = [
            &|o, _, _| o.levels = Levels::Coarse,
            &|o, _, _| o.levels = Levels::Criterion(LodCriterion::Homogeneous(5)),
            &|o, _, _| o.levels = Levels::Criterion(LodCriterion::MaxError(0.05)),
            &|o, _, _| *o = MeshOptions::simulation(),
            &|o, _, _| o.crossings = Crossings::Merge,
            &|o, _, _| o.crossings = Crossings::Separate,
            &|o, _, _| o.refine.quads = true,
            &|o, _, _| o.refine.caps = Caps::Flat,
            &|o, _, _| o.generate.poisson = 0.31,
            &|o, _, _| o.generate.soma_keep = SomaKeep::Area,
            &|o, _, _| o.generate.rings = BTreeMap::from([(1, 0.5)]),
            &|o, _, _| o.generate.kinds = Some([NeuriteKind::AXON].into_iter().collect()),
            &|o, _, _| o.generate.smooth = Smooth::Length(2.0),
            &|o, _, _| o.generate.unknown_radius = Some(0.4),
            &|o, _, _| o.soma_mesh = Some("soma.ply".into()),
            &|_, f, _| f.format = Format::Msh2,
            &|_, f, _| f.unit = Unit::Meter,
            &|_, f, _| f.walls = true,
            &|_, f, _| f.materials = true,
            &|_, f, _| f.color_by = Some(ColorBy::Type),
            &|_, f, _| f.compress = Some(Compression::Draco),
            &|_, f, _| f.parts = true,
            &|_, _, job| job.input = "in/b.swc".into(),
            &|_, _, job| job.placement = "0 0 0".into(),
            &|_, _, job| job.further = vec!["soma.ply".into()],
        ];
        let mut all: BTreeSet<String> = others.into_iter().map(hash).collect();
        all.insert(usual);
        assert_eq!(all.len(), others.len() + 1, "{all:?}");
    }
}
