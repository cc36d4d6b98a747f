//! Reads and meshes the inputs.

use std::collections::{BTreeSet, HashMap};
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use itertools::Itertools;
use neurotess_cache::Cache;
use neurotess_circuit::Compartment;
use neurotess_color::with_middles;
use neurotess_formats::{ReadOptions, Warning};
use neurotess_generate::GenerateOptions;
use neurotess_mesh::Watch;
use neurotess_morphology::Morphology;
use neurotess_picture::bounds::bounds;
use neurotess_recipe::memory;
#[cfg(feature = "gpu")]
use neurotess_render::Proxy;

use crate::error::DrawError;
use crate::host::Host;
use crate::meshed::{MeshedCell, Unread};
use crate::options::DrawOptions;

/// Number of cells, or of placements of cells, from which on a cell has a few bounding spheres instead of one per point.
pub(crate) const MANY: usize = 64;

/// Reads and meshes all inputs on all cores; reports those that fail. `cuts`: the compartments of
/// those that show values of a report. `cache`: of their circuit.
pub(crate) fn read(
    files: &[PathBuf],
    cuts: &HashMap<PathBuf, Vec<Compartment>>,
    asked: &DrawOptions,
    cache: Option<&Cache>,
    host: &dyn Host,
) -> Result<Vec<Result<MeshedCell, Unread>>, DrawError> {
    let meshing = Meshing {
        options: asked.picture.shape.generate(),
        exploring: asked.picture.explores(),
        many: files.len() >= MANY,
        cache,
        host,
    };
    check_memory(files, meshing.exploring)?;
    let read = ReadOptions {
        strict: asked.strict,
        ..ReadOptions::default()
    };
    let work = |file: &Path| {
        let cut = cuts.get(file).map_or(&[][..], Vec::as_slice);
        cell(file, cut, read, &meshing)
    };
    let done = host.each(files, &work).into_iter().zip_eq(files);
    let entries = done.map(|(entry, file)| {
        entry.map_err(|error| {
            host.failure(&error);
            let file = file.display().to_string();
            Unread { file, error }
        })
    });
    let entries: Vec<_> = entries.collect();
    let one = entries.len() == 1;
    for cell in entries.iter().flatten() {
        warn(cell, one || host.is_verbose(), host);
    }
    Ok(entries)
}

/// Whether memory holds what files of this size become, at the least: of 200,000 points in 9.6 MB of SWC, drawing took 44
/// times as much, and exploration 10 times.
fn check_memory(files: &[PathBuf], exploring: bool) -> Result<(), DrawError> {
    // A container has many cells.
    let files: BTreeSet<_> = files
        .iter()
        .map(|file| neurotess_formats::file_of(file))
        .collect();
    let sizes = files
        .into_iter()
        .map(|file| std::fs::metadata(file).map_or(0, |data| data.len()));
    let bytes = sizes.fold(0, u64::saturating_add);
    let needed = bytes.saturating_mul(if exploring { 6 } else { 25 });
    let checked = memory::check(needed);
    checked.map_err(|e| DrawError::Memory(format!("{e}: choose fewer cells, or --lod exploration")))
}

/// What meshes are made by.
struct Meshing<'a> {
    options: GenerateOptions,
    /// Whether exploration draws them.
    exploring: bool,
    /// Whether there are so many that what is not drawn is not kept.
    many: bool,
    cache: Option<&'a Cache>,
    host: &'a dyn Host,
}

fn cell(
    file: &Path,
    cut: &[Compartment],
    read: ReadOptions,
    meshing: &Meshing<'_>,
) -> Result<MeshedCell, String> {
    let mut read = meshing.host.read(file, &read)?;
    if !cut.is_empty() {
        read.morphology = with_middles(&read.morphology, cut);
    }
    let file = file.display().to_string();
    let options = &meshing.options;
    let stopped = meshing.host.stopped();
    let Some(cache) = meshing.cache else {
        let cell = meshed(file, read.morphology, options, stopped)?;
        return Ok(meshing.kept(MeshedCell {
            warnings: read.warnings,
            #[cfg(feature = "gpu")]
            proxy: meshing.only_proxies().then(|| Proxy::new(&cell.mesh, &[])),
            ..cell
        }));
    };
    let watch = Watch::stopped_by(stopped);
    let generate = || neurotess_generate::generate_watched(&read.morphology, options, &watch);
    let (generated, key) = cache
        .mesh(&read.morphology, options, generate)
        .map_err(|e| format!("{file}: {e}"))?;
    #[cfg(not(feature = "gpu"))]
    let _ = key;
    Ok(meshing.kept(MeshedCell {
        warnings: read.warnings,
        #[cfg(feature = "gpu")]
        proxy: meshing
            .exploring
            .then(|| cache.proxy(&key, &generated.mesh)),
        ..MeshedCell::of_mesh(file, read.morphology, generated)
    }))
}

impl Meshing<'_> {
    /// Whether meshes are needed only for their proxies.
    fn only_proxies(&self) -> bool {
        self.exploring && self.many
    }

    /// What is kept of a cell: of many that are explored, a mesh takes ten times as much memory as its proxy.
    fn kept(&self, mut cell: MeshedCell) -> MeshedCell {
        if self.only_proxies() {
            cell.bounds = Some(bounds(&cell.mesh));
            cell.mesh.vertices = Vec::new();
            cell.mesh.patches = Vec::new();
        }
        cell
    }
}

/// Meshes a cell that is in memory, unless another thread sets `stopped`.
pub(crate) fn meshed(
    file: String,
    morphology: Morphology,
    options: &GenerateOptions,
    stopped: &AtomicBool,
) -> Result<MeshedCell, String> {
    let watch = Watch::stopped_by(stopped);
    let generated = neurotess_generate::generate_watched(&morphology, options, &watch);
    let generated = generated.map_err(|e| format!("{file}: {e}"))?;
    Ok(MeshedCell::of_mesh(file, morphology, generated))
}

fn warn(cell: &MeshedCell, all: bool, host: &dyn Host) {
    let file = &cell.file;
    if cell.is_empty {
        host.warning(&format!(
            "{file}: nothing is left to draw: check --types and --soma"
        ));
    }
    if !all {
        return;
    }
    for Warning {
        line,
        message,
        code,
        ..
    } in &cell.warnings
    {
        let place = match line {
            Some(line) => format!("{file}:{line}:"),
            None => format!("{file}:"),
        };
        host.warning(&format!("{place} {message} ({code})"));
    }
    for mended in &cell.mended {
        host.warning(&format!("{file}: {mended}"));
    }
}
