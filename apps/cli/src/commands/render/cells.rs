//! Reads and meshes the inputs.

use std::collections::{BTreeSet, HashMap};
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use neurotess::batch::{self, Input, Inputs};
use neurotess::cache::Cache;
use neurotess::circuit::Compartment;
use neurotess::coloring::with_middles;
use neurotess::formats::{self, ReadOptions, Warning};
use neurotess::generate::{self, GenerateOptions, Generated};
use neurotess::mesh::{CoarseMesh, Watch};
use neurotess::morphology::Morphology;
use neurotess::picture::BoundingSphere;
use neurotess::picture::bounds::bounds;
use neurotess::recipe::memory;
#[cfg(feature = "gpu")]
use neurotess::render::Proxy;

use super::args::{LodMode, RenderArgs};
use crate::io::batch::each;
use crate::report::{Entry, Failure, Reporter, place};

/// Number of cells, or of placements of cells, from which on a cell has a few bounding spheres instead of one per point.
pub(super) const MANY: usize = 64;

/// A cell that can be drawn.
pub(crate) struct MeshedCell {
    pub(crate) file: String,
    pub(crate) morphology: Morphology,
    pub(crate) mesh: CoarseMesh,
    /// What exploration draws, if it came with the mesh; all its color keys are 0.
    #[cfg(feature = "gpu")]
    pub(crate) proxy: Option<Proxy>,
    /// Bounding spheres of the mesh, if only its tracing points are kept.
    pub(crate) bounds: Option<Vec<BoundingSphere>>,
    warnings: Vec<Warning>,
    mended: Vec<String>,
    /// Whether nothing of it can be drawn.
    is_empty: bool,
}

/// Reads and meshes all inputs on all cores; reports those that fail. `cuts`: the compartments of
/// those that show values of a report. `cache`: of their circuit.
pub(crate) fn read(
    inputs: &Inputs,
    cuts: &HashMap<PathBuf, Vec<Compartment>>,
    args: &RenderArgs,
    cache: Option<&Cache>,
    reporter: &Reporter,
) -> anyhow::Result<Vec<Entry<MeshedCell>>> {
    let meshing = Meshing {
        options: options(args),
        exploring: args.lod == Some(LodMode::Exploration),
        many: inputs.files.len() >= MANY,
        cache,
        stopped: reporter.stopped(),
    };
    check_memory(inputs, meshing.exploring)?;
    let read = ReadOptions {
        strict: args.strict,
        ..ReadOptions::default()
    };
    let entries = each(inputs, reporter, |input| {
        let cut = cuts.get(&input.path).map_or(&[][..], Vec::as_slice);
        cell(input, cut, read, &meshing)
    })?;
    let one = entries.len() == 1;
    for entry in &entries {
        if let Entry::Done(cell) = entry {
            warn(cell, one || reporter.verbose(), reporter);
        }
    }
    Ok(entries)
}

/// Whether memory holds what files of this size become, at the least: of 200,000 points in 9.6 MB of SWC, drawing took 44
/// times as much, and exploration 10 times.
fn check_memory(inputs: &Inputs, exploring: bool) -> anyhow::Result<()> {
    // A container has many cells.
    let files = inputs
        .files
        .iter()
        .map(|input| formats::member(&input.path).0);
    let files: BTreeSet<&Path> = files.collect();
    let sizes = files
        .into_iter()
        .map(|file| std::fs::metadata(file).map_or(0, |data| data.len()));
    let bytes = sizes.fold(0, u64::saturating_add);
    let needed = bytes.saturating_mul(if exploring { 6 } else { 25 });
    let checked = memory::check(needed);
    checked.map_err(|e| {
        anyhow::Error::new(e).context(format!("{e}: choose fewer cells, or --lod exploration"))
    })
}

/// How cells are meshed.
pub(super) fn options(args: &RenderArgs) -> GenerateOptions {
    let kinds = args.types.iter().flat_map(|types| types.0.iter().copied());
    GenerateOptions {
        soma: args.soma.method(),
        rings: args.rings.positions(),
        radius_factor: args.radius_factor(),
        unknown_radius: args.radius.radius,
        least_radius: args.radius.min_radius.unwrap_or(0.0),
        kinds: (!args.types.is_empty()).then(|| kinds.collect()),
        ..GenerateOptions::default()
    }
}

/// What meshes are made by.
struct Meshing<'a> {
    options: GenerateOptions,
    /// Whether exploration draws them.
    exploring: bool,
    /// Whether there are so many that what is not drawn is not kept.
    many: bool,
    cache: Option<&'a Cache>,
    stopped: &'a AtomicBool,
}

fn cell(
    input: &Input,
    cut: &[Compartment],
    read: ReadOptions,
    meshing: &Meshing<'_>,
) -> Result<MeshedCell, Failure> {
    let mut read = batch::read(&input.path, None, &read)?;
    if !cut.is_empty() {
        read.morphology = with_middles(&read.morphology, cut);
    }
    let file = input.path.display().to_string();
    let Meshing {
        options, stopped, ..
    } = meshing;
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
    let generate = || generate::generate_watched(&read.morphology, options, &watch);
    let (generated, key) = cache
        .mesh(&read.morphology, options, generate)
        .map_err(|e| Failure(format!("{file}: {e}")))?;
    #[cfg(not(feature = "gpu"))]
    let _ = key;
    Ok(meshing.kept(MeshedCell {
        warnings: read.warnings,
        #[cfg(feature = "gpu")]
        proxy: meshing
            .exploring
            .then(|| cache.proxy(&key, &generated.mesh)),
        ..of_mesh(file, read.morphology, generated)
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
pub(super) fn meshed(
    file: String,
    morphology: Morphology,
    options: &GenerateOptions,
    stopped: &AtomicBool,
) -> Result<MeshedCell, Failure> {
    let watch = Watch::stopped_by(stopped);
    let generated = generate::generate_watched(&morphology, options, &watch);
    let generated = generated.map_err(|e| Failure(format!("{file}: {e}")))?;
    Ok(of_mesh(file, morphology, generated))
}

fn of_mesh(file: String, morphology: Morphology, generated: Generated) -> MeshedCell {
    let mended = generated.warnings.iter();
    MeshedCell {
        file,
        mended: mended.map(|w| format!("{w} ({})", w.code)).collect(),
        is_empty: generated.mesh.patches.is_empty(),
        morphology,
        mesh: generated.mesh,
        #[cfg(feature = "gpu")]
        proxy: None,
        bounds: None,
        warnings: Vec::new(),
    }
}

fn warn(cell: &MeshedCell, all: bool, reporter: &Reporter) {
    let file = &cell.file;
    if cell.is_empty {
        reporter.warning(&format!(
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
        let place = place(file, *line);
        reporter.warning(&format!("{place} {message} ({code})"));
    }
    for mended in &cell.mended {
        reporter.warning(&format!("{file}: {mended}"));
    }
}
