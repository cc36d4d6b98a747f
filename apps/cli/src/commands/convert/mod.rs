//! `neurotess convert`: morphologies in another format, and mended on the way.

mod circuit;
mod report;

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};

use clap::Args;
use neurotess::batch::{self, Input, Inputs, MORPHOLOGIES, readable, targets};
use neurotess::formats::swc::SampleNumbers;
use neurotess::formats::{self, Format, ReadOptions};
use neurotess::morphology::edit::{EditReport, Edited};
use serde::Serialize;

use crate::io::batch::each;
use crate::io::circuits::partition;
use crate::io::morphologies::{ReaderWarning, write_morphology, written as written_formats};
use crate::io::output::{self, OutputError};
use crate::report::{Entry, Failed, Failure, Reporter, Usage, usage};
use neurotess::options::EditRecipe;
use neurotess::options::groups::{CellSelection, EditOptions};

/// `neurotess convert`
#[derive(Args, Debug)]
#[command(after_help = "Lengths are µm after --scale or --units. \
    Numbers of samples are those of the input; of formats that have none, from 1 on in \
    the order of the file.")]
pub(crate) struct ConvertArgs {
    /// Morphology files, folders (searched recursively) or globs; FILE.h5#PATH for one cell of a container; -
    /// for standard input; or one circuit, whose cells are written in its coordinates
    #[arg(required = true, value_name = "INPUT")]
    pub(crate) inputs: Vec<PathBuf>,
    /// A file for one input, - for standard output; a folder for several, or for a folder, whose
    /// structure it repeats
    #[arg(short, long, value_name = "OUT", required_unless_present = "dry_run")]
    pub(crate) out: Option<PathBuf>,
    /// Replace files that exist
    #[arg(long)]
    pub(crate) force: bool,
    /// Format to write, where OUT's extension does not tell: swc, asc, h5 or nml
    #[arg(long, value_name = "FORMAT")]
    pub(crate) format: Option<String>,
    /// Keep the samples' own numbers in SWC where they do not ascend from row to row: NEURON refuses such files. The copy's
    /// samples are numbered from 1 on otherwise
    #[arg(long)]
    pub(crate) keep_ids: bool,
    /// Take every warning of the reader as an error
    #[arg(long)]
    pub(crate) strict: bool,
    /// Say what would change, and write nothing; needs no OUT
    #[arg(long)]
    pub(crate) dry_run: bool,
    #[command(flatten)]
    pub(crate) edits: EditOptions,
    #[command(flatten)]
    pub(crate) cells: CellSelection,
}

/// One object of the JSON list.
#[derive(Serialize)]
struct Converted {
    file: String,
    out: Option<String>,
    format: Option<&'static str>,
    warnings: Vec<ReaderWarning>,
    /// What the format cannot represent.
    lost: Vec<ReaderWarning>,
    /// What each edit changed.
    edits: Vec<EditReport>,
    /// Whether nothing was written.
    dry_run: bool,
    /// The node of a circuit.
    #[serde(skip_serializing_if = "Option::is_none")]
    node: Option<NodeName>,
}

/// A node of a circuit.
#[derive(Serialize)]
struct NodeName {
    population: String,
    node_id: u64,
}

/// Runs the command.
pub(crate) fn run(args: &ConvertArgs, reporter: &Reporter) -> anyhow::Result<()> {
    let recipe = match EditRecipe::of(&args.edits) {
        Ok(recipe) => recipe,
        Err(error) => {
            reporter.failure(&Failure(error.clone()));
            let file = "--spines".to_owned();
            let failed: Entry<Converted> = Entry::Failed(Failed { file, error });
            return reporter.document(&[failed]);
        }
    };
    let (circuits, others) = partition(&args.inputs);
    match &circuits[..] {
        [] => {}
        [path] if others.is_empty() => return circuit::run(args, path, &recipe, reporter),
        _ => return usage("a circuit is converted alone: leave out the other inputs"),
    }
    if args.cells.any() {
        return usage("no input is a circuit: leave out what chooses cells of one");
    }
    if recipe.needs_synapses() {
        return usage(
            "--spines synapses is of the cells of a circuit: name one, or a table of places",
        );
    }
    let inputs = Inputs::find(&args.inputs, &MORPHOLOGIES);
    if recipe.is_of_one_cell() && !inputs.one_file {
        return usage("a table of places is of one cell: give one input file");
    }
    let target = args
        .out
        .as_deref()
        .map(|out| target(out, args, &inputs, reporter))
        .transpose()?;
    let converted = each(&inputs, reporter, |input| {
        convert(input, args, target.as_ref(), &recipe)
    })?;
    tell_all(&converted, args, reporter)
}

/// Says what was done with each input.
fn tell_all(
    converted: &[Entry<Converted>],
    args: &ConvertArgs,
    reporter: &Reporter,
) -> anyhow::Result<()> {
    for entry in converted {
        if let Entry::Done(done) = entry {
            tell(done, args, reporter);
        }
    }
    reporter.document(&converted)
}

/// Where results go.
struct Target {
    format: Format,
    /// The file that each input becomes.
    outs: BTreeMap<PathBuf, PathBuf>,
}

