//! Reads and meshes the inputs.

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

use neurotess::circuit::Compartment;
use neurotess::coloring::with_middles;
use neurotess::formats::{ReadOptions, Warning};
use neurotess::generate::{self, GenerateOptions};
use neurotess::mesh::CoarseMesh;
use neurotess::morphology::Morphology;

use super::args::RenderArgs;
use crate::io::batch::each;
use crate::io::inputs::{Input, Inputs};
use crate::io::morphologies::read_morphology;
use crate::report::{Entry, Failure, Reporter, place};

/// A cell that can be drawn.
pub(crate) struct MeshedCell {
    pub(crate) file: String,
    pub(crate) morphology: Morphology,
    pub(crate) mesh: CoarseMesh,
    warnings: Vec<Warning>,
    mended: Vec<String>,
}

/// Reads and meshes all inputs on all cores; reports those that fail. `cuts`: the compartments of
/// those that show values of a report.
pub(crate) fn read(
    inputs: &Inputs,
    cuts: &HashMap<PathBuf, Vec<Compartment>>,
    args: &RenderArgs,
    reporter: &Reporter,
) -> anyhow::Result<Vec<Entry<MeshedCell>>> {
    let options = options(args);
    let read = ReadOptions {
        strict: args.strict,
        ..ReadOptions::default()
    };
    let entries = each(inputs, reporter, |input| {
        let cut = cuts.get(&input.path).map_or(&[][..], Vec::as_slice);
        cell(input, cut, read, &options, reporter.stopped())
    })?;
    let one = entries.len() == 1;
    for entry in &entries {
        if let Entry::Done(cell) = entry {
            warn(cell, one || reporter.verbose(), reporter);
        }
    }
    Ok(entries)
}

/// How cells are meshed.
pub(super) fn options(args: &RenderArgs) -> GenerateOptions {
    let kinds = args.types.iter().flat_map(|types| types.0.iter().copied());
    GenerateOptions {
        soma: args.soma.method(),
        rings: args.rings.positions(),
        radius_factor: args.radius_factor(),
        kinds: (!args.types.is_empty()).then(|| kinds.collect()),
        ..GenerateOptions::default()
    }
}

fn cell(
    input: &Input,
    cut: &[Compartment],
    read: ReadOptions,
    options: &GenerateOptions,
    stopped: &AtomicBool,
) -> Result<MeshedCell, Failure> {
    let mut read = read_morphology(&input.path, None, &read)?;
    if !cut.is_empty() {
        read.morphology = with_middles(&read.morphology, cut);
    }
    let file = input.path.display().to_string();
    Ok(MeshedCell {
        warnings: read.warnings,
        ..meshed(file, read.morphology, options, stopped)?
    })
}

/// Meshes a cell that is in memory, unless another thread sets `stopped`.
pub(super) fn meshed(
    file: String,
    morphology: Morphology,
    options: &GenerateOptions,
    stopped: &AtomicBool,
) -> Result<MeshedCell, Failure> {
    let generated = generate::generate_stoppable(&morphology, options, || 0.0, stopped);
    let generated = generated.map_err(|e| Failure(format!("{file}: {e}")))?;
    let mended = generated.warnings.iter();
    Ok(MeshedCell {
        file,
        mended: mended.map(|w| format!("{w} ({})", w.code)).collect(),
        morphology,
        mesh: generated.mesh,
        warnings: Vec::new(),
    })
}

fn warn(cell: &MeshedCell, all: bool, reporter: &Reporter) {
    let file = &cell.file;
    if cell.mesh.patches.is_empty() {
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