fn target(
    out: &Path,
    args: &ConvertArgs,
    inputs: &Inputs,
    reporter: &Reporter,
) -> anyhow::Result<Target> {
    if !args.dry_run {
        output::reserve_standard(out, reporter)?;
    }
    let format = format(out, args, inputs)?;
    let named = out.extension().unwrap_or_default();
    let named = Format::of_extension(&named.to_string_lossy());
    reporter.warn_of_name(out, format.name(), named.map(Format::name));
    let jobs =
        targets::plan(inputs, out, format.extensions()[0]).map_err(|e| Usage(e.to_string()))?;
    let outs = jobs.into_iter().map(|job| (job.input, job.out)).collect();
    Ok(Target { format, outs })
}

fn convert(
    input: &Input,
    args: &ConvertArgs,
    target: Option<&Target>,
    recipe: &EditRecipe,
) -> Result<Converted, Failure> {
    let file = input.path.display().to_string();
    readable(&input.path)?;
    let out = target.map(|target| (target.outs[&input.path].as_path(), target.format));
    if let Some((out, _)) = out {
        output::check(out, args.force).map_err(|e| Failure(format!("{file}: {e}")))?;
    }
    let read = read(&input.path, args)?;
    let edited = recipe.apply(&read.morphology);
    let edited = edited.map_err(|e| Failure(format!("{file}: {e}")))?;
    written(file, read.warnings, edited, args, out)
}

fn read(path: &Path, args: &ConvertArgs) -> Result<formats::Read, Failure> {
    let options = ReadOptions {
        strict: args.strict,
        zero_for_bad_radii: args.edits.mends_radii(),
        unit_given: args.edits.gives_unit(),
        ..ReadOptions::default()
    };
    Ok(batch::read(path, None, &options)?)
}

/// Writes an edited tracing, unless this is a dry run.
fn written(
    file: String,
    warnings: Vec<formats::Warning>,
    edited: Edited,
    args: &ConvertArgs,
    out: Option<(&Path, Format)>,
) -> Result<Converted, Failure> {
    let failed = |e: OutputError| Failure(format!("{file}: {e}"));
    let numbers = match args.keep_ids {
        true => SampleNumbers::Kept,
        false => SampleNumbers::Ascending,
    };
    let lost = match out {
        Some((out, format)) if args.dry_run => {
            formats::write_numbered(&edited.morphology, format, numbers, io::sink())
                .map_err(|e| failed(OutputError::broken(out, e)))?
        }
        Some((out, format)) => {
            write_morphology(&edited.morphology, format, numbers, out, args.force)
                .map_err(failed)?
        }
        None => Vec::new(),
    };
    Ok(Converted {
        out: out.map(|(out, _)| out.display().to_string()),
        format: out.map(|(_, format)| format.extensions()[0]),
        lost: lost.into_iter().map(ReaderWarning::from).collect(),
        warnings: warnings.into_iter().map(ReaderWarning::from).collect(),
        edits: edited.reports,
        dry_run: args.dry_run,
        node: None,
        file,
    })
}

/// Says what was done, or would be.
fn tell(done: &Converted, args: &ConvertArgs, reporter: &Reporter) {
    let out = done.out.as_deref().map(|out| format!(" → {out}"));
    let mut lines = vec![format!("{}{}", done.file, out.unwrap_or_default())];
    lines.extend(done.edits.iter().map(report::line));
    match args.dry_run {
        true => {
            lines[0].push_str(" (dry run: nothing is written)");
            reporter.answer(&lines.join("\n"));
        }
        false => reporter.result(&lines.join("\n")),
    }
    for warning in &done.warnings {
        let of_unit = warning.is_of_unit() && !args.edits.changes_units();
        if of_unit || reporter.verbose() {
            reporter.warning(&warning.in_file(&done.file));
        }
    }
    report_losses(done, reporter);
}

/// Reports what OUT lacks: everything with --verbose, else the codes.
fn report_losses(done: &Converted, reporter: &Reporter) {
    let (Some(out), Some(format)) = (&done.out, done.format) else {
        return;
    };
    if done.lost.is_empty() {
        return;
    }
    if reporter.verbose() {
        for loss in &done.lost {
            reporter.warning(&format!("{out}: {}", loss.message()));
        }
        return;
    }
    let codes: Vec<&str> = done.lost.iter().map(ReaderWarning::code).collect();
    reporter.warning(&format!(
        "{out}: not all can be said in {format}: {} (-v tells more)",
        codes.join(", ")
    ));
}

/// The format named by --format or by OUT's extension; SWC for a folder.
fn format(out: &Path, args: &ConvertArgs, inputs: &Inputs) -> anyhow::Result<Format> {
    let name = match &args.format {
        Some(format) => format.clone(),
        None if targets::is_folder(out, inputs) => return Ok(Format::Swc),
        None => out
            .extension()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned(),
    };
    let format = Format::of_extension(&name).filter(|f| Format::WRITTEN.contains(f));
    if let Some(format) = format {
        return Ok(format);
    }
    let name = if name.is_empty() {
        format!("{} has no extension", out.display())
    } else {
        format!("morphologies cannot be written as '{name}'")
    };
    usage(format!("{name}: use {}", written_formats().join(", ")))
}
